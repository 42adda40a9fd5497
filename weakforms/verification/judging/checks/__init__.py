"""The kinds of checks a case is made of: what each needs solved, what it is called, and how it judges."""
