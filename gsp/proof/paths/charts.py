"""Boxes of poses that hold intervals of a path, for the compiled bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.frames import exp3
from gsp.geometry.rotations import nearest_rotations
from gsp.geometry.vectors import Array, cross
from gsp.proof.paths.pieces import Numbers, Pieces
from gsp.proof.paths.series import Series, constant_product

# A chart turns by no more than this [rad], so that its three angles are far from those where two
# of their axes are parallel. Most charts of a piece: beyond, its intervals have wide boxes.
CHART_TURN, CHARTS_PER_PIECE = 0.5, 1024
# Coefficients of series of boxes.
BOX_COEFFICIENTS = 3


@dataclass(frozen=True, eq=False)
class Charts:
    """The pieces in c parts with small turns, each with its frame of angles.

    A rotation of a part is R = E R_c, R_c the rotation at its middle, and E has three angles about
    moving axes, the first of which is that of the turn at the middle.

    Attributes
    ----------
    pieces : Pieces
    piece : (c,) int array
    ends : (c, 2) array
        Ends as number of the piece plus its u.
    left, right : (c, 3, 3) arrays
        In the axes of the frame, E is left exp([v]×) right.
    frames : (c, 18) array
        Axes and R_c, as the compiled code takes them.
    """

    pieces: Pieces
    piece: Numbers
    ends: Array
    left: Array
    right: Array
    frames: Array

    @classmethod
    def of(cls, pieces: Pieces) -> Charts:
        """Return the charts of pieces."""
        powers = np.arange(pieces.turn.shape[1])
        speed = (np.linalg.norm(pieces.turn, axis=2) * powers).sum(axis=1)
        # Numbers of parts are powers of two, so that all ends are exact.
        count = np.minimum(
            2 ** np.ceil(np.log2(np.maximum(speed / CHART_TURN, 1.0))), CHARTS_PER_PIECE
        )
        counts = count.astype(np.int64)
        piece = np.repeat(np.arange(len(pieces)), counts)
        first = np.concatenate([np.arange(n) / n for n in counts])
        ends = piece[:, None] + np.stack((first, first + 1.0 / counts[piece]), axis=1)
        u = Series.variable(ends.mean(axis=1) - piece, np.zeros(len(piece)), 2)
        vector = pieces.vectors(piece, u).mid
        turn, rate = vector[0].T, vector[1].T
        before = pieces.before[piece]
        rotation = nearest_rotations(before @ exp3(turn))
        axes = np.stack([_axes(x) for x in np.einsum("nij,nj->ni", before, rate)])
        return cls(
            pieces=pieces,
            piece=piece,
            ends=ends,
            left=axes @ before,
            right=rotation.swapaxes(1, 2) @ axes.swapaxes(1, 2),
            frames=np.concatenate((axes.reshape(-1, 9), rotation.reshape(-1, 9)), axis=1),
        )

    def boxes(self, chart: Numbers, low: Array, high: Array) -> Array:
        """Boxes (n, 12) of positions and angles that hold intervals of charts."""
        with np.errstate(all="ignore"):
            return self._boxes(chart, low, high)

    def _boxes(self, chart: Numbers, low: Array, high: Array) -> Array:
        n, piece = len(low), self.piece[chart]
        middle, half = 0.5 * (low + high) - piece, 0.5 * (high - low)
        u = Series.variable(
            np.tile(middle, 2), np.concatenate((np.zeros(n), half)), BOX_COEFFICIENTS
        )
        both = np.tile(piece, 2)
        left, right = (np.tile(x[chart], (2, 1, 1)) for x in (self.left, self.right))
        turn = constant_product(left, self.pieces.turned(both, u), right)
        level = (turn[0, 0] * turn[0, 0] + turn[0, 1] * turn[0, 1]).sqrt()
        angles = (
            (-turn[1, 2]).atan2(turn[2, 2]),
            turn[0, 2].atan2(level),
            (-turn[0, 1]).atan2(turn[0, 0]),
        )
        place = self.pieces.places(both, u)
        result = np.empty((n, 12))
        for k, x in enumerate((place[0], place[1], place[2], *angles)):
            result[:, k], result[:, 6 + k] = enclosed(x, half)
        return result


def enclosed(x: Series, half: Array) -> tuple[Array, Array]:
    """Bounds of a function on balls, from its series at their middles and, after it, at the balls.

    Parameters
    ----------
    x : Series, shape (k, ..., 2 n)
    half : (n,) array
        Radii of the balls.
    """
    n = len(half)
    reach = np.abs(x.mid[-1, ..., n:]) + x.rad[-1, ..., n:]
    for k in range(len(x.mid) - 2, 0, -1):
        reach = reach * half + np.abs(x.mid[k, ..., :n]) + x.rad[k, ..., :n]
    reach = (reach * half) * (1.0 + 1e-12) + x.rad[0, ..., :n]
    middle = x.mid[0, ..., :n]
    reach = reach + 2.0**-50 * np.abs(middle)
    # The coefficients at the balls bound the function, too; the only ones where it has a corner.
    plain, wide = x.mid[0, ..., n:], x.rad[0, ..., n:] * (1.0 + 1e-12)
    return np.fmax(middle - reach, plain - wide), np.fmin(middle + reach, plain + wide)


def at_middle(x: Series, n: int) -> tuple[Array, Array]:
    """Bounds of a function at the middles of n balls: see `enclosed`."""
    middle, reach = x.mid[0, ..., :n], x.rad[0, ..., :n]
    reach = reach + 2.0**-50 * np.abs(middle)
    return middle - reach, middle + reach


def _axes(direction: Array) -> Array:
    """Return a right-handed orthonormal frame whose first axis is a direction, if there is one."""
    size = np.linalg.norm(direction)
    if size == 0.0:
        return np.eye(3)
    axes = np.linalg.svd((direction / size)[None])[2]
    axes[0] *= np.sign(axes[0] @ direction)
    axes[2] = cross(axes[0], axes[1])
    return np.asarray(axes)
