"""The command line: `gsp …`."""

from gsp.cli.app import main

__all__ = ["main"]
