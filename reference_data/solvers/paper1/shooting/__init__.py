"""The circular membrane by shooting (method a)."""
