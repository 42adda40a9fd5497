"""Two methods for the sheared annulus, without common equations."""
