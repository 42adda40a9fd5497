"""Energies and loads as UFL expressions, without mesh, solver or numbers."""
