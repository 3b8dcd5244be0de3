"""Evidence for what is missing from a model: hypotheses, marginal likelihood, held-out prediction, graded verdicts."""
