"""What needs a process of its own: start, memory, growth."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile

PREAMBLE = """
import json, resource, time
import gsp
from benchmarks import cases
def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
"""

START = """
wall, cpu = time.perf_counter(), time.process_time()
gsp.evaluate(cases.UPS, cases.poses(1000), cases.INDICES, progress=False, **cases.GIVEN)
print(json.dumps([time.perf_counter() - wall, time.process_time() - cpu]))
"""

GROWTH = """
n = {n}
pose = cases.poses(n)
before = peak()
gsp.evaluate(cases.UPS, pose[: min(n, 1000)], cases.INDICES, progress=False, **cases.GIVEN)
start = time.process_time()
gsp.evaluate(cases.UPS, pose, cases.INDICES, workers=1, progress=False, **cases.GIVEN)
print(json.dumps([(time.process_time() - start) / n, before, peak()]))
"""

CATALOGUE = """
pose = cases.poses({n})
start = time.perf_counter()
gsp.rank(cases.catalogue(), pose, cases.INDICES, progress=False, **cases.GIVEN)
print(json.dumps([time.perf_counter() - start, peak()]))
"""


def run(code: str, **environment: str) -> list[float]:
    """Run code in a new process and return the numbers that it prints."""
    import os

    done = subprocess.run(
        [sys.executable, "-c", PREAMBLE + code], check=True, capture_output=True, text=True,
        env={**os.environ, **environment},
    )  # fmt: skip
    return json.loads(done.stdout)


def starts() -> dict[str, list[float]]:
    """Seconds (wall, CPU) to the first result: without and with compiled code on disk."""
    with tempfile.TemporaryDirectory() as folder:
        cold = run(START, NUMBA_CACHE_DIR=folder)
        warm = [run(START, NUMBA_CACHE_DIR=folder) for _ in range(3)]
    return {"cold": cold, "warm": sorted(warm)[1]}
