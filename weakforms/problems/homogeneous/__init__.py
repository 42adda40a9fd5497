"""Bodies that deform homogeneously, and material laws at a point."""
