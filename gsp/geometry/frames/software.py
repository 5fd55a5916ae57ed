"""Pinocchio, imported where it is used: it has no wheel for every system."""

from __future__ import annotations

from typing import Any

from gsp.errors import MissingSoftware

HINT = "pip install pin (Linux, macOS) or conda install -c conda-forge pinocchio (Windows too)"


def import_pinocchio() -> Any:
    """Return the module `pinocchio`.

    Raises
    ------
    MissingSoftware
        If it cannot be imported; the message has the command that installs it.
    """
    try:
        import pinocchio
    except ImportError as error:
        purpose = "frames and models of Pinocchio"
        raise MissingSoftware("pinocchio", purpose, hint=HINT) from error
    return pinocchio
