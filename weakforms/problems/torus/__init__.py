"""The torus of circular cross-section under gas."""
