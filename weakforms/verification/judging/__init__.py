"""Verdicts: comparison of results with references."""
