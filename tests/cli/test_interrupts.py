"""Ctrl-C at any moment after the entry point runs: one line and status 130.

The signal is sent by the process itself at chosen imports, so that no result depends on the speed
of the machine.
"""

import signal
import subprocess
import sys

import pytest

# Sends SIGINT when a module is looked up for the k-th time after the entry point has begun.
AT_IMPORT = """
import os, signal, sys
from gsp.cli import main
class Pressed:
    left = {left}
    def find_spec(self, name, path=None, target=None):
        Pressed.left -= 1
        if Pressed.left == 0:
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Pressed())
sys.argv[1:] = {words}
{before}
main()
"""
WORDS = ["show", "toz-kucuk-2016-d3-6"]


def run(left, words=WORDS, before="", cwd=None):
    code = AT_IMPORT.format(left=left, words=words, before=before)
    return subprocess.run(
        [sys.executable, "-c", code], cwd=cwd,
        capture_output=True, text=True, timeout=120, check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip


@pytest.mark.parametrize("left", [1, 20, 150, 400, 700])
def test_while_modules_are_imported(left):
    done = run(left)
    assert (done.returncode, done.stderr) == (130, "gsp: stopped\n"), done


def test_little_is_imported_before_the_handler_is_set():
    code = (
        "import sys; before = set(sys.modules); import gsp.cli; print(*set(sys.modules) - before)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    light = {
        "__future__",
        "importlib._bootstrap_external",
        "importlib",
        "importlib._bootstrap",
        "warnings",
    }
    assert set(done.stdout.split()) <= {"gsp", "gsp.cli", *light}


def test_in_a_command_and_after_it():
    """An exception that a library replaces, one that it suppresses, and one at the end."""
    press = "os.kill(os.getpid(), signal.SIGINT)"
    for body in (
        f"""
    try:
        {press}
    except KeyboardInterrupt as error:
        raise ImportError("another error") from error""",
        f"""
    try:
        {press}
    except BaseException:
        print("result so far")""",
    ):
        before = (
            "import typer, gsp.cli.design.show as show\n"
            f"def find(*a, **k):{body}\n    raise typer.Exit(3)\n"
            "show.find_mechanism_or_design = find\n"
        )
        done = run(0, before=before)
        assert (done.returncode, done.stderr) == (130, "gsp: stopped\n"), done
    # When everything is printed nothing is left to stop.
    done = run(0, before=f"import atexit\natexit.register(lambda: {press})\n")
    assert (done.returncode, done.stderr) == (0, ""), done
    assert "D3^6" in done.stdout


def test_a_second_time_while_a_command_ends():
    before = """
import gsp.cli.design.show as show
def find(*a, **k):
    try:
        os.kill(os.getpid(), signal.SIGINT)
    finally:
        os.kill(os.getpid(), signal.SIGINT)
        while True:
            pass
show.find_mechanism_or_design = find
"""
    done = run(0, before=before)
    assert (done.returncode, done.stderr) == (130, "gsp: stopped\n"), done


# Sends SIGINT where LLVM calls back, whose exceptions are printed and lost.
IN_COMPILATION = """
import numba
from llvmlite.binding import ExecutionEngine
def press(*_):
    os.kill(os.getpid(), signal.SIGINT)
ExecutionEngine._find_module_ptr = press
def compiled():
    numba.njit(lambda x: x + 1.0)(1.0)
    print("went on")
"""


def test_while_numba_compiles(tmp_path):
    before = f"""{IN_COMPILATION}
import gsp.cli.design.show as show
show.find_mechanism_or_design = lambda *_: compiled()
"""
    done = run(0, before=before)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "gsp: stopped\n"), done
    # A ranking states what it keeps, and leaves no empty folder.
    before = f"""{IN_COMPILATION}
from gsp.cli.ranking.plan import Plan
def compute(self, chosen, decides, workers, parts, resume):
    assert parts.folder.is_dir()
    compiled()
Plan.compute = compute
"""
    words = ["rank", "toz-kucuk-2016-d3-6", "--samples", "5", "--no-plot", "--out", "a.csv"]
    done = run(0, words, before, tmp_path)
    assert (done.returncode, done.stderr) == (130, "gsp: stopped; nothing was written\n"), done
    assert "went on" not in done.stdout
    assert list(tmp_path.iterdir()) == []


def test_while_a_curve_of_a_workspace_is_followed(tmp_path):
    before = """
from gsp.workspace.boundary.tracing import Tracer
seen = []
step = Tracer._broken
def press(self, *given):
    seen.append(0)
    if len(seen) == 9:
        os.kill(os.getpid(), signal.SIGINT)
    return step(self, *given)
Tracer._broken = press
"""
    words = ["workspace", "workspace-6-3", "--rays", "2", "--starts", "1", "--out", "a.csv"]
    done = run(0, words, before, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "gsp: stopped\n"), done
    assert list(tmp_path.iterdir()) == []


def test_where_it_is_ignored_it_stays_ignored():
    before = "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
    done = run(20, before=before)
    assert (done.returncode, done.stderr) == (0, ""), done


def test_with_given_words_the_handler_of_the_caller_stays():
    import gsp.cli

    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(SystemExit):
        gsp.cli.main(["--version"])
    assert signal.getsignal(signal.SIGINT) is before
