"""Contact of a membrane with a soft substrate: its phases, and the history of a patch that sticks."""
