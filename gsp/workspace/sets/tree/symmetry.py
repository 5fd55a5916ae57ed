"""Mirror planes of the positions that SPS legs reach with some orientation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.rotations import congruences
from gsp.geometry.vectors import Array
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.tree.growing import Leaves

# Anchors and strokes are mirrored if they agree to this share of the size of the design. Squared
# lengths then differ by less than bounds are widened for rounding.
MIRROR_TOLERANCE = 1e-13


def mirror_planes(problem: Bounded) -> list[tuple[int, float]]:
    """Return axes of the frame, and coordinates, of planes that map the positions to themselves.

    A plane mirrors the base anchors, and a congruence of the platform, which turns it over, moves
    the platform anchors in the same order; strokes agree. All orientations count, so the mirrored
    position is reached too.
    """
    if not (problem.only_spheres and problem.free) or len(problem.half_spaces):
        return []
    planes = []
    for k in range(3):
        middle = 0.5 * (problem.legs[:, k].min() + problem.legs[:, k].max())
        centred = abs(problem.low[k] + problem.high[k] - 2.0 * middle)
        wide = problem.high[k] - problem.low[k]
        if wide > 0.0 and centred <= 1e-9 * wide and _mirrored(problem.legs, k, middle):
            planes.append((k, middle))
    return planes


def _mirrored(legs: Array, k: int, middle: float) -> bool:
    size = float(np.abs(legs[np.isfinite(legs)]).max())
    image = legs[:, :3].copy()
    image[:, k] = 2.0 * middle - image[:, k]
    strokes, near = legs[:, 7:], MIRROR_TOLERANCE * size
    fits = np.abs(image[:, None] - legs[None, :, :3]).max(axis=2) <= near
    with np.errstate(invalid="ignore"):
        apart = np.abs(strokes[:, None] - strokes[None]).max(axis=2)
    fits &= ~(apart > near) & (np.isinf(strokes)[:, None] == np.isinf(strokes)[None]).all(axis=2)
    return _ordered(legs[:, 3:6], fits, near, ())


def _ordered(arms: Array, fits: NDArray[np.bool_], near: float, order: tuple[int, ...]) -> bool:
    """Whether some order of the legs, begun with `order`, fits base and platform."""
    n = len(order)
    if n == len(arms):
        return _turned_over(arms, arms[list(order)], near)
    for j in range(len(arms)):
        if j in order or not fits[n, j]:
            continue
        now = [*order, j]
        # A congruence keeps inner products; this ends most orders after two or three legs.
        same = np.abs(arms[: n + 1] @ arms[n] - arms[now] @ arms[j]).max()
        if same <= 4.0 * near * (1.0 + np.abs(arms).max()) and _ordered(
            arms, fits, near, tuple(now)
        ):
            return True
    return False


def _turned_over(arms: Array, images: Array, near: float) -> bool:
    """Whether a congruence of determinant −1 moves platform anchors to others."""
    q = min(congruences(arms, images), key=np.linalg.det)
    return bool(np.abs(arms @ q.T - images).max() <= near)


def unfolded(leaves: Leaves, planes: list[tuple[int, float]]) -> Leaves:
    """Return leaves on one side of mirror planes together with their images."""
    low, high, codes, cuts = leaves.low, leaves.high, leaves.codes, leaves.cuts
    for k, middle in planes:
        first, last, other = low.copy(), high.copy(), cuts.copy()
        first[:, k], last[:, k] = 2.0 * middle - high[:, k], 2.0 * middle - low[:, k]
        other[:, [k, 4 + k]] *= -1.0
        low, high = np.concatenate((low, first)), np.concatenate((high, last))
        codes, cuts = np.concatenate((codes, codes)), np.concatenate((cuts, other))
    return Leaves(low, high, codes, cuts, leaves.levels + len(planes), leaves.nodes)
