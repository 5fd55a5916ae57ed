"""The closed forms of Lee's platforms against the assembled rows."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

from gsp.families import lee
from gsp.geometry.pose import Pose
from gsp.indices import manipulability

SIDES = [(1.0, 2.0), (1.3, 2.1), (2.0, 0.7)]
SHARES = [(0.0, 0.0), (0.0, 0.3), (0.0, 0.8), (0.25, 1 / 6), (0.8, 0.7), (0.6, 0.1)]
RHO = [0.0, 0.1, 0.2, 0.45, 0.9]


def central(h, theta=0.0):
    return Pose.from_rpy([0.0, 0.0, h], [0.0, 0.0, theta])


@pytest.mark.parametrize(("a", "b"), SIDES)
@pytest.mark.parametrize(("alpha", "beta"), SHARES)
def test_central_configuration_of_the_hexagons(a, b, alpha, beta):
    posture = lee.platform_6_6(a, b, alpha, beta).at(central(0.8))
    np.testing.assert_allclose(posture.joints, lee.leg_length(a, b, 0.8, alpha, beta), rtol=1e-13)
    determinant = lee.central_determinant(a, b, 0.8, alpha, beta)
    np.testing.assert_allclose(manipulability(posture), determinant, rtol=1e-12)


@pytest.mark.parametrize(("a", "b"), SIDES)
@pytest.mark.parametrize(("alpha", "beta"), SHARES)
def test_best_height_is_where_the_slope_vanishes(a, b, alpha, beta):
    h = lee.best_height(a, b, alpha, beta)
    at = [lee.central_determinant(a, b, h * k, alpha, beta) for k in (1 - 1e-4, 1.0, 1 + 1e-4)]
    assert at[1] > max(at[0], at[2])
    assert abs(at[2] - at[0]) < 1e-7 * at[1]
    np.testing.assert_allclose(at[1], lee.central_maximum(a, b, alpha, beta), rtol=1e-13)


@pytest.mark.parametrize(("alpha", "beta"), SHARES[:4] + SHARES[5:])
def test_best_ratio_is_where_the_slope_vanishes(alpha, beta):
    ratio = lee.best_ratio(alpha, beta)
    at = lee.central_maximum(1.3, 1.3 * ratio * np.array([1 - 1e-4, 1, 1 + 1e-4]), alpha, beta)
    assert at[1] > max(at[0], at[2])
    assert abs(at[2] - at[0]) < 1e-7 * at[1]
    np.testing.assert_allclose(at[1], lee.absolute_maximum(1.3, alpha), rtol=1e-13)


@pytest.mark.parametrize(("alpha", "beta"), [(1 / 3, 1 / 3), (1 / 4, 2 / 5), (0.0, 1 / 2)])
def test_regulus_platforms_are_singular_in_every_pose(alpha, beta):
    assert lee.regulus_factor(alpha, beta) == pytest.approx(0.0, abs=1e-15)
    design = lee.platform_6_6(1.0, 1.7, alpha, beta)
    poses = Pose.sample([(-2, 2)] * 3, [(-2, 2)] * 3, 50, rng=1)
    values = np.linalg.svd(design.at(poses).jacobian, compute_uv=False)
    assert values[:, 5].max() < 1e-14
    rank = 3 if alpha == 0.0 else 5  # with α = 0 the legs coincide two by two
    assert values[:, rank - 1].min() > 1e-4


def test_regulus_platforms_have_three_freedoms_in_the_central_configuration():
    for alpha, beta in [(1 / 3, 1 / 3), (1 / 4, 2 / 5), (0.0, 1 / 2)]:
        posture = lee.platform_6_6(1.0, 1.7, alpha, beta).at(central(0.8))
        assert np.linalg.matrix_rank(posture.jacobian, tol=1e-12) == 3


def test_octahedron_volume_is_the_hull_and_the_absolute_maximum():
    from scipy.spatial import ConvexHull

    a, b, h = 1.2, 2.3, 0.9
    design = lee.octahedral_3_3(a, b)
    points = np.vstack((design.base_points, design.platform_points + np.array([0, 0, h])))
    assert ConvexHull(points, qhull_options="QJ").volume == pytest.approx(
        lee.octahedron_volume(a, b, h), rel=1e-6
    )
    assert lee.octahedron_volume(a, 2 * a, a) == pytest.approx(lee.absolute_maximum(a), rel=1e-14)


def test_translated_octahedron():
    a, b = 1.3, 2.2
    x, y, z = np.random.default_rng(0).uniform(-1, 1, (3, 4, 5))
    posture = lee.octahedral_3_3(a, b).at(Pose(np.stack((x, y, z), axis=-1)))
    lengths = lee.translated_leg_lengths(a, b, x, y, z)
    np.testing.assert_allclose(posture.joints, lengths, rtol=1e-13)
    expected = lee.translated_determinant(a, b, x, y, z)
    np.testing.assert_allclose(manipulability(posture), expected, rtol=1e-11)


def test_polar_form_of_the_translated_octahedron():
    r, theta = np.random.default_rng(0).uniform(0, 4, (2, 50))
    direct = lee.translated_quality(1.0, 2.0, r * np.cos(theta), r * np.sin(theta), 1.0)
    np.testing.assert_allclose(lee.quality_polar(r, theta), direct, rtol=1e-12)


def test_bracket_form_of_a_general_octahedron():
    rng = np.random.default_rng(3)
    base, platform = rng.normal(size=(2, 7, 3, 3))
    e, p = (np.repeat(np.moveaxis(v, 1, 0), 2, axis=0) for v in (base, platform))
    start, end = e[[0, 2, 2, 4, 4, 0]], p[[0, 0, 2, 2, 4, 4]]
    lines = np.moveaxis(lee.line_coordinates(start, end), 0, 1)
    star = lee.bracket_determinant(base, platform)
    np.testing.assert_allclose(np.abs(np.linalg.det(lines)), np.abs(star), rtol=1e-11)


def test_brackets_of_the_turned_octahedron():
    a, b, h, theta = 1.3, 2.1, 0.7, 0.9
    design = lee.octahedral_3_3(a, b)
    base = design.base_points[[0, 2, 4]] - [0, 0, h]
    turn = central(0.0, theta).rotation
    platform = design.platform_points[[0, 2, 4]] @ turn.T
    (ea, eb, ec), (pa, pb, pc) = base, platform
    first, second = lee.turned_brackets(a, b, h, theta)
    for four in ((eb, ea, pa, pc), (ea, ec, pc, pb), (ec, eb, pb, pa)):
        assert lee.bracket(*four) == pytest.approx(first, rel=1e-13)
    for four in ((eb, ea, pa, pb), (ea, ec, pc, pa), (ec, eb, pb, pc)):
        assert lee.bracket(*four) == pytest.approx(second, rel=1e-13)
    star = lee.bracket_determinant(base, platform)
    assert abs(star) == pytest.approx(lee.turned_determinant(a, b, h, theta), rel=1e-13)
    assert abs(star) == pytest.approx(abs(first**3 + second**3), rel=1e-13)


def test_shear_of_points_and_of_lines():
    rng = np.random.default_rng(0)
    p, q = rng.normal(size=(2, 9, 3))
    moved = [np.c_[np.ones(9), v] @ lee.shear(0.3, -0.4, 0.8).T for v in (p, q)]
    lines = lee.line_coordinates(p, q) @ lee.shear_of_lines(0.3, -0.4, 0.8).T
    np.testing.assert_allclose(lee.line_coordinates(*(m[:, 1:] for m in moved)), lines, atol=1e-14)
    assert np.linalg.det(lee.shear_of_lines(0.3, -0.4, 0.8)) == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(("a", "b"), SIDES)
@pytest.mark.parametrize("rho", RHO)
@pytest.mark.parametrize("theta", [0.0, 0.3, -1.1])
@pytest.mark.parametrize(
    ("design", "closed_form"),
    [
        (lee.separated_to_centre, lee.to_centre),
        (lee.separated_along_side, lee.along_side),
    ],
)
def test_separated_joints(design, closed_form, a, b, rho, theta):
    posture = design(a, b, rho).at(central(0.7, theta))
    known = closed_form(a, b, rho, theta, 0.7)
    np.testing.assert_allclose(posture.joints[::2], known.lengths[0], rtol=1e-13)
    np.testing.assert_allclose(posture.joints[1::2], known.lengths[1], rtol=1e-13)
    np.testing.assert_allclose(manipulability(posture), known.determinant, rtol=1e-11)


@pytest.mark.parametrize("closed_form", [lee.to_centre, lee.along_side])
@pytest.mark.parametrize("rho", RHO)
def test_best_central_pose_beats_its_neighbours(closed_form, rho):
    value, theta, pose = lee.best_central_pose(closed_form, 1.0, 2.0, rho)
    h = pose.position[2]
    for dh, dt in ((1e-3, 0), (-1e-3, 0), (0, 1e-3), (0, -1e-3)):
        assert closed_form(1.0, 2.0, rho, theta + dt, h + dh).determinant < value
    twists = np.linspace(-np.pi, np.pi, 500)[:, None]
    heights = np.linspace(0.01, 3.0, 300)
    assert closed_form(1.0, 2.0, rho, twists, heights).determinant.max() <= value * (1 + 1e-12)


def test_families_are_the_octahedron_without_separation():
    octahedron = lee.octahedral_3_3(1.0, 2.0)
    pose = Pose.from_rpy([0.1, -0.2, 0.9], [0.2, 0.3, -0.4])
    value = manipulability(octahedron.at(pose))
    for other in (
        lee.platform_3_6(1.0, 2.0, 0.0),
        lee.platform_6_6(1.0, 2.0, 0.0, 0.0),
        lee.separated_to_centre(1.0, 2.0, 0.0),
        lee.separated_along_side(1.0, 2.0, 0.0),
    ):
        assert manipulability(other.at(pose)) == pytest.approx(value, rel=1e-13)


@pytest.mark.parametrize("share", [-0.1, 1.1, float("nan")])
def test_shares_outside_of_zero_to_one_are_errors(share):
    from gsp.errors import InvalidInput

    for make in (lee.platform_3_6, lee.separated_to_centre, lee.separated_along_side):
        with pytest.raises(InvalidInput, match=r"\[0, 1\]|finite"):
            make(1.0, 2.0, share)
    with pytest.raises(InvalidInput, match="positive"):
        lee.octahedral_3_3(-1.0, 2.0)


# Powers of the unit of length by which the closed forms change, for arguments a, b, h.
POWERS = {
    "leg_length": 1, "best_height": 1, "central_determinant": 3, "central_maximum": 3,
    "octahedron_volume": 3, "absolute_maximum": 3, "translated_leg_lengths": 1,
    "translated_determinant": 3, "translated_quality": 0,
}  # fmt: skip
LENGTHS = {"a": 1.3, "b": 2.1, "h": 0.8, "x": 0.3, "y": -0.4, "z": 0.9}


@pytest.mark.parametrize("name", POWERS)
@pytest.mark.parametrize("unit", [1e-95, 1e-30, 1e60, 1e95])
def test_closed_forms_scale_with_the_unit_of_length(name, unit):
    function = getattr(lee, name)
    known = set(inspect.signature(function).parameters) & set(LENGTHS)
    here = function(**{k: LENGTHS[k] for k in known})
    there = function(**{k: LENGTHS[k] * unit for k in known})
    np.testing.assert_allclose(there / unit ** POWERS[name], here, rtol=1e-12)


@pytest.mark.parametrize("closed_form", [lee.to_centre, lee.along_side])
@pytest.mark.parametrize("unit", [1e-95, 1e95])
def test_closed_forms_of_separated_joints_scale_with_the_unit(closed_form, unit):
    here, there = closed_form(1.3, 2.1, 0.2, 0.4), closed_form(1.3 * unit, 2.1 * unit, 0.2, 0.4)
    np.testing.assert_allclose(there.height / unit, here.height, rtol=1e-12)
    np.testing.assert_allclose(np.divide(there.lengths, unit), here.lengths, rtol=1e-12)
    np.testing.assert_allclose(there.determinant / unit**3, here.determinant, rtol=1e-12)
    value, theta, pose = lee.best_central_pose(closed_form, 1.3, 2.1, 0.2)
    large, twist, far = lee.best_central_pose(closed_form, 1.3 * unit, 2.1 * unit, 0.2)
    assert (large / unit**3, twist) == pytest.approx((value, theta), rel=1e-9)
    np.testing.assert_allclose(far.position / unit, pose.position, rtol=1e-9)


def test_anchors_above_each_other_have_lengths_without_rounding_errors():
    """The printed sum of eq. (61) is −4e-16 there, of which the root is NaN."""
    assert lee.best_height(1.3, 1.3, 1 / 3, 1 / 3) == pytest.approx(0.0, abs=1e-16)
    assert lee.leg_length(1.3, 1.3, 0.7, 1 / 3, 1 / 3) == pytest.approx(0.7, rel=1e-15)
    assert lee.to_centre(1.3, 1.3, 0.2, np.pi / 3.0, 0.7).lengths[1] == pytest.approx(0.7)
    assert np.isnan(lee.translated_determinant(1.0, 1.0, 0.0, -1.0 / 3**0.5, 0.0))


def test_where_there_is_no_best_ratio_the_maximum_grows_with_the_base():
    values = lee.central_maximum(1.0, np.geomspace(0.1, 1e6, 50), 0.8, 0.7)
    assert (np.diff(values) > 0.0).all()
