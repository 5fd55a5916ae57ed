"""Pinocchio, imported where it is used: it has no wheel for every system."""

from __future__ import annotations

from typing import Any

from gsp.installed import optional

HINT = "pip install pin (Linux, macOS) or conda install -c conda-forge pinocchio (Windows too)"


def import_pinocchio() -> Any:
    """Return the module `pinocchio`.

    Raises
    ------
    MissingSoftware
        If it cannot be imported; the message has the command that installs it.
    """
    with optional("pinocchio", "frames and models of Pinocchio", hint=HINT):
        import pinocchio
    return pinocchio
