"""``python -m weakforms`` is the command line."""

from weakforms.cli import main

main()
