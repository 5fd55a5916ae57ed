"""Derivatives of the matrices of postures along directions of the dimensions of a design."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.copies import kept_property
from gsp.geometry.duals import Dual
from gsp.geometry.vectors import Array, norm
from gsp.model.posture.assembly import (
    POSES_PER_ASSEMBLY,
    Group,
    Part,
    in_places,
    part_of,
    passive_places,
    put,
)
from gsp.model.posture.postures import Posture

# Own directions of a leg: three each of a, b, s and t, and the characteristic length.
ANCHOR_DIRECTIONS = 12
OWN_DIRECTIONS = ANCHOR_DIRECTIONS + 1


@dataclass(frozen=True, eq=False, kw_only=True)
class Directions:
    """k directions of the dimensions of a design.

    Attributes
    ----------
    anchors : (k, n_legs, 12) array [per unit of the parameter]
        Rates of a_i, b_i, s_i and t_i. Of the rates of s and t only the parts across s and t count.
    length : (k,) array
        Rates of the characteristic length.
    """

    anchors: Array
    length: Array

    @classmethod
    def of_anchors(cls, n_legs: int) -> Directions:
        """Return the 12 n_legs directions of single coordinates; the length is fixed."""
        k = ANCHOR_DIRECTIONS * n_legs
        return cls(anchors=np.eye(k).reshape(k, n_legs, -1), length=np.zeros(k))

    def __len__(self) -> int:
        return len(self.length)

    def of_legs(self, legs: NDArray[np.int64]) -> Array:
        """Return the own directions of legs, shape (number of legs, 13, k)."""
        lengths = np.broadcast_to(self.length[:, None, None], (len(self), len(legs), 1))
        return np.concatenate((self.anchors[:, legs], lengths), axis=-1).transpose(1, 2, 0)


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives of the matrices of a posture along k directions; the pose is fixed.

    Attributes
    ----------
    posture : Posture, batch shape (...)
    directions : Directions

    NaN marks an element that the posture does not define.
    """

    posture: Posture
    directions: Directions

    @kept_property
    def _own(self) -> tuple[Array, Array]:
        """Derivatives of joints (N, n, 1, 12) and rows (N, n, 6, 12) along own directions."""
        posture = self.posture
        shape = (posture.pose.size, len(posture.joint_names))
        joints, rows = (np.empty((*shape, size, OWN_DIRECTIONS)) for size in (1, 6))
        with np.errstate(all="ignore"):
            for poses, group, _, segment, undefined in _parts(posture):
                kind = group.kind
                for constraint, places in zip(kind.constraints, group.rows, strict=True):
                    values = [constraint.measure(segment)]
                    put(joints, poses, places, [_slope(x) for x in values], undefined)
                    row = constraint.row(segment, 1.0)
                    put(rows, poses, places, [_slope(x) for x in row], undefined)
        return joints, rows

    def _along(self, own: Array, legs: NDArray[np.int64]) -> Array:
        """Return derivatives (..., k, m, c) of rows (N, m, c, 13) that belong to legs (m,)."""
        found = np.moveaxis(own @ self.directions.of_legs(legs), -1, 1)
        return np.asarray(found.reshape(*self.posture.shape, *found.shape[1:]))

    @property
    def _legs(self) -> NDArray[np.int64]:
        return np.array([row.leg for row in self.posture.design.rows], dtype=np.int64)

    @kept_property
    def joints(self) -> Array:
        """Derivatives of `Posture.joints`, shape (..., k, n)."""
        return self._along(self._own[0], self._legs)[..., 0]

    @kept_property
    def jacobian(self) -> Array:
        """Derivatives of `Posture.jacobian`, shape (..., k, n, 6)."""
        return self._along(self._own[1], self._legs)

    def weighted(self, length: float | None) -> Array:
        """Return the derivatives of `Posture.weighted(length)`, shape (..., k, n, 6)."""
        angular = self.posture.angular
        if length is None or not angular.any():
            return self.jacobian
        scaled = self.jacobian * np.where(angular, length, 1.0)[:, None]
        return scaled + self._length * np.where(angular[:, None], self._rows, 0.0)

    def homogeneous(self, length: float) -> Array:
        """Return the derivatives of `Posture.homogeneous(length)`, shape (..., k, n, 6)."""
        scale = np.where(np.arange(6) < 3, 1.0, 1.0 / length)
        rows = self.posture.weighted(length)[..., None, :, :]
        shrinking = np.where(np.arange(6) < 3, 0.0, -1.0 / length**2)
        return self.weighted(length) * scale + self._length * rows * shrinking

    @property
    def _length(self) -> Array:
        return self.directions.length[:, None, None]

    @property
    def _rows(self) -> Array:
        return self.posture.jacobian[..., None, :, :]

    def passive_rates(self, length: float | None) -> Array:
        """Return the derivatives of `Posture.passive_rates(length)`, shape (..., k, m, 6)."""
        posture = self.posture
        starts, total = passive_places(posture.design.groups)
        first = dict(zip(posture.design.groups, starts, strict=True))
        own = np.empty((posture.pose.size, total, 6, OWN_DIRECTIONS))
        legs = np.empty(total, dtype=np.int64)
        unit = np.zeros((OWN_DIRECTIONS, 1, 1))
        unit[-1] = 1.0
        scale = Dual(np.full((1, 1), 1.0 if length is None else length), unit)
        with np.errstate(all="ignore"):
            for poses, group, _, segment, undefined in _parts(posture):
                (start, step), kind = first[group], group.kind
                for i, row in enumerate(in_places(kind, kind.passive(segment, scale), 6)):
                    places = slice(start + i, start + group.count * step, step)
                    put(own, poses, places, [_slope(x) for x in row], undefined)
                    legs[places] = np.arange(posture.design.n_legs)[group.legs]
        return self._along(own, legs)


