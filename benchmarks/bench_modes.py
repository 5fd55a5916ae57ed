"""All assembly modes against random restarts of a local search, in turn in one run.

`python -m benchmarks --only modes`
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

import gsp
from benchmarks.timing import Way, in_turn, markdown, rows

DESIGNS, STARTS, MOST = 10, 1000, 50_000
MODES = "`gsp.assembly_modes`"
# Distance of two poses, in sizes of the design, above which they are different modes.
APART = 1e-6


def platforms() -> list[tuple[gsp.Design, np.ndarray, int]]:
    """Random platforms with six SPS legs, joint values, and their numbers of real modes."""
    rng = np.random.default_rng(16)
    found = []
    for _ in range(DESIGNS):
        design = gsp.Design(["D1"] * 6, rng.standard_normal((6, 3)), rng.standard_normal((6, 3)))
        pose = gsp.Pose(rng.standard_normal(3), Rotation.random(rng=rng).as_matrix())
        joints = design.at(pose).joints
        found.append((design, joints, len(gsp.assembly_modes(design, joints).side)))
    return found


def restarts(design: gsp.Design, joints: np.ndarray, modes: int) -> int:
    """Return how many starts of `gsp.forward` find all modes, at most `MOST`."""
    rng = np.random.default_rng(0)
    known = np.empty((0, 12))
    for starts in range(STARTS, MOST + 1, STARTS):
        position = 2.0 * design.rms_radius * rng.standard_normal((STARTS, 3))
        guess = gsp.Pose(position, Rotation.random(STARTS, rng=rng).as_matrix())
        ends = gsp.forward(design, joints, guess)
        pose = ends.pose[ends.converged]
        rotations = pose.rotation.reshape(-1, 9)
        for row in np.hstack((pose.position / design.rms_radius, rotations)):
            if not len(known) or np.abs(known - row).max(axis=1).min() > APART:
                known = np.vstack((known, row))
        if len(known) >= modes:
            return starts
    return MOST


def section(rounds: int) -> str:
    """Return the table of docs/performance.md."""
    some = platforms()
    again = "`gsp.forward` from random poses, until it has found as many"
    ways = {
        again: Way(lambda: [restarts(*each) for each in some], DESIGNS),
        MODES: Way(lambda: [gsp.assembly_modes(d, joints) for d, joints, _ in some], DESIGNS),
        MODES + ", certified": Way(
            lambda: [gsp.assembly_modes(d, joints, certify=True) for d, joints, _ in some], DESIGNS
        ),
    }
    times = in_turn(ways, rounds)
    starts = [restarts(*each) for each in some]
    head = (
        "method",
        "median, ms per design",
        "least",
        "times faster than restarts (least … greatest)",
    )
    real = [modes for _, _, modes in some]
    return (
        markdown(head, rows(times, again, 1e3))
        + f"\n\nThe {DESIGNS} designs have {min(real)} to {max(real)} real modes. The restarts "
        f"used at most {max(starts):,} starts, and have no criterion for having found all modes."
    )
