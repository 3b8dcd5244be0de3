"""Readings linear about a model: whitened arrays, their sums, and every hypothesis at once to first order."""
