"""Proofs along paths: requirements over poses, speeds and accelerations."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import expm, logm
from scipy.spatial.transform import Rotation, RotationSpline

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.proof.paths.charts import enclosed
from gsp.proof.paths.pieces import pieces_of_path
from gsp.proof.paths.rates import Rates
from gsp.proof.paths.series import Series
from tests.campaign import count
from tests.proof.proofs import KINDS, hexapod
from tests.support import random_design, random_pose, turn

HEXAPOD = hexapod()
UP = gsp.Pose([0.0, 0.0, 1.5])


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
        gsp.certify_path(HEXAPOD, path(10.0), motion="arc")
    with pytest.raises(InvalidInput):
        gsp.certify_path(HEXAPOD, UP.reshape(1))
    half_turn = gsp.Pose([[0, 0, 1.5]] * 2, [np.eye(3), np.diag([1.0, -1.0, -1.0])])
    with pytest.raises(InvalidInput, match="π"):
        gsp.certify_path(HEXAPOD, half_turn)


# --- splines, speeds and accelerations ---


def joints(design, position, rotation):
    """Joint values by the definitions, (n_joints, n), and signed distances of D4."""
    values = []
    for leg, a, b, s, t in zip(
        design.legs, design.base_points, design.platform_points, design.base_directions,
        design.platform_directions, strict=True,
    ):  # fmt: skip
        d, line = position + rotation @ b - a, rotation @ t
        normal = np.cross(line, s)
        sine = np.linalg.norm(normal, axis=-1)
        for constraint in leg.constraints:
            values.append({
                "D1": np.linalg.norm(d, axis=-1),
                "D2": np.linalg.norm(np.cross(d, line), axis=-1),
                "D3": np.linalg.norm(np.cross(d, s), axis=-1),
                "D4": (d * normal).sum(axis=-1) / sine,
                "A1": np.arctan2(sine, line @ s),
            }[constraint.name])  # fmt: skip
    return np.array(values)


def rates(function, t, h):
    """First and second central differences, of fourth order."""
    near, far = [function(t + k * h) for k in (-1, 1)], [function(t + 2 * k * h) for k in (-1, 1)]
    first = (8.0 * (near[1] - near[0]) - (far[1] - far[0])) / (12.0 * h)
    second = (16.0 * (near[0] + near[1]) - (far[0] + far[1]) - 30.0 * function(t)) / (12.0 * h**2)
    return first, second


def splines(rng, n):
    """Nodes, times, and the splines of scipy through them."""
    nodes, times = random_pose(rng, (n,)), np.cumsum(rng.uniform(0.3, 2.0, n))
    turns = RotationSpline(times, Rotation.from_matrix(nodes.rotation))
    return nodes, times, CubicSpline(times, nodes.position), turns


def test_paths_of_splines_are_those_of_scipy():
    nodes, times, places, turns = splines(np.random.default_rng(0), 5)
    path = gsp.PosePath.through(nodes, times)
    t = np.linspace(times[0], times[-1], 57)
    pose = path.pose(t)
    np.testing.assert_allclose(pose.position, places(t), atol=1e-14)
    np.testing.assert_allclose(pose.rotation, turns(t).as_matrix(), atol=1e-14)
    same = gsp.PosePath.of_splines(places, turns)
    np.testing.assert_allclose(same.turn, path.turn, atol=1e-12)
    np.testing.assert_allclose(path.pose(times).position, nodes.position, atol=1e-14)
    assert len(path) == 4


@pytest.mark.parametrize("unit", [1e-40, 1e-20, 1e-6, 1e20])
def test_splines_do_not_depend_on_the_unit_of_time(unit):
    nodes, times, _, _ = splines(np.random.default_rng(0), 5)
    t = np.linspace(times[0], times[-1], 57)
    one, other = gsp.PosePath.through(nodes, times), gsp.PosePath.through(nodes, unit * times)
    np.testing.assert_allclose(other.pose(unit * t).position, one.pose(t).position, atol=1e-12)
    np.testing.assert_allclose(other.pose(unit * t).rotation, one.pose(t).rotation, atol=1e-12)


@pytest.mark.parametrize("unit", [1e-200, 1e-60, 1e60, 1e200])
def test_times_whose_powers_overflow_are_refused(unit):
    nodes, times, _, _ = splines(np.random.default_rng(0), 5)
    with pytest.raises(InvalidInput, match="times: expected steps between"):
        gsp.PosePath.through(nodes, unit * times)


@pytest.mark.parametrize("kind", KINDS)
def test_bounds_of_rates_hold_for_differences_and_are_near_to_them(kind):
    """In every interval, at its worst points, for splines of random poses."""
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(count(2, 40)):
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        _, times, places, turns = splines(rng, 4)

        def values(t, design=design, places=places, turns=turns):
            return joints(design, places(t), turns(t).as_matrix())

        bound = Rates.of(design, 1.0, 1.0, None) if kind not in ("A1", "D4 A1") else None
        if bound is None:
            bound = Rates.of(design, np.ones(len(design.joint_names)), None, None)
        pieces = pieces_of_path(gsp.PosePath.of_splines(places, turns))
        h, share = 1e-3, np.linspace(0.0, 1.0, 41)
        for width in (0.1, 1e-3):
            middle = rng.uniform(0.1, 0.9, 12)
            piece = rng.integers(0, 3, 12)
            found = bound.bounds(pieces, piece, middle, np.full(12, 0.5 * width))
            for i in range(12):
                start, span = times[piece[i]], pieces.span[piece[i]]
                t = start + span * (middle[i] + width * (share - 0.5))
                here = values(t)
                smooth = (np.sign(here) == np.sign(here[:, :1])).all(axis=1)
                smooth &= np.abs(here).min(axis=1) > 1e-2
                for order, exact in enumerate(rates(values, t, h * span)):
                    exact = exact * np.sign(here)
                    low, high = found[order, :, i, 0, None], found[order, :, i, 1, None]
                    noise = (1e-8, 1e-5)[order] * (1.0 + np.abs(exact))
                    inside = (low <= exact + noise) & (exact - noise <= high)
                    assert inside[smooth].all()
                    if width == 1e-3:
                        size = np.abs(exact).max(axis=1) + 1.0
                        over = (high - low)[:, 0] - np.ptp(exact, axis=1)
                        assert (over[smooth] < 0.1 * size[smooth]).all()


def test_speeds_and_accelerations_are_bounded_between_the_nodes():
    rng = np.random.default_rng(8)
    for kind in ("D1", "D2", "D3", "A1"):
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        nodes, times, places, turns = splines(rng, 3)
        t = np.linspace(times[0] + 1e-2, times[-1] - 1e-2, 2001)

        def values_at(t, design=design, places=places, turns=turns):
            return joints(design, places(t), turns(t).as_matrix())

        found = rates(values_at, t, 1e-3)
        for name, values in zip(("speeds", "accelerations"), found, strict=True):
            most = np.abs(values).max(axis=1)
            for factor, status in ((1.1, "proven"), (0.95, "refuted")):
                given = {"times": times, "motion": "spline", "regular": False}
                done = gsp.certify_path(design, nodes, **given, **{name: factor * most})
                # At the ends, which the differences leave out, accelerations may be greater.
                assert done.status == status or (factor > 1.0 and done.bracket[0] not in t)
                for low, high in done.violated:
                    some = (t > low) & (t < high)
                    assert (np.abs(values[:, some]) > 0.94 * most[:, None]).any(axis=0).all()
                if done.status == "refuted":
                    assert name[:-1] in done.reason
                    assert times[0] <= done.bracket[0] == done.bracket[1] <= times[-1]


def test_a_line_at_constant_speed_has_the_speeds_of_the_legs():
    """A leg that is pulled along itself: its speed is that of the platform."""
    nodes, times = gsp.Pose([[0, 0, 1.0], [0, 0, 3.0]]), [10.0, 12.0]
    base = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [2, 0, 0], [0, 2, 0.0]])
    design = gsp.Design(["D1"] * 6, base, 0.5 * base)
    most = np.full(6, np.nan)
    for speed, status in ((1.0 + 1e-9, "proven"), (1.0 - 1e-9, "refuted")):
        most[0] = speed
        done = gsp.certify_path(design, nodes, times=times, speeds=most, regular=False)
        assert done.status == status
    assert done.violated.tolist() == [[10.0, 12.0]]
    assert "speed of d1" in done.reason


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_speeds_of_common_normals_are_bounded_where_lines_meet(sense):
    """The distance |z| of two skew lines has the speed 1 on both sides, and a corner between."""
    s, t = np.tile([1.0, 0, 0], (6, 1)), np.tile([0.0, 1, 0], (6, 1))
    design = gsp.Design(["D4"] * 6, np.zeros((6, 3)), np.zeros((6, 3)), s, t)
    nodes = gsp.Pose([[0, 0, -1.0 * sense], [0, 0, 1.0 * sense]])
    given = {"times": [0, 2], "regular": False}
    assert gsp.certify_path(design, nodes, speeds=1.001, **given).status == "proven"
    assert gsp.certify_path(design, nodes, speeds=0.999, **given).status == "refuted"
    done = gsp.certify_path(design, nodes, accelerations=0.5, **given, budget=2000)
    assert done.status == "undecided"
    (_, low), (high, _) = done.proven
    assert low <= 1.0 <= high < low + 1e-6


def test_copies_within_tolerances_keep_their_speeds():
    nodes, times, places, turns = splines(np.random.default_rng(3), 3)
    off = 0.01
    t = np.linspace(times[0], times[-1], 400)
    most = 0.0
    rng = np.random.default_rng(0)
    for _ in range(20):
        step = rng.standard_normal((2, 6, 3))
        step *= off / np.linalg.norm(step, axis=2, keepdims=True)
        copy = HEXAPOD.replace(
            base_points=HEXAPOD.base_points + step[0],
            platform_points=HEXAPOD.platform_points + step[1],
        )
        speed, _ = rates(lambda t, d=copy: joints(d, places(t), turns(t).as_matrix()), t, 1e-4)
        most = max(most, np.abs(speed).max())
    wide = gsp.Tolerances(base_points=off, platform_points=off)
    given = {"times": times, "motion": "spline", "regular": False, "tolerances": wide}
    assert gsp.certify_path(HEXAPOD, nodes, speeds=0.999 * most, **given).status != "proven"
    assert gsp.certify_path(HEXAPOD, nodes, speeds=0.5 * most, **given).status == "refuted"
    assert gsp.certify_path(HEXAPOD, nodes, speeds=1.3 * most, **given).status == "proven"


def test_splines_are_proven_and_refuted_between_their_nodes():
    """The spline overshoots its nodes: limits that hold at all of these are violated."""
    nodes = gsp.Pose([[0, 0, 1.5], [0.3, 0, 1.5], [0.3, 0, 1.6], [0, 0, 1.5]])
    path = gsp.PosePath.through(nodes)
    t = np.linspace(0.0, 3.0, 20_001)
    reached = path.pose(t).position[:, 0].max()
    assert reached > 0.32
    for excess, status in ((1e-5, "proven"), (-1e-5, "refuted")):
        limits = gsp.Limits(position=[(np.nan, reached + excess), None, None])
        for poses, given in ((nodes, {"motion": "spline"}), (path, {})):
            done = gsp.certify_path(HEXAPOD, poses, limits, regular=False, **given)
            assert done.status == status
            for low, high in done.violated:
                assert (path.pose(np.linspace(low, high, 9)).position[:, 0] > reached - 1e-4).all()
    far = gsp.PosePath([0, 1], [[[0, 0, 1.5]]], [[[0, 0, 0], [0, 0, 2.4]]])
    done = gsp.certify_path(HEXAPOD, far)
    assert done.status == "refuted"
    one, other = (np.linalg.det(HEXAPOD.at(far.pose(s)).jacobian) for s in done.bracket)
    assert one * other < 0.0


def test_accelerations_of_paths_with_corners_are_refused():
    given = {"times": [0, 1, 3], "accelerations": 1.0}
    with pytest.raises(InvalidInput, match="node 1"):
        gsp.certify_path(HEXAPOD, path(10.0), **given)
    with pytest.raises(InvalidInput, match="node 1"):
        gsp.certify_path(HEXAPOD, path(10.0), motion="screw", **given)
    straight = gsp.Pose([[0, 0, 1.5], [0.1, 0, 1.5], [0.3, 0, 1.5]])
    assert gsp.certify_path(HEXAPOD, straight, **given).status == "proven"


def test_bad_input_of_rates_and_splines():
    nodes = path(10.0)
    with pytest.raises(MissingParameter, match="times"):
        gsp.certify_path(HEXAPOD, nodes, speeds=1.0)
    for times in ([0, 1], [0, 1, 1], [0, 2, 1], "abc"):
        with pytest.raises(InvalidInput, match="times"):
            gsp.certify_path(HEXAPOD, nodes, times=times)
    for speeds in (0.0, -1.0, [1.0, 2.0], "fast"):
        with pytest.raises(InvalidInput, match="speeds"):
            gsp.certify_path(HEXAPOD, nodes, times=[0, 1, 2], speeds=speeds)
    mixed = random_design(np.random.default_rng(0), ["A1"] * 2 + ["D1"] * 4)
    with pytest.raises(InvalidInput, match="one for each joint"):
        gsp.certify_path(mixed, nodes, times=[0, 1, 2], speeds=1.0)
    with pytest.raises(InvalidInput, match="PosePath"):
        gsp.certify_path(HEXAPOD, gsp.PosePath.through(nodes), times=[0, 1, 2])
    for motion in ("straight", "screw", "spline", "arc"):
        with pytest.raises(InvalidInput, match="motion: expected none with a PosePath"):
            gsp.certify_path(HEXAPOD, gsp.PosePath.through(nodes), motion=motion)
    with pytest.raises(InvalidInput, match="meet"):
        gsp.PosePath([0, 1, 2], [[[0, 0, 1.0], [1, 0, 0]]] * 2, [[[0, 0, 0]]] * 2)
    with pytest.raises(InvalidInput, match="meet"):
        gsp.PosePath([0, 1, 2], [[[0, 0, 1.0]]] * 2, [[[0, 0, 0], [0, 0, 1.0]]] * 2)
    with pytest.raises(InvalidInput, match="PPoly"):
        gsp.PosePath.of_splines(None, None)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_gaps_and_corners_beyond_rounding_are_found_in_any_unit_of_time(unit):
    """Two pieces with the velocity 1 and 1 + jump, and a gap between them."""
    times, none = [0.0, unit, 2.0 * unit], [[[0, 0, 0]]] * 2

    def joined(gap, jump):
        steps = [
            [[0, 0, 1.5], [1.0 / unit, 0, 0]],
            [[1.0 + gap, 0, 1.5], [(1.0 + jump) / unit, 0, 0]],
        ]
        return gsp.PosePath(times, steps, none)

    joined(5e-10, 0.0)
    with pytest.raises(InvalidInput, match="meet"):
        joined(3e-9, 0.0)
    most = {"accelerations": 10.0 / unit**2, "regular": False}
    assert gsp.certify_path(HEXAPOD, joined(0.0, 5e-7), **most).status == "proven"
    with pytest.raises(InvalidInput, match="corner"):
        gsp.certify_path(HEXAPOD, joined(0.0, 2e-6), **most)


# --- series ---


def test_series_hold_the_coefficients_of_functions_at_all_points_of_balls():
    """Random compositions, with 40 digits."""
    rng = np.random.default_rng(0)

    def function(x, root, atan2, sinc):
        y = x * x + 1.5
        z = root(y) - 0.3 * x
        return sinc(y * y) / z + atan2(z, x - 0.4) * y

    def sinc(x):
        return mpmath.sin(mpmath.sqrt(x)) / mpmath.sqrt(x)

    for _ in range(count(6, 200)):
        middle, radius = rng.uniform(-1.0, 1.0), 10.0 ** rng.uniform(-12, -1)
        u = Series.variable(np.array([middle]), np.array([radius]), 4)
        found = function(u, Series.sqrt, Series.atan2, lambda x: x.turning(1))
        for share in (-1.0, 1.0, float(rng.uniform(-1.0, 1.0))):
            with mpmath.workdps(40):
                x = mpmath.mpf(middle) + mpmath.mpf(radius) * share
                exact = mpmath.taylor(lambda x: function(x, mpmath.sqrt, mpmath.atan2, sinc), x, 3)
                for k in range(4):
                    assert abs(exact[k] - found.mid[k, 0]) <= found.rad[k, 0]
        assert found.rad[0, 0] < 100.0 * radius + 1e-11


@pytest.mark.parametrize("start", [1, 2, 3])
def test_functions_of_angles_are_bounded_up_to_several_turns(start):
    def exact(x):
        angle = mpmath.sqrt(x)
        return {
            1: lambda: mpmath.sin(angle) / angle,
            2: lambda: (1 - mpmath.cos(angle)) / x,
            3: lambda: (angle - mpmath.sin(angle)) / (x * angle),
        }[start]()

    for value in (1e-12, 0.01, 1.0, 9.0, 30.0, 44.9, 46.0, 300.0):
        for radius in (0.0, 1e-3 * value):
            found = Series.variable(np.array([value]), np.array([radius]), 4).turning(start)
            with mpmath.workdps(60):
                for x in (value - radius, value + radius):
                    series = mpmath.taylor(exact, mpmath.mpf(x), 3)
                    for k in range(4):
                        assert abs(series[k] - found.mid[k, 0]) <= found.rad[k, 0]


def test_the_form_of_taylor_holds_between_the_ends():
    middle, half = np.array([0.3]), np.array([0.2])
    u = Series.variable(np.tile(middle, 2), np.concatenate((np.zeros(1), half)), 4)
    low, high = enclosed((u * u * u - u).derivative(), half)
    x = np.linspace(0.1, 0.5, 100)
    exact = 3.0 * x**2 - 1.0
    assert low <= exact.min() <= exact.max() <= high
    assert high - low < 1.5 * np.ptp(exact)
