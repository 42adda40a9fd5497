"""Inertia, eigenvalues and modes of the second variation."""
