"""Judges curves of other codes: row by row, with units, with pictures."""
