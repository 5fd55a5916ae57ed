"""Why `optimise` has no design to return: what the nearest one misses, or what is undefined."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from gsp.errors import apart, expected
from gsp.exploration.optimisation.evaluating import Evaluator
from gsp.exploration.optimisation.goals import CERTIFIED
from gsp.geometry.pose.texts import pose_text
from gsp.limits import Limits, feasible
from gsp.model.design import Design
from gsp.ranking.restrictions import FEASIBLE


def none_meets(evaluator: Evaluator, nearest: int) -> str:
    """Return the message where no design satisfies all bounds, with what the nearest one misses.

    Parameters
    ----------
    evaluator : Evaluator
    nearest : int
        Number of the evaluated design that violates the bounds least.
    """
    rows = evaluator.rows
    row, given = rows[nearest], _parameters(evaluator, rows[nearest])
    wanted = f"a space and bounds that a design of {len(rows)} satisfies"
    missed = "; ".join(_missed(evaluator, row))
    return expected("optimise", wanted, f"none; the nearest is {given}: {missed}")


def _missed(evaluator: Evaluator, row: Mapping[str, Any]) -> list[str]:
    if "error" in row:
        return [str(row["error"])]
    goals, texts = evaluator.goals, evaluator.goals.missed(row)
    limits = goals.task.limits
    if limits is not None and not row[FEASIBLE] >= goals.feasible:
        got, least = apart(100.0 * float(row[FEASIBLE]), 100.0 * goals.feasible)
        design = evaluator.space.design(**_parameters(evaluator, row))
        worst = _worst_violation(evaluator, design, limits)
        texts.append(f"{got} % of the poses are within the limits, of {least} % required{worst}")
    if not texts and goals.certify and not row.get(CERTIFIED, False):
        texts.append("it is not proven regular and within the limits over the box of the task")
    return texts


def _worst_violation(evaluator: Evaluator, design: Design, limits: Limits) -> str:
    """Return the limit that is passed by the greatest share of its bound, and where."""
    poses = evaluator.goals.task.pose()
    found = feasible(design, poses, limits)
    bounds = np.stack((found.low, found.high), axis=-1)
    sizes = np.where(np.isfinite(bounds) & (bounds != 0.0), np.abs(bounds), 1.0)
    with np.errstate(invalid="ignore"):  # of values that are infinite, as their bound may be
        passed = np.abs(found.values[..., None] - bounds) / sizes
    passed = np.where(found.violated, np.where(np.isnan(passed), np.inf, passed), -1.0)
    i, quantity, side = np.unravel_index(int(passed.argmax()), passed.shape)
    value, name = float(found.values[i, quantity]), found.names[quantity]
    where = pose_text(poses[int(i)], design.unit, design.rms_radius)
    if np.isnan(value):
        return f" ({name} is not defined at {where})"
    got, bound = apart(value, float(bounds[quantity, side]))
    return f" (the farthest: {name} = {got} {'<>'[int(side)]} {bound} at {where})"


def none_has_value(evaluator: Evaluator) -> str:
    """Return the message where something wanted is undefined for all designs that are accepted."""
    goals, rows = evaluator.goals, evaluator.rows
    accepted = [row for row in rows if goals.violation(row) == 0.0]
    some = f", which are those of {len(rows)} that satisfy all bounds"
    tried = f"all {len(accepted)} designs" + (some if len(accepted) < len(rows) else "")
    first = accepted[0]
    what = " and ".join(goals.without_value(first))
    given = _parameters(evaluator, first)
    got = (
        f"none: undefined for {tried}; {what} of the first, {given}: {_undefined(evaluator, first)}"
    )
    labels = " and ".join(wish.label for wish in goals.task.wanted)
    return expected("optimise", f"a space with a design that has a value of {labels}", got)


def _undefined(evaluator: Evaluator, row: Mapping[str, Any]) -> str:
    """Return why a design has no value."""
    if row.get(FEASIBLE, 1.0) == 0.0:
        return "no pose is within the limits"
    design = evaluator.space.design(**_parameters(evaluator, row))
    posture = design.at(evaluator.goals.task.pose())
    for entry in posture.undefined:
        return f"{entry.joint} is not defined: {entry.reason}"
    return "all poses are singular" if posture.singular().all() else "it is undefined at all poses"


def _parameters(evaluator: Evaluator, row: Mapping[str, Any]) -> dict[str, Any]:
    return {name: row.get(name) for name in evaluator.space.names}
