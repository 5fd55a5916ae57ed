"""How the command line finds a design: a file, or a published name."""

from __future__ import annotations

from pathlib import Path

from gsp.catalogue import design as published_design
from gsp.design import Design, read_design


def find_design(text: str) -> Design:
    """Return the design in a file of that path, else the published design of that name."""
    if Path(text).is_file() or text.endswith(".toml"):
        return read_design(text)
    return published_design(text)
