"""A power of two as a factor of the unit of length changes no bit of a workspace.

Such a factor changes exponents alone, so results are equal but for the factor, unless a search adds
or compares numbers of different units. Designs are of small and of large units, 1e60 apart.
"""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp import workspace
from gsp.limits.bounds import bounded_quantities
from gsp.workspace.boundary.rays import ray_ends
from tests import campaign
from tests.metamorphic import random_design

SMALL, LARGE = 2.0**-100, 2.0**100
LEGS = (
    ["D1"] * 6,
    ["D1", "D1", "D2", "D4", "A1", "D3"],
    ["D1", "D1", "D1", "D2", "D3", "D4 A1"],
    ["D1", "D2", "D3", "D4", "D4 A1", "A1", "D1"],
)
LIMITS = {
    "strokes": lambda design: {},
    "cones": lambda design: {"base_cone": 0.6, "platform_cone": 1.2},
    "index": lambda design: {
        "indices": [f"CTN >= {control_number(design) / 2.0}"],
        "length": design.rms_radius,
    },
    "clearance": lambda design: {"leg_radius": 0.01 * design.rms_radius},
    "position": lambda design: {
        "position": design.home.position[:, None] + 0.5 * design.rms_radius * np.array([-1, 1])
    },
}


def control_number(design):
    return gsp.indices.control_number(design.at(design.home), design.rms_radius)


CASES = [(legs, kind) for kind in LIMITS for legs in LEGS]
# Three has no factor in common with the four designs: all of them are among the first ones.
CASES = (CASES[::3] + CASES[1::3] + CASES[2::3])[: campaign.count(7, len(CASES))]


def design_of(legs, unit):
    """A design with strokes around the lengths and angles of its home pose."""
    plain = random_design(legs, 3, "general")
    home = gsp.Pose([0.0, 0.0, 1.5 * plain.rms_radius])
    joints = plain.at(home).joints
    width = np.where(plain.angular, 0.5, 0.35 * joints)
    strokes = np.stack((joints - width, joints + width), axis=1)
    return plain.replace(home=home, strokes=strokes).scaled(unit)


def limits_of(design, kind):
    return gsp.Limits(**LIMITS[kind](design))


def agree(small, large):
    np.testing.assert_array_equal(small / SMALL, large / LARGE)


@pytest.mark.parametrize(("legs", "kind"), campaign.some(CASES, 3))
def test_ends_of_rays_are_the_same_in_every_unit(legs, kind):
    headings = np.concatenate((np.eye(3), -np.eye(3)[:1]))

    def ends(unit):
        design = design_of(legs, unit)
        bounds = bounded_quantities(design, limits_of(design, kind))
        places = np.tile(design.home.position, (4, 1)), np.tile(np.eye(3), (4, 1, 1))
        assert bounds.allowed(*places).all()
        return ray_ends(bounds, np.eye(3), *places, headings)

    small, large = ends(SMALL), ends(LARGE)
    assert (small.distance > 0.1 * small.bounds.scale).any()
    agree(small.distance, large.distance)
    assert small.reason == large.reason
    assert small.active == large.active


# Rays whose ends are flat in a turn, or beside a pose where a distance of lines changes fast.
FLAT = [17, 26, 28, 50, 63, 80]


@pytest.mark.parametrize(
    ("legs", "kind", "rays"),
    campaign.some(
        [
            (0, "cones", range(6)),
            (0, "index", range(6)),
            (1, "strokes", FLAT),
            (2, "cones", [3, 4, 5]),
        ],
        2,
    ),
)
def test_ends_and_their_checks_are_the_same_in_units_that_round(legs, kind, rays):
    headings = np.random.default_rng(2).normal(size=(96, 3))[list(rays)]
    headings /= np.linalg.norm(headings, axis=1)[:, None]

    def ends(unit):
        design = design_of(LEGS[legs], unit)
        places = np.tile(design.home.position, (len(headings), 1))
        turns = np.tile(np.eye(3), (len(headings), 1, 1))
        bounds = bounded_quantities(design, limits_of(design, kind))
        return ray_ends(bounds, np.eye(3), places, turns, headings)

    plain = ends(1.0)
    assert plain.maximal.all(), plain.reason
    for unit in (1e-6, 25.4, np.pi):
        other = ends(unit)
        assert (other.reason, other.active) == (plain.reason, plain.active)
        np.testing.assert_allclose(other.distance / unit, plain.distance, rtol=1e-8)


@pytest.mark.parametrize("kind", ["strokes", "cones"])
def test_curves_of_a_section_are_the_same_in_every_unit(kind):
    def curves(unit):
        design = design_of(LEGS[1], unit)
        options = {"rays": 3, "starts": 1, "most": 2, "connecting": False, "progress": False}
        return workspace.section(design, limits=limits_of(design, kind), **options).curves

    small, large = curves(SMALL), curves(LARGE)
    assert small
    assert [curve.label for curve in small] == [curve.label for curve in large]
    for one, other in zip(small, large, strict=True):
        agree(one.pose.position, other.pose.position)


def test_a_surface_is_the_same_in_every_unit():
    def mapped(unit):
        design = design_of(LEGS[1], unit)
        return workspace.surface(
            design, limits=limits_of(design, "cones"), counts=(2, 2), starts=1, progress=False
        )

    small, large = mapped(SMALL), mapped(LARGE)
    assert small.maximal.any()
    agree(small.distance, large.distance)
    assert (small.labels == large.labels).all()


def test_a_region_and_its_boundary_are_the_same_in_every_unit():
    def mapped(unit):
        design = design_of(LEGS[1], unit)
        plane = design.home.position, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        region = workspace.reachable(
            design, None, plane=plane, budget=500, workers=1, progress=False
        )
        return region, workspace.boundary_curves(region, most=2, progress=False)

    (small, some), (large, others) = mapped(SMALL), mapped(LARGE)
    np.testing.assert_array_equal(np.array(small.area) / SMALL**2, np.array(large.area) / LARGE**2)
    assert (some.missed == others.missed).all()
    labels = [[curve.label for curve in one.section.curves] for one in (some, others)]
    assert labels[0] == labels[1]
