"""Bounds over boxes, distances to singular poses, and largest boxes."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp.errors import InvalidInput, MissingParameter, UnknownIndex
from gsp.proof.branching import search
from gsp.proof.distance import least_distances
from gsp.proof.extremes import _best
from gsp.variation.layout import MID_HIGH, MID_LOW
from tests.campaign import count
from tests.proof.proofs import KINDS, around, hexapod, poses_in, singular_design
from tests.support import moved, random_design, turn

HEXAPOD = hexapod()
UP = gsp.Pose([0.0, 0.0, 1.5])


# --- bounds ---


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_best_centre_is_the_best_of_those_that_count_and_few_are_decided(side):
    rng = np.random.default_rng(7)
    for share in (0.0, 0.002, 0.3):
        boxes, quantity = rng.normal(size=(2000, 12)), rng.normal(size=(2000, 10))
        quantity[::9] = np.nan
        quantity[:, MID_HIGH] = quantity[:, MID_LOW]
        centres = 0.5 * (boxes[:, :6] + boxes[:, 6:])
        hits = rng.random(2000) < share
        decided = []

        def counts(points, centres=centres, hits=hits, decided=decided):
            numbers = [int(np.flatnonzero((centres == p).all(axis=1))[0]) for p in points]
            decided.extend(numbers)
            return hits[numbers]

        value, point = _best(quantity, boxes, side, 0.5, boxes[0, :6], counts)
        values = side * quantity[:, MID_LOW]
        allowed = np.flatnonzero(hits & (values > 0.5))
        if not allowed.size:
            assert (value, list(point)) == (0.5, list(boxes[0, :6]))
            continue
        best = allowed[values[allowed].argmax()]
        assert value == values[best]
        np.testing.assert_array_equal(point, centres[best])
        assert len(decided) <= max(32, 4 * (values > value).sum())


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


@pytest.mark.parametrize("index", ["d2", "CDN_CL", "σ_min", "|det J|"])
def test_bounds_close_to_each_tolerance_and_become_narrower(index):
    box = gsp.PoseBox([(0.0, 0.1), (0.0, 0.1), (1.45, 1.5)], [(0.0, 0.05)] * 3)
    before = None
    for tolerance in (0.3, 0.1, 0.05):
        found = gsp.bounds(HEXAPOD, box, index, tolerance, length=1.0)
        assert found.closed
        assert found.high - found.greatest <= tolerance * found.high
        assert found.least - found.low <= tolerance * found.least
        # What occurs by one search is within the bounds of every other.
        if before is not None:
            assert before.low <= found.low <= before.least
            assert before.greatest <= found.high <= before.high
            assert found.n_boxes >= before.n_boxes
        before = found


def test_a_box_with_a_singular_pose_has_no_bound_of_the_condition():
    found = gsp.bounds(HEXAPOD, around(1.5, 0.5, 30.0), "CDN_CL", length=1.0, budget=3000)
    assert found.high == np.inf
    assert not found.closed


@pytest.mark.parametrize("index", ["CTN", "|det J|"])
def test_a_length_that_the_index_does_not_need_has_no_effect(index):
    """Before, the bracket became as wide as the range of CTN with a length unlike the design's."""
    box = around(1.5, 0.01, 1.0)
    low, high = gsp.bounds(hexapod(), box, index)
    for length in (0.01, 100.0):
        assert gsp.bounds(hexapod(), box, index, length=length) == (low, high)
        needed = [gsp.bounds(hexapod(), box, "σ_min", length=x)[0] for x in (1.0, length)]
        assert needed[0] != needed[1]


def test_an_index_without_bounds_is_named_before_its_parameters():
    for text in ("SD >= 1", "LCI >= 0.1"):
        with pytest.raises(InvalidInput, match=r"limits\.indices: expected one of"):
            gsp.certify(hexapod(), around(1.5, 0.01, 1.0), gsp.Limits(indices=[text]))


