"""Designs and boxes for the tests of proofs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import gsp
from gsp.model.legs import LEG
from gsp.variation.layout import PROVEN
from tests.support import turn

KINDS = tuple(LEG)


def circle(degrees, radius):
    angle = np.deg2rad(degrees)
    return radius * np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)


def hexapod():
    """Base radius 2, platform 1, joints in pairs; studied at height 1.5."""
    base = circle([-10.0, 10.0, 110.0, 130.0, 230.0, 250.0], 2.0)
    return gsp.Design(["D1"] * 6, base, circle([-50.0, 50.0, 70.0, 170.0, 190.0, 290.0], 1.0))


def around(height, half, degrees):
    pairs = [(-half, half), (-half, half), (height - half, height + half)]
    return gsp.PoseBox(pairs, [(-degrees, degrees)] * 3, degrees=True)


def unit(x):
    return x / np.linalg.norm(x)


def singular_leg(rng, kind, pose, velocity, spin):
    """a, b, s, t of a leg that a twist of the platform at a pose does not move.

    Its line (for angles, its axis) is chosen perpendicular to the velocity of its foot.
    """
    p, r = pose.position, pose.rotation
    foot = rng.uniform(-0.7, 0.7, 3)  # from the platform origin, in base axes
    speed = velocity + np.cross(spin, foot)
    if kind == "A1":
        u = unit(np.cross(spin, rng.standard_normal(3)))
    elif kind == "D4 A1":
        u = unit(np.cross(spin, speed))
    else:
        u = unit(np.cross(speed, rng.standard_normal(3)))
    s, t = (unit(np.cross(u, rng.standard_normal(3))) for _ in range(2))
    base = p + foot - rng.uniform(0.5, 2.0) * u
    if kind in ("D3", "D4", "A1", "D4 A1"):
        base = base + rng.uniform(-1.0, 1.0) * s
    on_platform = foot + (rng.uniform(-0.5, 0.5) * t if kind not in ("D1", "D3") else 0.0)
    return base, r.T @ on_platform, s, r.T @ t


def singular_design(rng, kinds):
    """A design with a pose where it is singular but for rounding: the pose is chosen first."""
    position = rng.uniform(-0.3, 0.3, 3) + np.array([0.0, 0.0, 1.5])
    pose = gsp.Pose(position, turn(rng.uniform(-0.6, 0.6, 3)))
    velocity, spin = rng.standard_normal((2, 3))
    legs = [singular_leg(rng, kind, pose, velocity, spin) for kind in kinds]
    a, b, s, t = (np.array([leg[i] for leg in legs]) for i in range(4))
    return gsp.Design(kinds, a, b, s, t), pose


def box_with(rng, pose, least=-3.0, most=-0.3):
    """A box of random widths with a pose anywhere in it, well inside but for rounding."""
    here = np.concatenate((pose.position, pose.angles()))
    widths = 10.0 ** rng.uniform(least, most, 6)
    low = here - widths * rng.uniform(0.02, 0.98, 6)
    pairs = np.stack((low, low + widths), axis=1)
    pairs[3:] = np.clip(pairs[3:], -np.pi, np.pi)
    return gsp.PoseBox(pairs[:3].tolist(), pairs[3:].tolist())


def poses_in(rng, box, n):
    return box.pose(box.low + rng.random((n, 6)) * (box.high - box.low))


def claimed(done):
    """A certificate of the same requirements that claims its whole box to be proven, in one."""
    return replace(
        done,
        status="proven",
        reason="",
        points=np.empty((0, 6)),
        counterexample=None,
        bracket=None,
        tree=np.array([PROVEN], dtype=np.int8),
        n_boxes=1,
    )
