"""Forward kinematics against a hand-written Newton's method and scipy, in turn in one run.

`python -m benchmarks --only forward`
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import fsolve, least_squares
from scipy.spatial.transform import Rotation

import gsp
from benchmarks.timing import Way, in_turn, markdown, rows
from gsp.geometry.vectors import Array

POSES, WIDTH, SAMPLES = 4000, 0.05, 100_000
BY_HAND = "Newton's method by hand, numpy"
ANGLES = np.deg2rad([[-10, 10, 110, 130, 230, 250], [-50, 50, 70, 170, 190, 290]])
BASE, PLATFORM = np.stack((np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES), axis=-1)
HEXAPOD = gsp.Design(["D1"] * 6, BASE, 0.6 * PLATFORM)
HOME = gsp.Pose([0.0, 0.0, 1.0])
BOX = gsp.PoseBox([(-0.2, 0.2), (-0.2, 0.2), (0.8, 1.2)], [(-0.3, 0.3)] * 3)


def by_hand(joints: Array, position: Array, rotation: Array) -> Array:
    """Return the position by Newton's method on the rows of UPS legs, without checks."""
    a, b = HEXAPOD.base_points, HEXAPOD.platform_points
    p, r = position.copy(), rotation.copy()
    for _ in range(10):
        arm = b @ r.T
        d = p + arm - a
        length = np.sqrt((d * d).sum(axis=1))
        error = length - joints
        if np.abs(error).max() < 1e-12:
            break
        u = d / length[:, None]
        step = np.linalg.solve(np.hstack((u, np.cross(arm, u))), -error)
        p = p + step[:3]
        r = Rotation.from_rotvec(step[3:]).as_matrix() @ r
    return p


def logged() -> gsp.Pose:
    """Return poses of a machine that swings about a pose, at 1,000 samples per second."""
    time = np.linspace(0.0, SAMPLES / 1000.0, SAMPLES)[:, None]
    rates = np.array([3.0, 2.6, 2.2, 1.8, 3.4, 1.4])
    widths = np.array([0.2, 0.2, 0.2, 0.3, 0.3, 0.3])
    return HOME.moved(widths * np.sin(2.0 * np.pi * rates * time))


def section(rounds: int) -> str:
    """Return the table of docs/performance.md."""
    rng = np.random.default_rng(0)
    truth = BOX.sample(POSES, rng=rng)
    guess = truth.moved(rng.uniform(-WIDTH, WIDTH, (POSES, 6)))
    joints, robot = HEXAPOD.at(truth).joints, gsp.prepare(HEXAPOD)
    each = [guess[i] for i in range(200)]
    log = HEXAPOD.at(logged()).joints

    def residual(x: Array, i: int) -> Array:
        turn = Rotation.from_rotvec(x[3:]).as_matrix() @ guess.rotation[i]
        arm = HEXAPOD.platform_points @ turn.T
        return np.linalg.norm(guess.position[i] + x[:3] + arm - BASE, axis=1) - joints[i]

    tight = {"xtol": 1e-12, "ftol": 1e-12, "gtol": 1e-12}
    ways = {
        BY_HAND: Way(
            lambda: [by_hand(joints[i], guess.position[i], guess.rotation[i]) for i in range(100)],
            100,
        ),
        "`scipy.optimize.fsolve`": Way(
            lambda: [fsolve(residual, np.zeros(6), (i,), xtol=1e-12) for i in range(30)], 30
        ),
        "`scipy.optimize.least_squares`": Way(
            lambda: [least_squares(residual, np.zeros(6), args=(i,), **tight) for i in range(20)],
            20,
        ),
        "`gsp.prepare(design).forward`": Way(
            lambda: [robot.forward(joints[i], each[i]) for i in range(200)], 200
        ),
        "`gsp.forward`, one pose": Way(
            lambda: [gsp.forward(HEXAPOD, joints[i], each[i]) for i in range(200)], 200
        ),
        "`gsp.forward`, batch of 4,000": Way(lambda: gsp.forward(HEXAPOD, joints, guess), POSES),
        "`gsp.track`, log of 100,000 samples": Way(lambda: gsp.track(HEXAPOD, log, HOME), SAMPLES),
    }
    times = in_turn(ways, rounds)
    return markdown(
        (
            "method", "median, ns per pose", "least",
            "times faster than Newton's method by hand (least … greatest)",
        ),
        rows(times, BY_HAND),
    )  # fmt: skip
