"""Messages of commands: errors, warnings and notices, one line each, on streams that take them."""

from __future__ import annotations

import logging
import os
import re
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any, NoReturn

import typer

from gsp.cli.outputs import pipes
from gsp.errors import GspError, UnwritableOutput, brief
from gsp.progress import OnTerminal

# Characters of the longest word of a message, about those of a long path.
LETTERS_PER_WORD = 300
# Letters that are left of the beginning and of the end of longer ones.
LETTERS_OF_START, LETTERS_OF_END = 150, 50

# Options, by the names of the arguments in Python with which messages of the library begin.
# Messages on files and on the designs in them begin with other names.
OPTIONS: Mapping[str, str] = MappingProxyType(
    {
        "limits.position": "--box",
        "pose.position": "--position",
        "position": "--position",
        "domain": "--box",
        "shells": "--stroke",
        "angles": "--angles",
        "rotation": "--angles",
        "order": "--order",
        "resolution": "--resolution",
        "limits.indices": "--require",
        "ellipsoid.semi_axes": "--ellipsoid",
        "solids.radius": "--radius",
        "solids.density": "--density",
        "solids.platform_mass": "--platform-mass",
        "solids.metres": "--metres",
        "solids": "--platform-mass, --radius",
        "drives.efforts": "--effort",
        "drives.speeds": "--speed",
        "speeds": "--speeds",
        "accelerations": "--accelerations",
        "base_radius": "--base-radius",
        "base_angle": "--base-angle",
        "platform_radius": "--platform-radius",
        "platform_angle": "--platform-angle",
        "height": "--height",
    }
)
# Options that take one, and may be repeated.
ONE_OF_THEM: Mapping[str, str] = MappingProxyType({"--indices": "--index"})
# What separates the names of indices in values of options.
BETWEEN_NAMES = re.compile("[,<>=≤≥]")
# The argument, and which of its few numbers or attributes are meant.
ARGUMENT = re.compile(r"([a-z_.]+)(?: \((?:at index \[\d\]|[a-z_, ]+)\))?: ")


def clear_environment() -> None:
    """Set aside variables with which a command could not print or draw.

    Pictures are written to files, so that no display is needed; lines of 0 letters show nothing.
    """
    os.environ["MPLBACKEND"] = "agg"
    if not os.environ.get("COLUMNS", "1").lstrip("0"):
        del os.environ["COLUMNS"]


