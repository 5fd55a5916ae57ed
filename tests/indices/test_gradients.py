"""Gradients of indices by dimensions: differences in 50 digits, and where there are none."""

from types import SimpleNamespace

import mpmath
import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.indices import INDICES, gradient
from gsp.indices.cdn_points import largest_corners
from gsp.indices.gradients import index_slopes
from gsp.model.posture.slopes import Directions, Slopes
from tests import exact
from tests.support import random_design, random_pose

LENGTH = 0.8
ELLIPSOID = gsp.Ellipsoid([0.5, 0.7, 1.0], [0.1, 0.2, 0.3])
PARTS = ("base_points", "platform_points", "base_directions", "platform_directions")
WITH_SLOPE = [name for name, index in INDICES.items() if index.slope]
NO_PARAMETERS = dict.fromkeys(("length", "ellipsoid", "maximum"))


def options(name):
    given = {"length": LENGTH, "ellipsoid": ELLIPSOID}
    return {key: given[key] for key in INDICES[name].parameters if key in given}


def shifted(design, directions, step):
    """A design in 50 digits: `tests.screws` makes directions unit vectors."""
    moved = {
        part: exact.exact(getattr(design, part)) + step * exact.exact(direction)
        for part, direction in zip(PARTS, directions, strict=True)
    }
    return SimpleNamespace(legs=design.legs, **moved)


def in_fifty_digits(design, pose, corners):
    values = exact.reviewed(design, pose, LENGTH, corners)
    names = ("condition_number", "condition_number_ellipsoid", "control_number")
    three = exact.indices(design, pose, LENGTH, ELLIPSOID)
    return {**values, **dict(zip(names, three, strict=True))}


@pytest.mark.parametrize("name", ["D1^6", "D2^3 D3^3", "D4^4 A1^2", "D1 D2 D3 D4 A1^2"])
def test_gradients_are_central_differences_in_fifty_digits(name):
    rng = np.random.default_rng(len(name))
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    design, pose = random_design(rng, legs), random_pose(rng)
    directions = rng.normal(size=(4, design.n_legs, 3))
    corners = largest_corners(design)[0]
    with mpmath.workdps(exact.DIGITS):
        step = mpmath.mpf(10) ** -15
        high, low = (
            in_fifty_digits(shifted(design, directions, sign * step), pose, corners)
            for sign in (1, -1)
        )
        differences = {key: float((high[key] - low[key]) / (2 * step)) for key in high}
    posture = design.at(pose)
    assert set(differences) == set(WITH_SLOPE)
    for index, wanted in differences.items():
        given = {} if index == "manipulability" else options(index)
        found = gradient(posture, index, **given)
        parts = [getattr(found, part) for part in PARTS]
        along = sum((x * y).sum() for x, y in zip(parts, directions, strict=True))
        size = sum(np.abs(x * y).sum() for x, y in zip(parts, directions, strict=True))
        # Rounding is that of J⁻¹, so it has the condition number as a factor.
        assert abs(along - wanted) < 1e-14 * gsp.indices.condition_number(posture, LENGTH) * size
        assert abs(wanted) > 1e-6


@pytest.mark.parametrize("legs", [["D1"] * 8, ["D2", "D3", "A1", "D4 A1", "D1", "D4", "D1"]])
def test_redundant_designs_and_batches(legs):
    rng = np.random.default_rng(len(legs))
    design, pose = random_design(rng, legs), random_pose(rng, (2, 3))
    anchors, step = rng.normal(size=(1, len(legs), 12)), 1e-6
    directions = Directions(anchors=anchors, length=np.array([0.7]))

    def value(index, sign):
        moved = {
            part: getattr(design, part) + sign * step * anchors[0, :, 3 * i : 3 * i + 3]
            for i, part in enumerate(PARTS)
        }
        given = {**options(index), "length": LENGTH + sign * step * 0.7}
        given = {key: given[key] for key in options(index) if index != "manipulability"}
        return INDICES[index].function(design.replace(**moved).at(pose), **given)

    for index in WITH_SLOPE:
        if INDICES[index].actuators:
            continue
        given = {} if index == "manipulability" else options(index)
        found = index_slopes(index, design.at(pose), directions, {**NO_PARAMETERS, **given})
        wanted = (value(index, 1) - value(index, -1)) / (2 * step)
        assert found.shape == (2, 3, 1)
        np.testing.assert_allclose(found[..., 0], wanted, rtol=1e-6, atol=1e-6 * abs(wanted).max())


def test_the_bits_of_a_pose_do_not_depend_on_the_others():
    rng = np.random.default_rng(5)
    design, pose = random_design(rng, ["D1"] * 6), random_pose(rng, (600,))
    for index in WITH_SLOPE:
        given = {} if index == "manipulability" else options(index)
        many = gradient(design.at(pose), index, **given).base_points
        one = gradient(design.at(pose[571]), index, **given).base_points
        np.testing.assert_allclose(many[571], one, rtol=1e-13)


