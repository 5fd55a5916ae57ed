"""Two solutions that are so near to each other that paths to them end at a single pose.

Near joint values of a singular pose two solutions x ± s v differ along the motion v that is hardly
controlled. Their distance is the root of what the joint values differ by.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.equations import Complex, Layout, coordinates, linear, refined

# Share of the smallest singular value of a solution that may have another one beside it, of
# equations and unknowns in their own scales.
PAIRED_SHARE = 1e-5
# Distances of two solutions, as shares of the size of the pose, that are told apart here. Nearer
# ones are one double solution, as the rounding of joint values of a singular pose has this effect;
# those farther apart have paths of their own.
LEAST_GAP, MOST_GAP = 3e-7, 1e-3
# Step of the second derivative, Newton steps to the middle of a pair, and shares of singular values
# that these leave out.
BENDING_STEP, MIDDLE_STEPS, MIDDLE_RCOND = 1e-4, 6, 1e-4
# Imaginary part of a real solution at most, as a share of the distance of the two.
REAL_SHARE = 0.1


class Pair(NamedTuple):
    """Two solutions beside each other.

    Attributes
    ----------
    poses : (2, 7) complex array
        Without imaginary parts if they are real.
    gap : float
        Their distance, of rotations and positions.
    real : bool
    """

    poses: Complex
    gap: float
    real: bool


def pair_at(layout: Layout, parameters: Complex, pose: Complex) -> Pair | None:
    """Return the two solutions beside a pose (7,), None if they are not told apart there.

    From the middle, where all components of the residual but one vanish, that one is r + σ t +
    κ t² / 2 along the motion v: its two roots are refined by Newton's method.
    """
    middle = _middle(layout, parameters, pose)
    error, slopes = linear(layout, parameters, middle[None])
    if not np.isfinite(slopes).all():
        return None
    left, values, right = np.linalg.svd(slopes[0])
    along, across = right[-1].conj(), left[:, -1].conj()
    h = BENDING_STEP
    both = np.stack((middle + h * along, middle - h * along))
    ahead, behind = linear(layout, parameters, both)[1]
    curvature = across @ ((ahead - behind) / (2.0 * h)) @ along
    if abs(curvature) <= np.finfo(float).tiny:
        return None
    root = np.sqrt(values[-1] ** 2 - 2.0 * curvature * (across @ error[0]))
    steps = (np.array([root, -root]) - values[-1]) / curvature
    poses, last = refined(layout, parameters, middle + steps[:, None] * along)
    return _checked(poses, last)


def _middle(layout: Layout, parameters: Complex, pose: Complex) -> Complex:
    """Return the pose where all components of the residual but the least controlled one vanish."""
    middle = pose.copy()
    for _ in range(MIDDLE_STEPS):
        error, slopes = linear(layout, parameters, middle[None])
        if not np.isfinite(slopes).all():
            break
        middle -= np.linalg.pinv(slopes[0], rcond=MIDDLE_RCOND) @ error[0]
    return middle


def _checked(poses: Complex, last: NDArray[np.float64]) -> Pair | None:
    """Return two poses as a pair if Newton's method has converged to each of them."""
    if not np.isfinite(poses).all():
        return None
    points = coordinates(poses)
    size, gap = float(np.abs(points).max()), float(np.abs(points[1] - points[0]).max())
    settled = (last * np.abs(poses).max(axis=1) < REAL_SHARE * gap).all()
    if not (settled and LEAST_GAP * size < gap < MOST_GAP * size):
        return None
    real = bool((np.abs(poses.imag).max(axis=1) < REAL_SHARE * gap).all())
    return Pair(poses.real.astype(np.complex128) if real else poses, gap, real)


class Apart(NamedTuple):
    """Regular solutions and clusters of singular ones, once pairs are told apart.

    Attributes
    ----------
    regular : (n, 7) complex array
    paired : (n,) bool array
        Which of them are of a pair; of these the real ones have no imaginary parts.
    clusters : (m, 7) complex array
    numbers : (m,) int array
    """

    regular: Complex
    paired: NDArray[np.bool_]
    clusters: Complex
    numbers: NDArray[np.int64]


def told_apart(
    layout: Layout,
    parameters: Complex,
    regular: Complex,
    shares: Array,
    clusters: Complex,
    numbers: NDArray[np.int64],
) -> Apart:
    """Return solutions with pairs in the place of clusters of at most two, and of single ones.

    A cluster that is not told apart takes the regular solutions beside it: they are the same
    multiple one.

    Parameters
    ----------
    layout : Layout
    parameters : (6, 13) complex array
    regular : (n, 7) complex array
    shares : (n,) array [1]
        Their smallest singular values, of the largest ones.
    clusters : (m, 7) complex array
    numbers : (m,) int array
        How many paths ended at each.
    """
    alone = np.flatnonzero(shares < PAIRED_SHARE)
    if not len(clusters) and not alone.size:
        return Apart(regular, np.zeros(len(regular), dtype=bool), clusters, numbers)
    pairs: list[Pair] = []
    points, dropped = coordinates(regular), np.zeros(len(regular), dtype=bool)
    kept, counts = np.ones(len(clusters), dtype=bool), numbers.copy()
    for i, centre in enumerate(clusters):
        pair = pair_at(layout, parameters, centre) if numbers[i] <= 2 else None
        if pair is not None:
            kept[i] = False
            _add(pairs, pair)
            continue
        here = coordinates(centre[None])[0]
        same = np.abs(points - here).max(axis=1, initial=0.0) < MOST_GAP * np.abs(here).max()
        same &= (shares < PAIRED_SHARE) & ~dropped
        counts[i] = max(int(numbers[i]), 2) if same.any() and numbers[i] <= 2 else numbers[i]
        dropped |= same
    for i in alone[~dropped[alone]]:
        pair = pair_at(layout, parameters, regular[i])
        if pair is not None:
            _add(pairs, pair)
    for pair in pairs:
        ends = coordinates(pair.poses)
        apart = np.abs(points[:, None] - ends).max(axis=2).min(axis=1, initial=np.inf)
        dropped |= apart < 0.5 * pair.gap
    found = np.vstack([regular[~dropped], *(pair.poses for pair in pairs)])
    paired = np.arange(len(found)) >= len(found) - 2 * len(pairs)
    return Apart(found, paired, clusters[kept], counts[kept])


def _add(pairs: list[Pair], pair: Pair) -> None:
    """Add a pair unless it is there already, as found from its other member."""
    ends = coordinates(pair.poses)
    for other in pairs:
        apart = np.abs(coordinates(other.poses)[:, None] - ends).max(axis=2)
        if apart.min() < 0.5 * max(pair.gap, other.gap):
            return
    pairs.append(pair)
