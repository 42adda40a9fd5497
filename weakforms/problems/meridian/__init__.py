"""One axisymmetric membrane, from which the models of the problems are made."""
