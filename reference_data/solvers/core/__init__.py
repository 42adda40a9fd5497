"""Code that several reference codes use: collocation, laws, tables."""
