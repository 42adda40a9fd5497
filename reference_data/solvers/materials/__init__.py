"""Tables of material laws, and of the papers' problems with these laws."""
