"""Directions, names and maxima at the edges of what sweeps take."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.families import lee

START = gsp.Pose([0.0, 0.0, 1.0])


@pytest.mark.parametrize("size", [1e-300, 1e-161, 1.0, 1e154, 1e300])
def test_the_length_of_a_direction_does_not_matter(size):
    slanted = [size, size, 0.0]
    turned = gsp.sweeps.turn(START, slanted, [90.0]).pose.rotation[0]
    line = np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0)
    assert np.allclose(turned, np.outer(line, line) + np.cross(line, np.eye(3)).T, atol=1e-15)
    moved = gsp.sweeps.translation(START, slanted, [1.0]).pose.position[0]
    assert np.allclose(moved, START.position + line, atol=1e-15)
    plane = gsp.sweeps.plane(START, [1.0], [1.0], ([size, 0, 0], [0, size, 0]))
    assert np.allclose(plane.pose.position[0, 0], [1.0, 1.0, 1.0])


def test_a_plane_has_two_directions_and_angles_are_bounded():
    with pytest.raises(InvalidInput, match="not parallel"):
        gsp.sweeps.plane(START, [1.0], [1.0], ([1.0, 0, 0], [-1.0, 0, 0]))
    with pytest.raises(InvalidInput, match="angles_deg: expected at most"):
        gsp.sweeps.turn(START, "x", [1e308])


@pytest.mark.parametrize("name", ["value", "x", "starts"])
def test_the_parameter_of_maxima_keeps_its_column(name):
    with pytest.raises(InvalidInput, match="name: expected one that no other column has"):
        gsp.sweeps.maxima(lambda b: lee.octahedral_3_3(1.0, b), name, [1.0])


def test_the_parameter_of_designs_keeps_its_column():
    make = lambda b: lee.octahedral_3_3(1.0, b)  # noqa: E731
    with pytest.raises(InvalidInput, match="name: expected"):
        gsp.sweeps.over_designs(make, "control_number", [1.0], START, ["CTN"])


def test_the_maximum_of_another_design_is_refused():
    rng = np.random.default_rng(0)
    other = gsp.determinant.maximum(gsp.Design(["D1"] * 6, *rng.normal(size=(2, 6, 3))))
    path = gsp.sweeps.translation(START, "z", [0.0])
    with pytest.raises(InvalidInput, match="maximum: expected that of this design"):
        gsp.sweep(lee.octahedral_3_3(1.0, 2.0), path, maximum=other)


def test_functions_over_the_example_set_return_one_number_per_height():
    for returned in (1.0, np.zeros(7)):
        with pytest.raises(InvalidInput, match="function: expected"):
            gsp.families.nawratil.over_example_set(lambda p, r=returned: r, [0.1], [0.1, 0.2])
