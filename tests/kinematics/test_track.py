"""Tracking returns the path that made the joint values, or stops with a reason."""

from itertools import pairwise

import numpy as np
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.geometry.vectors import norm

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
ANGLE = np.deg2rad
HEXAPOD = gsp.Design(
    ["D1"] * 6,
    *(
        radius * np.stack((np.cos(a), np.sin(a), 0 * a), axis=1)
        for radius, a in (
            (1.0, ANGLE([-10.0, 10, 110, 130, 230, 250])),
            (0.6, ANGLE([-50.0, 50, 70, 170, 190, 290])),
        )
    ),
)
HOME = gsp.Pose([0, 0, 1])


def loop(number, size=0.2):
    t = np.linspace(0, 2 * np.pi, number)
    rates = np.array([1, 2, 3, 1, 2, 3])
    return HOME.moved(size * (np.sin(t[:, None] * rates + rates) - np.sin(rates)))


@pytest.mark.parametrize("number", [60, 1000])
def test_a_loop_is_followed_and_closed(number):
    path = loop(number)
    found = gsp.track(HEXAPOD, HEXAPOD.at(path).joints, HOME)
    assert found.status == "complete"
    assert found.complete
    assert found.reached == number
    np.testing.assert_allclose(found.pose.position, path.position, rtol=0, atol=1e-10)
    np.testing.assert_allclose(found.pose.rotation, path.rotation, rtol=0, atol=1e-10)
    assert found.residual.max() <= 1e-12
    smallest = HEXAPOD.at(path).singular_values(HEXAPOD.rms_radius)[:, -1]
    assert (found.margin <= smallest * (1 + 1e-9)).all()
    assert (found.margin >= smallest / np.sqrt(6) * (1 - 1e-9)).all()


@pytest.mark.parametrize("number", [3, 77, 160])
def test_mixed_legs_are_followed_in_their_unit(number):
    design = instantiate(mechanisms()[number], TEMPLATE)
    t = np.linspace(0, 1, 200)[:, None]
    path = design.home.moved(t * np.array([9.0, -6, 8, 0.08, 0.05, -0.06]))
    found = gsp.track(design, design.at(path).joints, design.home)
    assert found.complete
    np.testing.assert_allclose(found.pose.position, path.position, rtol=0, atol=1e-7)


def test_far_samples_are_reached_in_pieces_like_near_ones():
    """The way between two samples is divided; it ends where a fine log on the same line ends."""
    path = loop(9, 0.25)
    joints = HEXAPOD.at(path).joints
    coarse = gsp.track(HEXAPOD, joints, HOME, largest_gap=1.0)
    share = np.linspace(0, 1, 400)[:, None]
    fine = np.concatenate([a + share * (b - a) for a, b in pairwise(joints)])
    dense = gsp.track(HEXAPOD, fine, HOME)
    assert coarse.complete
    assert dense.complete
    assert coarse.pieces.max() > 1
    np.testing.assert_allclose(
        coarse.pose.position[1:], dense.pose.position[399::400], rtol=0, atol=1e-10
    )


def test_a_way_that_needs_a_singular_posture_stops_there():
    """The legs are pulled beyond what the platform can reach."""
    ahead = np.linspace(0, 1, 400)[:, None] * np.array([1.0, 0, 1, 0, 1, 0])
    found = gsp.track(HEXAPOD, HEXAPOD.at(HOME).joints + ahead, HOME)
    assert found.status == "singular"
    assert 0 < found.reached < 400
    assert np.isfinite(found.pose.position[: found.reached]).all()
    assert np.isnan(found.pose.position[found.reached :]).all()
    assert np.nanmin(found.margin) < 0.1
    sides = np.sign(np.linalg.det(HEXAPOD.at(found.pose[: found.reached]).jacobian))
    assert (sides == sides[0]).all()
    earlier = gsp.track(HEXAPOD, HEXAPOD.at(HOME).joints + ahead, HOME, least_margin=0.1)
    assert earlier.status == "singular"
    assert earlier.reached < found.reached
    assert np.nanmin(earlier.margin) >= 0.1


def _log_where_lines_meet(seed, number, beside=0.0):
    """A design with one D4 leg and a path whose middle has its lines at a distance from another."""
    rng = np.random.default_rng(seed)
    a, b, s, t = rng.normal(size=(4, 6, 3))
    rates, start = rng.normal(size=6) * np.repeat([0.3, 0.2], 3), gsp.Pose([0.1, -0.2, 1.3])
    middle = start.moved(0.5 * rates)
    normal = np.cross(middle.rotation @ t[3], s[3])
    met = a[3] + 0.5 * s[3] + 0.3 * middle.rotation @ t[3] + beside * normal / norm(normal)
    b[3] = middle.rotation.T @ (met - middle.position)
    design = gsp.Design(["D1", "D1", "D2", "D4", "A1", "A1"], a, b, s, t)
    path = start.moved(np.linspace(0.0, 1.0, number)[:, None] * rates)
    normals = np.cross(path.rotation @ t[3], s[3])
    arms = path.position + path.rotation @ b[3] - a[3]
    signed = np.einsum("mi,mi->m", arms, normals / norm(normals)[:, None])
    sides = np.sign(np.linalg.det(design.at(path).jacobian) * np.sign(signed))
    return design, path, signed, bool((sides == sides[0]).all())


