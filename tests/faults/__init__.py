"""Faults on the bus and in the rig, each tried on a short run: a man-in-the-middle proxy, its faults, their page.

``python -m tests.faults`` runs the catalogue and writes the table of docs/fault-table.md.
"""
