"""What is verified: cases, their specifications and their reference tables."""
