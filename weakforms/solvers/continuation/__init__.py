"""Branches of solutions and what is located along them."""
