"""Learned hypotheses: those that are listed, and those whose numbers the readings propose."""
