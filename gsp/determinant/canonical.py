"""The canonical form of a design: the same for all designs that have the same maximum of |det J|.

Two designs share it if they differ by the unit of length (a similarity), by rigid motions of base
and platform axes, by the order of the legs (up to seven), or by which body is called the base.
Coordinates are rounded to TOLERANCE of the size of the design. (The unit is not free for
redundant designs with A1 rows.) Over a box of poses the axes
matter, and only unit and order of the legs are free.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from itertools import permutations, product
from typing import Any

import numpy as np

from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array, dot, norm, unit
from gsp.model.design import Design

TOLERANCE = 1e-10
MOST_LEGS = 7
# Vectors shorter than this share of the size give no axis.
SHORT = 1e-6


@dataclass(frozen=True, eq=False)
class Canonical:
    """A design in canonical form, and how poses are carried there and back.

    Attributes
    ----------
    legs : list of str
    rows : list of lists of 12 floats
        Per leg its base anchor, base line, platform anchor and platform line, multiples of
        TOLERANCE; zeros where there is no line. The size of the design is 1.
    domain : [[low, high], order] or None
        The box, in the same way.
    exchanged : bool
        Whether base and platform have changed places.
    length : float [unit]
        Size of the original design.
    base, platform : (3, 4) arrays
        [axes as columns | origin] of the canonical frames in the original axes, before exchange.
    """

    legs: list[str]
    rows: list[list[float]]
    domain: list[Any] | None
    exchanged: bool
    length: float
    base: Array
    platform: Array

    @property
    def key(self) -> str:
        """SHA-256 of legs, rows and domain, in hexadecimal."""
        return key_of(self.legs, self.rows, self.domain)

    @property
    def design(self) -> Design:
        """The canonical design."""
        return design_of(self.legs, self.rows)

    def inward(self, pose: Pose) -> Pose:
        """Return a pose of the original design as one of the canonical design."""
        (e, c), (f, k) = _parts(self.base), _parts(self.platform)
        moved = (pose.position + pose.rotation @ k - c) @ e / self.length
        inner = Pose(moved, _rotation(e.T @ pose.rotation @ f))
        return inner.inverse() if self.exchanged else inner

    def outward(self, pose: Pose) -> Pose:
        """Return a pose of the canonical design as one of the original design."""
        inner = pose.inverse() if self.exchanged else pose
        (e, c), (f, k) = _parts(self.base), _parts(self.platform)
        rotation = _rotation(e @ inner.rotation @ f.T)
        return Pose(e @ inner.position * self.length + c - rotation @ k, rotation)

    def scale(self, design: Design) -> float:
        """Return what |det J| of the canonical design is multiplied with for the original one."""
        return float(self.length ** (3 - int(design.angular.sum())))


def canonical(design: Design, box: PoseBox | None = None) -> Canonical:
    """Return the canonical form of a design, over all poses or over a box."""
    length = _size(design)
    if box is not None:
        return _fixed(design, box, length)
    orders = _orders(design)
    choices = []
    for exchanged, side in ((False, design), (True, design.exchanged())):
        base = _framed(side.base_points, side.base_directions, orders(side), length)
        top = _framed(side.platform_points, side.platform_directions, orders(side), length)
        rows = np.concatenate((base.rows, top.rows), axis=-1)
        best = min(range(len(rows)), key=lambda i, r=rows: tuple(r[i].ravel()))  # type: ignore[misc]
        legs = [side.legs[i].name for i in orders(side)[best]]
        choices.append((legs, rows[best].tolist(), exchanged, base.frames[best], top.frames[best]))
    legs, numbers, exchanged, low, high = min(choices, key=lambda c: (c[0], c[1]))
    if exchanged:
        low, high = high, low
    return Canonical(legs, numbers, None, exchanged, length, low, high)


def _fixed(design: Design, box: PoseBox, length: float) -> Canonical:
    """Canonical form over a box: the axes stay, legs are sorted by their coordinates."""
    columns = [
        design.base_points / length, design.base_directions,
        design.platform_points / length, design.platform_directions,
    ]  # fmt: skip
    rows = _rounded(np.concatenate(columns, axis=1))
    order = sorted(range(len(rows)), key=lambda i: (design.legs[i].name, tuple(rows[i])))
    legs, numbers = [design.legs[i].name for i in order], rows[order].tolist()
    scaled = np.stack((box.low, box.high)) / np.repeat([length, 1.0], 3)
    domain = [_rounded(scaled).tolist(), box.order]
    still = np.eye(3, 4)
    return Canonical(legs, numbers, domain, False, length, still, still)


def _size(design: Design) -> float:
    """Root-mean-square distance of the anchors from the centres of their bodies.

    It is 1 for redundant designs with A1 rows: their sqrt(det JᵀJ) has no power of the length.
    """
    if len(design.joint_names) > 6 and design.angular.any():
        return 1.0
    sides = (design.base_points, design.platform_points)
    squares = np.concatenate([s - s.mean(axis=0) for s in sides]) ** 2
    return float(np.sqrt(squares.sum(axis=1).mean())) or 1.0


def _orders(design: Design) -> Any:
    """Return a function of a design that gives all orders with its kinds of legs sorted: (m, n)."""

    def orders(side: Design) -> Array:
        names = [leg.name for leg in side.legs]
        kinds = sorted(set(names))
        groups = [[i for i, name in enumerate(names) if name == kind] for kind in kinds]
        ways = [permutations(g) if len(names) <= MOST_LEGS else [tuple(g)] for g in groups]
        return np.array([sum(way, ()) for way in product(*ways)])

    return orders


@dataclass(frozen=True, eq=False)
class _Framed:
    """Rounded coordinates (m, n, 6) of points and directions, and the frames (m, 3, 4)."""

    rows: Array
    frames: Array


def _framed(points: Array, directions: Array, orders: Array, length: float) -> _Framed:
    """Coordinates in the frame of the first vectors that span it, for every order of the legs."""
    centre = points.mean(axis=0)
    arms = ((points - centre) / length)[orders]
    lines = np.nan_to_num(directions)[orders]
    vectors = np.concatenate((arms, lines), axis=1)
    x = _first(vectors)
    y = _first(vectors - dot(vectors, x[:, None, :])[..., None] * x[:, None, :])
    y = np.where(norm(y)[:, None] > 0.0, y, unit(_across(x)))
    axes = np.stack((x, y, np.cross(x, y)), axis=-1)
    rows = np.concatenate((arms @ axes, lines @ axes), axis=-1)
    shift = np.broadcast_to(centre[:, None], (len(orders), 3, 1))
    return _Framed(_rounded(rows), np.concatenate((axes, shift), axis=-1))


def _first(vectors: Array) -> Array:
    """First vector of each list that is long enough, normalised; zero if there is none."""
    long = np.asarray(norm(vectors) > SHORT)
    first = vectors[np.arange(len(vectors)), long.argmax(axis=1)]
    return np.where(
        np.asarray(long.any(axis=1))[:, None], unit(np.where(first == 0.0, 0.0, first)), 0.0
    )


def _across(x: Array) -> Array:
    """Return some vector that is perpendicular to each of x."""
    other = np.eye(3)[np.abs(x).argmin(axis=1)]
    return np.asarray(np.cross(x, other))


def _rounded(values: Array) -> Array:
    """Multiples of TOLERANCE nearest to values, NaN as 0, without negative zeros."""
    return np.round(np.nan_to_num(values) / TOLERANCE) * TOLERANCE + 0.0


def key_of(legs: list[str], rows: list[list[float]], domain: list[Any] | None) -> str:
    """Return the key of a canonical form: of whole multiples of TOLERANCE, so that it is exact."""
    whole: list[Any] = [list(legs), _multiples(rows)]
    if domain is not None:
        whole.append([_multiples(domain[0]), domain[1]])
    return hashlib.sha256(json.dumps(whole).encode()).hexdigest()


def design_of(legs: list[str], rows: list[list[float]]) -> Design:
    """Return the design of a canonical form."""
    a, s, b, t = np.split(np.array(rows, dtype=np.float64), 4, axis=1)
    return Design(legs, a, b, _lines(s), _lines(t), name="canonical")


def _multiples(values: Any) -> Any:
    return np.rint(np.array(values, dtype=np.float64) / TOLERANCE).astype(np.int64).tolist()


def _lines(directions: Array) -> Array:
    """Directions with NaN where there is none."""
    return np.where(np.asarray(norm(directions) > 0.5)[:, None], directions, np.nan)


def _parts(frame: Array) -> tuple[Array, Array]:
    return frame[:, :3], frame[:, 3]


def _rotation(matrix: Array) -> Array:
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)
