"""The bent tube as a surface in space."""
