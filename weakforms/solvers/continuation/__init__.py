"""Branches of solutions and special points on them."""
