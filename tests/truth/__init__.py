"""Data for honest tests of discovery, from a truth that shares nothing with the estimator.

A case is a machine with errors of geometry and set-up, and mechanisms that act in time; `simulate` drives a plan on it
and gives the record that `hexdbb-run` would have written, without a bus. The truth is that of the simulated rig
(`hexdbb.rig`): six-coordinate Newton, exact point transforms, mechanisms with an inner state. Nothing here imports the
engine or what is built on it.
"""
