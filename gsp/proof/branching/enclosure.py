"""Bounds of all quantities over boxes, without a search."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.proof.branching.problem import Problem
from gsp.variation.layout import POSITION, SCREEN


def enclose(problem: Problem, frame: Array, boxes: Array) -> tuple[Array, Array]:
    """Bound all quantities on boxes (n, 12): (n, quantities, 10), and signs of det J (n,)."""
    from gsp.variation.kernel import enclose_boxes

    out = np.empty((len(boxes), len(problem.named), 10))
    signs = np.zeros(len(boxes))
    wanted = (problem.wanted | POSITION) & ~SCREEN
    enclose_boxes(np.ascontiguousarray(boxes), frame, *problem.arguments, wanted, out, signs)
    return out, signs
