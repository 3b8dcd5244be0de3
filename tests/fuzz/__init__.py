"""Damaged input to everything that hexdbb reads: each is accepted, or refused with one line.

``python -m tests.fuzz --count 10000 --seed 1`` tries all formats and prints a table.
"""