def _slope(value: object) -> Array | float:
    return value.slope if isinstance(value, Dual) else 0.0


def _parts(posture: Posture) -> Iterator[Part]:
    """Yield the legs of one kind at some poses, with derivatives along their own directions."""
    pose = posture.pose.reshape(posture.pose.size)
    groups = [_moving(group) for group in posture.design.groups]
    most = POSES_PER_ASSEMBLY // OWN_DIRECTIONS
    for start in range(0, pose.size, most):
        poses = slice(start, min(start + most, pose.size))
        p = list(pose.position[poses].T[:, None])
        r = list(pose.rotation[poses].reshape(-1, 9).T[:, None])
        distance = norm(pose.position[poses])
        with np.errstate(all="ignore"):
            yield from [
                part_of(moving, poses, p, r, distance)._replace(group=group)
                for group, moving in zip(posture.design.groups, groups, strict=True)
            ]


def _moving(group: Group) -> Group:
    """Return a group whose anchors and lines have derivatives; slopes have the axes (13, k, 1)."""
    points = tuple(_duals(x, 3 * i) for i, x in enumerate(group.points))
    directions = tuple(
        _duals(x, 6 + 3 * i, unit=True) if len(x) else [] for i, x in enumerate(group.directions)
    )
    return replace(group, points=(points[0], points[1]), directions=(directions[0], directions[1]))


def _duals(vectors: Array, first: int, *, unit: bool = False) -> list[Dual]:
    """Return vectors (3, k, 1) as dual numbers; unit vectors stay of unit length."""
    slopes = np.zeros((3, OWN_DIRECTIONS, *vectors.shape[1:]))
    slopes[:, first : first + 3] = np.eye(3)[..., None, None]
    if unit:
        slopes[:, first : first + 3] -= vectors[:, None] * vectors[None]
    return [Dual(x, slope) for x, slope in zip(vectors, slopes, strict=True)]
