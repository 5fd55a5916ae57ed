"""Files that one command reads or writes: no two of its options may name the same one."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import typer

from gsp.errors import InvalidInput, expected

# Metavars of parameters whose texts may be names of files.
FILE_METAVARS = ("FILE", "DESIGN")


def is_path(parameter: Any) -> bool:
    """Return whether a parameter of a command is a path, and not a text."""
    kind = parameter.type_descriptor.annotation
    return Path in {kind, *get_args(kind)}


def shown_name(parameter: Any) -> str:
    """Return how messages name a parameter: the option, or the argument in capitals."""
    first = str(parameter.opts[0])
    return first if first.startswith("-") else str(parameter.name).upper()


def refuse_same_file(context: typer.Context) -> None:
    """Raise an error if two parameters name one file, which the second would overwrite.

    Raises
    ------
    InvalidInput
    """
    names: dict[str, str] = {}
    for parameter in sorted(context.command.params, key=is_path):  # what is only read comes first
        written = is_path(parameter)
        name = shown_name(parameter)
        for text in _texts(parameter, context.params.get(parameter.name or "")):
            file = _resolved(text)
            if written and file in names:
                raise InvalidInput(expected(name, f"another file than {names[file]}", text))
            names.setdefault(file, name)


def _texts(parameter: Any, value: object) -> Iterator[str]:
    """Yield the paths that a parameter has: of a text that may be one, only files that exist."""
    if is_path(parameter):
        if value is not None:
            yield str(value)
        return
    metavar = getattr(parameter, "metavar", None) or ""
    if parameter.opts[0].startswith("-") and not any(end in metavar for end in FILE_METAVARS):
        return
    for text in value if isinstance(value, list | tuple) else [value]:
        if isinstance(text, str) and os.path.isfile(text):
            yield text


def _resolved(text: str) -> str:
    """Return the path to which links lead, in one spelling per file."""
    try:
        return os.path.normcase(os.path.realpath(text))
    except ValueError:  # a byte 0, which is reported where the file is written
        return text
