"""Solvers of limit points of parts of spheres under gas."""
