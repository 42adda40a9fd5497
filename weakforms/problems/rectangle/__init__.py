"""Square and rectangular membranes."""
