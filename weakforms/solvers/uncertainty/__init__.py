"""From results on several meshes to numbers with uncertainties."""
