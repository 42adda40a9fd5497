"""What the energy is. UFL only: no mesh, no solver, no numbers."""
