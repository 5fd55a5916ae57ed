"""TOML texts: their contents, and the line of each key, for messages about data files."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from typing import Any

from gsp.errors import MalformedFile

# The start of a key of too many parts: the time to read one grows with their square.
_LONG_KEY = re.compile(r"""(?<![\w.-])(?:[\w"'-]++[ \t]*+\.[ \t]*+){100}""")
_HEAD = re.compile(r"\s*\[+\s*[\w.-]+\s*\]+\s*(#.*)?$")


def heads_of(lines: Sequence[str], table: str) -> list[int]:
    """Return the lines, from 1, of the heads of the tables of a name.

    >>> heads_of(["[[legs]]", "a = 1", "[[legs]]", "a = 2"], "legs")
    [1, 3]
    """
    head = re.compile(rf"\s*\[+\s*{re.escape(table)}\s*\]+")
    return [i for i, line in enumerate(lines, 1) if head.match(line)]


def line_of(lines: Sequence[str], key: str, table: str = "", number: int = 0) -> int:
    """Return the line, from 1, of a key in the number-th table of that name.

    It is the line of the head of the table where the key is not there, and 1 where neither is.

    >>> line_of(["[[legs]]", "a = 1", "[[legs]]", "a = 2"], "a", "legs", 1)
    4
    """
    heads = heads_of(lines, table) if table else []
    start = heads[number] - 1 if number < len(heads) else 0
    wanted = re.compile(rf"\s*{re.escape(key)}\s*[.=]")
    named = re.compile(rf"\s*\[+\s*{re.escape(key)}\s*[].]")
    for i, line in enumerate(lines[start:], start):
        if i > start and table and _HEAD.match(line):
            break
        if wanted.match(line) or (not table and named.match(line)):
            return i + 1
    return start + 1


def parse_toml(text: str, origin: str) -> dict[str, Any]:
    """Return the contents of a TOML text; a byte-order mark at its beginning is ignored.

    Parameters
    ----------
    text : str
    origin : str
        The file, for messages.

    Raises
    ------
    MalformedFile
        If the text is not TOML, or nested too deeply.
    """
    if _LONG_KEY.search(text):
        raise MalformedFile(f"{origin}: not TOML that can be read: a key of more than 100 parts")
    try:
        # Without the last newline a mistake in the last line is reported at the end.
        return tomllib.loads(text + "\n")
    except tomllib.TOMLDecodeError as error:
        raise MalformedFile(f"{origin}: not TOML: {error}") from error
    except RecursionError as error:
        raise MalformedFile(f"{origin}: not TOML that can be read: nested too deeply") from error
    except ValueError as error:  # integers of thousands of digits
        reason = "a number has too many digits" if "digits" in str(error) else str(error)
        raise MalformedFile(f"{origin}: not TOML that can be read: {reason}") from error