def test_bad_input_of_bounds():
    box = around(1.5, 0.1, 5.0)
    with pytest.raises(UnknownIndex, match="rigidity"):
        gsp.bounds(HEXAPOD, box, "rigidity_rate")
    # Legs from one point have no distances, and no other quantity takes their places.
    one_point = HEXAPOD.replace(base_points=np.zeros((6, 3)))
    for name in ("x", "base cone 1"):
        with pytest.raises(UnknownIndex):
            gsp.bounds(one_point, box, name)
    with pytest.raises(MissingParameter, match="ellipsoid"):
        gsp.bounds(HEXAPOD, box, "CDN_OE")
    with pytest.raises(InvalidInput):
        gsp.bounds(HEXAPOD, box, 3)
    for name in ("theta1", "", "clearance 1-9"):
        with pytest.raises(UnknownIndex, match=r"CTN, λ, or their names; d1, .*d6; or a clearance"):
            gsp.bounds(HEXAPOD, box, name)
    with pytest.raises(UnknownIndex, match=r"index with bounds.*Known: .* λ, or their names$"):
        gsp.proof.worst(HEXAPOD, box, "d1")
    # An angle that differs from the limit in its last digits.
    wide = gsp.PoseBox([0, 0, 1], [(0, np.nextafter(2 * np.pi, 7)), 0, 0])
    with pytest.raises(InvalidInput, match=r"received 6\.283185307179587 rad, and 2π is 6\.283"):
        gsp.bounds(HEXAPOD, wide, "d1")
    with pytest.raises(InvalidInput):
        gsp.bounds(HEXAPOD, box, "d1", 0.0)
    with pytest.raises(InvalidInput):
        gsp.bounds(HEXAPOD, UP, "d1")
    with pytest.raises(MissingParameter):
        gsp.bounds(HEXAPOD, box, "CDN_CL")


def test_bounds_are_a_pair_that_cannot_be_changed():
    found = gsp.bounds(HEXAPOD, around(1.5, 0.1, 5.0), "clearance 2-1", budget=3)
    again = pickle.loads(pickle.dumps(found))
    assert again == found == (found.low, found.high)
    for name in ("least", "greatest", "closed", "n_boxes"):
        assert getattr(again, name) == getattr(found, name)
    assert found == gsp.bounds(HEXAPOD, around(1.5, 0.1, 5.0), "clearance 1-2", budget=3)
    with pytest.raises(AttributeError):
        found.least = 1.0


# --- distance to singular poses ---


def within(rng, pose, radius, scale, n):
    """Poses at most so far from a pose in the metric of `gsp.singularity_distance`."""
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
    # Along the free motion the joints are constant to second order.
    ways = [moved(found.nearest, found.free_motion, step) for step in (-1e-4, 1e-4)]
    change = np.subtract(*(HEXAPOD.at(pose).joints for pose in ways))
    shift = np.linalg.norm(ways[1].position - ways[0].position)
    turned = Rotation.from_matrix(ways[1].rotation @ ways[0].rotation.T).magnitude()
    assert np.abs(change).max() < 1e-6 * (shift + turned)
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
    assert found.free_motion.shape == (2, 6)
    one = gsp.singularity_distance(HEXAPOD, pose[1], 1.0, budget=2000)
    assert float(found.lower[1]) == float(one.lower)
    assert float(found.upper[1]) == float(one.upper)


def test_a_regular_pose_is_not_called_singular_for_an_origin_far_away():
    design = HEXAPOD.with_origin([1e4, 0.0, 0.0])
    here = UP.compose(gsp.Pose([1e4, 0.0, 0.0]))
    assert not design.at(here).singular()
    found = gsp.singularity_distance(design, here, 1.0, budget=2000)
    assert found.lower < found.upper
    # Both sides of a change of sign: the determinant nearly vanishes there, about the centre.
    values = HEXAPOD.at(found.nearest.compose(gsp.Pose([-1e4, 0.0, 0.0]))).singular_values(1.0)
    assert values[-1] < 1e-6 * values[0]


