"""Wrinkled membranes of revolution, Papers 4 and 5."""
