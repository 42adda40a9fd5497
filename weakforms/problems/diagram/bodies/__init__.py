"""The membranes of diagrams: weak forms all of whose parameters are loads."""
