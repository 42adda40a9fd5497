"""Verdicts: results held against references."""
