"""Postures: order of rows, batches, homogeneous and weighted rows, spectra."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter, UndefinedPosture
from gsp.model.posture.assembly import POSES_PER_ASSEMBLY
from tests.support import LEG_NAMES, random_design, random_pose

DESIGN = random_design(np.random.default_rng(0), LEG_NAMES, unit="mm")
ANGLES = np.array([0, 0, 0, 0, 1, 0, 1], dtype=bool)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_shapes_and_elements(shape):
    pose = random_pose(np.random.default_rng(1), shape)
    posture = DESIGN.at(pose)
    assert posture.shape == posture.defined.shape == posture.singular().shape == shape
    assert posture.joints.shape == (*shape, 7)
    assert posture.jacobian.shape == (*shape, 7, 6)
    assert posture.singular_values(2.0).shape == (*shape, 6)
    for index in np.ndindex(shape):
        one = DESIGN.at(pose[index])
        np.testing.assert_allclose(posture.joints[index], one.joints, rtol=1e-13)
        np.testing.assert_allclose(posture.jacobian[index], one.jacobian, rtol=1e-12, atol=1e-14)


def test_rows_come_leg_by_leg():
    posture = DESIGN.at(random_pose(np.random.default_rng(1)))
    np.testing.assert_array_equal(posture.angular, ANGLES)
    assert posture.joint_names == ("d1", "d2", "d3", "d4", "theta5", "d6", "theta6")
    order = [5, 0, 4, 3, 2, 1]
    other = DESIGN.replace(
        legs=[LEG_NAMES[i] for i in order],
        **{
            name: getattr(DESIGN, name)[order]
            for name in ("base_points", "platform_points", "base_directions", "platform_directions")
        },
    ).at(posture.pose)
    rows = [5, 6, 0, 4, 3, 2, 1]
    np.testing.assert_array_equal(other.jacobian, posture.jacobian[rows])
    np.testing.assert_array_equal(other.joints, posture.joints[rows])


def test_homogeneous_and_weighted():
    posture = DESIGN.at(random_pose(np.random.default_rng(1), (4,)))
    j, length = posture.jacobian, 2.5
    expected = j / np.array([1, 1, 1, length, length, length])
    expected[:, ANGLES] *= length
    np.testing.assert_allclose(posture.homogeneous(length), expected, rtol=1e-15)
    np.testing.assert_allclose(posture.homogeneous(length)[:, ANGLES], j[:, ANGLES], rtol=1e-15)
    expected = j * np.where(ANGLES, length, 1.0)[:, None]
    np.testing.assert_allclose(posture.weighted(length), expected, rtol=1e-15)
    np.testing.assert_allclose(
        posture.singular_values(length),
        np.linalg.svd(posture.homogeneous(length), compute_uv=False),
        rtol=1e-14,
    )


def test_angular_rows_need_a_length():
    pose = random_pose(np.random.default_rng(1))
    with pytest.raises(MissingParameter, match=r"length: expected a positive number, as .* A1"):
        DESIGN.at(pose).weighted(None)
    ups = random_design(np.random.default_rng(0), ["D1"] * 6).at(pose)
    np.testing.assert_array_equal(ups.weighted(None), ups.jacobian)


def test_segments_end_on_anchors_and_lines():
    posture = DESIGN.at(random_pose(np.random.default_rng(1), (3, 2)))
    lines, segments, p = posture.lines, posture.segments, posture.pose.position[..., None, :]
    base = segments.base_feet - DESIGN.base_points
    platform = segments.platform_feet - p - lines.arm
    for i, leg in enumerate(DESIGN.legs):
        for on_line, offset, way in (
            (leg.base_line, base, lines.s[i]),
            (leg.platform_line, platform, lines.t[..., i, :]),
        ):
            away = np.cross(offset[..., i, :], way) if on_line else offset[..., i, :]
            assert np.abs(away).max() < 1e-12
            if on_line:
                across = (segments.direction[..., i, :] * way).sum(axis=-1)
                assert np.abs(across).max() < 1e-13
    np.testing.assert_allclose(np.linalg.norm(segments.along, axis=-1), segments.length)
    np.testing.assert_allclose(segments.normal, np.cross(lines.t, lines.s), atol=1e-15)
    both = [leg.base_line and leg.platform_line for leg in DESIGN.legs]
    angles = np.arccos(np.einsum("...i,...i->...", lines.t, lines.s)[..., both])
    np.testing.assert_allclose(segments.sine[..., both], np.sin(angles), rtol=1e-10)
    assert np.isnan(segments.sine[..., ~np.array(both)]).all()
    distances = [i for i, row in enumerate(DESIGN.rows) if not DESIGN.angular[i]]
    owners = [DESIGN.rows[i].leg for i in distances]
    np.testing.assert_array_equal(segments.length[..., owners], posture.joints[..., distances])


@pytest.mark.parametrize(
    "count", [POSES_PER_ASSEMBLY - 1, POSES_PER_ASSEMBLY, POSES_PER_ASSEMBLY + 1]
)
def test_bits_do_not_depend_on_the_batch(count):
    pose = random_pose(np.random.default_rng(1), (count,))
    many = DESIGN.at(pose)
    for i in (0, 7, count - 1):
        one = DESIGN.at(pose[i])
        np.testing.assert_array_equal(one.jacobian, many.jacobian[i])
        np.testing.assert_array_equal(one.joints, many.joints[i])
        np.testing.assert_array_equal(one.segments.base_feet, many.segments.base_feet[i])
        np.testing.assert_array_equal(one.passive_rates(0.7), many.passive_rates(0.7)[i])


def test_arrays_are_read_only():
    posture = DESIGN.at(random_pose(np.random.default_rng(1)))
    for array in (posture.joints, posture.jacobian):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


BAD_LENGTHS = [0, -1.0, np.nan, np.inf, "1", True, 1j, [1.0], np.ones(3), {}]


@pytest.mark.parametrize("length", BAD_LENGTHS, ids=repr)
def test_bad_lengths(length):
    ups = random_design(np.random.default_rng(0), ["D1"] * 6).at(gsp.Pose([0, 0, 1.5]))
    for posture in (DESIGN.at(gsp.Pose([0, 0, 1.5])), ups):
        for method in ("homogeneous", "weighted", "passive_rates", "singular_values", "singular"):
            with pytest.raises(InvalidInput, match="length: expected a positive number, received"):
                getattr(posture, method)(length)


def test_a_defined_posture_passes_the_check():
    posture = DESIGN.at(random_pose(np.random.default_rng(1), (4,)))
    posture.check_defined()
    assert posture.undefined == ()
    assert posture.defined.all()


def test_undefined_names_pose_joint_and_reason():
    pose = random_pose(np.random.default_rng(1), (2, 3))
    positions = pose.position.copy()
    positions[1, 2] -= DESIGN.at(pose).lines.d[1, 2, 0]
    posture = DESIGN.at(gsp.Pose(positions, pose.rotation))
    assert posture.undefined == (((1, 2), "d1", "the anchor points coincide"),)
    message = (
        r"d1 .*at pose \[1, 2\]\): expected a value, received none: the anchor points coincide"
    )
    with pytest.raises(UndefinedPosture, match=message):
        posture.check_defined()


def test_as_far_away_as_a_pose_may_be_the_rows_are_defined():
    posture = DESIGN.at(gsp.Pose([1e100, 0.0, 0.0]))
    assert posture.defined.all()
    assert np.isfinite(posture.jacobian).all()
