"""The kinds of checks of a case: the solutions that each needs, its names, and its judgement."""
