"""Places of labels that do not cover each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.geometry.vectors import Array


def free_places(
    candidates: Sequence[Array], sizes: Array, taken: Array, costs: Sequence[Array]
) -> list[Array]:
    """Return the centres of labels, each chosen from its candidates, in turn.

    The first of those with the least sum of overlaps with what is there already and of its cost.

    Parameters
    ----------
    candidates : n arrays (k, 2) [any length]
        Centres, the preferred ones first.
    sizes : (n, 2) array [the same]
        Width and height of the labels.
    taken : (m, 4) array [the same]
        Boxes to avoid: left, bottom, right, top.
    costs : n arrays (k,) [its square]
        Of each candidate, compared with areas of overlap.
    """
    found = []
    for places, size, cost in zip(candidates, sizes, costs, strict=True):
        boxes = np.concatenate((places - 0.5 * size, places + 0.5 * size), axis=1)
        ends = np.minimum(boxes[:, None, 2:], taken[:, 2:])
        starts = np.maximum(boxes[:, None, :2], taken[:, :2])
        common = np.prod(np.maximum(ends - starts, 0.0), axis=-1).sum(axis=-1)
        best = int((common + cost).argmin())
        taken = np.concatenate((taken, boxes[best : best + 1]))
        found.append(places[best])
    return found
