"""Diagrams: lines of critical points in a plane of two parameters."""
