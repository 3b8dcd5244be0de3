"""Sets of hypotheses fitted in full: their evidence, what speaks against them, what they predict where left out."""
