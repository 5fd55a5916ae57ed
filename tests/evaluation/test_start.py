"""First use: no compiled code where none is needed, the progress bar."""

import io
import os
import subprocess
import sys

import pytest

import gsp
from gsp.progress import meter

DESIGN = gsp.catalogue.design("toz-kucuk-2016-d3-6")


def python(code):
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": os.getcwd()},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_numpy_does_without_numba():
    code = """
import gsp, sys
design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
gsp.evaluate(design, design.home, backend="numpy")
print("numba" in sys.modules)
"""
    assert python(code) == "False"


class Terminal(io.StringIO):
    """A stream that reports to be a terminal."""

    def isatty(self):
        return True


@pytest.mark.parametrize(("stream", "drawn"), [(Terminal(), True), (io.StringIO(), False)])
def test_a_bar_is_drawn_on_a_terminal_only(monkeypatch, stream, drawn):
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr("gsp.progress.SECONDS_BEFORE_BAR", -1.0)
    monkeypatch.setenv("TERM", "xterm")
    if not drawn:  # rich draws nothing there either: it must not even be imported
        monkeypatch.setitem(sys.modules, "rich.progress", None)
    with meter(None, "designs") as report:
        report(1, 2)
    assert ("designs" in stream.getvalue()) == drawn


def test_a_short_run_and_false_draw_nothing(monkeypatch):
    stream = Terminal()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr("gsp.progress.SECONDS_BEFORE_BAR", 1e9)
    gsp.evaluate(DESIGN, DESIGN.home)
    monkeypatch.setattr("gsp.progress.SECONDS_BEFORE_BAR", -1.0)
    gsp.evaluate(DESIGN, DESIGN.home, progress=False)
    assert stream.getvalue() == ""


def test_progress_has_to_be_callable():
    with pytest.raises(gsp.GspError, match="progress: expected a function"):
        gsp.evaluate(DESIGN, DESIGN.home, progress="yes")
