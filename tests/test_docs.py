"""README and docs: every Python block runs, every command line is one that exists."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import typer.main

from gsp.cli import main
from gsp.cli.app import app

ROOT = Path(__file__).parents[1]
PAGES = (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md")))
BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Commands that are run as they stand (quick ones), and what makes others quick.
RUN = ("catalogue", "show", "jacobian", "--version", "--help")
QUICK = {"rank": ("--samples", "4", "--no-plot")}
# What is ranked instead of the whole catalogue, which the tests of the command rank.
FEW = ("D1^6", "D3^4 A1^2")
DESIGN_FILE = re.compile(r"[\w-]+\.toml")
# The file after --task, which has the poses and their number.
TASK = """samples = 4
[[wanted]]
index = "CTN"
[box]
position = [0, 0, [120, 140]]
angles = [0, 0, 0]
"""


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    page: Path
    line: int
    language: str
    note: str
    text: str


def blocks(page: Path) -> Iterator[Block]:
    text = page.read_text(encoding="utf-8")
    for match in BLOCK.finditer(text):
        yield Block(page, text.count("\n", 0, match.start()) + 1, *match.groups())


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def commands() -> Iterator[tuple[str, str]]:
    """Command lines of sh blocks, continued lines joined, with their place."""
    for page in PAGES:
        for block in blocks(page):
            if block.language in ("sh", "bash", "shell", "console"):
                for line in block.text.replace("\\\n", " ").splitlines():
                    words = line.strip().removeprefix("$ ")
                    if words and not words.startswith("#"):
                        yield f"{name(page)}:{block.line}", words


def mentions() -> Iterator[str]:
    """Commands in running text, in backticks, that are written out."""
    for page in PAGES:
        text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
        for code in re.findall(r"`(gsp [^`\n]+)`", text):
            if not set("…<>|") & set(code):  # those are forms, not commands
                yield code


# A line that several pages have is that of the first one.
PLACES = {line: place for place, line in reversed(list(commands()))}
COMMANDS = [pytest.param(line, id=f"{PLACES[line]} {line}"[:80]) for line in sorted(PLACES)]
WITH_PYTHON = [p for p in PAGES if any(b.language == "python" for b in blocks(p))]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return an empty folder to work in, without a screen."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    return tmp_path


@pytest.mark.parametrize("page", WITH_PYTHON, ids=name)
def test_python_blocks_run(page, folder):
    """The blocks of a page share their names, from top to bottom.

    A block headed `python not-run` needs what is not here (another machine): it is compiled only.
    """
    names = {"__name__": "__main__"}
    for block in blocks(page):
        if block.language == "python":
            code = "\n" * block.line + block.text
            compiled = compile(code, str(page), "exec")
            if block.note.strip() != "not-run":
                exec(compiled, names)


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_exist(line, folder):
    words = shlex.split(line, comments=True)
    if words[0] == "make":
        targets = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
        wanted = [word for word in words[1:] if "=" not in word]
        assert set(wanted) <= set(targets)
    elif Path(words[0]).name == "gsp" or words[:3] == ["python", "-m", "gsp"]:
        arguments = words[1:] if Path(words[0]).name == "gsp" else words[3:]
        check_command(arguments)
    else:
        assert words[0] in ("pip", "git", "cd", "python", "conda"), "neither make nor gsp"


@pytest.mark.parametrize("line", sorted(set(mentions())))
def test_mentioned_commands_exist(line):
    parse(until_redirection(shlex.split(line)[1:]))


def check_command(arguments: list[str]) -> None:
    """Parse a command line of gsp; run it where that is quick."""
    arguments = until_redirection(arguments)
    design = (ROOT / "catalogue/designs/toz-kucuk-2016-d3-6.toml").read_text()
    outputs = {b for a, b in pairwise(arguments) if a in ("--out", "--plot")}
    for word in arguments:
        if DESIGN_FILE.fullmatch(word) and word not in outputs:
            Path(word).write_text(design)
    tasks = [b for a, b in pairwise(arguments) if a == "--task"]
    for word in tasks:
        Path(word).write_text(TASK)
    given = parse(arguments)
    if arguments and arguments[0] in (*RUN, *QUICK):
        few = FEW if given.get("designs", True) in (None, (), []) else ()
        quick = ("--no-plot",) if tasks else QUICK.get(arguments[0], ())
        with pytest.raises(SystemExit) as end:
            main([*arguments, *quick, *few])
        assert end.value.code in (0, None)


def until_redirection(arguments: list[str]) -> list[str]:
    ends = [i for i, word in enumerate(arguments) if word in ("|", ">", ">>", "&&", ";")]
    return arguments[: ends[0]] if ends else arguments


def parse(arguments: list[str]) -> dict[str, Any]:
    """Return the parameters of a command, none of a command without arguments."""
    group = typer.main.get_command(app)
    if not arguments or arguments[0].startswith("-"):
        return {}
    with group.make_context("gsp", list(arguments)) as context:
        found, command, rest = group.resolve_command(context, list(arguments))
        if "--help" not in rest:
            return command.make_context(found, rest, parent=context).params
    return {}


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page):
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
        if not target.startswith(("http:", "https:", "mailto:")):
            assert (page.parent / target).exists(), f"{name(page)}: {target}"


def test_there_is_something_to_check():
    assert name(PAGES[0]) == "README.md"
    assert WITH_PYTHON
    assert COMMANDS


@pytest.mark.parametrize("arguments", [["rank", "--nonsense"], ["dance"], ["jacobian"]])
def test_wrong_commands_are_noticed(arguments, folder):
    with pytest.raises(typer.TyperException):
        check_command(arguments)
