"""Writes the report of a run as pages, figures and machine-readable files."""