def test_without_a_change_of_sign_there_is_no_nearest_pose_and_no_motion():
    """det J of seven legs is not defined."""
    design = random_design(np.random.default_rng(8), ["D1"] * 7)
    found = gsp.singularity_distance(design, UP, 1.0, budget=100)
    assert np.isinf(found.upper)
    assert np.isnan(found.nearest.position).all()
    assert np.isnan(found.free_motion).all()


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


def test_an_interrupt_ends_the_search_for_the_largest_box(monkeypatch):
    """An interrupted proof is no verdict on its box."""
    run, proofs = search._search, []

    def stop(*words, **names):
        proofs.append(1)
        if len(proofs) == 2:
            raise KeyboardInterrupt
        return run(*words, **names)

    monkeypatch.setattr(search, "_search", stop)
    with pytest.raises(KeyboardInterrupt):
        gsp.largest_box(HEXAPOD, UP, [0, 0, 0, 0, 0, 1.0], budget=2000, workers=1)
    assert len(proofs) == 2


def test_bad_input_of_largest_boxes():
    for wide in ([0.0] * 6, [-1.0] * 6, [1.0] * 5):
        with pytest.raises(InvalidInput):
            gsp.largest_box(HEXAPOD, UP, wide)
    with pytest.raises(InvalidInput):
        gsp.largest_box(HEXAPOD, UP.reshape(1), [1.0] * 6)


def test_bounds_that_stay_open_at_a_single_pose():
    """No coordinate can be halved, and the platform origin is too far away for finite bounds."""
    far = gsp.catalogue.design("toz-kucuk-2016-d3-6").with_origin(1e7 * np.ones(3))
    found = gsp.bounds(far, gsp.PoseBox.around(far.home, np.zeros(6)), "CTN", length=95.0)
    value = float(gsp.indices.control_number(far.at(far.home), 95.0))
    assert found.low <= value <= found.high
    assert not found.closed


# --- poses without a value ---


def meeting(kind):
    """A design whose first leg has the length 0 at position (0, 0, 1)."""
    base = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.3, -1, 0], [-1, 0.5, 0]])
    arms = 0.5 * base
    arms[0] = 0.0
    lines = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [1, 1, 0], [1, -1, 0.2], [0, 1, 0.3]])
    return gsp.Design([kind] * 6, base.astype(float), arms, lines, lines[::-1])


@pytest.mark.parametrize("kind", ["D1", "D2", "D3"])
@pytest.mark.parametrize("index", ["CDN_CL", "σ_min", "CTN", "|det J|"])
def test_ends_are_values_that_occur_beside_undefined_poses(kind, index):
    design, box = meeting(kind), gsp.PoseBox([(-0.2, 0.2), (-0.2, 0.2), (0.8, 1.2)], [0, 0, 0])
    found = gsp.bounds(design, box, index, length=1.0, budget=2000)
    assert found.low <= found.least <= found.greatest <= found.high
    assert found.n_boxes <= 4000
    for value, pose in (
        (found.least, found.least_pose),
        (found.greatest, found.greatest_pose),
    ):
        table = gsp.evaluate(design, pose, index, length=1.0, progress=False)
        assert value == pytest.approx(table.iloc[0, -1], rel=1e-3, abs=1e-12)
    worst = gsp.proof.worst(design, box, index, length=1.0, budget=2000).iloc[0]
    better = found.greatest if index == "CDN_CL" else found.least
    assert better in (worst["low"], worst["high"])


def test_without_a_defined_pose_no_value_occurs():
    point = gsp.PoseBox([0.0, 0.0, 1.0], [0, 0, 0])
    found = gsp.bounds(meeting("D1"), point, "σ_min", length=1.0)
    assert tuple(found) == (0.0, np.inf)
    assert np.isnan([found.least, found.greatest]).all()
    assert not found.closed
    worst = gsp.proof.worst(meeting("D1"), point, "σ_min", length=1.0).iloc[0]
    assert worst["low"] == 0.0
    assert np.isnan(worst["high"])
