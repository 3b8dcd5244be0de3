"""`python -m hexdbb.cli`: the command `hexdbb` under a chosen interpreter."""

from hexdbb.cli import main

main()
