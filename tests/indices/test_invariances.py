"""What each index does not depend on, and what it does: by the records, on general geometry."""

import numpy as np
import pytest

import gsp
from gsp.indices import INDICES
from tests.support import random_design, random_pose, turn

MECHANISMS = ["D1^6", "D2^2 D3^4", "D4^3 D1^3", "D1 D2 D3 D4 A1^2", "D4^3 A1^3"]
CORE = (
    "condition_number", "condition_number_ellipsoid", "control_number",
    "quality_index", "manipulability", "minimum_singular_value",
)  # fmt: skip
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
        "length": 0.8 * scale, "ellipsoid": design.ellipsoid, "maximum": 2.0 * scale**power,
    }  # fmt: skip
    if name == "manipulability":
        given["length"] = None
    index = INDICES[name]
    return index.function(posture, **{key: given[key] for key in index.parameters})


def angles(name):
    return gsp.catalogue.mechanism(name).counts[4]


each = pytest.mark.parametrize("index", CORE)
on_each = pytest.mark.parametrize("name", MECHANISMS)


@each
@on_each
def test_rigid_motion_of_everything(index, name):
    """Another fixed frame: base and poses moved together."""
    design, pose = case(name)
    motion = gsp.Pose([0.4, -2.0, 0.7], turn([0.5, 1.5, -0.4]))
    g = motion.rotation
    other = design.replace(
        base_points=motion.position + design.base_points @ g.T,
        base_directions=design.base_directions @ g.T,
    )
    np.testing.assert_allclose(
        values(other, motion.compose(pose), index), values(design, pose, index), rtol=RTOL
    )


def with_platform_frame(design, pose, frame):
    """The same posture, described in another frame of the platform (its pose in the old one)."""
    back = frame.inverse()
    e = design.ellipsoid
    other = design.replace(
        platform_points=back.position + design.platform_points @ back.rotation.T,
        platform_directions=design.platform_directions @ back.rotation.T,
        ellipsoid=gsp.Ellipsoid(
            e.semi_axes, back.position + back.rotation @ e.center, back.rotation @ e.rotation
        ),
    )
    return other, pose.compose(frame)


@each
@on_each
def test_turned_platform_frame(index, name):
    design, pose = case(name)
    other, there = with_platform_frame(design, pose, gsp.Pose([0, 0, 0], turn([1.0, 0.3, -2.0])))
    np.testing.assert_allclose(values(other, there, index), values(design, pose, index), rtol=RTOL)


@each
@on_each
def test_shifted_platform_origin(index, name):
    """The indices that take the twist at the origin depend on it: the operation point."""
    design, pose = case(name)
    other, there = with_platform_frame(design, pose, gsp.Pose([0.3, -0.4, 0.2]))
    one, two = values(design, pose, index), values(other, there, index)
    if index in ("condition_number", "minimum_singular_value"):
        assert (np.abs(two / one - 1.0) > 1e-3).all()
    else:
        np.testing.assert_allclose(two, one, rtol=RTOL)


@each
@on_each
@pytest.mark.parametrize("scale", [1000.0, 0.0254])
def test_change_of_unit(index, name, scale):
    """The record's `unit_power`, with all parameters in the new unit."""
    design, pose = case(name)
    power = 3 - angles(name)
    one = values(design, pose, index)
    two = values(
        design.scaled(scale), gsp.Pose(pose.position * scale, pose.rotation), index, scale, power
    )
    record = {"1": 0, "length^(3 − n_A1)": power}[INDICES[index].unit_power]
    np.testing.assert_allclose(two, one * scale**record, rtol=RTOL)


@on_each
def test_a_length_that_keeps_its_number_matters(name):
    """Counter-examples: a change of unit that forgets the parameters changes these indices."""
    design, pose = case(name)
    there, scaled = gsp.Pose(pose.position * 1000.0, pose.rotation), design.scaled(1000.0)
    for index in ("condition_number", "minimum_singular_value"):
        assert (np.abs(values(scaled, there, index) / values(design, pose, index) - 1) > 0.01).all()
    forgot = scaled.replace(ellipsoid=design.ellipsoid)
    index = "condition_number_ellipsoid"
    assert (np.abs(values(forgot, there, index) / values(design, pose, index) - 1) > 0.01).all()
    changed = values(scaled, there, "control_number") / values(design, pose, "control_number")
    assert (np.abs(changed - 1.0) > 1e-3).all() == any(leg.cylindrical for leg in design.legs)


@each
@on_each
def test_order_of_legs(index, name):
    design, pose = case(name)
    order = np.random.default_rng(1).permutation(design.n_legs)
    other = design.replace(
        legs=[design.legs[i].name for i in order],
        **{
            key: getattr(design, key)[order]
            for key in (
                "base_points", "platform_points", "base_directions", "platform_directions",
            )
        },
    )  # fmt: skip
    np.testing.assert_allclose(values(other, pose, index), values(design, pose, index), rtol=RTOL)


@on_each
def test_base_and_platform_exchanged(name):
    """CTN and |det J| see both sides alike; the condition numbers look at the platform."""
    design, pose = case(name)
    other, there = design.exchanged().replace(ellipsoid=design.ellipsoid), pose.inverse()
    np.testing.assert_allclose(other.at(there).joints, design.at(pose).joints, rtol=1e-12)
    for index in CORE:
        one, two = values(design, pose, index), values(other, there, index)
        if index in ("control_number", "quality_index", "manipulability"):
            np.testing.assert_allclose(two, one, rtol=RTOL)
        else:
            assert (np.abs(two / one - 1.0) > 1e-3).any()


@on_each
def test_manipulability_with_a_length_has_no_unit(name):
    design, pose = case(name)
    one = gsp.indices.manipulability(design.at(pose), 0.8)
    scaled = design.scaled(25.4).at(gsp.Pose(pose.position * 25.4, pose.rotation))
    np.testing.assert_allclose(gsp.indices.manipulability(scaled, 0.8 * 25.4), one, rtol=RTOL)


def test_units_of_all_sizes():
    """From 1e-150 to 1e150: no overflow, no underflow on the way."""
    design, pose = case("D1 D2 D3 D4 A1^2")
    expected = {index: values(design, pose, index) for index in CORE}
    for scale in (1e-150, 1e-75, 1e75, 1e150):
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
