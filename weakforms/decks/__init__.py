"""Decks: a body of this project as a mesh with boundary, material and load, for another code to solve."""

from weakforms.decks.write import CODES, write_deck

__all__ = ["CODES", "write_deck"]
