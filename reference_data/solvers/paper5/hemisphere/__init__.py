"""The hanging hemisphere."""
