"""What needs a process of its own: start, memory, growth."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

PREAMBLE = """
import json, time
import gsp
from benchmarks import cases
from benchmarks.processes import memory, peak
"""

START = """
wall, cpu = time.perf_counter(), time.process_time()
gsp.evaluate(cases.UPS, cases.poses(1000), cases.INDICES, progress=False, **cases.GIVEN)
print(json.dumps([time.perf_counter() - wall, time.process_time() - cpu]))
"""

GROWTH = """
n = {n}
pose = cases.poses(n)
gsp.evaluate(cases.UPS, pose[: min(n, 1000)], cases.INDICES, progress=False, **cases.GIVEN)
before, start = memory(), time.process_time()
frame = gsp.evaluate(cases.UPS, pose, cases.INDICES, workers=1, progress=False, **cases.GIVEN)
print(json.dumps([(time.process_time() - start) / n, before, peak() - before]))
"""

CATALOGUE = """
pose = cases.poses({n})
memory()
start = time.perf_counter()
gsp.rank(cases.catalogue(), pose, cases.INDICES, progress=False, **cases.GIVEN)
print(json.dumps([time.perf_counter() - start, peak()]))
"""

REPEATED = """
pose = cases.poses({n})
for line in open(0):
    gsp.evaluate(cases.UPS, pose, cases.INDICES, workers=1, progress=False, **cases.GIVEN)
    print(flush=True)
"""


def memory() -> float:
    """Return the memory of this process in MiB, and begin a new record of its peak (Linux)."""
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    return _status("VmRSS")


def peak() -> float:
    """Return the peak of the memory of this process in MiB since the last `memory`."""
    return _status("VmHWM")


def _status(name: str) -> float:
    text = Path("/proc/self/status").read_text(encoding="ascii")
    return int(re.search(rf"{name}:\s*(\d+)", text)[1]) / 1024


def run(code: str, **environment: str) -> list[float]:
    """Run code in a new process and return the numbers that it prints."""
    done = subprocess.run(
        [sys.executable, "-c", PREAMBLE + code],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
    )
    return json.loads(done.stdout)


@contextmanager
def independent(poses: int) -> Iterator[Callable[[int], None]]:
    """Return what makes the first n of two processes evaluate poses, all at the same time."""
    code = PREAMBLE + REPEATED.format(n=poses)
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    children = [subprocess.Popen([sys.executable, "-c", code], **pipes) for _ in range(2)]

    def at_once(n: int) -> None:
        for child in children[:n]:
            child.stdin.write("\n")
            child.stdin.flush()
        for child in children[:n]:
            child.stdout.readline()

    try:
        yield at_once
    finally:
        for child in children:
            child.communicate()


# Whole processes: Python itself, the light parts of the library, and two commands.
PROCESSES = {
    "`python -c pass`": ("-c", "pass"),
    "`import numpy`": ("-c", "import numpy"),
    "`import gsp; gsp.Design; gsp.Pose`": ("-c", "import gsp; gsp.Design; gsp.Pose"),
    "the same, and a design read with its pose": (
        "-c", "import gsp; gsp.Design; gsp.Pose; gsp.catalogue.design('toz-kucuk-2016-d3-6')",
    ),
    "`gsp --help`": ("-m", "gsp", "--help"),
    "`gsp show D1^6`": ("-m", "gsp", "show", "D1^6"),
    "`gsp show toz-kucuk-2016-d3-6`": ("-m", "gsp", "show", "toz-kucuk-2016-d3-6"),
}  # fmt: skip


def whole(arguments: Sequence[str]) -> tuple[float, float]:
    """Return wall time and CPU time (user and system) of a Python process in seconds."""
    start = time.perf_counter()
    child = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    wall = time.perf_counter() - start
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise subprocess.CalledProcessError(child.returncode, arguments)
    return wall, used.ru_utime + used.ru_stime


def starts() -> dict[str, list[float]]:
    """Seconds (wall, CPU) to the first result: without and with compiled code on disk."""
    with tempfile.TemporaryDirectory() as folder:
        cold = run(START, NUMBA_CACHE_DIR=folder)
        warm = [run(START, NUMBA_CACHE_DIR=folder) for _ in range(3)]
    return {"cold": cold, "warm": sorted(warm)[1]}