class _Warnings(logging.Handler):
    """Prints each warning once, as one line on stderr without the place in the code."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.printed: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        self.show(record.getMessage())

    def show(self, message: Warning | str, *_: Any, **__: Any) -> None:
        text = printable(str(message))
        if "glyph" in text.lower():  # matplotlib has several texts for one cause
            text = "the font of the picture does not have a character of its texts: a box is drawn"
        if text not in self.printed:
            self.printed.add(text)
            print(f"gsp: {text}", file=sys.stderr)


@contextmanager
def notices() -> Iterator[None]:
    """Print what the library logs, and all warnings, for the time of a command."""
    shown = _Warnings()
    warnings.showwarning = shown.show
    log, others, handler = logging.getLogger("gsp"), logging.getLogger("matplotlib"), OnTerminal()
    level = log.level
    log.addHandler(handler)
    others.addHandler(shown)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.removeHandler(handler)
        others.removeHandler(shown)
        log.setLevel(level)


def fail_on_output(error: OSError) -> NoReturn:
    """Print that the output could not be written, and exit."""
    what = error.filename or "standard output cannot be written"
    print(f"gsp: {printable(f'{what}: {error.strerror or error}')}", file=sys.stderr)
    pipes.drop(sys.stdout)
    sys.exit(2)


def printable(text: str) -> str:
    r"""Return a message on one line: what would change a terminal is escaped, long words are cut.

    >>> print(printable("a\x1b[31m\nb"), len(printable("a" * 5000)))
    a\x1b[31m b 201
    """
    words = [w if len(w) <= LETTERS_PER_WORD else _cut(w) for w in text.split()]
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(words)
    )


def _cut(word: str) -> str:
    """Return the beginning and the end of a long word."""
    return f"{word[:LETTERS_OF_START]}…{word[-LETTERS_OF_END:]}"


def _with_options(text: str, words: Sequence[str], options: Mapping[str, int]) -> str:
    """Return a message of the library that begins with the option that it is about.

    >>> text = "pose.position (at index [2]): expected finite numbers, received nan"
    >>> _with_options(text, [], {"--position": 3})
    '--position: expected finite numbers, received nan'
    >>> _with_options("a.ods: cannot be written", ["show", "--out", "a.ods"], {"--out": 1})
    '--out: a.ods: cannot be written'
    """
    found = ARGUMENT.match(text)
    if found is not None:
        same = f"--{found[1].replace('_', '-')}"
        for option in (OPTIONS.get(found[1], same), ONE_OF_THEM.get(same, "")):
            if option.partition(", ")[0] in options:
                text = f"{option}: {text[found.end() :]}"
                break
    of_task = any(option == "--task" for option, _ in _given(words, options))
    for name in ("length", "ellipsoid"):
        place = f"{name} in the task" if of_task else f"--{name}"
        text = text.replace(f"expected {name}=", f"expected {place}")
    for option, value in _given(words, options):
        if _begins_with(text, value):
            return f"{option}: {_shortened(text, value)}"
    return text


def _given(words: Sequence[str], options: Mapping[str, int]) -> Iterator[tuple[str, str]]:
    """Yield options and values as the user typed them."""
    for i, word in enumerate(words):
        name, equals, value = word.partition("=")
        if name in options and equals:
            yield name, value
        elif name in options:
            yield from ((name, text) for text in words[i + 1 : i + 1 + options[name]])


def _begins_with(text: str, value: str) -> bool:
    """Return whether a message is about a value: a path, or a list with an unknown name in it."""
    path = " ".join(str(Path(value)).split())
    if text.startswith((f"{path}: ", f"{path}, ", f"{printable(path)}: ")):
        return True
    if len(path) > LETTERS_PER_WORD and text.startswith(path[:LETTERS_PER_WORD]):
        return True
    parts = (value, *BETWEEN_NAMES.split(value))
    # As messages have them, on one line.
    names = {" ".join(brief(name).split()) for part in parts for name in (part, part.strip())}
    return any(re.match(rf"unknown [a-z ]+ {re.escape(name)}(?=[.;]|$)", text) for name in names)


def _shortened(text: str, value: str) -> str:
    """Return a message in which a long path is cut."""
    path = " ".join(str(Path(value)).split())
    if len(path) <= LETTERS_PER_WORD or not text.startswith(path[:LETTERS_PER_WORD]):
        return text
    # The middle of a longer message is gone already, and with it that of the path.
    return f"{_cut(path)}{text.rpartition(path[-LETTERS_OF_END:])[2]}"


def options_of(command: Any) -> dict[str, int]:
    """Return the long options of a command, with the number of words that each takes."""
    return {
        option: 0 if getattr(parameter, "is_flag", False) else parameter.nargs
        for parameter in getattr(command, "params", ())
        for option in parameter.opts
        if option.startswith("--")
    }


def one_line(
    error: GspError | typer.TyperException, words: Sequence[str], command: Any = None
) -> str:
    """Return the message of an error as one line that names options.

    Parameters
    ----------
    words : sequence of str
        The arguments of the process.
    command : command of typer or None
        The one that they call, None if there is none.
    """
    if isinstance(error, GspError):
        text = _with_options(" ".join(str(error).split()), words, options_of(command))
        if isinstance(error, UnwritableOutput):
            text = text.replace("may not be overwritten", "--force replaces it")
        return text
    from gsp.cli.outputs.usage import usage_text

    context = getattr(error, "ctx", None)
    path = context.command_path if context else " ".join(("gsp", *words[: command is not None]))
    return " ".join(f"{usage_text(error, words, command)} (see {path} --help)".split())
