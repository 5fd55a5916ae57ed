"""What the record of a certificate may claim: names, bounds and numbers that have a sense."""

from __future__ import annotations

from itertools import combinations
from math import acos, inf, isfinite, pi
from typing import Any

from gsp.proof.verification.matrices import Range
from gsp.proof.verification.model import Model

# Indices that the check supports.
INDICES = (
    "minimum_singular_value",
    "condition_number",
    "manipulability",
    "condition_number_ellipsoid",
    "control_number",
)
# Largest deviation of unit vectors and of rotations from their definition.
UNIT_TOLERANCE = 1e-12
# Six digits of a value that is stated; and the least part of an angle that is compared.
STATED_VALUE_TOLERANCE, STATED_ANGLE_TOLERANCE = 1e-5, 1e-7
# The reason of a refutation by two poses.
CHANGE = "det J changes its sign: a pose between the two of the bracket is singular or undefined"
CHANGE_ON_PATH = "det J changes its sign: a pose between the parameters is singular or undefined"
# What is bounded of joints along a path.
RATES = ("speed", "acceleration")


def flaw(model: Model, record: dict[str, Any]) -> str:
    """Return the first meaningless entry of a record, or "" if there is none."""
    rates = RATES if "path" in record else ()
    names = {f"{kind} of {joint}" for kind in rates for joint in joint_names(model)}
    return _numbers(model) or _bounds(model, names) or _stated(record)


def pairs_of(model: Model) -> dict[str, tuple[int, int]]:
    """Return the legs of each distance between two, by its name."""
    numbers = combinations(range(len(model.legs)), 2)
    return {f"clearance {i + 1}-{j + 1}": (i, j) for i, j in numbers}


def is_angle(name: str) -> bool:
    """Whether bounds of a quantity are angles, compared by their cosines."""
    return name.startswith("theta") or "cone" in name


def states(model: Model, reason: str, name: str, found: Range) -> bool:
    """Whether a reason states that a quantity, with bounds `found`, violates what is claimed."""
    parts = reason.removeprefix(f"{name} = ").split(" ")
    if not reason.startswith(f"{name} = ") or len(parts) != 3 or parts[1] not in ("<", ">"):
        return False
    value, bound, below = float(parts[0]), float(parts[2]), parts[1] == "<"
    least, most = float(found[0].mid()), float(found[1].mid())
    claimed = model.claims["bounds"][name][0 if below else 1]
    if claimed is None:
        return False
    rest = STATED_ANGLE_TOLERANCE if is_angle(name) else 0.0
    if is_angle(name):
        least, most = (acos(min(max(x, -1.0), 1.0)) for x in (most, least))
        claimed = min(max(claimed, 0.0), pi)
    near = STATED_VALUE_TOLERANCE * abs(claimed) + rest
    # Bounds of joints are claimed with the tolerance of the joint, and violated without it.
    slack = inf if name in joint_names(model) else near
    beyond = claimed - bound if below else bound - claimed
    wide = STATED_VALUE_TOLERANCE * abs(value) + rest
    return (
        -near <= beyond <= slack
        and (value <= bound if below else value >= bound)
        and least - wide <= value <= most + wide
    )


def joint_names(model: Model) -> set[str]:
    """Return the names of the actuated joints."""
    kinds = [leg["constraints"].replace(",", " ").split() for leg in model.legs]
    return {
        f"{'theta' if kind == 'A1' else 'd'}{i}"
        for i, some in enumerate(kinds, start=1)
        for kind in some
    }


def box_flaw(box: dict[str, Any]) -> str:
    """Return what is wrong with a box, or "" if it is six intervals."""
    low, high = box["low"], box["high"]
    if not (len(low) == len(high) == 6 and all(is_number(x) for x in [*low, *high])):
        return "the box is not six intervals"
    pairs = zip(low, high, strict=True)
    return "" if all(a <= b for a, b in pairs) else "the box has low above high"


def _numbers(model: Model) -> str:
    """Return what is wrong with the length, the ellipsoid or the tolerances."""
    claims, given = model.claims, model.claims["ellipsoid"]
    if not isinstance(claims["regular"], bool):
        return "regular is neither true nor false"
    if not (is_number(claims["length"]) and claims["length"] > 0):
        return "the characteristic length is not positive"
    rows = claims["tolerances"]
    if not _is_list(rows, len(model.legs)) or not all(
        _is_list(row, 4) and all(is_number(x) and x >= 0 for x in row) for row in rows
    ):
        return "the tolerances are not four numbers ≥ 0 per leg"
    if given is None:
        return ""
    if not (
        len(given["semi_axes"]) == 3 and all(is_number(x) and x > 0 for x in given["semi_axes"])
    ):
        return "the semi-axes of the ellipsoid are not positive"
    if not (len(given["center"]) == 3 and all(is_number(x) for x in given["center"])):
        return "the centre of the ellipsoid is not a point"
    columns = list(zip(*given["rotation"], strict=True))
    products = [(_product(columns[i], columns[j]), i == j) for i in range(3) for j in range(3)]
    if not all(abs(x - one) <= 1e3 * UNIT_TOLERANCE for x, one in products):
        return "the axes of the ellipsoid are not orthonormal"
    return ""


def _bounds(model: Model, rates: set[str]) -> str:
    """Return what is wrong with the bounds, their names, or the axes of cones."""
    bounds, axes, legs = model.claims["bounds"], model.claims["axes"], range(len(model.legs))
    if not bounds and not model.claims["regular"]:
        return "nothing is claimed"
    if not _is_list(axes, len(legs)) or not all(
        _is_list(pair, 2) and all(_is_list(x, 3) and all(map(is_number, x)) for x in pair)
        for pair in axes
    ):
        return "the axes of the cones are not two vectors per leg"
    # Where a design has no axis it is 0.
    if any(any(x) and not _is_unit(x) for pair in axes for x in pair):
        return "the axis of a cone is not a unit vector"
    cones = {
        f"{side} cone {i + 1}": (i, k) for k, side in enumerate(("base", "platform")) for i in legs
    }
    known = {*joint_names(model), *rates, "x", "y", "z", *INDICES, *cones, *pairs_of(model)}
    for name, pair in bounds.items():
        if name not in known:
            return f"{name!r} is not a quantity that is checked"
        if len(pair) != 2 or not all(x is None or is_number(x) for x in pair):
            return f"the bounds of {name} are not two numbers"
        if pair[0] is None and pair[1] is None:
            return f"nothing is claimed of {name}"
        if name in cones:
            i, k = cones[name]
            if not _is_unit(axes[i][k]):
                return f"the axis of the {name} is not a unit vector"
    return ""


def _stated(record: dict[str, Any]) -> str:
    """Return what is stated of a refutation in a certificate that is none."""
    if record["status"] == "refuted":
        return ""
    if len(record["points"]) or record["counterexample"] or record["bracket"]:
        return "a certificate that refutes nothing names a pose that refutes"
    return (
        "reasons are stated of a proof" if record["status"] == "proven" and record["reason"] else ""
    )


def is_number(x: Any) -> bool:
    """Whether an entry of a record is a finite number."""
    return isinstance(x, (int, float)) and not isinstance(x, bool) and isfinite(x)


def _is_list(x: Any, n: int) -> bool:
    return isinstance(x, list) and len(x) == n


def _is_unit(x: list[float]) -> bool:
    return abs(_product(x, x) - 1.0) <= UNIT_TOLERANCE


def _product(x: Any, y: Any) -> float:
    return float(sum(a * b for a, b in zip(x, y, strict=True)))
