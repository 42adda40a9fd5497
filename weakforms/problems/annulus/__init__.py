"""The flat annulus whose inner edge is turned in its plane."""
