"""Flat and cylindrical sheets with the relaxed energy."""
