"""Proven bounds of |det J|: no pose exceeds them, and where they close."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.proof.maximum import certify_maximum, far_bound
from tests.campaign import count
from tests.proof.proofs import circle, hexapod
from tests.support import turn

LEE = gsp.families.lee


@pytest.mark.parametrize(
    "design",
    [LEE.octahedral_3_3(a=1.0, b=2.0), gsp.catalogue.design("lee-2000-6-6")],
    ids=["3-3", "6-6"],
)
def test_the_maximum_of_the_platforms_of_the_dissertation_is_proven(design):
    best = certify_maximum(design)
    assert best.closed
    assert best.gap < 1e-9
    assert best.found.value <= best.bound


def test_a_box_closes_to_the_requested_tolerance():
    design = LEE.octahedral_3_3(a=1.0, b=2.0)
    box = gsp.PoseBox([(0.3, 0.4), (-0.05, 0.05), (0.6, 0.7)], [(-0.05, 0.05)] * 3)
    best = certify_maximum(design, box, tolerance=0.06, budget=30_000)
    assert best.method == "boxes"
    assert best.closed
    values = gsp.indices.manipulability(design.at(box.sample(20_000, rng=0)))
    assert values.max() <= best.found.value * (1 + 1e-9) <= best.bound


def test_maxima_close_to_each_tolerance_and_bounds_become_lower():
    design = LEE.octahedral_3_3(a=1.0, b=2.0)
    box = gsp.PoseBox([(0.3, 0.4), (-0.05, 0.05), (0.6, 0.7)], [(-0.05, 0.05)] * 3)
    bound = np.inf
    for tolerance in (0.3, 0.1, 0.03, 0.01):
        best = certify_maximum(design, box, tolerance=tolerance)
        assert best.closed
        assert 0.0 < best.gap <= tolerance
        assert best.found.value <= best.bound <= bound
        bound = best.bound


def test_a_neighbourhood_is_bounded():
    """Around a maximum, of an octahedron in turned axes."""
    design = LEE.octahedral_3_3(a=1.0, b=1.2)
    design = design.replace(base_points=design.base_points @ turn([0.2, 0.1, 0.3]).T)
    home = gsp.determinant.maximum(design).pose
    near = gsp.determinant.Neighbourhood(
        home=home, centre=home.position + [0.005, 0.0, -0.01], displacement=0.02, angle=0.02
    )
    best = certify_maximum(design, near, budget=300)
    values = gsp.indices.manipulability(design.at(near.sample(5_000, np.random.default_rng(0))))
    assert values.max() <= best.bound < 1.05 * best.found.value


def test_the_bound_of_far_poses_holds():
    design, rng = hexapod(), np.random.default_rng(1)
    arms = np.linalg.norm(design.platform_points, axis=1)
    reach = arms + np.linalg.norm(design.base_points, axis=1)
    for radius in (6.5, 10.0, 30.0):
        away = rng.standard_normal((20_000, 3))
        away *= radius / np.linalg.norm(away, axis=1, keepdims=True)
        pose = gsp.Pose(away, turn(rng.standard_normal((20_000, 3))))
        values = gsp.indices.manipulability(design.at(pose))
        assert values.max() <= far_bound(reach, arms, radius)
        # It falls with the square of the distance, and so do the values.
        assert values.max() > 0.005 * far_bound(reach, arms, radius)


def test_all_poses_are_closed_to_one_percent():
    """In the short form the budget ends before that, and the formula remains."""
    design = gsp.catalogue.design("nawratil-isotropic-3-mu-0")
    budget = count(2_000, 20_000_000)
    best = certify_maximum(design, "all", budget=budget)
    assert best.closed == (budget > 2_000)
    assert best.found.value <= best.bound <= gsp.determinant.upper_bound(design) * (1 + 1e-9)


@pytest.mark.parametrize("power", [-300, 170, 300])
def test_certified_maxima_hold_in_every_unit(power):
    size = 2.0**power
    for design in (LEE.octahedral_3_3(a=1.0, b=2.0), hexapod()):
        one, other = (certify_maximum(x, "all", budget=100) for x in (design, design.scaled(size)))
        assert other.bound == one.bound * size**3
        assert other.closed == one.closed
        assert other.found.value <= other.bound


def test_a_design_that_is_singular_everywhere_has_no_gap_and_no_proof():
    ring = circle(np.arange(6) * 60.0, 1.0)
    best = certify_maximum(gsp.Design(["D1"] * 6, 2.0 * ring, ring), "all")
    assert best.found.pose is None
    assert best.gap == 0.0
    assert best.bound > 1.0
    assert not best.closed


def test_bad_input_of_certified_maxima():
    with pytest.raises(InvalidInput):
        certify_maximum(None)
    with pytest.raises(InvalidInput):
        certify_maximum(hexapod(), tolerance=1.0)
