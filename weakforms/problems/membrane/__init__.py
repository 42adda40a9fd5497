"""Membranes of any shape."""
