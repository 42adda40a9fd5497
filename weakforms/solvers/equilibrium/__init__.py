"""Systems of equations, their constraints, and Newton's method."""