@pytest.mark.parametrize("number", [40, 101, 1000])
def test_a_track_ends_before_lines_that_meet(number):
    """The log cannot show on which side of the base line the platform line continues."""
    tried = 0
    for seed in range(12):
        design, path, signed, regular = _log_where_lines_meet(seed, number)
        crossings = np.flatnonzero(signed[1:] * signed[:-1] <= 0.0)
        if not regular or not crossings.size:
            continue
        tried += 1
        found = gsp.track(design, design.at(path).joints, path[0], least_margin=1e-4)
        assert found.status == "ambiguous"
        assert not found.complete
        assert 1 <= found.reached <= crossings[0] + 1
        done = slice(found.reached)
        np.testing.assert_allclose(found.pose[done].position, path[done].position, atol=1e-7)
        assert np.isnan(found.pose.position[found.reached :]).all()
        assert np.isnan(found.margin[found.reached :]).all()
        rest = slice(crossings[0] + 3, crossings[1] if crossings.size > 1 else number)
        after = gsp.track(design, design.at(path[rest]).joints, path[rest.start], least_margin=1e-4)
        went = slice(rest.start, rest.start + after.reached)
        assert after.reached > 0
        np.testing.assert_allclose(
            after.pose[: after.reached].position, path[went].position, atol=1e-7
        )
    assert tried >= 3


def test_lines_that_pass_beside_one_another_do_not_end_a_dense_log():
    tried = 0
    for seed in range(60):
        design, path, signed, regular = _log_where_lines_meet(seed, 1000, beside=0.02)
        if regular and np.abs(signed).min() > 0.01:
            tried += 1
            found = gsp.track(design, design.at(path).joints, path[0], least_margin=1e-4)
            assert found.complete
            np.testing.assert_allclose(found.pose.position, path.position, atol=1e-7)
    assert tried >= 3


def test_lines_that_meet_between_skipped_samples_are_detected():
    design, path, signed, _ = next(x for x in map(_crossing_log, range(12)) if x is not None)
    joints = design.at(path).joints.copy()
    bad = np.arange(len(joints)) % 3 == 1
    joints[bad] = np.nan
    found = gsp.track(design, joints, path[0], skip=True)
    first = int(np.flatnonzero(signed[1:] * signed[:-1] <= 0.0)[0])
    assert found.status == "ambiguous"
    assert found.reached <= first + 2
    assert gsp.track(design, joints, path[0]).status == "gap"
    resting = np.repeat(design.at(path[:1]).joints, 5, axis=0)
    assert gsp.track(design, resting, path[0]).complete


def _crossing_log(seed):
    design, path, signed, regular = _log_where_lines_meet(seed, 200)
    return (design, path, signed, regular) if regular and signed[0] * signed[-1] < 0.0 else None


def test_bad_samples_end_the_track_or_are_passed_over():
    path = loop(300)
    joints = HEXAPOD.at(path).joints.copy()
    joints[50, 2] = np.nan
    found = gsp.track(HEXAPOD, joints, HOME)
    assert (found.status, found.reached) == ("gap", 50)
    joints[100, 1] = -1.0
    over = gsp.track(HEXAPOD, joints, HOME, skip=True)
    assert over.complete
    assert np.isnan(over.pose.position[[50, 100]]).all()
    good = np.delete(np.arange(300), [50, 100])
    np.testing.assert_allclose(over.pose.position[good], path.position[good], atol=1e-10)
    joints[50] = joints[49]
    ended = gsp.track(HEXAPOD, joints, HOME)
    assert (ended.status, ended.reached) == ("undefined", 100)
    joints[80:] += 0.5
    jumped = gsp.track(HEXAPOD, joints, HOME)
    assert (jumped.status, jumped.reached) == ("gap", 80)


def test_no_samples_and_no_start():
    empty = gsp.track(HEXAPOD, np.empty((0, 6)), HOME)
    assert empty.complete
    assert empty.pose.shape == (0,)
    lost = gsp.track(HEXAPOD, np.full((3, 6), 1.0), gsp.Pose([0, 0, 0]))
    assert lost.reached == 0
    assert lost.status in ("singular", "not converged")


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (("x", np.ones((2, 6)), HOME), {}, "design"),
        ((HEXAPOD, np.ones(6), HOME), {}, r"shape \(\.\.\., n, 6\)"),
        ((HEXAPOD, np.ones((1, 2, 6)), HOME), {}, r"shape \(m, 6\)"),
        ((HEXAPOD, np.ones((2, 6)), loop(3)), {}, "single pose"),
        ((HEXAPOD, np.ones((2, 6)), HOME), {"largest_gap": 0}, "largest_gap"),
        ((HEXAPOD, np.ones((2, 6)), HOME), {"least_margin": -1}, "least_margin"),
        ((HEXAPOD, np.ones((2, 6)), HOME), {"skip": 1}, "skip"),
    ],
)
def test_bad_input(arguments, options, message):
    with pytest.raises(gsp.GspError, match=message):
        gsp.track(*arguments, **options)
