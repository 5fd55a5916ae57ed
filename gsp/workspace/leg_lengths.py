"""Shortest and longest lengths of SPS legs over a box of angles of the platform."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array

# Rounds in which each free angle is improved in turn, at most.
SWEEPS_OVER_ANGLES = 40
# Nodes per free angle from which extremes are sought, where several angles are free.
NODES_PER_ANGLE = 5
# Three angles [rad] that determine A + B cos + C sin.
THIRDS = np.array([0.0, 2.0, 4.0]) * np.pi / 3.0


@dataclass(frozen=True, eq=False, kw_only=True)
class LegLengths:
    """Lengths of legs whose platform turns within a box of angles.

    Attributes
    ----------
    base_points, platform_points : (n, 3) arrays [length]
    least, greatest : (3,) arrays [rad]
        The box of angles.
    order : str
        The angle set.
    """

    base_points: Array
    platform_points: Array
    least: Array
    greatest: Array
    order: str

    @property
    def free(self) -> tuple[int, ...]:
        """The angles that have a range."""
        return tuple(int(i) for i in np.flatnonzero(self.greatest > self.least))

    def extremes(self, position: Array) -> tuple[Array, Array]:
        """Return the shortest and longest lengths (N, n, 2), and angles (N, n, 2, 3) of them.

        Along one angle the square of a length is A + B cos + C sin, so its extremes over an
        interval are known in closed form. With several angles they are improved in turn, from
        the best node of a grid over the box.

        Parameters
        ----------
        position : (N, 3) array [length]
        """
        results = [self._extreme(position, sign) for sign in (-1.0, 1.0)]
        return (
            np.stack([length for length, _ in results], axis=-1),
            np.stack([angles for _, angles in results], axis=-2),
        )

    def _square(self, position: Array, leg: NDArray[np.intp], angles: Array) -> Array:
        """Squared lengths of legs (N,) at positions (N, 3) and angles (N, 3): shape (N,)."""
        rotation = rotation_from_angles(angles, self.order)
        arm = (rotation @ self.platform_points[leg][..., None])[..., 0]
        d = position + arm - self.base_points[leg]
        return np.asarray((d * d).sum(axis=-1))

    def _extreme(self, position: Array, sign: float) -> tuple[Array, Array]:
        n = len(self.base_points)
        places = np.repeat(position, n, axis=0)
        legs = np.tile(np.arange(n, dtype=np.intp), len(position))
        angles = self._best_node(position, sign).reshape(-1, 3)
        value = sign * self._square(places, legs, angles)
        going = np.arange(len(legs))
        for _ in range(SWEEPS_OVER_ANGLES if len(self.free) > 1 else len(self.free)):
            part, before = angles[going], value[going]
            for axis in self.free:
                value[going] = self._improve(places[going], legs[going], part, axis, sign)
            angles[going] = part
            going = going[value[going] > before + 1e-14 * np.abs(before)]
            if not going.size:
                break
        shape = (len(position), n)
        return np.sqrt(np.maximum(sign * value, 0.0)).reshape(shape), angles.reshape(*shape, 3)

    def _best_node(self, position: Array, sign: float) -> Array:
        """Best angles of a grid over the box, per position and leg: (N, n, 3)."""
        nodes = self._nodes()
        rotation = rotation_from_angles(nodes, self.order)
        arm = self.platform_points @ np.swapaxes(rotation, -1, -2)
        best = np.full((len(position), len(self.base_points)), -np.inf)
        where = np.zeros(best.shape, dtype=np.intp)
        for node in range(len(nodes)):
            d = position[:, None] + arm[node] - self.base_points
            value = sign * (d * d).sum(axis=-1)
            where = np.where(value > best, node, where)
            best = np.maximum(value, best)
        return nodes[where]

    def _nodes(self) -> Array:
        number = NODES_PER_ANGLE if len(self.free) > 1 else 1
        axes = [
            np.linspace(self.least[i], self.greatest[i], number if i in self.free else 1)
            for i in range(3)
        ]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)

    def _improve(
        self, position: Array, leg: NDArray[np.intp], angles: Array, axis: int, sign: float
    ) -> Array:
        """Set one angle of each to its best value in its interval; return the values there."""
        samples = []
        for third in THIRDS:
            at = angles.copy()
            at[..., axis] = third
            samples.append(sign * self._square(position, leg, at))
        f = np.stack(samples)
        b = 2.0 / 3.0 * np.einsum("s,s...->...", np.cos(THIRDS), f)
        c = 2.0 / 3.0 * np.einsum("s,s...->...", np.sin(THIRDS), f)
        least, greatest = self.least[axis], self.greatest[axis]
        top = np.arctan2(c, b)
        top = least + (top - least) % (2.0 * np.pi)
        mean = f.mean(axis=0)

        def value(x: Array | float) -> Array:
            return np.asarray(mean + b * np.cos(x) + c * np.sin(x))

        ends = np.where(value(greatest) > value(least), greatest, least)
        angles[..., axis] = np.where(top <= greatest, top, ends)
        return value(angles[..., axis])
