"""The pre-stretched tube of Paper 2."""
