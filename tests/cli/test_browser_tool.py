"""`gsp app` starts the server with the design; invalid options are errors."""

from __future__ import annotations

import socket
import subprocess
import sys

import pytest

from gsp.catalogue import design

pytest.importorskip("nicegui", reason="the extra `app` is not installed")


@pytest.fixture
def served(monkeypatch):
    """What the server is started with, instead of starting it."""
    found = []
    monkeypatch.setattr("gsp.app.server.serve", lambda *given: found.append(given[:3]))
    return found


@pytest.mark.parametrize(
    ("words", "name", "host", "port"),
    [
        ([], "toz-kucuk-2016-d3-6", "127.0.0.1", 8080),
        (["lee-2000-3-3", "--port", 8090], "lee-2000-3-3", "127.0.0.1", 8090),
        (["D1^3 D2^3", "--host", "0.0.0.0"], "D1^3 D2^3", "0.0.0.0", 8080),
    ],
)
def test_the_server_gets_the_design(gsp, served, words, name, host, port):
    assert gsp("app", *words).status == 0
    ((design, *where),) = served
    assert (design.name, *where) == (name, host, port)


@pytest.mark.parametrize(
    "words", [["nobody"], ["--port", 0], ["--host", ""], ["lee-2000-3-3", "--template", "x.toml"]]
)
def test_what_cannot_be_served(gsp, served, words):
    assert gsp("app", *words).error
    assert served == []


def test_a_port_in_use_is_an_error(gsp):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        error = gsp("app", "--port", port).error
    assert "expected a free port, and an address of this machine" in error
    assert "expected a free port" in gsp("app", "--host", "no.such.name.invalid").error


def test_without_the_framework_the_extra_is_named(gsp, monkeypatch):
    monkeypatch.setattr("gsp.installed.is_installed", lambda package: False)
    assert 'pip install "gsp-mechanisms[app]"' in gsp("app").error


def test_the_view_model_needs_no_framework():
    """The state, in all its modules, loads without it."""
    code = (
        "import sys, gsp.app.searches, gsp.app.guard\n"
        "from gsp.app.scene import drawing, figure, modes, region\n"
        "from gsp.app.state import choices, curves, links, matrices, motion, reading, recording\n"
        "print({'nicegui', 'fastapi', 'uvicorn', 'matplotlib'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


def test_a_report_is_written_once(gsp, tmp_path, monkeypatch):
    from gsp.app.report import page

    monkeypatch.setattr(page, "SECTIONS", page.SECTIONS[1:2])
    assert gsp("report", "lee-2000-3-3").status == 0
    written = (tmp_path / "lee-2000-3-3.html").read_text(encoding="utf-8")
    assert "gsp report lee-2000-3-3" in written
    assert "exists" in gsp("report", "lee-2000-3-3").error
    assert gsp("report", "lee-2000-3-3", "--force").status == 0
    assert (tmp_path / "lee-2000-3-3.html").read_text(encoding="utf-8") == written


def test_a_report_is_named_after_the_design(gsp, tmp_path, monkeypatch):
    from gsp.app.report import page

    monkeypatch.setattr(page, "SECTIONS", page.SECTIONS[1:2])
    design("lee-2000-3-3").replace(name="../my press").write(tmp_path / "mine.toml")
    assert gsp("report", "mine.toml").status == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["mine.toml", "my-press.html"]


@pytest.mark.parametrize(
    "words",
    [
        ["nobody"],
        ["lee-2000-3-3", "--out", "report.pdf"],
        ["lee-2000-3-3", "--task", "none.toml"],
        ["lee-2000-3-3", "--length", -1],
        ["lee-2000-3-3", "--position", 0, 0, "x"],
    ],
)
def test_reports_that_cannot_be_made(gsp, tmp_path, words):
    assert gsp("report", *words).error
    assert not list(tmp_path.iterdir())
