"""From the sets found to causes by name: other explanations compared, known words preferred, a grade."""
