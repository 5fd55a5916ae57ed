"""Poses between frames of other origins: by the points that they place."""

import numpy as np

from gsp.geometry.pose.centring import centred_pose, original_pose
from tests.support import random_pose


def test_a_centred_pose_places_the_same_points():
    rng = np.random.default_rng(3)
    pose, size, base, platform, point = random_pose(rng), 2.5, *rng.normal(size=(3, 3))
    small = centred_pose(pose, size, base, platform)
    placed = small.position + small.rotation @ ((point - platform) / size)
    np.testing.assert_allclose(
        placed * size + base, pose.position + pose.rotation @ point, rtol=0, atol=1e-14
    )
    back = original_pose(small, size, base, platform)
    np.testing.assert_allclose(back.position, pose.position, rtol=0, atol=1e-14)
