"""The index singularity_distance: no pose nearer than its value is singular."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.indices import INDICES, singularity_distance
from tests.campaign import count
from tests.proof.proofs import KINDS, hexapod, singular_design
from tests.support import random_design, random_pose, turn

UP = gsp.Pose([0.0, 0.0, 1.5])


def moved(pose, step, length):
    """Poses after displacements and turns (…, 6) [length], turns divided by the length."""
    rotation = turn(step[..., 3:] / length) @ pose.rotation
    return gsp.Pose(pose.position + step[..., :3], rotation)


def directions(rng, n):
    x = rng.standard_normal((n, 6))
    return x / np.linalg.norm(x, axis=1, keepdims=True)


def test_known_singular_poses_are_not_in_the_ball():
    """The singular pose is chosen first, the pose that is asked about then."""
    rng = np.random.default_rng(0)
    for i in range(count(60, 3000)):
        kind = KINDS[i % len(KINDS)]
        kinds = [kind] * (2 if kind == "D4 A1" else 3)
        kinds += ["D1"] * (6 - sum(len(k.split()) for k in kinds))
        design, singular = singular_design(rng, kinds)
        length = 10.0 ** rng.uniform(-1, 1)
        here = moved(singular, 10.0 ** rng.uniform(-4, 0) * directions(rng, 1)[0], length)
        angle = Rotation.from_matrix(here.rotation @ singular.rotation.T).magnitude()
        exact = np.hypot(np.linalg.norm(here.position - singular.position), length * angle)
        assert singularity_distance(design.at(here), length) <= exact * (1 + 1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_climbing_to_singular_poses_does_not_end_in_the_ball(kind):
    """The least singular value is reduced step by step within the ball, and stays above zero."""
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(count(2, 40)):
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        pose, length = random_pose(rng), 0.8
        radius = float(singularity_distance(design.at(pose), length))
        assert radius > 0.0
        start = design.at(pose).singular_values(length)[-1]
        best, spread = directions(rng, 200), 0.5
        for _ in range(8):
            postures = design.at(moved(pose, radius * best, length))
            value = postures.singular_values(length)[..., -1]
            # σ_min ≥ σ_min(centre) (1 − G/…): it cannot vanish before the surface of the ball.
            assert (value > 1e-6 * start).all()
            top = best[np.argsort(value)[:20]]
            best = np.repeat(top, 10, axis=0) + spread * directions(rng, 200)
            best /= np.maximum(1.0, np.linalg.norm(best, axis=1, keepdims=True))
            spread *= 0.7


def test_the_ball_is_a_fair_share_of_the_distance():
    """The hexapod: proven lower bound from one ball, from many boxes, and a singular pose."""
    one = singularity_distance(hexapod().at(UP), 1.0)
    both = gsp.singularity_distance(hexapod(), UP, 1.0, budget=300)
    assert one <= both.lower * (1 + 1e-12) < both.upper
    assert one > 0.2 * both.upper


def test_near_a_singular_pose_the_value_is_near_to_its_distance():
    """The bound is of first order: halving the distance halves it."""
    rng = np.random.default_rng(2)
    design, singular = singular_design(rng, ["D1"] * 6)
    step = directions(rng, 1)[0]
    away = 10.0 ** -np.arange(3.0, 7.0)
    values = np.array(
        [singularity_distance(design.at(moved(singular, a * step, 1.0)), 1.0) for a in away]
    )
    assert (values < away * (1 + 1e-9)).all()
    np.testing.assert_allclose(values[1:] / values[:-1], 0.1, rtol=0.3)


def test_singular_and_undefined_postures():
    design, pose = singular_design(np.random.default_rng(5), ["D1"] * 6)
    assert singularity_distance(design.at(pose), 1.0) < 1e-9
    points = np.random.default_rng(0).uniform(-1, 1, (6, 3))
    flat = gsp.Design(["D1"] * 6, points, points)
    assert singularity_distance(flat.at(gsp.Pose([0, 0, 1.0])), 1.0) == 0.0
    meets = gsp.Pose(hexapod().base_points[0] - hexapod().platform_points[0])
    assert np.isnan(singularity_distance(hexapod().at(meets), 1.0))


def test_it_is_evaluated_and_ranked_as_other_indices():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    poses = gsp.PoseBox.around(design.home, [5, 5, 5, 0.1, 0.1, 0.1]).sample(5, rng=0)
    table = gsp.evaluate(design, poses, "SD", length=95.0)
    exact = singularity_distance(design.at(poses), 95.0)
    np.testing.assert_allclose(table["singularity_distance"], exact, rtol=1e-12)
    each = [singularity_distance(design.at(poses[i]), 95.0) for i in range(5)]
    np.testing.assert_allclose(exact, each, rtol=1e-11)
    ranked = gsp.rank([design], poses, "SD", length=95.0)
    assert ranked["singularity_distance_mean"].iloc[0] == pytest.approx(exact.mean())
    with pytest.raises(MissingParameter, match="length"):
        gsp.evaluate(hexapod(), UP, "SD")
    with pytest.raises(InvalidInput):
        singularity_distance(design.at(design.home), 0.0)
    assert INDICES["singularity_distance"].unit(design) == "mm"
