"""Flat sheets whose edges are moved in their plane."""
