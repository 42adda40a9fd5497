"""The bent tube by collocation of the strong form (method b)."""
