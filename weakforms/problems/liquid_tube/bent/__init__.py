"""The liquid-filled tube where it bends sideways, as a surface in space."""
