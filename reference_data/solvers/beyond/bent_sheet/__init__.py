"""A sheet bent in its plane between two concentric arcs: shooting, and quadratures of a first integral."""
