"""Tables of questions that the papers did not ask."""