def test_no_part_along_a_direction_and_none_of_missing_lines():
    rng = np.random.default_rng(2)
    design = random_design(rng, ["D1", "D2", "D3", "D4", "A1", "D4 A1"])
    found = gradient(design.at(random_pose(rng)), "CTN", length=LENGTH)
    for part in PARTS[2:]:
        values, lines = getattr(found, part), getattr(design, part)
        there = np.isfinite(lines).all(axis=-1)
        assert (values[~there] == 0.0).all()
        assert abs((values * lines)[there].sum(axis=-1)).max() < 1e-14


def hexapod(radius):
    return gsp.hexapod(2.0, 0.3, radius, 0.4, 1.5)


def test_repeated_singular_values_are_differentiable_where_they_stay_together():
    """At the centred pose of a hexapod σ are in pairs, in its family as well."""
    design = hexapod(1.0)
    posture = design.at(design.home)
    values = posture.singular_values(0.3)
    assert values[4] - values[5] < 1e-13
    assert np.isnan(gradient(posture, "CDN_CL", length=0.3).base_points).any()
    step = 1e-6
    high, low = hexapod(1.0 + step), hexapod(1.0 - step)
    anchors = np.zeros((1, 6, 12))
    anchors[0, :, 3:6] = (high.platform_points - low.platform_points) / (2 * step)
    along = Directions(anchors=anchors, length=np.zeros(1))
    found = index_slopes("condition_number", posture, along, {**NO_PARAMETERS, "length": 0.3})
    ends = [gsp.indices.condition_number(d.at(design.home), 0.3) for d in (high, low)]
    assert found[0] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-8)


def test_singular_and_undefined_postures_have_none():
    octahedron = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    # In the plane of the base it is singular.
    singular = octahedron.at(gsp.Pose([0.0, 0.0, 0.0]))
    assert singular.singular()
    on_anchor = octahedron.base_points[0] - octahedron.platform_points[0]
    undefined = octahedron.at(gsp.Pose(on_anchor))
    assert not undefined.defined
    for index in WITH_SLOPE:
        given = {} if index == "manipulability" else options(index)
        for posture in (singular, undefined):
            if INDICES[index].properties.zero_iff_singular or posture is undefined:
                assert np.isnan(gradient(posture, index, **given).platform_points).all(), index


def test_the_maximum_of_lambda_changes_with_the_dimensions():
    design = random_design(np.random.default_rng(8), ["D1"] * 6)
    pose = random_pose(np.random.default_rng(9))
    shift = np.random.default_rng(10).normal(size=(6, 3))
    found = gradient(design.at(pose), "λ")
    step = 1e-5

    def value(sign):
        moved = design.replace(base_points=design.base_points + sign * step * shift)
        return gsp.indices.quality_index(moved.at(pose))

    wanted = (value(1) - value(-1)) / (2 * step)
    assert (found.base_points * shift).sum() == pytest.approx(wanted, rel=1e-6)
    given = gradient(design.at(pose), "λ", maximum=2.0).base_points
    plain = gradient(design.at(pose), "|det J|").base_points
    np.testing.assert_allclose(given, plain / 2.0, rtol=1e-15)
    assert abs(given - found.base_points).max() > 1e-3


def test_slopes_of_joints_are_differences():
    rng = np.random.default_rng(3)
    design = random_design(rng, ["D1", "D2", "D3", "D4", "A1", "D4 A1"])
    pose, anchors = random_pose(rng), rng.normal(size=(1, 6, 12))
    moved = [
        design.replace(
            **{
                part: getattr(design, part) + step * anchors[0, :, 3 * i : 3 * i + 3]
                for i, part in enumerate(PARTS)
            }
        )
        for step in (1e-6, -1e-6)
    ]
    wanted = (moved[0].at(pose).joints - moved[1].at(pose).joints) / 2e-6
    along = Directions(anchors=anchors, length=np.zeros(1))
    np.testing.assert_allclose(Slopes(design.at(pose), along).joints[0], wanted, atol=1e-8)


def test_bad_calls():
    design = hexapod(1.0)
    posture = design.at(design.home)
    with pytest.raises(InvalidInput, match=r"one with a gradient: .*, received SD"):
        gradient(posture, "SD", length=1.0)
    with pytest.raises(MissingParameter, match="expected length="):
        gradient(posture, "CDN_CL")
    with pytest.raises(InvalidInput, match="posture: expected"):
        gradient(design, "CTN")
    mixed = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    with pytest.raises(InvalidInput, match="maximum: expected a number"):
        gradient(mixed.at(mixed.home), "λ")
