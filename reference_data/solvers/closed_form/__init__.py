"""Closed and nearly closed forms."""
