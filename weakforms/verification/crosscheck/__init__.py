"""The judging of somebody else's curve: row by row, with its units, as pictures."""
