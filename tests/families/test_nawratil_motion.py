import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.families import nawratil
from gsp.families.nawratil.motion import (
    INTERVALS,
    between_axes,
    compare_screws,
    singular_angle,
    turned,
)
from gsp.indices.motion import InstantaneousMotion


def motion_of(point, direction, pitch=0.0):
    """A screw through a point, as a motion about the base origin."""
    w = np.asarray(direction, dtype=float)
    twist = np.concatenate((np.cross(point, w) + pitch * w, w))
    return InstantaneousMotion(twist[:, None], np.ones(1), np.zeros(3))


@pytest.mark.parametrize(
    ("point", "direction", "distance", "angle"),
    [
        ([0, 3, 4], [2, 0, 0], 5.0, 0.0),  # parallel
        ([0, 0, 2], [0, 1, 0], 2.0, np.pi / 2),  # skew
        ([0, 0, 2], [1, 1, 0], 2.0, np.pi / 4),
        ([7, 0, 0], [1, 1, 1], 0.0, np.arccos(1 / np.sqrt(3))),  # they meet
        ([0, 0, 2], [-1, 0, 0], 2.0, 0.0),
    ],
)
def test_distance_and_angle_of_known_axes(point, direction, distance, angle):
    found = between_axes(motion_of([1, 0, 0], [1, 0, 0], 0.3), motion_of(point, direction, -1.1))
    np.testing.assert_allclose(found, [distance, angle], atol=1e-12)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_all_errors_vanish_at_the_singular_posture(axis):
    at = singular_angle(axis)
    table = compare_screws(axis, [at - 1e-6, at, at + 1e-6])
    errors = [c for c in table if c.startswith(("distance", "angle_", "pitch_error"))]
    assert (table[errors].to_numpy() < 1e-4).all()
    assert table["control_number"][1] < 1e-12
    assert turned(axis, at).singular() or table["sigma_r"][1] < 1e-14


@pytest.mark.parametrize("axis", ["x", "y"])
def test_far_from_it_the_control_number_gives_the_better_screw(axis):
    table = compare_screws(axis, INTERVALS[axis])
    assert (table["distance_c"] < table["distance_p"]).all()
    if axis == "x":
        assert (table["angle_c"] < table["angle_p"]).all()
        assert (table["pitch_error_c"] < table["pitch_error_p"]).all()


def test_the_determinant_of_the_example_set_has_a_closed_form():
    alpha, h = np.linspace(0, np.pi / 6, 12), np.linspace(0.01, 2, 15)
    values = nawratil.over_example_set(gsp.indices.manipulability, alpha, h)
    np.testing.assert_allclose(
        values, nawratil.example_determinant(alpha, h[:, None]), rtol=1e-10, atol=1e-13
    )
    s, c = np.sin(np.pi / 6 - alpha[:-1]), np.cos(np.pi / 6 - alpha[:-1])
    np.testing.assert_allclose(nawratil.example_determinant(alpha[:-1], s), 27 / 4 * c**3)
    for k in (0.99, 1.01):
        assert (nawratil.example_determinant(alpha[:-1], k * s) < 27 / 4 * c**3).all()


def test_another_axis_is_an_error():
    with pytest.raises(InvalidInput, match="axis"):
        turned("z", 0.1)
