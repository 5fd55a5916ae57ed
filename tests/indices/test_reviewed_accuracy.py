"""The reviewed indices against 50-digit arithmetic, up to conditions of 1e10."""

import numpy as np
import pytest

import gsp
from gsp.families.nawratil.motion import singular_angle, turned
from gsp.indices import INDICES
from gsp.indices.cdn_points import largest_corners
from tests import exact
from tests.support import random_design, random_pose

LENGTH = 0.8


def assert_close(design, pose):
    posture = design.at(pose)
    size = float(gsp.indices.condition_number(posture, LENGTH))
    for name, wanted in exact.reviewed(design, pose, LENGTH, largest_corners(design)[0]).items():
        index = INDICES[name]
        given = {"length": LENGTH} if "length" in index.parameters else {}
        found = float(index.function(posture, **given))
        bound = 4e-15 * max(size, gsp.indices.condition_number_plain(posture))
        assert found == pytest.approx(float(wanted), rel=bound), name
    return size


@pytest.mark.parametrize("axis", ["x", "y"])
def test_towards_a_singular_posture(axis):
    largest = 0.0
    for offset in (1e-1, 1e-3, 1e-6, 1e-9):
        posture = turned(axis, singular_angle(axis) + offset)
        largest = max(largest, assert_close(posture.design, posture.pose))
    assert largest > 1e8


@pytest.mark.parametrize("name", ["D1^6", "D2^3 D3^3", "D4^6", "D1^3 D2 D3 A1", "D1 D2 D3 D4 A1^2"])
def test_random_geometry(name):
    rng = np.random.default_rng(len(name))
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    for _ in range(3):
        assert_close(random_design(rng, legs), random_pose(rng))
