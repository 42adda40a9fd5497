"""Reference solvers of problems beyond the papers."""
