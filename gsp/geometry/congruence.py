"""Congruent figures of points and lines: in which order one fits onto another, and how it moves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from gsp.geometry.rotations import congruences
from gsp.geometry.vectors import Array, Mask, norm

# A change of a dot product [1] that a displacement by the tolerance can make, over the tolerance
# times the longest vector: once for each of the two vectors, and as much again for the rounding.
PRODUCT_SLACK = 4.0


class Figure(NamedTuple):
    """Numbered points, each with a line through it or without one, and a centre.

    Attributes
    ----------
    arms : (n, 3) array [1]
        From the centre to the points, over the size.
    lines : (n, 3) array [1]
        Unit vectors along the lines, of either sense; 0 where there is none.
    centre : (3,) array [unit]
        Moved onto the centre of an image.
    """

    arms: Array
    lines: Array
    centre: Array

    @classmethod
    def of(
        cls, points: Array, size: float, *, centre: Array | None = None, lines: Array | None = None
    ) -> Figure:
        """Return the figure of points [unit] over a size [unit]; their mean is the centre."""
        middle = points.mean(axis=0) if centre is None else centre
        arms = (points - middle) / size
        return cls(arms, np.zeros_like(arms) if lines is None else lines, middle)


def congruent_orders(
    pairs: Sequence[tuple[Figure, Figure]], tolerance: float
) -> Iterator[tuple[int, ...]]:
    """Yield the orders in which all figures may fit onto their images, sorted.

    Point i of each figure would come to point order[i] of its image. All distances from the centre
    and angles fit; `isometries` decides.

    Parameters
    ----------
    pairs : sequence of (figure, image)
        With the same number of points each.
    tolerance : float [1]
        As for `isometries`.
    """
    n = len(pairs[0][0].arms)
    fits = [_fitting(figure, image, tolerance) for figure, image in pairs]

    def extended(order: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        i = len(order)
        if i == n:
            yield order
            return
        for j in (j for j in range(n) if j not in order):
            if all(fit[i, list(range(i + 1)), j, [*order, j]].all() for fit in fits):
                yield from extended((*order, j))

    yield from extended(())


def _fitting(figure: Figure, image: Figure, tolerance: float) -> Mask:
    """Whether the products of i and k agree with those of j and l: (n, n, n, n), i, k, j, l."""
    longest = max(1.0, *(float(norm(f.arms).max()) for f in (figure, image)))
    slack = PRODUCT_SLACK * tolerance * longest
    fit = np.ones((len(figure.arms),) * 4, dtype=bool)
    for here, there in zip(_products(figure), _products(image), strict=True):
        fit &= np.abs(here[:, :, None, None] - there) <= slack
    return fit


def _products(figure: Figure) -> tuple[Array, ...]:
    """Return products of all pairs of vectors, those of lines without their sign: (n, n) each."""
    arms, lines = figure.arms, figure.lines
    return arms @ arms.T, np.abs(arms @ lines.T), np.abs(lines @ arms.T), np.abs(lines @ lines.T)


def isometries(
    figure: Figure, image: Figure, order: Sequence[int], tolerance: float
) -> list[Array]:
    """Return the isometries that move a figure onto its image in an order.

    Where the vectors of the figure are in a plane, a reflection is among them for each rotation;
    where they are on one line, one rotation and one reflection stand for all.

    Parameters
    ----------
    figure, image : Figure
    order : sequence of n integers
        Point i is moved to point order[i] of the image.
    tolerance : float [1]
        Largest distance of a moved point from its image, over the size, and largest difference
        of the unit vectors of lines.

    Returns
    -------
    list of (3, 4) arrays [1, unit]
        [Q | shift] with an orthogonal Q.
    """
    places = list(order)
    whole = np.concatenate((figure.arms, figure.lines))
    there = np.concatenate((image.arms[places], image.lines[places]))
    lines = [i for i in _independent(whole, tolerance) if i >= len(places)]
    some = [*range(len(places)), *lines]
    found: list[Array] = []
    for senses in product((1.0, -1.0), repeat=len(lines)):
        signs = np.ones(len(whole))
        signs[lines] = senses
        for q in congruences(whole[some], there[some] * signs[some, None]):
            better = _refined(q, whole, there, len(places))
            signed = there * _senses(better, whole, there, len(places))[:, None]
            close = norm(whole @ better.T - signed).max() <= tolerance
            if close and all(np.abs(better - other).max() > tolerance for other in found):
                found.append(better)
    return [np.column_stack((q, image.centre - q @ figure.centre)) for q in found]


def _independent(vectors: Array, tolerance: float) -> list[int]:
    """Up to three vectors that span the space of all; the first ones where they are as good."""
    from scipy.linalg import qr

    _, r, places = qr(vectors.T, mode="economic", pivoting=True)
    rank = int((np.abs(np.diag(r)) > tolerance).sum())
    return [int(place) for place in places[:rank]]


def _senses(q: Array, whole: Array, there: Array, n: int) -> Array:
    """Return 1 for points, and for lines the sense in which they fit their images."""
    dots = (whole @ q.T * there).sum(axis=1)
    return np.where((np.arange(len(whole)) >= n) & (dots < 0.0), -1.0, 1.0)


def _refined(q: Array, whole: Array, there: Array, n: int) -> Array:
    """Return the matrix nearest to all vectors, of the same determinant."""
    signed = there * _senses(q, whole, there, n)[:, None]
    if (signed == there).all() and not whole[n:].any():
        return q
    options = congruences(whole, signed)
    return min(options, key=lambda option: abs(np.linalg.det(option) - np.linalg.det(q)))
