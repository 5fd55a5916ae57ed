"""Feasibility of many poses: `python -m benchmarks.workspace_grid`.

Thresholds on two indices, by the functions of the indices (numpy) and by compiled code, and the
strokes alone, in one process on one core.
"""

from __future__ import annotations

import time
from unittest.mock import patch

import gsp
from gsp.workspace import Limits, feasible

POSES = 50_000


def main() -> None:
    design = gsp.catalogue.design("workspace-6-3")
    pose = gsp.PoseBox.around(design.home, [3, 3, 3, 0.3, 0.3, 0.3]).sample(POSES, rng=1)
    limits = Limits(indices=["condition_number <= 20", "CTN >= 0.1"], length=design.rms_radius)
    feasible(design, pose, limits)  # loads the compiled code
    with patch("gsp.limits.bounds.POSES_FOR_COMPILED", POSES + 1):
        slow = rate(design, pose, limits)
    for text, speed in (
        ("indices, numpy", slow),
        ("indices, compiled", rate(design, pose, limits)),
        ("strokes alone", rate(design, pose, None)),
    ):
        print(f"{text:20} {speed:12.0f} poses/s  {speed / slow:6.1f} ×")


def rate(design: gsp.Design, pose: gsp.Pose, limits: Limits | None) -> float:
    """Poses per second of CPU time."""
    start = time.process_time()
    feasible(design, pose, limits)
    return POSES / (time.process_time() - start)


if __name__ == "__main__":
    main()
