"""Tables beyond the papers."""
