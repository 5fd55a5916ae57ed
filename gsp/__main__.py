"""`python -m gsp` is the command line."""

from gsp.cli import main

main()
