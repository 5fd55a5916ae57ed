"""The operation ellipsoid and the metric that its six vertices give."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, InvalidRotation
from tests.support import random_pose, turn

ELLIPSOID = gsp.Ellipsoid([0.5, 0.7, 0.4], [0.1, -0.2, 0.3], turn([0.3, 0.2, 0.1]))


def test_vertices():
    arms = ELLIPSOID.vertices - ELLIPSOID.center
    np.testing.assert_allclose(arms[:3], -arms[3:], rtol=1e-14)
    inside = (arms @ ELLIPSOID.rotation / ELLIPSOID.semi_axes) ** 2
    np.testing.assert_allclose(inside.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(arms[:3], axis=1), ELLIPSOID.semi_axes)


def test_a_number_is_a_sphere():
    sphere = gsp.Ellipsoid(2)
    np.testing.assert_array_equal(sphere.semi_axes, [2, 2, 2])
    np.testing.assert_array_equal(sphere.center, [0, 0, 0])
    np.testing.assert_array_equal(sphere.rotation, np.eye(3))
    with pytest.raises(ValueError, match="read-only"):
        sphere.center[0] = 1.0


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
def test_whiten_by_the_definition_of_d(shape):
    """X Xᵀ = D⁻¹ for D summed over the vertices: eq. (12) of Nawratil, at the platform origin."""
    rotation = random_pose(np.random.default_rng(0), shape).rotation
    x = ELLIPSOID.whiten(np.broadcast_to(np.eye(6), (*shape, 6, 6)), rotation)
    for index in np.ndindex(shape):
        d = np.zeros((6, 6))
        for vertex in ELLIPSOID.vertices:
            sx, sy, sz = rotation[index] @ vertex
            velocity = np.hstack((np.eye(3), [[0, sz, -sy], [-sz, 0, sx], [sy, -sx, 0]]))
            d += velocity.T @ velocity
        np.testing.assert_allclose(x[index] @ x[index].T, np.linalg.inv(d), atol=1e-14)


@pytest.mark.parametrize(
    "axes",
    [
        0,
        -1,
        [1, 2],
        [1, 2, 0],
        [1, 2, -3],
        [1, 2, np.nan],
        np.inf,
        None,
        "abc",
        True,
        [[1, 2, 3]],
        1j,
    ],
    ids=repr,
)
def test_bad_axes(axes):
    with pytest.raises(InvalidInput, match=r"ellipsoid\.semi_axes"):
        gsp.Ellipsoid(axes)


def test_bad_center_and_rotation():
    for center in ([0, 0], None, [0, 0, np.nan], np.zeros((2, 3)), "abc"):
        with pytest.raises(InvalidInput, match="ellipsoid"):
            gsp.Ellipsoid(1, center)
    with pytest.raises(InvalidRotation, match=r"ellipsoid\.rotation"):
        gsp.Ellipsoid(1, rotation=np.diag([1, 1, -1.0]))
    with pytest.raises(InvalidInput, match="one centre and one rotation"):
        gsp.Ellipsoid(1, rotation=np.broadcast_to(np.eye(3), (2, 3, 3)))


@pytest.mark.parametrize("number", [2, 3])
def test_rotations_are_one_for_each_jacobian_or_one_for_all(number):
    rng = np.random.default_rng(3)
    rows, turns = rng.normal(size=(2, 6, 6)), turn(rng.normal(size=(number, 3)))
    each = ELLIPSOID.whiten(rows, turns[0])
    np.testing.assert_array_equal(each[1], ELLIPSOID.whiten(rows[1], turns[0]))
    if number == 2:
        np.testing.assert_array_equal(
            ELLIPSOID.whiten(rows, turns)[1], ELLIPSOID.whiten(rows[1], turns[1])
        )
    else:
        with pytest.raises(InvalidInput, match=r"rotation: expected shape \(2, 3, 3\)"):
            ELLIPSOID.whiten(rows, turns)
    with pytest.raises(InvalidInput, match="rotation: expected"):
        ELLIPSOID.whiten(rows[0], turns)
