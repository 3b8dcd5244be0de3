"""`python -m hexdbb.cli`: the command `hexdbb` under a chosen interpreter."""

from hexdbb_start import hexdbb

hexdbb()
