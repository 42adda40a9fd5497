"""What several reference codes use: collocation, laws, tables."""
