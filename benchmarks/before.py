"""Times of another checkout over those of this one: `python -m benchmarks.before CHECKOUT`.

Each round starts one process per checkout, in turn, so that changes of the speed of the machine
act on both. Times are CPU times of one core.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent.parent
# Module of the settings and of the backends: now, and in 0.1.0.
PACKAGES = ("gsp.evaluation", "gsp.ranking")
# Runs of a job in a process, of which the least time counts.
RUNS = 5


def jobs() -> dict[str, tuple[Callable[[], object], int]]:
    """Return what is run with the `gsp` on the path, and the number of poses of each job."""
    import gsp
    from benchmarks import cases

    try:
        backends, settings = (import_module(f"{PACKAGES[0]}.{m}") for m in ("backends", "settings"))
    except ModuleNotFoundError:
        backends, settings = (import_module(f"{PACKAGES[1]}.{m}") for m in ("backends", "settings"))
    given = settings.Settings(cases.LENGTH, cases.ELLIPSOID, 1.0)
    few, some, many = (cases.poses(n) for n in (16, 2_048, 50_000))
    mixed = cases.catalogue()[::13]
    home, more = cases.UPS.home, {**cases.GIVEN, "workers": 1, "progress": False}

    def kernel(design):
        return lambda: backends.compiled_results(design, given, many, 7)

    def evaluated(designs, pose, backend):
        for design in designs:
            gsp.evaluate(design, pose, cases.INDICES, backend=backend, **more)

    def jacobians(pose, times):
        for _ in range(times):
            cases.UPS.at(pose).jacobian  # noqa: B018 - evaluated when it is read

    kernels = [kernel(d) for d in mixed]
    ups = [cases.UPS]
    return {
        "kernel only, UPS": (kernel(cases.UPS), many.size),
        "kernel only, mixed": (lambda: [run() for run in kernels], many.size * len(mixed)),
        "`gsp.evaluate`, compiled, UPS": (lambda: evaluated(ups, many, "compiled"), many.size),
        "`gsp.evaluate`, numpy, UPS": (lambda: evaluated(ups, some, "numpy"), some.size),
        "`gsp.evaluate`, numpy, mixed": (
            lambda: evaluated(mixed, some, "numpy"),
            some.size * len(mixed),
        ),
        "`design.at(pose).jacobian`, one pose": (lambda: jacobians(home, 300), 300),
        "the same, 16 poses at once": (lambda: jacobians(few, 100), 100 * few.size),
        "the same, 2,048 poses at once": (lambda: jacobians(some, 5), 5 * some.size),
    }


def measure() -> dict[str, float]:
    """Return the least seconds per pose of each job, after one run that does not count."""
    least = {}
    for name, (run, poses) in jobs().items():
        run()
        times = []
        for _ in range(RUNS):
            start = time.process_time()
            run()
            times.append(time.process_time() - start)
        least[name] = min(times) / poses
    return least


def in_process(checkout: Path) -> dict[str, float]:
    """Return `measure()` of a new process with the library of a checkout."""
    done = subprocess.run(
        [sys.executable, __file__, "--measure"],
        check=True,
        capture_output=True,
        text=True,
        cwd=checkout,
        env={**os.environ, "PYTHONPATH": str(checkout), "OPENBLAS_NUM_THREADS": "1"},
    )
    return json.loads(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkout", type=Path, nargs="?", help="of the version to compare with")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--measure", action="store_true", help="print the times of one process")
    options = parser.parse_args()
    if options.measure:
        print(json.dumps(measure()))
        return
    pairs = [
        (in_process(options.checkout.resolve()), in_process(HERE)) for _ in range(options.rounds)
    ]
    print("| job | before, ns per pose | after | times faster (least … greatest) |")
    print("| --- | --- | --- | --- |")
    for name in pairs[0][1]:
        before, after = (np.array([pair[i][name] for pair in pairs]) for i in (0, 1))
        ratios = before / after
        nanoseconds = (f"{np.median(x) * 1e9:,.0f}" for x in (before, after))
        spread = f"{np.median(ratios):.2f} ({ratios.min():.2f} … {ratios.max():.2f})"
        print("|", " | ".join((name, *nanoseconds, spread)), "|")


if __name__ == "__main__":
    main()
