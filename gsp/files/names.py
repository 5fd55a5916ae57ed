"""Names of files that are made from the names of designs."""

from __future__ import annotations

import re

# Characters of such a name; file systems take 255 bytes, and one character has up to four.
LONGEST_NAME = 60


def file_stem(name: str) -> str:
    """Return the name of a file, without its ending, for a design of some name.

    It has no parts of a path and no spaces, is not hidden, and does not look like an option.

    >>> file_stem("../my press (2)"), file_stem("a/b"), file_stem("--"), file_stem("")
    ('my-press-2', 'a-b', 'design', 'design')
    """
    return re.sub(r"[^\w.-]+", "-", name)[:LONGEST_NAME].strip("-._") or "design"
