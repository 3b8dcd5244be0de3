"""Forms, cases and what is true of them; see `tests.truth`."""
