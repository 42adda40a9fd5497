"""Lopsided states of the free tube, without mirror symmetry about mid-length, by two methods."""
