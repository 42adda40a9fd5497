"""Cases, their specifications and their reference tables."""
