"""Forms, cases and what is true of them; see `hexdbb_truth`."""
