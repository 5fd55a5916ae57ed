"""Values depend neither on a far platform origin nor, at symmetric designs, on rounding."""

import numpy as np
import pytest

import gsp
from gsp.indices.cdn_points import largest_triangles
from tests.support import random_design, random_pose, turn

LEGS = {
    "D1^6": ["D1"] * 6,
    "mixed": ["D4 A1", "D1", "D2", "D3", "D4"],
    "seven": ["D1"] * 7,
    "nine rows": ["D1", "D2", "D3", "D4", "D1", "D2", "D4", "D4 A1"],
}
on_legs = pytest.mark.parametrize("legs", LEGS)
far_away = pytest.mark.parametrize("away", [1e2, 1e4, 1e6])


def seen_from(design, pose, point):
    """The same platform with its origin moved, so that its old origin is at `point`."""
    frame = gsp.Pose(np.asarray(point, dtype=float), turn([0.4, -1.1, 0.8]))
    f = frame.rotation
    moved = design.replace(
        platform_points=frame.position + design.platform_points @ f.T,
        platform_directions=design.platform_directions @ f.T,
    )
    return moved, pose.compose(frame.inverse())


def flat_case(height):
    """A hexapod whose platform lies in the base at height 0: singular of defect three."""
    angle = np.arange(6) * np.pi / 3
    other = angle + 0.1 * (-1.0) ** np.arange(6)
    ring = [np.stack((np.cos(a), np.sin(a), 0 * a), axis=1) for a in (angle, other)]
    return gsp.Design(["D1"] * 6, 2 * ring[1], ring[0]), gsp.Pose([0.1, 0.2, height])


@on_legs
def test_an_origin_a_million_sizes_away_changes_nothing(legs):
    """The metamorphic suite ends at 1e4 sizes."""
    rng, away = np.random.default_rng(5), 1e6
    design, pose = random_design(rng, LEGS[legs]), random_pose(rng, (4,))
    far, there = seen_from(design, pose, away * np.array([1.0, 0.3, -0.2]))
    here, moved = design.at(pose), far.at(there)
    assert not moved.singular().any()
    for name in ("manipulability", "condition_number_points"):
        index = gsp.indices.INDICES[name]
        given = {"length": 0.8} if index.length_for else {}
        wanted = index.function(here, **given)
        np.testing.assert_allclose(index.function(moved, **given), wanted, rtol=1e-10 * away)


@far_away
def test_nearly_singular_is_not_singular_from_afar(away):
    """CDN is 4e4 here; 1e-15 times the distance of the origin is what rounding moves the pose."""
    design, pose = flat_case(1e-4)
    posture = gsp.Design.at(*seen_from(design, pose, away * np.array([1.0, 0.3, -0.2])))
    assert not posture.singular()
    for function in (gsp.indices.manipulability, gsp.indices.rigidity_rate):
        wanted = function(design.at(pose))
        assert wanted > 0.0
        np.testing.assert_allclose(function(posture), wanted, rtol=1e-10 * away)
    assert gsp.Design.at(*flat_case(0.0)).singular()


@pytest.mark.parametrize("away", [1.0, 1e2, 1e4])
@on_legs
def test_forward_from_everywhere(legs, away):
    rng = np.random.default_rng(8)
    design, pose = random_design(rng, LEGS[legs]), random_pose(rng, (6,))
    guess = pose.moved(0.02 * rng.normal(size=(6, 6)))
    joints = design.at(pose).joints
    near = gsp.forward(design, joints, guess)
    point = away * np.array([1.0, 0.3, -0.2])
    far, start = seen_from(design, guess, point)
    found = gsp.forward(far, joints, start)
    np.testing.assert_array_equal(found.status, near.status)
    assert found.converged.mean() > 0.7
    good = found.converged
    anchors = [
        at.design.platform_points @ np.swapaxes(at.pose.rotation, -1, -2)
        + at.pose.position[:, None]
        for at in (far.at(found.pose[good]), design.at(near.pose[good]))
    ]
    np.testing.assert_allclose(anchors[0], anchors[1], rtol=0, atol=1e-9 * max(1.0, away / 100))


def platform(kind):
    """Six or eight platform anchors of which several triangles are equally large."""
    if kind == "mirror":
        half = np.array([[1.0, 0.2, 0.1], [0.3, 0.9, 0.0], [-0.7, 0.5, 0.2]])
        return np.concatenate((half, half * [1, -1, 1]))
    n, angle = {"D6": (6, 0.0), "D8": (8, 0.0), "D3": (6, 0.3)}[kind]
    turns = 2 * np.pi * np.arange(n) / n + angle * (-1.0) ** np.arange(n)
    return np.stack((np.cos(turns), np.sin(turns), 0 * turns), axis=1)


@pytest.mark.parametrize("kind", ["mirror", "D6", "D8", "D3"])
def test_equally_large_triangles_have_one_value(kind):
    rng = np.random.default_rng(2)
    points = platform(kind)
    n = len(points)
    design = gsp.Design(["D1"] * n, 2.0 * rng.normal(size=(n, 3)), points)
    pose = random_pose(rng, (3,))
    assert len(largest_triangles(design)) > 1
    value = gsp.indices.condition_number_points(design.at(pose))
    order = rng.permutation(n)
    others = [
        (
            design.replace(base_points=design.base_points[order], platform_points=points[order]),
            pose,
        ),
        (design.scaled(1e-3), pose.scaled(1e-3)),
        seen_from(design, pose, [3.0, -5.0, 20.0]),
    ]
    for other in others:
        found = gsp.indices.condition_number_points(gsp.Design.at(*other))
        np.testing.assert_allclose(found, value, rtol=1e-9)
    each = [
        gsp.indices.condition_number_points(design.at(pose), points=triangle)
        for triangle in largest_triangles(design)
    ]
    np.testing.assert_allclose(value, np.max(each, axis=0))


def test_planar_singularity_from_everywhere():
    """Similar triangles that are turned against each other are regular."""
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.8]])
    for away in (0.0, 1e2, 1e6):
        shift = away * np.array([1.0, 0.4])
        design = gsp.planar.PlanarDesign(["D1"] * 3, 3 * triangle, triangle + shift)
        for angle in (0.3, 0.7):
            turned = gsp.planar.PlanarPose([0.0, 0.0], angle)
            pose = gsp.planar.PlanarPose([1.0, 0.8] - turned.rotation @ shift, angle)
            assert not design.at(pose).singular()
