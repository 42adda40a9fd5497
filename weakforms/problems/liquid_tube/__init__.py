"""The fluid-loaded tube of Paper 3."""
