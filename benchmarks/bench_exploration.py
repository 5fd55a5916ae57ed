"""Many designs at few poses: `gsp.exploration.explore` beside its compiled code alone."""

from __future__ import annotations

import time

import gsp
from benchmarks.timing import Way, in_turn, markdown, ratio
from gsp.evaluation.backends import compiled_results
from gsp.evaluation.settings import Settings
from gsp.exploration import explore

POSES, DESIGNS, MANY_DESIGNS = 1000, 500, 10_000
EVERY_PROBLEM = 7
SPACE = gsp.Space(
    gsp.hexapod,
    {"platform_radius": (0.5, 1.5), "platform_angle": (0.1, 1.0), "height": (1.0, 2.0)},
    fixed={"base_radius": 2.0, "base_angle": 0.3},
)
TASK = gsp.Task(
    poses=gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (1.4, 1.6)], [(-0.1, 0.1)] * 3),
    wanted=["mean CTN", "worst CDN_CL", "mean CDN_OE", "worst σ_min"],
    samples=POSES,
    length=0.8,
    ellipsoid=gsp.Ellipsoid([1.0, 1.0, 0.5]),
)
WHOLE = "`gsp.exploration.explore`"
MAKE = "its designs alone, `space.design`"
KERNEL = "its compiled code alone"
SINGLE = "`gsp.evaluate`, one design after another"


def section(rounds: int) -> str:
    """Four indices of hexapods, CPU time of one core per design and pose, and one large run."""
    pose, sample = TASK.pose(), SPACE.sample(DESIGNS, seed=1)
    parameters = sample.to_dict("records")
    designs = [SPACE.design(**one) for one in parameters]
    settings = Settings(TASK.length, TASK.ellipsoid)
    given = {"length": TASK.length, "ellipsoid": TASK.ellipsoid, "workers": 1, "progress": False}
    size = DESIGNS * POSES
    ways = {
        SINGLE: Way(
            lambda: [gsp.evaluate(d, pose, list(TASK.indices), **given) for d in designs], size
        ),
        WHOLE: Way(lambda: explore(SPACE, TASK, DESIGNS, seed=1, workers=1, progress=False), size),
        MAKE: Way(lambda: [SPACE.design(**one) for one in parameters], size),
        KERNEL: Way(
            lambda: [compiled_results(d, settings, pose, EVERY_PROBLEM) for d in designs], size
        ),
    }
    times = in_turn(ways, rounds)
    table = []
    for name, values in times.items():
        low, middle, high = ratio(times, name, KERNEL)
        cells = (f"{values.min() * 1e9:,.0f}", f"{middle:.2f} ({low:.2f} … {high:.2f})")
        table.append((name, *cells))
    head = ("method", "least, ns per design and pose", "times the compiled code (least … greatest)")
    return markdown(head, table) + "\n\n" + _large()


def _large() -> str:
    start = time.process_time()
    explore(SPACE, TASK, MANY_DESIGNS, seed=1, workers=2, progress=False)
    seconds = time.process_time() - start
    return f"{MANY_DESIGNS:,} designs at {POSES:,} poses, two threads: {seconds:.1f} s of CPU time."
