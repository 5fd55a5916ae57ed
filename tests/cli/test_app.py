"""The command itself: help, version, errors."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
import typer.main

from gsp.cli.app import COMMANDS, app, load
from gsp.version import __version__


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


@pytest.mark.parametrize("arguments", [["dance"], ["--dance"], ["rank", "--dance"]])
def test_usage_errors_are_one_line(gsp, arguments):
    assert "--help" in gsp(*arguments).error


def test_interrupt_is_no_traceback(gsp, monkeypatch):
    def interrupted(*arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr("gsp.cli.ranking.plan.Plan.compute", interrupted)
    result = gsp("rank", "--no-plot")
    assert result.status == 130
    assert "Traceback" not in result.err


def test_terminal_without_unicode(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "gsp", "show", "D1^6"], capture_output=True, timeout=120,
        env={**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONWARNINGS": "error"}, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert b"|d|" in done.stdout


def test_module_and_closed_pipe(tmp_path):
    """`python -m gsp catalogue | head -1` ends without a traceback."""
    command = f'"{sys.executable}" -m gsp catalogue | head -1'
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=120)
    assert done.stdout.startswith("name")
    assert done.stderr == ""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_full_disk_is_an_error():
    command = f'"{sys.executable}" -m gsp catalogue > /dev/full'
    done = subprocess.run(
        command, shell=True, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 2
    assert done.stderr == "gsp: standard output cannot be written: No space left on device\n"
