"""Lines of critical points of the fluid-loaded tube, by the methods of paper 3."""
