"""Each point of a section is where its label states, for random designs in any unit of length."""

from functools import cache

import numpy as np
import pytest

import gsp
from gsp.workspace import section
from tests.campaign import count

HOME = gsp.Pose.from_angles([0.1, -0.2, 1.5], [5.0, -4.0, 11.0], "rpy", degrees=True)
# Of the terms of the lengths; the equations of a point are solved to 1e-12 of the size.
TOLERANCE = 1e-11


def lengths(pose, base, platform):
    """‖p + R b − a‖ of each pose and leg, written out."""
    turned = np.einsum("...ij,kj->...ki", pose.rotation, platform)
    return np.sqrt(((pose.position[..., None, :] + turned - base) ** 2).sum(axis=-1))


def random_design(seed, number, unit):
    rng = np.random.default_rng(seed)
    base = rng.normal(size=(number, 3)) * [1.0, 1.0, 0.1]
    platform = rng.normal(size=(number, 3)) * [0.6, 0.6, 0.1]
    here = lengths(HOME, base, platform)
    low, high = here * rng.uniform(0.75, 0.93, number), here * rng.uniform(1.05, 1.3, number)
    home = gsp.Pose(unit * HOME.position, HOME.rotation)
    strokes = unit * np.stack((low, high), axis=-1)
    return gsp.Design(["D1"] * number, unit * base, unit * platform, strokes=strokes, home=home)


def most(unit):
    """Number of curves that are followed; in other units than 1 fewer of them."""
    return count(12 if unit == 1.0 else 8, 20)


@cache
def mapped(seed, number, unit):
    design = random_design(seed, number, unit)
    return section(
        design, rays=2, starts=1, rng=0, connecting=False, most=most(unit), progress=False
    )  # fmt: skip


# Seed 5 has a curve of two points between bifurcation points, where a third constraint is at a
# bound at one end only; seed 4 has curves along which the platform may spin, with singular
# equations.
@pytest.mark.parametrize(
    ("seed", "number", "unit"),
    [(5, 8, 1.0), (5, 8, 1e-9), (1, 7, 1e6), (4, 6, 1.0), (4, 6, 1e-9), (4, 6, 1e6)],
)
def test_every_point_satisfies_its_label_and_all_strokes(seed, number, unit):
    design = random_design(seed, number, unit)
    found = mapped(seed, number, unit)
    assert len(found.curves) >= most(unit) // 2
    assert len(found.bifurcations) >= most(unit) // 2
    for point in (*found.curves, *found.bifurcations):
        values = lengths(point.pose, design.base_points, design.platform_points)
        for leg, mark in enumerate(point.label.split()):
            if mark != "-":
                gap = values[..., leg] - design.strokes[leg, int(mark)]
                assert np.abs(gap).max() < TOLERANCE * unit, point.label
        assert (values >= design.strokes[:, 0] - 1e-8 * unit).all(), point.label
        assert (values <= design.strokes[:, 1] + 1e-8 * unit).all(), point.label


def test_labels_state_all_legs_at_their_bounds():
    """No leg without a mark is at a bound all along a curve, or at a bifurcation point."""
    design = random_design(5, 8, 1.0)
    found = mapped(5, 8, 1.0)
    for point in (*found.curves, *found.bifurcations):
        values = np.atleast_2d(lengths(point.pose, design.base_points, design.platform_points))
        gaps = np.abs(values[..., None] - design.strokes).max(axis=0)
        free = [mark == "-" for mark in point.label.split()]
        assert (gaps[free] > 1e-9).all(), point.label


@pytest.mark.parametrize("seed", [5, 12])
def test_no_curve_is_lost(seed):
    """Of these designs, one leg alone is active along some curves and leaves a turn free."""
    design = random_design(seed, 6 + seed % 3, 1.0)
    found = section(design, rays=4, starts=2, rng=0, connecting=False, most=20, progress=False)
    assert len(found.curves) == 20
    assert not any(curve.lost for curve in found.curves)
    if seed == 12:
        assert any(len(curve.active) == 1 for curve in found.curves)
