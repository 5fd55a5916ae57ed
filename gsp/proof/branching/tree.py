"""The tree of halved boxes: decided and open boxes, and shares of the volume."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.variation.layout import OPEN, PROVEN

Codes = NDArray[np.int8]
Numbers = NDArray[np.int64]


class Tree:
    """Boxes by number: the mark of each, and the number of its first half; the second follows.

    The first box is number 0. A box that is not decided is marked OPEN.
    """

    def __init__(self) -> None:
        self.marks: Codes = np.full(1, OPEN, dtype=np.int8)
        self.children: Numbers = np.zeros(1, dtype=np.int64)
        self.size = 1

    @classmethod
    def of(cls, marks: Codes) -> Tree:
        """Return the tree of marks in preorder."""
        tree = cls()
        tree.marks, tree.children = np.full_like(marks, OPEN), np.zeros(len(marks), dtype=np.int64)
        waiting = [0]
        for mark in marks.tolist():
            node = waiting.pop()
            tree.marks[node] = mark
            if mark < PROVEN:
                tree.children[node] = tree.size
                waiting += [tree.size + 1, tree.size]
                tree.size += 2
        return tree

    def open_boxes(self, box: Array) -> list[tuple[int, Array]]:
        """Return the open boxes, shape (12,) each, with their numbers, in preorder."""
        result, waiting = [], [(0, box)]
        while waiting:
            node, here = waiting.pop()
            mark = int(self.marks[node])
            if mark == OPEN:
                result.append((node, here))
            if mark >= PROVEN:
                continue
            first, second = here.copy(), here.copy()
            first[6 + mark] = second[mark] = 0.5 * (here[mark] + here[6 + mark])
            start = int(self.children[node])
            waiting += [(start + 1, second), (start, first)]
        return result

    def graft(self, node: int, marks: Codes, children: Numbers) -> int:
        """Put the tree of a search in the place of an open box; return where its boxes start.

        Box k > 0 of the search becomes box start + k − 1.
        """
        start, more = self.size, len(marks) - 1
        while len(self.marks) < start + more:
            self.marks = np.concatenate((self.marks, np.full_like(self.marks, OPEN)))
            self.children = np.concatenate((self.children, np.zeros_like(self.children)))
        moved = children + (start - 1)
        self.marks[start : start + more] = marks[1:]
        self.children[start : start + more] = moved[1:]
        self.size, self.children[node] = start + more, moved[0]
        # The box is open until all else is there: an interrupt may come in between.
        self.marks[node] = marks[0]
        return start

    def preorder(self) -> Codes:
        """Return the marks of all boxes, each before its halves: the first half comes first."""
        result = np.empty(self.size, dtype=np.int8)
        waiting, place = [0], 0
        marks, children = self.marks[: self.size].tolist(), self.children[: self.size].tolist()
        while waiting:
            node = waiting.pop()
            result[place] = marks[node]
            place += 1
            if marks[node] < PROVEN:
                waiting += [children[node] + 1, children[node]]
        return result[:place]


def is_complete(marks: Codes) -> bool:
    """Whether marks in preorder are those of a whole tree."""
    waiting = 1
    for mark in marks.tolist():
        if waiting == 0 or not 0 <= mark <= OPEN:
            return False
        waiting += 1 if mark < PROVEN else -1
    return waiting == 0


def leaves(marks: Codes, low: Array, high: Array) -> tuple[Array, Array, Codes, Array]:
    """Return the boxes that are not halved: low (m, 6), high (m, 6), marks (m,), shares (m,).

    Parameters
    ----------
    marks : (n,) int8 array
        A tree in preorder: 0 … 5 is the coordinate that is halved, at 0.5 * (low + high).
    low, high : (6,) arrays
        The first box.
    """
    lows, highs, kinds, shares = [], [], [], []
    waiting = [(low.tolist(), high.tolist(), 1.0)]
    for mark in marks.tolist():
        least, most, share = waiting.pop()
        if mark >= PROVEN:
            lows.append(least)
            highs.append(most)
            kinds.append(mark)
            shares.append(share)
            continue
        middle = 0.5 * (least[mark] + most[mark])
        first, second = most.copy(), least.copy()
        first[mark] = second[mark] = middle
        waiting += [(second, most, 0.5 * share), (least, first, 0.5 * share)]
    shape = (len(kinds), 6)
    return (
        np.array(lows).reshape(shape),
        np.array(highs).reshape(shape),
        np.array(kinds, dtype=np.int8),
        np.array(shares),
    )


def proven_share(marks: Codes) -> float:
    """Return the share of the volume in proven boxes, of a tree in preorder."""
    depths: list[int] = []
    waiting = [0]
    for mark in marks.tolist():
        depth = waiting.pop()
        if mark < PROVEN:
            waiting += [depth + 1, depth + 1]
        elif mark == PROVEN:
            depths.append(depth)
    # Halves are exact in binary, so the sum of all shares is exactly 1.
    return float(np.sum(np.exp2(-np.array(depths, dtype=np.float64))))
