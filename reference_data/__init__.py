"""Reference numbers for the thesis's figures and tables, and the codes that produced them."""
