"""Figures that are moved onto each other: known isometries are found, others are not."""

import numpy as np
import pytest

from gsp.geometry.congruence import Figure, congruent_orders, isometries
from tests.support import turn

TOLERANCE = 1e-9


def figure(rng, n=6, dimension=3, lines=True):
    """Points and unit lines in the first coordinates of space."""
    kept = np.arange(3) < dimension
    points = rng.standard_normal((n, 3)) * kept
    directions = rng.standard_normal((n, 3)) * kept
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return points, directions * lines


def moved(points, lines, order, q, shift, rng):
    """The image of a figure: point i is moved to place order[i]; lines get any sense."""
    there, along = np.empty_like(points), np.empty_like(lines)
    there[order] = points @ q.T + shift
    along[order] = lines @ q.T * rng.choice([-1.0, 1.0], (len(lines), 1))
    return there, along


@pytest.mark.parametrize("hand", [1.0, -1.0], ids=["motion", "reflection"])
@pytest.mark.parametrize("lines", [True, False], ids=["lines", "points"])
@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_a_known_isometry_is_found(dimension, lines, hand):
    rng = np.random.default_rng(dimension)
    points, along = figure(rng, dimension=dimension, lines=lines)
    q = turn(rng.standard_normal(3)) * hand
    order = rng.permutation(6)
    image = moved(points, along, order, q, np.array([1.0, 2.0, 3.0]), rng)
    pair = tuple(Figure.of(p, 2.0, lines=s) for p, s in ((points, along), image))
    assert tuple(order) in list(congruent_orders([pair], TOLERANCE))
    found = isometries(*pair, order, TOLERANCE)
    hands = sorted(np.sign(np.linalg.det(g[:, :3])) for g in found)
    assert hands == ([hand] if dimension == 3 else [-1.0, 1.0])
    for g in found:
        np.testing.assert_allclose(points @ g[:, :3].T + g[:, 3], image[0][order], atol=1e-9)
        np.testing.assert_allclose(g[:, :3] @ g[:, :3].T, np.eye(3), atol=1e-12)
    if dimension == 3:
        np.testing.assert_allclose(found[0][:, :3], q, atol=1e-9)


def test_lines_decide_where_points_are_in_one_place():
    """Three orthogonal lines through one point: all 24 turns and 24 reflections of the cube."""
    cross = Figure.of(np.zeros((3, 3)), 1.0, lines=np.eye(3))
    orders = list(congruent_orders([(cross, cross)], TOLERANCE))
    assert len(orders) == 6
    found = [g for order in orders for g in isometries(cross, cross, order, TOLERANCE)]
    assert len(found) == 48
    # A third line in the plane of two others is moved onto none of them but itself.
    flat = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.8, 0.6, 0.0]])
    plane = Figure.of(np.zeros((3, 3)), 1.0, lines=flat)
    assert list(congruent_orders([(plane, plane)], TOLERANCE)) == [(0, 1, 2)]


def test_a_line_is_no_point():
    """Points fit and the line of one of them does not."""
    points = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    lines = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    here = Figure.of(points, 1.0, lines=lines)
    assert list(congruent_orders([(here, here)], TOLERANCE)) == [(0, 1)]
    lines[1] = [0.0, 0.6, 0.8]
    there = Figure.of(points, 1.0, lines=lines)
    # A half turn moves the points onto each other, and a turn about them the lines.
    assert list(congruent_orders([(there, there)], TOLERANCE)) == [(0, 1), (1, 0)]
    found = isometries(there, there, (1, 0), TOLERANCE)
    assert found
    for g in found:
        sines = np.linalg.norm(np.cross(lines @ g[:, :3].T, lines[::-1]), axis=1)
        np.testing.assert_allclose(sines, 0.0, atol=1e-9)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_the_tolerance_is_a_share_of_the_size(size):
    square = size * np.array([[1.0, 0, 0], [0, 1.0, 0], [-1.0, 0, 0], [0, -1.0, 0]])
    square[0, 0] *= 1.0 + 1e-3
    here = Figure.of(square, size, centre=np.zeros(3))
    turned = (1, 2, 3, 0)
    assert not isometries(here, here, turned, 0.9e-3)
    assert isometries(here, here, turned, 1.1e-3)
    assert turned in list(congruent_orders([(here, here)], 1.1e-3))


def test_all_figures_take_the_same_order():
    rng = np.random.default_rng(5)
    ring = np.array([[1.0, 0, 0], [0, 1.0, 0], [-1.0, 0, 0], [0, -1.0, 0]])
    square = Figure.of(ring, 1.0)
    other = Figure.of(rng.standard_normal((4, 3)), 1.0)
    assert len(list(congruent_orders([(square, square)], TOLERANCE))) == 8
    assert list(congruent_orders([(square, square), (other, other)], TOLERANCE)) == [(0, 1, 2, 3)]
