"""Trials of the estimator on machines of known truth (`hexdbb_truth`) that close whole loops."""
