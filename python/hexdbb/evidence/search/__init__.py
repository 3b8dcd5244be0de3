"""Search for the sets of hypotheses that say what is missing, and what a set must do to be sure."""
