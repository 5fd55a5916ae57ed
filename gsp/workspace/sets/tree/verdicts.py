"""Decisions on cells of positions and rotations, for any limits."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.proof.branching.enclosure import enclose
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes
from gsp.workspace.sets.problem import Bounded, inside_half_spaces


def verdicts(problem: Bounded, low: Array, high: Array, rotations: Array) -> Codes:
    """Decide cells of positions and rotations: −1 if no pose is feasible, 1 if all are, else 0."""
    from gsp.workspace.sets.compiled.cells import clear_verdicts, sphere_verdicts

    codes = np.ones(len(low), dtype=np.int8)
    if not len(low):
        return codes
    # Arrays of one memory layout, so that one version of each function is compiled.
    low, high, rotations = (np.array(x, order="C") for x in (low, high, rotations))
    sphere_verdicts(low, high, rotations, problem.legs, problem.turns, codes)
    codes = _both(codes, inside_half_spaces(problem.half_spaces, low, high))
    if len(problem.pairs):
        clear = np.empty(len(low), dtype=np.int8)
        clear_verdicts(
            low,
            high,
            rotations,
            problem.legs,
            problem.turns,
            problem.pairs,
            problem.clearance,
            clear,
        )
        codes = _both(codes, clear)
    # These bounds take longest, so only cells that nothing else excludes get there.
    if problem.proof is not None:
        open_ = np.flatnonzero(codes >= 0)
        codes[open_] = _both(
            codes[open_], _enclosed(problem, low[open_], high[open_], rotations[open_])
        )
    # A limit without bounds may be violated anywhere: nothing is inside, but what violates another
    # limit is outside still.
    return np.minimum(codes, UNDECIDED).astype(np.int8) if problem.unbounded_limits else codes


def _both(one: Codes, other: Codes) -> Codes:
    return np.asarray(np.minimum(one, other), dtype=np.int8)


def _enclosed(problem: Bounded, low: Array, high: Array, rotations: Array) -> Codes:
    proof = problem.proof
    assert proof is not None
    boxes = np.concatenate((low, rotations[:, :3], high, rotations[:, 3:]), axis=1)
    with np.errstate(all="ignore"):
        bounds, _ = enclose(proof, problem.turns.flatten(), boxes)
    least, most = bounds[:, proof.chosen, 0], bounds[:, proof.chosen, 1]
    below, above = proof.low[proof.chosen], proof.high[proof.chosen]
    within = ((least >= below) & (most <= above)).all(axis=1)
    beyond = ((most < below) | (least > above)).any(axis=1)
    return np.where(beyond, OUTSIDE, np.where(within, INSIDE, UNDECIDED)).astype(np.int8)
