"""How figures and pages look: what can be known without drawing them."""

from __future__ import annotations

import json
from pathlib import Path

TEMPLATES = Path(__file__).parent / "templates"
LOOK = json.loads((TEMPLATES / "figures.json").read_text("utf-8"))
"""Colours for light and dark pages (the style sheet takes them from here too), markers, style."""
WIDTH, LEFT, RIGHT = 4.9, 0.68, 0.16
"""Of a panel, and of what is left free beside its axes, in inches: small enough that the text stays readable
at the width of a phone."""
HEIGHT = 3.2
"""Of a panel's axes, in inches."""
