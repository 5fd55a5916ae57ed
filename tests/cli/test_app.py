"""The command itself: help, version, errors."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import threading
from functools import cache

import pytest
import rich.console
import typer.main
from rich.cells import cell_len

from gsp.cli.app import COMMANDS, app, load
from gsp.cli.outputs import waiting
from gsp.progress import compiling, during, meter, running
from gsp.version import __version__
from tests import campaign

NAME = "toz-kucuk-2016-d3-6"


def test_version(gsp):
    assert gsp("--version").out == f"gsp {__version__}\n"


def test_alone_it_helps(gsp):
    result = gsp()
    assert result.status == 0
    assert all(name in result.out for name in COMMANDS)


def test_list_is_that_of_the_commands():
    """The table of `gsp --help` has each command with the first line of its own help."""
    assert list(typer.main.get_command(app).commands) == list(COMMANDS)
    for name, (_, line) in COMMANDS.items():
        assert load(name).help.partition("\n\n")[0].replace("\n", " ") == line


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("flag", ["--help", "-h"])
def test_every_command_has_help(gsp, name, flag):
    result = gsp(name, flag)
    assert result.status == 0
    assert f"Usage: gsp {name}" in result.out


@pytest.mark.parametrize("name", ["rank", "catalogue", "show", "jacobian"])
def test_help_has_examples(gsp, name):
    assert f"• gsp {name}" in gsp(name, "--help").out


# As `load`, once for the tests of all commands.
loaded = cache(load)


def all_commands():
    """Yield the words of every command, also of commands of commands, and the command itself."""
    for name in COMMANDS:
        command = loaded(name)
        yield (name,), command
        yield from (
            ((name, part), found) for part, found in getattr(command, "commands", {}).items()
        )


@pytest.mark.parametrize(("words", "command"), list(all_commands()), ids=lambda x: str(x)[:30])
def test_messages_of_the_parser_state_what_was_expected(gsp, words, command):
    """Of every option: one letter too many, no value, a value too many; and of all arguments."""
    see = f" (see gsp {' '.join(words)} --help)"
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    for one in command.params:
        option = one.opts[0]
        if not option.startswith("--"):
            continue
        error = gsp(*words, f"{option}x").error
        assert error.startswith(f"gsp: unknown option '{option}x'; nearest: {option}"), error
        assert error.endswith(see)
        flag = getattr(one, "is_flag", False)
        error = gsp(*words, f"{option}=1" if flag else option).error
        end = "expected no value, received '1'" if flag else ", received none"
        assert error.startswith(f"gsp: {option}: expected "), error
        assert error.partition(" (see ")[0].endswith(end), error
        if one.nargs > 1:
            assert ", received 1 (see" in gsp(*words, f"{option}=1").error
    known = ["x"] * len(arguments)
    group = hasattr(command, "commands")
    asks = any(p.required for p in command.params if p not in arguments)
    if not group and not asks and all(p.nargs == 1 for p in arguments):
        names = " ".join(p.name.upper() for p in arguments)
        wanted = f"nothing after {names}" if names else "no argument"
        message = f"gsp: {' '.join(words)}: expected {wanted}, received 'y z'{see}"
        assert gsp(*words, *known, "y", "z").error == message
    if arguments and arguments[0].required:
        name = arguments[0].name.upper()
        error = gsp(*words).error
        assert error.startswith(f"gsp: {name}: expected "), error
        assert error.endswith(f", received none{see}"), error


def test_unknown_commands_have_the_nearest_ones(gsp):
    assert (
        gsp("rnak").error == "gsp: unknown command 'rnak'; nearest: rank, planar (see gsp --help)"
    )
    assert gsp("store", "imprt").error.startswith("gsp: unknown command 'imprt'; nearest: import")
    assert gsp("--dance").error.startswith("gsp: unknown option '--dance'")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("rank", "--samples", "x"), "--samples: expected an integer, received 'x'"),
        (("rank", "--samples", 0), "--samples: expected a number greater than or equal to 1"),
        (("rank", "--length", "x"), "--length: expected a number, received 'x'"),
        (("export", "x", "--to", "urfd"), "--to: expected one of mjcf, urdf, sdf, pinocchio, rec"),
        (("workspace", "x", "--region", "plan"), "received 'plan'; nearest: plane (see"),
        (("show", "x", "--position", 1, 2), "--position: expected 3 numbers (X Y Z), received 2"),
    ],
)
def test_values_that_the_parser_refuses(gsp, words, message):
    assert message in gsp(*words).error


def test_an_interrupt_prints_no_traceback(gsp, monkeypatch):
    def interrupted(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("gsp.cli.ranking.plan.Plan.compute", interrupted)
    result = gsp("rank", "--no-plot")
    assert (result.status, result.err) == (130, "gsp: stopped; nothing was written\n")


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("show", "gsp.cli.design.show.find_mechanism_or_design"),
        ("sweep", "gsp.cli.design.sweep.sweep"),
        ("maximum", "gsp.cli.design.maximum.find"),
        ("certify", "gsp.cli.design.certify.prove"),
        ("check", "gsp.published.check"),
        ("workspace", "gsp.workspace.section"),
        ("show", "gsp.cli.app.load"),
    ],
)
def test_interrupt_is_one_line_anywhere(gsp, monkeypatch, name, place):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(place, interrupted)
    design = "workspace-6-3" if name == "workspace" else "toz-kucuk-2016-d3-6"
    words = {"sweep": ["--rotate", "z"], "certify": ["--box", "10 -10 138 5 -5 -10"]}
    given = [] if name == "check" else [design, *words.get(name, [])]
    result = gsp(name, *given)
    assert (result.status, result.err) == (130, "gsp: stopped\n")


@pytest.mark.parametrize(
    ("streams", "printed"),
    campaign.some(
        [
            (">&-", 2),
            ("<&-", 0),
            ("2>&-", 0),
            ("<&- >&- 2>&-", 2),
            ("2>/dev/full", 0),
            ("2>&1 >&-", 2),
            (">/dev/full", 2),
        ],
        4,
    ),
)
def test_only_results_that_cannot_be_written_change_the_status(streams, printed):
    if "full" in streams and not os.path.exists("/dev/full"):
        pytest.skip("no /dev/full")
    for command, status in (("catalogue", printed), ("show nobody", 2)):
        call = f'"{sys.executable}" -m gsp {command} {streams}'
        done = subprocess.run(call, shell=True, capture_output=True, timeout=120, check=False)
        assert done.returncode == status, (command, done)
        assert b"Traceback" not in done.stderr + done.stdout
        assert b"Exception ignored" not in done.stderr + done.stdout


def test_nobody_reads_the_error():
    """Standard error is a pipe whose reading end is closed before the command begins."""
    read, write = os.pipe()
    os.close(read)
    words = [sys.executable, "-m", "gsp", "show", "nobody"]
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=write, timeout=120, check=False)
    os.close(write)
    assert (done.returncode, done.stdout) == (2, b"")


def test_a_long_command_states_without_a_terminal_what_is_done(monkeypatch):
    """Each line comes after twice as long as the one before; none after the end."""
    printed, second = [], threading.Event()

    class Stream(io.StringIO):
        def write(self, text):
            printed.append(text)
            if "".join(printed).count("\n") == 2:
                second.set()
            return len(text)

    monkeypatch.setattr(sys, "stderr", Stream())
    with meter(None, "cells") as report:
        report(3, 8)
        with waiting.lines(first=1e-3):
            assert second.wait(120.0)
        compiling(1)
        compiling(1)
        compiling(-1)
        assert running() == "cells, 3 of 8, formulas are compiled"
        compiling(-1)
    lines = "".join(printed).splitlines()
    wanted = re.compile(r"gsp: working for \d+ s: cells, 3 of 8")
    assert all(map(wanted.fullmatch, lines)), lines
    with waiting.lines():
        pass
    assert "".join(printed).splitlines() == lines
    # Between counted runs the command is named, or what it does.
    second.clear()
    printed.clear()
    with waiting.lines(first=1e-3, command="workspace"):
        assert second.wait(120.0)
    assert re.fullmatch(r"gsp: working for \d+ s: workspace", printed[0].strip())
    with during("picture"):
        assert running() == "picture"
    assert running() == ""


def test_terminal_without_unicode(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "gsp", "show", "D1^6"],
        capture_output=True,
        timeout=120,
        env={**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONWARNINGS": "error"},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert b"|d|" in done.stdout


def without_waiting(text):
    """The messages of a command, without the lines of one that takes longer than 10 s."""
    return re.sub(r"(?m)^gsp: working for \d+ s.*\n", "", text)


def test_module_and_closed_pipe(tmp_path):
    """`python -m gsp catalogue | head -1` ends without a traceback."""
    command = f'"{sys.executable}" -m gsp catalogue | head -1'
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=120)
    assert done.stdout.startswith("name")
    assert without_waiting(done.stderr) == ""


def test_the_files_of_a_command_are_written_though_nobody_reads_its_output(tmp_path):
    """Standard output is a pipe whose reading end is closed before the command begins."""
    words = ["rank", "D1^6", "D2^6", "--samples", "2", "--indices", "CTN", "--out", "t.csv"]
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-m", "gsp", *words, "--no-plot"],
        stdout=write, stderr=subprocess.PIPE, text=True, timeout=120, cwd=tmp_path, check=False,
    )  # fmt: skip
    os.close(write)
    assert (done.returncode, without_waiting(done.stderr)) == (1, "")
    assert len((tmp_path / "t.csv").read_text().splitlines()) == 3
    assert sorted(p.name for p in tmp_path.iterdir()) == ["t.csv", "t.csv.json"]


@pytest.mark.parametrize(
    "word", ["\x1b[31mred", "a\nb", "a\u202eb", "x" * 5000, "[red]x[/red]", "中文", "\udcff"]
)
@pytest.mark.parametrize("words", [["show"], ["rank"], ["catalogue", "--out"], ["forward", NAME]])
def test_messages_are_one_short_line_that_changes_no_terminal(gsp, words, word):
    error = gsp(*words, word).error
    assert len(error) < 700
    assert error.isprintable()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_full_disk_is_an_error():
    command = f'"{sys.executable}" -m gsp catalogue > /dev/full'
    done = subprocess.run(
        command, shell=True, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 2
    assert done.stderr == "gsp: standard output cannot be written: No space left on device\n"


def test_a_missing_number_names_the_command(gsp):
    assert gsp("show", "D1^6", "--position", 1, 2).error.endswith("(see gsp show --help)")


@pytest.mark.filterwarnings("default::gsp.determinant.StoreWarning")
def test_a_warning_is_one_line_without_code(gsp, monkeypatch):
    monkeypatch.setenv("GSP_STORE", "sqlite:////dev/null/no.sqlite")
    result = gsp("maximum", "toz-kucuk-2016-d3-6", "--box", "10 -10 137:138 5 -5 -10")
    assert result.status == 0
    assert result.err.startswith(
        "gsp: store of maxima sqlite:////dev/null/no.sqlite cannot be opened: "
    )
    assert len(result.err.splitlines()) == 1
    assert gsp("store", "list").out.startswith("0 maxima: no file /dev/null/no.sqlite")


@pytest.mark.parametrize("columns", [40, 60, 80, 200])
def test_tables_at_any_width(columns):
    """Numbers and names are never cut; prose is wrapped in a narrow terminal."""
    from gsp.cli.outputs import console

    class Terminal(rich.console.Console):
        is_terminal = True

    text, source = io.StringIO(), "TozKucuk2016, eqs. (2), (12) and the text below"
    shown = Terminal(file=text, width=columns, highlight=False)
    table = console.plain_table("name", "value", "source", title="[red]t[/red]", right=("value",))
    table.add_row("[bold]grün[/bold]", "1.23456789", source)
    table.add_row("D1^6 中文", "-1", "")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(console, "stdout", lambda: shown)
        console.show_table(table)
    lines = text.getvalue().splitlines()
    assert lines[0] == "[red]t[/red]"
    assert "[bold]grün[/bold]  1.23456789" in text.getvalue()
    assert " ".join(source.split()) == " ".join(
        " ".join(line[31:].strip() for line in lines[2:-1]).split()
    )
    assert (len(lines) == 4) == (columns >= 80)
    ends = {cell_len(line[: line.index("1.23456789") + 10]) for line in lines if "1.234" in line}
    assert ends == {cell_len(line) for line in lines if line.startswith("D1^6")}


@pytest.mark.parametrize("terminal", [True, False])
def test_a_line_where_code_is_compiled(gsp, monkeypatch, terminal):
    """Half a minute without a message looks like a command that hangs; once for a process."""
    from gsp.cli.design import show
    from gsp.kernels import compiled

    listener = compiled._First()
    monkeypatch.setattr(compiled, "compiling", lambda change: None)
    find = show.find_mechanism_or_design
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal, raising=False)

    def compiling(*arguments):
        for _ in range(2):
            listener.on_start(None)
        return find(*arguments)

    monkeypatch.setattr(show, "find_mechanism_or_design", compiling)
    result = gsp("show", "D1^6")
    assert result.status == 0
    assert result.err.count("formulas are compiled") == terminal


@pytest.mark.parametrize(
    ("variables", "closed", "arguments", "said"),
    [
        ({"COLUMNS": "0"}, "", ["inverse", NAME], "joint values"),
        ({"MPLBACKEND": "nonsense"}, "", ["show", NAME, "--plot", "x.png"], "Picture    x.png"),
        ({}, "<&-", ["new"], "--base-radius, "),
    ],
)
def test_the_environment_does_not_stop_a_command(tmp_path, variables, closed, arguments, said):
    command = f'"$@" {closed}'
    words = ["sh", "-c", command, "sh", sys.executable, "-m", "gsp", *arguments]
    ended = subprocess.run(
        words, env=os.environ | variables, cwd=tmp_path, capture_output=True, text=True
    )
    assert said in ended.stdout + ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_character_without_a_glyph_is_said_once(gsp, tmp_path):
    gsp("new", *"--base-radius 2 --base-angle 20 --platform-radius 1 --platform-angle 20".split(),
        "--height", "1.5", "--name", "目標", "--out", "lift.toml")  # fmt: skip
    drawn = gsp("show", "lift.toml", "--plot", "lift.png")
    assert drawn.err.count("\n") == 1
    assert drawn.err.startswith("gsp: the font of the picture")
