"""Forces, stiffness and drives at the base against numpy by hand, in turn in one run.

`python -m benchmarks --only statics`
"""

from __future__ import annotations

import numpy as np

import gsp
from benchmarks.bench_forward import BOX, HEXAPOD
from benchmarks.timing import Way, in_turn, markdown, ratio
from gsp.geometry.vectors import Array

POSES, EACH = 100_000, 300
WRENCH = np.array([10.0, -20.0, -500.0, 3.0, 5.0, -2.0])
STIFFNESS = np.linspace(1e6, 2e6, 6)
# Cranks along the radius whose tips are below the anchors at the home pose.
AXES = np.cross([0.0, 0.0, 1.0], HEXAPOD.base_points)
CRANKS = gsp.Design(
    [gsp.Crank(arm=0.2 * x, rod=1.0) for x in HEXAPOD.base_points],
    HEXAPOD.base_points, HEXAPOD.platform_points, AXES,
)  # fmt: skip


def _rows(position: Array, rotation: Array) -> Array:
    """Return the rows of UPS legs at a pose or a stack of them."""
    arm = HEXAPOD.platform_points @ np.swapaxes(rotation, -1, -2)
    d = position[..., None, :] + arm - HEXAPOD.base_points
    u = d / np.linalg.norm(d, axis=-1, keepdims=True)
    return np.concatenate((u, np.cross(arm, u)), axis=-1)


def _forces(position: Array, rotation: Array) -> Array:
    jacobian = _rows(position, rotation)
    return np.linalg.solve(np.swapaxes(jacobian, -1, -2), -WRENCH[:, None])[..., 0]


def _stiffness(position: Array, rotation: Array) -> Array:
    jacobian = _rows(position, rotation)
    return np.swapaxes(jacobian, -1, -2) @ (STIFFNESS[:, None] * jacobian)


def _angles(position: Array, rotation: Array) -> Array:
    """Return the angles of the cranks from |anchor − tip| = rod, the branch 1 of `gsp.Crank`."""
    d = position[..., None, :] + CRANKS.platform_points @ np.swapaxes(rotation, -1, -2)
    d = d - CRANKS.base_points
    arm = np.array([leg.drive.arm for leg in CRANKS.legs])
    axes = CRANKS.base_directions
    along, across = (d * arm).sum(axis=-1), (d * np.cross(axes, arm)).sum(axis=-1)
    level = 0.5 * ((d * d).sum(axis=-1) + (arm * arm).sum(axis=-1) - 1.0)
    with np.errstate(invalid="ignore"):  # NaN where the rod does not reach
        turn = np.arccos(level / np.hypot(along, across))
    angle = np.arctan2(across, along) - turn
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)


def section(rounds: int) -> str:
    """Return the table of docs/performance.md."""
    poses = BOX.sample(POSES, rng=np.random.default_rng(0))
    p, r = poses.position, poses.rotation
    tasks = {
        "actuator forces": (_forces, lambda: HEXAPOD.at(poses).actuator_forces(WRENCH)),
        "stiffness": (_stiffness, lambda: gsp.stiffness(HEXAPOD, poses, STIFFNESS)),
        "angles of cranks": (_angles, lambda: CRANKS.at(poses).joints),
    }
    table = []
    for name, (by_hand, ours) in tasks.items():
        ways = {
            "loop": Way(lambda f=by_hand: [f(p[i], r[i]) for i in range(EACH)], EACH),
            "stacks": Way(
                lambda f=by_hand: [
                    f(p[i : i + 2000], r[i : i + 2000]) for i in range(0, POSES, 2000)
                ],
                POSES,
            ),
            "gsp": Way(ours, POSES),
        }
        np.testing.assert_allclose(ours(), by_hand(p, r), rtol=1e-9, atol=1e-9)
        times = in_turn(ways, rounds)
        least, middle, most = zip(
            *(ratio(times, x, "gsp") for x in ("loop", "stacks")), strict=True
        )
        table.append(
            (name, f"{np.median(times['gsp']) * 1e9:,.0f}")
            + tuple(
                f"{m:.3g} ({a:.3g} … {b:.3g})" for a, m, b in zip(least, middle, most, strict=True)
            )
        )
    head = ("100,000 poses", "median, ns per pose", "times faster than numpy, pose by pose",
            "than numpy by hand, stacks of 2,000")  # fmt: skip
    return markdown(head, table)
