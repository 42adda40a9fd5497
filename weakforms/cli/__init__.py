"""The command line: one verb for each use of the suite, and one module for each kind of use."""

# The order of these modules is the order of the verbs in the help; each registers its verbs with the app.
from weakforms.cli import solving, diagrams, viewing, checking, comparing, decks, auditing, documenting  # noqa: F401, I001  (the order)
from weakforms.cli.app import app
from weakforms.cli.entry import main

__all__ = ["app", "main"]
