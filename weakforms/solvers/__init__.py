"""How it is solved: SNES, continuation, critical points, SLEPc, dolfinx versions. No physics."""
