"""Branches that leave free inflation of the tube where a symmetry breaks."""
