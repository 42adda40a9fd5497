"""Solvers of the hanging hemisphere."""
