"""Constants for the look of figures and pages."""

from __future__ import annotations

import json
from pathlib import Path

TEMPLATES = Path(__file__).parent / "templates"
LOOK = json.loads((TEMPLATES / "figures.json").read_text("utf-8"))
"""Colours for light and dark pages (also for the style sheet), markers, style."""
WIDTH, LEFT, RIGHT = 4.9, 0.68, 0.16
"""Size of a panel and of the margins of its axes, in inches, small enough that text is readable on a
phone."""
HEIGHT = 3.2
"""Size of a panel's axes, in inches."""
