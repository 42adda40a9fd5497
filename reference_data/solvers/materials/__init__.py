"""Tables of material laws, and of the papers' bodies made of them."""
