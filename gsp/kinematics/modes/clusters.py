"""Clusters of solutions that paths do not tell apart: which solutions they stand for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.beside import beside, size, within
from gsp.kinematics.modes.equations import Complex, Layout, coordinates

# Distance below which two multiple solutions are one: of paths that were left early, and this power
# of what was left of others, or of the least that counts.
SAME_MULTIPLE, SAME_POWER, LEAST_REST = 1e-2, 0.25, 1e-15
# Distance from a cluster that is not told apart within which solutions may be of it.
CLUSTER_REACH = 1e-4


def clustered(poses: Complex, left: Array) -> tuple[Complex, NDArray[np.int64]]:
    """Return the first pose of each cluster, and the numbers of poses.

    `left`: shares of the line that were left at the poses (m, 7).
    """
    points, waiting = coordinates(poses), np.ones(len(poses), dtype=bool)
    reach = np.minimum(np.maximum(left, LEAST_REST) ** SAME_POWER, SAME_MULTIPLE)
    kept, numbers = [], []
    for i in np.argsort(-left, kind="stable"):
        if waiting[i]:
            apart = np.abs(points - points[i]).max(axis=1)
            near = waiting & (apart < reach[i] * max(1.0, np.abs(points[i]).max()))
            waiting[near] = False
            kept.append(poses[i])
            numbers.append(near.sum())
    return np.array(kept).reshape(-1, 7), np.array(numbers, dtype=np.int64)


class Apart(NamedTuple):
    """Solutions, once those beside each other are told apart.

    Attributes
    ----------
    regular : (n, 7) complex array
    beside : (n,) bool array
        Which of them were told apart; of these the real ones have no imaginary parts.
    clusters : (m, 7) complex array
        Multiple ones.
    numbers : (m,) int array
    """

    regular: Complex
    beside: NDArray[np.bool_]
    clusters: Complex
    numbers: NDArray[np.int64]


def told_apart(
    layout: Layout,
    parameters: Complex,
    regular: Complex,
    others: NDArray[np.bool_],
    clusters: Complex,
    numbers: NDArray[np.int64],
) -> Apart:
    """Return solutions with those beside nearly singular ones in the place of these.

    Of a cluster that is not told apart, paths from other general systems may have come to single
    solutions: it stands for so many less.

    Parameters
    ----------
    layout : Layout
    parameters : (6, 13) complex array
    regular : (n, 7) complex array
    others : (n,) bool array
        Which were not found from the general system of the clusters.
    clusters : (m, 7) complex array
    numbers : (m,) int array
        How many paths ended at each.
    """
    found: list[Complex] = []
    multiple: list[tuple[Complex, int]] = []
    open_ = np.ones(len(clusters), dtype=bool)
    dropped = np.zeros(len(regular), dtype=bool)
    groups = [beside(layout, parameters, centre) for centre in clusters]
    for here in sorted(filter(None, groups), key=lambda group: -group.numbers.sum()):
        inside, replaced = open_ & here.has(clusters), ~dropped & here.has(regular)
        if here.numbers.sum() < numbers[inside].sum() + (replaced & ~others).sum():
            continue  # some of them are not on this curve
        if not inside.any():
            continue
        open_ &= ~inside
        dropped |= replaced
        for pose, number in zip(here.poses, here.numbers, strict=True):
            if number == 1:
                found.append(pose)
            else:
                multiple.append((pose, int(number)))
    for i in np.flatnonzero(open_):
        reach = CLUSTER_REACH * size(clusters[i])
        single = others & ~dropped & within(regular, clusters[i], reach)
        if single.sum() < numbers[i]:
            multiple.append((clusters[i], int(numbers[i] - single.sum())))
    ends = np.array(found, dtype=np.complex128).reshape(-1, 7)
    both = np.vstack((regular[~dropped], ends))
    return Apart(
        both,
        np.arange(len(both)) >= len(both) - len(ends),
        np.array([pose for pose, _ in multiple], dtype=np.complex128).reshape(-1, 7),
        np.array([number for _, number in multiple], dtype=np.int64),
    )
