"""Bent states of a tube of liquid that bears no compression, by the two codes of bent states of paper 3."""
