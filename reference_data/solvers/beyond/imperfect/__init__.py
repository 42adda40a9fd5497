"""An over-filled tube under tilted gravity, or of a thickness that varies around: its limit levels."""
