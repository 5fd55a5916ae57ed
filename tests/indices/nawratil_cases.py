"""Designs, poses and parameters that the tests of Nawratil's indices share."""

from __future__ import annotations

import numpy as np

import gsp
from gsp.families import nawratil


def hexapod(rng, n=6):
    """A random UPS design with n legs and a pose where it is well conditioned."""
    design = gsp.Design(["D1"] * n, rng.normal(size=(n, 3)), rng.normal(size=(n, 3)), name="random")
    pose = gsp.Pose.from_rpy(rng.normal(size=3) + np.array([0, 0, 2.0]), rng.normal(size=3))
    return design, pose


def mixed(name):
    """A mechanism of the catalogue on the published anchors, and the published pose."""
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    return gsp.catalogue.instantiate(gsp.catalogue.mechanism(name), template), template.home


def postures(seed=0):
    """UPS designs with six and eight legs, and mixed mechanisms, each at a pose."""
    rng = np.random.default_rng(seed)
    cases = [hexapod(rng), hexapod(rng, 8), mixed("D1 D2 D3^2 D4^2"), mixed("D1 D2 D3 D4 A1^2")]
    return [design.at(pose) for design, pose in cases]


def parameters(index, design):
    """Values for what an index needs, made from a design."""
    size = design.rms_radius
    power = 3 - sum(name.startswith("theta") for name in design.joint_names)
    given = {
        "length": 0.7 * size,
        "ellipsoid": gsp.Ellipsoid(np.array([0.5, 0.8, 1.1]) * size, center=[0.1 * size, 0, 0]),
        "maximum": 10.0 * size**power,
    }
    return {name: given[name] for name in index.missing(design, ()) if name in given}


def applies(index, design):
    """Whether an index is defined for a design when all its parameters are given."""
    return not index.missing(design, ("length", "ellipsoid", "maximum"))


def value(index, posture):
    """The value of an index, with parameters made from the design of the posture."""
    return index.function(posture, **parameters(index, posture.design))


def merit(index, posture):
    return index.merit(value(index, posture))


def singular_by_a_turn():
    """Six legs from the z-axis of the base: only the turn about it is not held."""
    rng = np.random.default_rng(5)
    base = np.column_stack((np.zeros((6, 2)), [0.0, 0.2, 0.5, -0.3, -0.8, 0.4]))
    return gsp.Design(["D1"] * 6, base, rng.normal(size=(6, 3)) + 1.0).at(gsp.Pose([0, 0, 1.0]))


def singular_everywhere_alike():
    """The end of the example set, where all legs are parallel."""
    return nawratil.example_design(np.pi / 6).at(nawratil.example_pose(0.8))


def singular_by_a_translation():
    """Six horizontal legs at different heights: only the translation along z is not held."""
    rng = np.random.default_rng(7)
    z = np.array([0.0, 0.4, 1.0, -0.3, 0.8, 1.7])
    base, platform = (np.column_stack((rng.normal(size=(6, 2)), z)) for _ in range(2))
    return gsp.Design(["D1"] * 6, base, platform).at(gsp.Pose([0.0, 0.0, 0.0]))
