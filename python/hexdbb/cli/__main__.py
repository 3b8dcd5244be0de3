"""`python -m hexdbb.cli`: the command `hexdbb`, for programs that start it with an interpreter of their own."""

from hexdbb.cli import main

main()
