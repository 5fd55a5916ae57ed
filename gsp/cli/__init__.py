"""The command line: `gsp …`."""

from __future__ import annotations

TYPE_CHECKING = False  # that of typing takes a few ms to import, in which Ctrl-C is a traceback
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command line on `arguments` (default those of the process), and exit.

    An error is one line on stderr and exit status 2, without a traceback. Ctrl-C is one line and
    status 130, while modules are imported too. With `arguments` the caller's handler of SIGINT is
    kept.

    Parameters
    ----------
    arguments : sequence of str or None
        Words after `gsp`; None takes those of the process.
    """
    try:
        from gsp.cli import interrupts

        if arguments is None:
            interrupts.end_at_once()
        from gsp.cli.app import run

        run(arguments)
    except KeyboardInterrupt:
        from gsp.cli import interrupts

        interrupts.stop(printed=False)
    except SystemExit as end:
        if interrupts.pressed():
            interrupts.stop(printed=end.code == interrupts.INTERRUPTED)
        interrupts.ignore()
        raise
    except BaseException:
        if interrupts.pressed():  # the interrupt became another error
            interrupts.stop(printed=False)
        raise
