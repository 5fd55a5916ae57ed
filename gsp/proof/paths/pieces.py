"""The pieces of a path as polynomials, or screws, and their series."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.frames import exp3, log3
from gsp.geometry.frames.screws import screw_velocity
from gsp.geometry.pose import Pose, PosePath
from gsp.geometry.scalars import cross, plus, times
from gsp.geometry.vectors import EPS, Array
from gsp.proof.paths.series import SUM_ROUNDING, Series, constant_product

Numbers = NDArray[np.int64]
Motion = Literal["straight", "screw", "spline"]
# Coefficients of the functions of the angle in exp: sin θ/θ, (1 − cos θ)/θ², (θ − sin θ)/θ³.
TURNING_SINE, TURNING_COSINE, TURNING_REST = 1, 2, 3
# Change of a rate at a node that counts as rounding, relative to the greatest rate of the path.
CORNER_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class Pieces:
    """The n pieces of a path; each runs over 0 ≤ u ≤ 1.

    With v = Σ_j turn[j] uʲ, the pose is R = before exp([v]×) and
    p = Σ_j position[j] uʲ + before G(v) u slide, G(v) = ∫₀¹ exp(y [v]×) dy. Screws slide.

    Attributes
    ----------
    ends : (n + 1,) array [time, or 1]
        Parameters at the ends of the pieces.
    position, turn : (n, k, 3) arrays [length, rad]
    before : (n, 3, 3) array
    slide : (n, 3) array [length]
    margin : (n,) array [length]
        To within which the position is known.
    slack : float [rad]
        To within which rotation vectors are known, besides rounding.
    """

    ends: Array
    position: Array
    turn: Array
    before: Array
    slide: Array
    margin: Array
    slack: float

    def __len__(self) -> int:
        return len(self.before)

    @property
    def span(self) -> Array:
        """Lengths of the pieces [time, or 1]."""
        return np.diff(self.ends)

    def turned(self, piece: Numbers, u: Series) -> Series:
        """Matrices exp([v]×) at balls of u: a series of shape (k, 3, 3, n)."""
        return _exponential(self.vectors(piece, u))

    def vectors(self, piece: Numbers, u: Series) -> Series:
        """Rotation vectors v at balls of u: a series of shape (k, 3, n)."""
        return _polynomial(self.turn[piece], u, self.slack)

    def places(self, piece: Numbers, u: Series) -> Series:
        """Positions at balls of u: a series of shape (k, 3, n)."""
        place = _polynomial(self.position[piece], u, self.margin[piece])
        if not self.slide.any():
            return place
        size, v = len(u.mid), _split(self.vectors(piece, u))
        slide = self.slide[piece].T
        step = [u * Series.constant(x, SUM_ROUNDING * np.abs(x), size) for x in slide]
        square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
        around = cross(v, step)
        moved = plus(
            plus(step, times(square.turning(TURNING_COSINE), around)),
            times(square.turning(TURNING_REST), cross(v, around)),
        )
        before = self.before[piece]
        for i in range(3):
            parts = [
                moved[j] * Series.constant(before[:, i, j], SUM_ROUNDING, size) for j in range(3)
            ]
            total = parts[0] + parts[1] + parts[2]
            place.mid[:, i] += total.mid
            place.rad[:, i] += total.rad + SUM_ROUNDING * np.abs(place.mid[:, i])
        return place

    def rotations(self, piece: Numbers, u: Series) -> Series:
        """Rotations R at balls of u: a series of shape (k, 3, 3, n)."""
        right = np.broadcast_to(np.eye(3), (len(piece), 3, 3))
        return constant_product(self.before[piece], self.turned(piece, u), right)

    def pose(self, parameter: float) -> Pose:
        """Return the pose at a number of a piece plus its u."""
        i = min(int(parameter), len(self) - 1)
        some = np.array([i])
        u = Series.variable(np.array([parameter - i]), np.zeros(1), 2)
        vector = self.vectors(some, u).mid[0, :, 0]
        return Pose(self.places(some, u).mid[0, :, 0], self.before[i] @ exp3(vector))

    def time(self, parameter: Array) -> Array:
        """Return the times of numbers of a piece plus its u."""
        i = np.minimum(parameter.astype(np.int64), len(self) - 1)
        share = parameter - i
        return np.asarray((1.0 - share) * self.ends[i] + share * self.ends[i + 1])

    def record(self) -> dict[str, Any]:
        """Return the pieces as plain numbers, for certificates."""
        return {
            "times": self.ends.tolist(),
            "position": self.position.tolist(),
            "turn": self.turn.tolist(),
            "rotation": self.before.tolist(),
            "slide": self.slide.tolist(),
            "margin": self.margin.tolist(),
            "slack": float(self.slack),
        }

    def corner(self) -> int | None:
        """Return the number of the first node where the velocity jumps, or None."""
        n = len(self)
        rates = []
        for u in (0.0, 1.0):
            x = Series.variable(np.full(n, u), np.zeros(n), 2)
            some = np.arange(n)
            place, turn = self.places(some, x).mid[1], self.rotations(some, x).mid[1].reshape(9, n)
            rates.append((place / self.span, turn / self.span))
        jumps = np.zeros(n - 1, dtype=bool)
        for start, end in zip(*rates, strict=True):
            most = max(np.abs(start).max(), np.abs(end).max())
            jumps |= (np.abs(start[:, 1:] - end[:, :-1]) > CORNER_TOLERANCE * most).any(axis=0)
        return int(jumps.argmax()) + 1 if jumps.any() else None


def _polynomial(coefficients: Array, u: Series, margin: Array | float) -> Series:
    """Series of polynomials with coefficients (n, k, 3), which are rounded: shape (·, 3, n)."""
    size, x = len(u.mid), u[None]
    parts = [
        Series.constant(c, SUM_ROUNDING * np.abs(c), size) for c in coefficients.transpose(1, 2, 0)
    ]
    parts[0].rad[0] += margin
    total = parts[-1]
    for part in parts[-2::-1]:
        total = total * x + part
    return total


def _split(x: Series) -> list[Series]:
    """Components of a series of vectors."""
    return [x[i] for i in range(3)]


def _exponential(vector: Series) -> Series:
    """exp([v]×) = (1 − B |v|²) I + A [v]× + B v vᵀ."""
    v = _split(vector)
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    b = square.turning(TURNING_COSINE)
    sines, cosine = times(square.turning(TURNING_SINE), v), 1.0 - b * square
    scaled = times(b, v)
    rows = [[scaled[i] * v[j] for j in range(3)] for i in range(3)]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        rows[i][i] = rows[i][i] + cosine
        rows[k][j] = rows[k][j] + sines[i]
        rows[j][k] = rows[j][k] - sines[i]
    return Series(
        *(
            np.stack([np.stack([getattr(x, name) for x in row], axis=1) for row in rows], axis=1)
            for name in ("mid", "rad")
        )
    )


def pieces_of_nodes(poses: Pose, ends: Array, motion: str) -> Pieces:
    """Return straight lines with slerp, or screws, between nodes.

    Raises
    ------
    InvalidInput
        If two neighbours differ by a turn of π.
    """
    first, last = poses.rotation[:-1], poses.rotation[1:]
    # In platform axes: R exp(v) is the same as exp(R v) R.
    vector = log3(first.swapaxes(-1, -2) @ last)
    angle = np.linalg.norm(vector, axis=-1)
    if (angle > np.pi - 1e-9).any():
        i = int((angle > np.pi - 1e-9).argmax())
        where = f"between poses {i} and {i + 1}"
        raise InvalidInput(expected("poses", "turns of less than π", brief(float(angle[i])), where))
    start, step = poses.position[:-1], np.diff(poses.position, axis=0)
    size = np.abs(poses.position[:-1]).max(axis=1) + np.abs(poses.position[1:]).max(axis=1)
    slide = np.zeros_like(step)
    if motion == "screw":
        slide = screw_velocity(vector, np.einsum("nji,nj->ni", first, step))
        step = np.zeros_like(step)
    return Pieces(
        ends=ends,
        position=np.stack((start, step), axis=1),
        turn=np.stack((np.zeros_like(vector), vector), axis=1),
        before=first,
        slide=slide,
        margin=64.0 * EPS * size,
        slack=16.0 * EPS,
    )


def pieces_of_path(path: PosePath) -> Pieces:
    """Return the pieces of a path, each over 0 ≤ u ≤ 1."""
    span = np.diff(path.times)[:, None, None]

    def scaled(coefficients: Array) -> Array:
        return np.asarray(coefficients * span ** np.arange(coefficients.shape[1])[:, None])

    n = len(path)
    return Pieces(
        ends=path.times,
        position=scaled(path.position),
        turn=scaled(path.turn),
        before=path.rotation,
        slide=np.zeros((n, 3)),
        margin=np.zeros(n),
        slack=0.0,
    )
