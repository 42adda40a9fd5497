"""Waves around a wrinkled membrane, Paper 5."""
