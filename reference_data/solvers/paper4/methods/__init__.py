"""Wrinkled states by collocation, by shooting and by finite differences."""
