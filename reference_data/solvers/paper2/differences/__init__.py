"""The tube by finite differences (method a)."""
