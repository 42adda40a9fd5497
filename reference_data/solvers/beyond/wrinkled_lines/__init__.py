"""Lines of critical points of the wrinkled tube, by the methods of paper 4."""
