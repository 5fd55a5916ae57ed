import numpy as np
import pytest

from gsp.planar import PlanarDesign, PlanarPose


@pytest.fixture
def rng():
    return np.random.default_rng(20240229)


def random_design(legs, rng):
    n = len(legs)
    return PlanarDesign(
        legs,
        base_points=rng.normal(size=(n, 2)) * 3,
        platform_points=rng.normal(size=(n, 2)),
        base_directions=rng.normal(size=(n, 2)),
        platform_directions=rng.normal(size=(n, 2)),
        unit="m",
    )


def random_pose(shape, rng):
    return PlanarPose(rng.normal(size=(*shape, 2)), rng.uniform(-np.pi, np.pi, size=shape))


@pytest.fixture
def make_design():
    return random_design


@pytest.fixture
def make_pose():
    return random_pose
