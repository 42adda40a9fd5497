"""Reference codes and tables of Paper 2."""
