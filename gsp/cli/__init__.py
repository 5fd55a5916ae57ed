"""The command line: `gsp …`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import NoReturn

__all__ = ["main"]

# Exit status of a command that was stopped by Ctrl-C.
INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command line on `arguments` (default those of the process), and exit.

    An error is one line on stderr and exit status 2, without a traceback. Ctrl-C is one line and
    status 130, while modules are imported too.

    Parameters
    ----------
    arguments : sequence of str or None
        Words after `gsp`; None takes those of the process.
    """
    try:
        from gsp.cli.app import run

        run(arguments)
    except KeyboardInterrupt:
        print("gsp: stopped", file=sys.stderr)
        sys.exit(INTERRUPTED)
