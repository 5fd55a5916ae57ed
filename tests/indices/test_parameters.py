"""Parameters of the indices in another unit, in units of all sizes, and legs given twice."""

import numpy as np
import pytest

import gsp
from gsp.indices import INDICES
from tests.support import random_design, random_pose, turn

MECHANISMS = ["D1^6", "D2^2 D3^4", "D4^3 D1^3", "D1 D2 D3 D4 A1^2", "D4^3 A1^3"]
CORE = (
    "condition_number",
    "condition_number_ellipsoid",
    "control_number",
    "quality_index",
    "manipulability",
    "minimum_singular_value",
)
RTOL = 1e-9


def case(name, seed=0, n=5):
    rng = np.random.default_rng([seed, len(name)])
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    ellipsoid = gsp.Ellipsoid([0.5, 0.7, 0.4], [0.1, -0.2, 0.3], turn([0.3, 0.2, 0.1]))
    design = random_design(rng, legs, ellipsoid=ellipsoid, characteristic_length=0.8)
    return design, random_pose(rng, (n,))


def values(design, pose, name, scale=1.0, power=0):
    """An index of a design, with its parameters; `scale` is the new unit of them."""
    posture = design.at(pose)
    given = {
        "length": 0.8 * scale,
        "ellipsoid": design.ellipsoid,
        "maximum": 2.0 * scale**power,
    }
    if name == "manipulability":
        given["length"] = None
    index = INDICES[name]
    return index.function(posture, **{key: given[key] for key in index.parameters})


on_each = pytest.mark.parametrize("name", MECHANISMS)


@on_each
def test_a_length_that_keeps_its_number_matters(name):
    """Counter-examples: a change of unit without the parameters changes these indices."""
    design, pose = case(name)
    there, scaled = gsp.Pose(pose.position * 1000.0, pose.rotation), design.scaled(1000.0)
    for index in ("condition_number", "minimum_singular_value"):
        assert (np.abs(values(scaled, there, index) / values(design, pose, index) - 1) > 0.01).all()
    forgot = scaled.replace(ellipsoid=design.ellipsoid)
    index = "condition_number_ellipsoid"
    assert (np.abs(values(forgot, there, index) / values(design, pose, index) - 1) > 0.01).all()
    changed = values(scaled, there, "control_number") / values(design, pose, "control_number")
    assert (np.abs(changed - 1.0) > 1e-3).all() == any(leg.cylindrical for leg in design.legs)


@on_each
def test_manipulability_with_a_length_has_no_unit(name):
    design, pose = case(name)
    one = gsp.indices.manipulability(design.at(pose), 0.8)
    scaled = design.scaled(25.4).at(gsp.Pose(pose.position * 25.4, pose.rotation))
    np.testing.assert_allclose(gsp.indices.manipulability(scaled, 0.8 * 25.4), one, rtol=RTOL)


def test_units_of_all_sizes():
    """From 1e-90 to 1e90: no overflow, no underflow on the way; larger coordinates are refused."""
    design, pose = case("D1 D2 D3 D4 A1^2")
    expected = {index: values(design, pose, index) for index in CORE}
    for scale in (1e-90, 1e-45, 1e45, 1e90):
        there = gsp.Pose(pose.position * scale, pose.rotation)
        scaled = design.scaled(scale)
        for index in CORE:
            factor = scale if index == "manipulability" else 1.0
            np.testing.assert_allclose(
                values(scaled, there, index, scale, 1), expected[index] * factor, rtol=RTOL
            )


def test_redundant_legs():
    """Each leg twice: J is J twice, and CTN and the condition numbers do not change."""
    design, pose = case("D1 D2 D3 D4 A1^2")
    twice = {
        key: np.concatenate((getattr(design, key),) * 2)
        for key in ("base_points", "platform_points", "base_directions", "platform_directions")
    }
    double = design.replace(legs=[leg.name for leg in design.legs] * 2, **twice)
    assert double.at(pose).jacobian.shape == (5, 12, 6)
    for index, factor in zip(CORE, (1, 1, 1, 8, 8, np.sqrt(2)), strict=True):
        np.testing.assert_allclose(
            values(double, pose, index), factor * values(design, pose, index), rtol=RTOL
        )
