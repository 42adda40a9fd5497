"""Two methods for the inflated torus, without common equations."""
