"""Membranes of flat triangles in space."""
