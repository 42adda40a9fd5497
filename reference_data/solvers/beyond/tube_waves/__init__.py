"""Stability of the axisymmetric tube of paper 2 against waves of any symmetry, by two methods."""
