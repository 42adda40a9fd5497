"""The tube by piecewise Chebyshev collocation (method b)."""
