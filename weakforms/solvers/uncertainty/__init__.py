"""Numbers with uncertainties, from results on several meshes."""
