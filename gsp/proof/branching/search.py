"""Branch and bound over boxes of poses: rounds of compiled searches, on any number of threads."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from gsp.evaluation.scheduling import pool_of, run_all
from gsp.geometry.vectors import Array
from gsp.kernels.stages import LANES
from gsp.proof.branching.problem import Problem
from gsp.proof.branching.refutation import Refuted, refute, refute_at_corners
from gsp.proof.branching.tree import Tree
from gsp.variation.layout import DONE, ENDED, OPEN, SIGN_CHANGED, VIOLATED

# Boxes of the first search, which runs alone, and of each of the later ones.
FIRST_SEARCH_BOXES, SEARCH_BOXES = 20_000, 100_000
# Searches of one round. It does not depend on the number of threads, nor does any result.
SEARCHES_PER_ROUND = 16
# Largest number of open boxes of one search; more end it, and the next round continues with them.
MOST_OPEN_BOXES = 4096


@dataclass(frozen=True, eq=False)
class Found:
    """The result of a search.

    Attributes
    ----------
    tree : Tree
    n_boxes : int
        Boxes that were evaluated.
    ended : int
        DONE, ENDED (the budget), VIOLATED or SIGN_CHANGED.
    quantity : int
        Number of the quantity that is violated, or −1.
    point, other : (6,) arrays or None
        Coordinates that violate a limit; or two with determinants of opposite sign.
    interrupted : bool
        Whether Ctrl-C ended the search.
    """

    tree: Tree
    n_boxes: int
    ended: int
    quantity: int
    point: Array | None
    other: Array | None
    interrupted: bool = False


@dataclass(frozen=True, eq=False)
class _Part:
    """The result of one compiled search."""

    node: int
    ended: int
    stack: Array
    nodes: Any
    marks: Any
    children: Any
    n_boxes: int
    quantity: int
    point: Array
    sign: Array


# Applies a search to the boxes of a round, in order, as `map` does.
Run = Callable[[Callable[[Any], _Part], list[Any]], Iterable[_Part]]


@contextmanager
def runner(workers: int, executor: Executor | None) -> Iterator[Run]:
    """Yield how the searches of a round are run: here, in threads, or by an executor."""
    if executor is not None:
        yield partial(_by_executor, executor)
    elif workers == 1:
        yield map
    else:
        with pool_of(workers) as pool:
            # The first search, which is alone in its round, may compile for a minute. Here an
            # interrupt stops it, in a thread it would be waited for.
            yield lambda function, tasks: (map if len(tasks) == 1 else pool.map)(function, tasks)


def _by_executor(
    executor: Executor, function: Callable[[Any], _Part], tasks: list[Any]
) -> list[_Part]:
    """Apply a function to tasks by an executor, in order; if that fails, in this process."""
    of_numbered = partial(_of_numbered, function)
    done = run_all(of_numbered, enumerate(tasks), len(tasks), executor=executor)
    results = {number: part for (number, _), part in done}
    return [results[number] for number in range(len(tasks))]


def _of_numbered(function: Callable[[Any], _Part], numbered: tuple[int, Any]) -> _Part:
    return function(numbered[1])


def explore(
    problem: Problem,
    frame: Array,
    box: Array,
    budget: int,
    run: Run,
    report: Callable[[int, int], object],
    tree: Tree | None = None,
) -> Found:
    """Decide a box, shape (1, 12); deterministic for any way to run the searches of a round.

    A tree that was left undecided is continued. An interrupt ends the search between two rounds:
    what the rounds before it decided stays.
    """
    n_boxes, sign, begins, interrupted = 0, np.zeros(7), tree is None, True
    tree = Tree() if tree is None else tree
    queue: list[tuple[int, Array]] = tree.open_boxes(box[0])
    with suppress(KeyboardInterrupt):
        if begins:
            # What varies without a turning point is worst at a corner, which boxes reach late.
            end, sign = refute_at_corners(problem, frame, box[0])
            if end is not None:
                return Found(tree, 0, *end)
        while queue and n_boxes < budget:
            some = queue[:SEARCHES_PER_ROUND] if n_boxes else queue[:1]
            left = max(1, (budget - n_boxes) // len(some))
            size = min(left, SEARCH_BOXES if n_boxes else FIRST_SEARCH_BOXES)
            parts = list(run(partial(_search, problem, frame, budget=size, sign=sign), some))
            queue = queue[len(some) :]
            for part in parts:
                n_boxes += part.n_boxes
                start = tree.graft(part.node, part.marks, part.children)
                queue += [
                    (int(k) + start - 1 if k else part.node, b)
                    for k, b in zip(part.nodes, part.stack, strict=True)
                ]
            report(n_boxes, budget)
            end = _refuted(parts, sign)
            if end is None and queue and n_boxes <= FIRST_SEARCH_BOXES + LANES:
                end = refute(problem, frame, box[0], parts[0].sign)
            if end is not None:
                return Found(tree, n_boxes, *end)
            if sign[0] == 0.0:
                sign = next((part.sign for part in parts if part.sign[0] != 0.0), sign)
        interrupted = False
    # A box too small to be halved stays open, and then nothing is proven.
    complete = not queue and not (tree.marks[: tree.size] == OPEN).any()
    return Found(tree, n_boxes, DONE if complete else ENDED, -1, None, None, interrupted)


def _refuted(parts: list[_Part], sign: Array) -> Refuted | None:
    """Return the first refutation of the parts; signs are compared between parts."""
    for part in parts:
        if part.ended == VIOLATED:
            return VIOLATED, part.quantity, part.point, None
        if part.ended == SIGN_CHANGED:
            return SIGN_CHANGED, -1, part.point, part.sign[1:]
        if sign[0] == 0.0:
            sign = part.sign
        elif part.sign[0] not in (0.0, sign[0]):
            return SIGN_CHANGED, -1, part.sign[1:], sign[1:]
    return None


def _search(
    problem: Problem, frame: Array, task: tuple[int, Array], *, budget: int, sign: Array
) -> _Part:
    from gsp.variation.kernel import search  # compiled code loads on first use

    (node, box), sign = task, sign.copy()
    stack, nodes = np.empty((MOST_OPEN_BOXES, 12)), np.zeros(MOST_OPEN_BOXES, dtype=np.int64)
    stack[0] = box
    capacity = 2 * budget + 64
    marks, children = np.full(capacity, OPEN, dtype=np.int8), np.zeros(capacity, dtype=np.int64)
    point = np.zeros(6)
    ended, top, used, n_boxes, quantity = search(
        stack,
        nodes,
        1,
        frame,
        *problem.arguments,
        problem.wanted,
        problem.bounds,
        problem.chosen,
        problem.signed,
        sign,
        marks,
        children,
        1,
        budget,
        point,
    )
    return _Part(
        node,
        ended,
        stack[:top].copy(),
        nodes[:top].copy(),
        marks[:used].copy(),
        children[:used].copy(),
        n_boxes,
        quantity,
        point,
        sign,
    )
