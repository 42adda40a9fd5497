"""The circular membrane by piecewise Chebyshev collocation (method b)."""
