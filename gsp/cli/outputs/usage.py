"""Messages on words that the parser refuses, in the form of the other errors of the library."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, get_args

import typer

from gsp.cli.inputs.files import shown_name
from gsp.errors import UnknownName, brief, expected

# What the parser states in words only: the errors have no attribute for it.
NO_COMMAND = re.compile(r"No such command '(.*)'\.(?: Did you mean .*)?", re.DOTALL)
EXTRA = re.compile(r"Got unexpected extra argument\(s\) \((.*)\)", re.DOTALL)
INPUT = re.compile(r"(?:Value error, )?Input should be (.*?)(?:, (?:unable|got) .*)?", re.DOTALL)
CHOICE = re.compile(r".* is not one of (.*)\.", re.DOTALL)
# Words for a value of a type, and for several.
KINDS = {int: ("an integer", "integers"), float: ("a number", "numbers"), Path: ("a path", "paths")}


def usage_text(error: typer.TyperException, words: Sequence[str], command: Any) -> str:
    """Return the message of an error of the parser: what was expected, and what came.

    Parameters
    ----------
    error : TyperException
    words : sequence of str
        The arguments of the process.
    command : command of typer or None
        The one that they call: some errors have no context.
    """
    context: Any = getattr(error, "ctx", None)
    parameter: Any = getattr(error, "param", None)
    option = getattr(error, "option_name", None)
    text = error.message
    if hasattr(error, "possibilities"):
        return str(UnknownName("option", str(option), _options(context)))
    if hasattr(error, "param_type") and parameter is not None:
        return expected(shown_name(parameter), _described(parameter), "none")
    if parameter is not None:
        return _refused_value(parameter, text, error.__cause__)
    if option is not None:
        return _wrong_number(str(option), text, words, command)
    if found := NO_COMMAND.fullmatch(text):
        return str(UnknownName("command", found[1], context.command.commands))
    if found := EXTRA.fullmatch(text):
        names = [shown_name(p) for p in context.command.params if _is_argument(p)]
        wanted = f"nothing after {' '.join(names)}" if names else "no argument"
        return expected(context.command_path.removeprefix("gsp "), wanted, brief(found[1]))
    return error.format_message()


def _is_argument(parameter: Any) -> bool:
    return bool(parameter.param_type_name == "argument")


def _options(context: Any) -> Iterator[str]:
    """Yield the names of the options of the command of a context."""
    for parameter in context.command.get_params(context) if context else ():
        if not _is_argument(parameter):
            yield from (*parameter.opts, *parameter.secondary_opts)


def _described(parameter: Any) -> str:
    """Return what a parameter is, by the first sentence of its help."""
    text = re.split(r"\.(?: |$)", " ".join((parameter.help or "a value").split()), maxsplit=1)[0]
    return text[:1].lower() + text[1:]


def _kind(parameter: Any, number: int = 1) -> str:
    """Return the words for so many values of a parameter, with their names."""
    hint = parameter.type_descriptor.annotation
    types = {t for one in (hint, *get_args(hint)) for t in (one, *get_args(one))}
    one, several = next((KINDS[t] for t in KINDS if t in types), (_described(parameter), "values"))
    if number == 1:
        return one
    return f"{number} {several}" + (f" ({parameter.metavar})" if parameter.metavar else "")


def _refused_value(parameter: Any, text: str, cause: BaseException | None) -> str:
    """Return the message on a value of another type, out of range, or that is no choice."""
    name = shown_name(parameter)
    invalid = getattr(cause, "errors", None)
    value = str(invalid()[0].get("input")) if callable(invalid) else ""
    text = text.rstrip(".").removeprefix("Value error, ")
    if choice := CHOICE.fullmatch(f"{text}."):
        known = re.findall(r"'([^']*)'", choice[1])
        near = difflib.get_close_matches(value, known, n=1, cutoff=0.4)
        wanted = f"one of {', '.join(known)}" if len(known) > 1 else known[0]
        return expected(name, wanted, brief(value)) + (f"; nearest: {near[0]}" if near else "")
    if found := INPUT.fullmatch(text):
        wanted = re.sub(r"^(greater|less)", r"a number \1", found[1])
        wanted = wanted.replace("a valid integer", "an integer").replace("a valid ", "a ")
        return expected(name, wanted, brief(value))
    return f"{name}: {text}" + (f", received {brief(value)}" if callable(invalid) else "")


def _wrong_number(option: str, text: str, words: Sequence[str], command: Any) -> str:
    """Return the message on an option with too few values, or with one that it does not take."""
    given = [i for i, word in enumerate(words) if word.partition("=")[0] == option]
    last = given[-1] if given else len(words) - 1
    inside = "=" in words[last] if words else False
    if "does not take a value" in text:
        return expected(option, "no value", brief(words[last].partition("=")[2]))
    received = len(words) - 1 - last + inside
    found = next((p for p in getattr(command, "params", ()) if option in p.opts), None)
    wanted = "more values" if found is None else _kind(found, found.nargs)
    return expected(option, wanted, received or "none")
