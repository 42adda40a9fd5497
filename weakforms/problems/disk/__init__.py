"""The circular membrane of Paper 1."""
