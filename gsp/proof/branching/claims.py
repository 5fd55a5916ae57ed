"""What certificates state: requirements as plain numbers, values, the reason of a refutation."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.errors import apart
from gsp.evaluation import evaluate
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.proof.branching.problem import Problem
from gsp.proof.tolerances import Tolerances


def claims_of(
    design: Design, problem: Problem | None, *, regular: bool, tolerances: Tolerances | None
) -> dict[str, Any]:
    """Return what is required as plain numbers: bounds of named quantities, None for none."""
    given = Tolerances() if tolerances is None else tolerances
    none = np.zeros((design.n_legs, 2, 3))
    return {
        "regular": regular,
        "length": 1.0 if problem is None else problem.length,
        "bounds": {} if problem is None else problem.claims,
        "axes": (none if problem is None else problem.axes).tolist(),
        "ellipsoid": None if problem is None else _ellipsoid_record(problem.ellipsoid),
        "tolerances": given.of_legs(design).tolist(),
    }


def _ellipsoid_record(ellipsoid: Ellipsoid | None) -> dict[str, Any] | None:
    if ellipsoid is None:
        return None
    names = ("semi_axes", "center", "rotation")
    return {name: getattr(ellipsoid, name).tolist() for name in names}


def violation(problem: Problem, quantity: int, least: float, most: float) -> str:
    """Return the bound that a quantity with a value between two numbers violates, as text."""
    value = 0.5 * (least + most)
    name, below = problem.named[quantity].name, value < problem.bounds[2, quantity]
    bound, sign = problem.bounds[2 if below else 3, quantity], "<" if below else ">"
    if problem.is_cosine(quantity):
        value, bound = np.arccos(np.clip((value, bound), -1.0, 1.0))
        sign = ">" if below else "<"
    return f"{name} = {f' {sign} '.join(apart(value, bound))}"


def value_at(design: Design, pose: Pose, name: str, given: dict[str, Any]) -> float:
    """Return an index at a pose; near singular poses its bounds there are wider than rounding."""
    table = evaluate(design, pose, name, **given, workers=1, progress=False)
    return float(table[name].iloc[0])
