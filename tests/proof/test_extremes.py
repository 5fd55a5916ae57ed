"""Bounds over boxes, distances to singular poses, largest boxes and paths."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm, logm
from scipy.spatial.transform import Rotation

import gsp
from gsp.errors import InvalidInput, MissingParameter, UnknownIndex
from gsp.proof.distance import least_distances
from tests.campaign import count
from tests.proof.proofs import KINDS, around, hexapod, poses_in, singular_design
from tests.support import random_design, random_pose, turn

HEXAPOD = hexapod()
UP = gsp.Pose([0.0, 0.0, 1.5])


# --- bounds ---


@pytest.mark.parametrize("index", ["CDN_CL", "σ_min", "d2"])
def test_bounds_hold_for_samples_and_are_near_to_them(index):
    rng = np.random.default_rng(1)
    box = around(1.5, 0.05, 3.0)
    pose = poses_in(rng, box, 20_000)
    posture = HEXAPOD.at(pose)
    values = {
        "CDN_CL": lambda: gsp.indices.condition_number(posture, 1.0),
        "σ_min": lambda: gsp.indices.minimum_singular_value(posture, 1.0),
        "d2": lambda: posture.joints[:, 1],
    }[index]()
    found = gsp.bounds(HEXAPOD, box, index, 0.01, length=1.0, budget=20_000)
    low, high = found
    assert low <= values.min() <= values.max() <= high
    assert found.least <= values.min() * (1 + 1e-9) + 0.02
    assert low <= found.least <= found.greatest <= high
    assert high - low < 3.0 * (values.max() - values.min())
    ends = HEXAPOD.at(found.greatest_pose)
    at_greatest = {
        "CDN_CL": lambda: gsp.indices.condition_number(ends, 1.0),
        "σ_min": lambda: gsp.indices.minimum_singular_value(ends, 1.0),
        "d2": lambda: ends.joints[1],
    }[index]()
    assert at_greatest == pytest.approx(found.greatest, rel=1e-9)


def test_bounds_of_a_stroke_close():
    found = gsp.bounds(HEXAPOD, around(1.5, 0.2, 10.0), "d1", 1e-3)
    assert found.closed
    assert found.high - found.greatest <= 1e-3 * found.greatest
    assert found.least - found.low <= 1e-3 * found.least


def test_a_box_with_a_singular_pose_has_no_bound_of_the_condition():
    found = gsp.bounds(HEXAPOD, around(1.5, 0.5, 30.0), "CDN_CL", length=1.0, budget=3000)
    assert found.high == np.inf
    assert not found.closed


def test_bad_input_of_bounds():
    box = around(1.5, 0.1, 5.0)
    with pytest.raises(UnknownIndex, match="rigidity"):
        gsp.bounds(HEXAPOD, box, "rigidity_rate")
    with pytest.raises(MissingParameter, match="ellipsoid"):
        gsp.bounds(HEXAPOD, box, "CDN_OE")
    with pytest.raises(InvalidInput):
        gsp.bounds(HEXAPOD, box, 3)
    with pytest.raises(InvalidInput):
        gsp.bounds(HEXAPOD, box, "d1", 0.0)
    with pytest.raises(InvalidInput):
        gsp.bounds(HEXAPOD, UP, "d1")
    with pytest.raises(MissingParameter):
        gsp.bounds(HEXAPOD, box, "CDN_CL")


# --- distance to singular poses ---


def within(rng, pose, radius, scale, n):
    """Poses at most so far from a pose in the metric of `gsp.SingularityDistance`."""
    x = rng.standard_normal((n, 6))
    x *= radius * rng.random((n, 1)) ** (1 / 6) / np.linalg.norm(x, axis=1, keepdims=True)
    return gsp.Pose(pose.position + x[:, :3], turn(x[:, 3:] / scale) @ pose.rotation)


def test_the_bracket_of_the_hexapod():
    found = gsp.singularity_distance(HEXAPOD, UP, 1.0, budget=10_000)
    assert 0.2 < found.lower <= found.upper < 1.0
    values = HEXAPOD.at(found.nearest).singular_values(1.0)
    assert values[-1] < 1e-9 * values[0]
    step = found.nearest.position - UP.position
    angle = Rotation.from_matrix(found.nearest.rotation).magnitude()
    assert np.hypot(np.linalg.norm(step), angle) == pytest.approx(found.upper, rel=1e-9)
    rng = np.random.default_rng(0)
    sign = np.sign(np.linalg.det(HEXAPOD.at(UP).jacobian))
    free = within(rng, UP, float(found.lower), 1.0, 20_000)
    assert (np.sign(np.linalg.det(HEXAPOD.at(free).jacobian)) == sign).all()


def test_no_ball_reaches_a_singular_pose_that_is_known():
    """The singular pose is chosen first, the pose that is asked about then."""
    rng = np.random.default_rng(3)
    for i in range(count(6, 300)):
        kinds = [KINDS[i % len(KINDS)]] * 2 + ["D1"] * 4
        design, singular = singular_design(rng, kinds[: 6 if i % 6 < 5 else 5])
        away = 10.0 ** rng.uniform(-2, -0.5)
        here = within(rng, singular, away, 1.0, 1)[0]
        angle = Rotation.from_matrix(here.rotation @ singular.rotation.T).magnitude()
        exact = np.hypot(np.linalg.norm(here.position - singular.position), angle)
        found = gsp.singularity_distance(design, here, 1.0, budget=1500)
        assert found.lower <= exact * (1 + 1e-9)


def test_distances_of_a_batch_are_those_of_its_poses():
    pose = gsp.Pose([[0.0, 0.0, 1.5], [0.1, 0.0, 1.6]])
    found = gsp.singularity_distance(HEXAPOD, pose, 1.0, budget=2000)
    assert found.lower.shape == found.upper.shape == found.nearest.shape == (2,)
    one = gsp.singularity_distance(HEXAPOD, pose[1], 1.0, budget=2000)
    assert float(found.lower[1]) == float(one.lower)
    assert float(found.upper[1]) == float(one.upper)


def test_a_singular_pose_has_distance_zero():
    design, pose = singular_design(np.random.default_rng(5), ["D1"] * 6)
    found = gsp.singularity_distance(design, pose, 1.0, budget=2000)
    assert found.lower < 1e-9


def test_bad_input_of_distances():
    for arguments in ((None, UP, 1.0), (HEXAPOD, None, 1.0), (HEXAPOD, UP, 0.0)):
        with pytest.raises(InvalidInput):
            gsp.singularity_distance(*arguments)
    with pytest.raises(InvalidInput):
        gsp.singularity_distance(HEXAPOD, UP, 1.0, tolerance=1.0)


def test_no_pose_of_a_box_is_nearer_than_its_bound():
    rng = np.random.default_rng(2)
    start = np.array([0.1, 0.2, 1.5, 0.0, 0.0, 0.0])
    for _ in range(200):
        low = start + rng.uniform(-1.2, 1.2, 6)
        box = np.concatenate((low, low + rng.random(6) * rng.choice([0.01, 0.3])))
        points = box[:6] + rng.random((300, 6)) * (box[6:] - box[:6])
        angle = Rotation.from_euler("ZYX", points[:, 3:]).magnitude()
        exact = np.hypot(np.linalg.norm(points[:, :3] - start[:3], axis=1), 0.7 * angle)
        assert least_distances(box[None], start, 0.7)[0] <= exact.min() * (1 + 1e-12)


# --- largest boxes ---


def test_the_largest_box_is_proven_and_a_larger_one_is_not():
    wide = np.array([0.1, 0.1, 0.1, 0.05, 0.05, 0.05])
    found = gsp.largest_box(HEXAPOD, UP, wide, tolerance=0.1, budget=30_000)
    assert found.certificate.status == "proven"
    assert found.refuted.status in ("refuted", "undecided")
    assert found.factor < found.above <= 1.1 * found.factor
    np.testing.assert_allclose(
        found.box.high - found.box.low, 2.0 * found.factor * wide, atol=1e-12
    )
    line = gsp.largest_box(HEXAPOD, UP, [0, 0, 0, 0, 0, 1.0], budget=2000, tolerance=1e-3)
    turns = np.linspace(-line.factor, line.factor, 2001)[:, None] * [0.0, 0.0, 1.0]
    signs = np.sign(np.linalg.det(HEXAPOD.at(gsp.Pose([0, 0, 1.5], turn(turns))).jacobian))
    assert (signs == signs[0]).all()


def test_bad_input_of_largest_boxes():
    for wide in ([0.0] * 6, [-1.0] * 6, [1.0] * 5):
        with pytest.raises(InvalidInput):
            gsp.largest_box(HEXAPOD, UP, wide)
    with pytest.raises(InvalidInput):
        gsp.largest_box(HEXAPOD, UP.reshape(1), [1.0] * 6)


# --- paths ---


def on_path(poses, parameter):
    """Poses of a path: straight lines and slerp, by the definition."""
    i = min(int(parameter), len(poses) - 2)
    share = parameter - i
    vector = Rotation.from_matrix(poses[i + 1].rotation @ poses[i].rotation.T).as_rotvec()
    place = (1 - share) * poses[i].position + share * poses[i + 1].position
    return gsp.Pose(place, turn(share * vector) @ poses[i].rotation)


def path(yaw):
    angles = [[0, 0, 0], [10, 20, yaw], [0, 0, 0]]
    return gsp.Pose.from_rpy([[0, 0, 1.5], [0.3, 0.2, 1.7], [0, 0.1, 1.4]], angles, degrees=True)


def test_a_path_is_proven_and_one_that_turns_further_is_refuted_between_its_nodes():
    done = gsp.certify_path(HEXAPOD, path(60.0))
    assert done.status == "proven"
    assert done.proven.tolist() == [[0.0, 2.0]]
    far = gsp.certify_path(HEXAPOD, path(120.0))
    assert far.status == "refuted"
    one, other = (np.linalg.det(HEXAPOD.at(on_path(path(120.0), s)).jacobian) for s in far.bracket)
    assert one * other < 0.0
    values = HEXAPOD.at(far.counterexample).singular_values(1.0)
    assert values[-1] < 1e-8 * values[0]
    # Sampled poses of the proven intervals have one sign each.
    for low, high in far.proven:
        some = [on_path(path(120.0), s) for s in np.linspace(low, high, 50)]
        signs = {float(np.sign(np.linalg.det(HEXAPOD.at(p).jacobian))) for p in some}
        assert len(signs) == 1


def on_screw(poses, parameter):
    """Poses of a path of screws, by the matrix logarithm."""
    i = min(int(parameter), len(poses) - 2)
    ends = np.tile(np.eye(4), (2, 1, 1))
    ends[:, :3, :3], ends[:, :3, 3] = poses[i : i + 2].rotation, poses[i : i + 2].position
    generator = logm(ends[1] @ np.linalg.inv(ends[0])).real
    matrix = expm((parameter - i) * generator) @ ends[0]
    return gsp.Pose(matrix[:3, 3], matrix[:3, :3])


def test_screws_are_proven_where_they_are_and_not_where_straight_lines_are():
    """The position on the screw leaves the straight line, and the interval that is allowed."""
    nodes = gsp.Pose.from_rpy([[0.4, 0, 1.5], [-0.4, 0, 1.5]], [[0, 0, 0], [0, 0, 1.2]])
    dense = [on_screw(nodes, s) for s in np.linspace(0.0, 1.0, 201)]
    places = np.array([pose.position for pose in dense])
    assert np.abs(places[:, 1]).max() > 0.1
    edge = np.stack((places.min(axis=0), places.max(axis=0)), axis=1)
    wide, tight = edge + [-1e-3, 1e-3], edge + [-1.0, 1.0]
    tight[1] = edge[1] * 0.9
    given = {"regular": False, "motion": "screw"}
    assert gsp.certify_path(HEXAPOD, nodes, gsp.Limits(position=wide), **given).status == "proven"
    done = gsp.certify_path(HEXAPOD, nodes, gsp.Limits(position=tight), **given)
    assert done.status == "refuted"
    exact = on_screw(nodes, done.bracket[0])
    np.testing.assert_allclose(done.counterexample.position, exact.position, atol=1e-12)
    np.testing.assert_allclose(done.counterexample.rotation, exact.rotation, atol=1e-12)
    most = np.array([HEXAPOD.at(pose).joints for pose in dense]).max(axis=0)
    for margin, status in ((1e-3, "proven"), (-1e-3, "refuted")):
        strokes = np.stack((np.full(6, np.nan), most + margin), axis=1)
        done = gsp.certify_path(HEXAPOD, nodes, gsp.Limits(strokes=strokes), motion="screw")
        assert done.status == status


@pytest.mark.parametrize("angle", [0.0, 1e-17, 1e-16, 1e-15, 1e-12, 1e-9, 1e-8, 1e-6, 1e-3, 3.0])
def test_screws_of_small_turns_are_decided(angle):
    """The exact screw is computed with 50 digits from its axis, which is far away."""
    with mpmath.workdps(50):
        start, end = (mpmath.matrix(x) for x in ([0.25, 0.5, 1.5], [0.75, 0.25, 1.75]))
        step, half = end - start, mpmath.mpf(angle) / 2

        def position(share):
            if angle == 0.0:
                return start + share * step
            cot = mpmath.cot(half)
            x, y = -(step[0] - cot * step[1]) / 2, -(step[1] + cot * step[0]) / 2
            c, s = mpmath.cos(2 * half * share) - 1, mpmath.sin(2 * half * share)
            moved = mpmath.matrix([c * x - s * y, s * x + c * y, share * step[2]])
            return start + moved

        assert mpmath.norm(position(1) - end) < 1e-30
        most = max(position(mpmath.mpf(i) / 1000)[0] for i in range(1001))
        rotations = [np.eye(3), np.array(gsp.Pose.from_rpy([0, 0, 0], [0, 0, angle]).rotation)]
        nodes = gsp.Pose(np.array([list(start), list(end)], dtype=float), rotations)
        for excess, status in ((1e-5, "proven"), (-1e-5, "refuted")):
            limits = gsp.Limits(position=[(np.nan, float(most) + excess), None, None])
            done = gsp.certify_path(HEXAPOD, nodes, limits, motion="screw", regular=False)
            assert done.status == status
        exact = np.array(list(position(mpmath.mpf(done.bracket[0]))), dtype=float)
        np.testing.assert_allclose(done.counterexample.position, exact, rtol=0.0, atol=1e-14)


def test_rotations_equal_to_rounding_give_no_refutation():
    """One rotation found in two ways: what a straight path satisfies, the screw does."""
    rng, unequal = np.random.default_rng(0), 0
    for _ in range(8):
        one, other = turn(rng.uniform(-0.1, 0.1, 3)), turn(np.array([0.1, 0.2, 0.3]))
        same = other @ (other.T @ one)
        unequal += not (same == one).all()
        nodes = gsp.Pose([[0.0, 0.0, 1.5], [0.2, 0.1, 1.6]], [one, same])
        limits = gsp.Limits(position=[(-0.01, 0.21), (-0.01, 0.11), (1.49, 1.61)])
        done = gsp.certify_path(HEXAPOD, nodes, limits, motion="screw", budget=3000)
        assert done.status == "proven"
    assert unequal


def test_violations_smaller_than_the_rounding_of_the_path_are_undecided():
    """The whole path is out of its bound by one unit of rounding of a far larger coordinate."""
    nodes = gsp.Pose([[0.0, 2.0**20, 1.5], [0.0, 2.0**20, 1.6]], np.eye(3))
    for excess, status in ((1e-12, "undecided"), (1e-3, "refuted")):
        limits = gsp.Limits(position=[(excess, np.nan), None, None])
        done = gsp.certify_path(HEXAPOD, nodes, limits, regular=False, budget=500)
        assert done.status == status


def test_limits_are_held_between_the_nodes():
    rng = np.random.default_rng(4)
    for kind in KINDS:
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        poses = random_pose(rng, (3,))
        dense = [on_path(poses, s) for s in np.linspace(0.0, 2.0, 401)]
        most = np.array([design.at(p).joints for p in dense]).max(axis=0)
        for margin, statuses in (
            (0.01, {"proven", "undecided"}),
            (-1e-3, {"refuted", "undecided"}),
        ):
            strokes = np.stack((np.full(len(most), np.nan), most + margin), axis=1)
            limits = gsp.Limits(strokes=strokes)
            done = gsp.certify_path(design, poses, limits, regular=False)
            assert done.status in statuses, kind
            if done.status == "refuted":
                assert not gsp.feasible(design, on_path(poses, done.bracket[0]), limits)


def test_bad_input_of_paths():
    with pytest.raises(InvalidInput):
        gsp.certify_path(HEXAPOD, UP)
    with pytest.raises(InvalidInput, match="screw"):
        gsp.certify_path(HEXAPOD, path(10.0), motion="spline")
    with pytest.raises(InvalidInput):
        gsp.certify_path(HEXAPOD, UP.reshape(1))
    half_turn = gsp.Pose([[0, 0, 1.5]] * 2, [np.eye(3), np.diag([1.0, -1.0, -1.0])])
    with pytest.raises(InvalidInput, match="π"):
        gsp.certify_path(HEXAPOD, half_turn)
