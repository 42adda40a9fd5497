"""Writes the documentation as static pages, from the registry, the docstrings and the folder ``docs``."""
