"""The nearest pose of driven designs far from what they reach: a minimum, found from home too."""

import numpy as np
import pytest

import gsp
from gsp import Crank, Pose, Slider
from gsp.kinematics.feasible_descent import Functions, closest, descended, local_minimum, restored
from tests import campaign

FAR = [-0.2, -0.3, -0.6, -2.8, 0.1, 0.4]


def random_driven(kinds, seed):
    """Six legs with general dimensions, whose drives are at zero at home."""
    rng = np.random.default_rng(seed)
    base = rng.uniform(-1.5, 1.5, (6, 3)) * [1.0, 1.0, 0.3]
    platform = rng.uniform(-0.8, 0.8, (6, 3)) * [1.0, 1.0, 0.3]
    lines, arms = rng.normal(size=(2, 6, 3))
    lines /= np.linalg.norm(lines, axis=1, keepdims=True)
    arms *= 0.5 / np.linalg.norm(arms, axis=1, keepdims=True)
    home = Pose.from_rpy([0.1, -0.2, 1.5], [0.2, 0.1, -0.3])
    anchors = home.position + platform @ home.rotation.T
    legs = []
    for i, kind in enumerate(rng.choice(kinds, 6)):
        if kind == "slider":
            rod, way = anchors[i] - base[i], lines[i]
        else:
            rod, way = anchors[i] - base[i] - arms[i], np.cross(lines[i], arms[i])
        length, branch = float(np.linalg.norm(rod)), 1 if rod @ way > 0.0 else -1
        drives = {"slider": lambda r, b: Slider(rod=r, branch=b),
                  "crank": lambda r, b, arm=arms[i]: Crank(arm=arm, rod=r, branch=b)}  # fmt: skip
        legs.append(drives[kind](length, branch) if kind in drives else kind)
    return gsp.Design(legs, base, platform, lines, rng.normal(size=(6, 3)), home=home, unit="m")


def limits_of(design, width=0.2):
    joints = design.at(design.home).joints
    strokes = np.stack((joints - width, joints + width), axis=1)
    return gsp.Limits(strokes=np.where(design.signed[:, None], strokes, np.maximum(strokes, 0.0)))


def distance(design, target, pose):
    """The distance of the docstring, written apart from the search."""
    centre = design.platform_points.mean(axis=0)
    p = pose.position + pose.rotation @ centre - target.position - target.rotation @ centre
    turn = gsp.geometry.log3(pose.rotation @ target.rotation.T)
    lengths = np.linalg.norm(p, axis=-1) / design.rms_radius, np.linalg.norm(turn, axis=-1)
    return np.hypot(*lengths)


def walked(design, target, limits, pose, rounds=12):
    """The distance that a random walk of feasible steps of 1e-6 to 1e-3 comes to."""
    rng, best = np.random.default_rng(0), distance(design, target, pose)
    for _ in range(rounds):
        step = 10.0 ** rng.uniform(-6, -3, (400, 1)) * rng.normal(size=(400, 6))
        around = pose.moved(step * np.repeat([design.rms_radius, 1.0], 3))
        allowed = gsp.feasible(design, around, limits).ok
        lengths = np.where(allowed, distance(design, target, around), np.inf)
        if lengths.min() < best:
            best, pose = lengths.min(), around[int(lengths.argmin())]
    return best


MIXED = ("slider", "crank", "D1")
CASES = [(("crank",), 5), (MIXED, 3), (("slider",), 0), (("slider",), 2), (("slider",), 3),
         (("crank",), 4), (("crank",), 3), (MIXED, 0), (MIXED, 2), (MIXED, 1)]  # fmt: skip


@pytest.mark.parametrize(("kinds", "seed"), CASES[: campaign.count(2, len(CASES))])
def test_no_walk_of_feasible_steps_leads_nearer_to_a_far_target(kinds, seed):
    """In the first two cases the only end of the searches was once the home pose."""
    design = random_driven(kinds, seed)
    limits, target = limits_of(design), design.home.moved(FAR)
    near = gsp.nearest(design, target, limits, starts=1)
    assert near.distance == pytest.approx(distance(design, target, near.pose), abs=1e-9)
    assert near.distance < 0.9 * distance(design, target, design.home)
    inside = gsp.feasible(design, near.pose, limits)
    assert np.nanmax(inside.low - inside.values) < 1e-8
    assert np.nanmax(inside.values - inside.high) < 1e-8
    assert walked(design, target, limits, near.pose) > (1.0 - 1e-4) * near.distance


def test_without_a_home_pose_a_feasible_pose_is_found_from_poses_that_drives_do_not_reach():
    design = random_driven(("slider",), 0)
    limits, target = limits_of(design), design.home.moved([0.0, 0.0, 2.0, 1.0, 0.5, 0.0])
    assert np.isnan(design.at(target).joints).any()
    found = gsp.nearest(design.replace(home=None), target, limits, starts=1)
    assert found.starts == 1
    inside = gsp.feasible(design, found.pose, limits)
    assert np.nanmax([inside.low - inside.values, inside.values - inside.high]) < 1e-8


def test_the_shortest_vector_with_linear_functions_is_the_closed_form():
    rows, least = np.eye(6)[:2], np.array([2.0, -1.0])
    np.testing.assert_allclose(closest(rows, least), [2, 0, 0, 0, 0, 0], atol=1e-14)
    np.testing.assert_array_equal(closest(rows, -least - 5.0), np.zeros(6))
    assert closest(np.stack((rows[0], -rows[0])), np.array([1.0, 1.0])) is None


def outside(squares):
    """Functions that are satisfied outside of an ellipsoid."""
    squares = np.array(squares, dtype=float)
    return Functions(
        lambda x: np.array([x @ (x / squares) - 1.0]),
        lambda x: 2.0 * (x / squares)[None],
        lambda x: x,
        1e-9,
    )


def test_a_descent_ends_at_the_axis_of_an_ellipsoid_and_leaves_a_saddle():
    """Outside of an ellipsoid the shortest vectors are its least semi-axes."""
    of = outside([1.0, 4.0, 9.0, 9.0, 16.0, 16.0])
    end = descended(of, np.array([0.8, 2.0, 1.0, -1.0, 3.0, 2.0]))
    np.testing.assert_allclose(np.abs(end), np.eye(6)[0], atol=1e-3)
    saddle = np.array([0.0, 2.0, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(descended(of, saddle), saddle, atol=1e-9)
    assert np.linalg.norm(local_minimum(of, saddle, lambda x: x)) == pytest.approx(1.0, abs=1e-6)
    assert of.satisfied(restored(of, np.full(6, 0.1)))
