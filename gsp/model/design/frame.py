"""The table of a design, one row per leg: to and from the columns of a data frame."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.arguments import LARGEST_NUMBER
from gsp.errors import InvalidInput, UnknownName, apart, brief, expected
from gsp.model.design.checks import below_zero
from gsp.model.drives import DRIVES, Crank, Drive
from gsp.model.legs import Leg, check_leg

if TYPE_CHECKING:
    from gsp.model.design import Design

POINTS = {side: [f"{side}_{axis}" for axis in "xyz"] for side in ("base", "platform")}
DIRECTIONS = {side: [f"{side}_d{axis}" for axis in "xyz"] for side in ("base", "platform")}
# Limits of the first and of the second actuator of a leg; only legs D4 A1 have two.
STROKES = (("stroke_low", "stroke_high"), ("stroke_low_2", "stroke_high_2"))
REQUIRED = (*POINTS["base"], *POINTS["platform"])
# Of legs that are driven at the base.
DRIVE = ("drive", "rod", "branch", "arm_x", "arm_y", "arm_z")
TEXTS = ("constraints", "drive")
COLUMNS = (
    "constraints",
    *DRIVE,
    *POINTS["base"],
    *DIRECTIONS["base"],
    *POINTS["platform"],
    *DIRECTIONS["platform"],
    *STROKES[0],
    *STROKES[1],
)

# Where a cell is, for errors: from the number of its row and the name of its column.
Place = Callable[[int, str], str]


def columns_from_design(design: Design) -> dict[str, list[Any]]:
    """Return the columns of a design that it needs, in the order of `COLUMNS`.

    Parameters
    ----------
    design : Design

    Returns
    -------
    dict of lists
        Texts in `TEXTS`, floats elsewhere; NaN where a leg has no line or limit, and "" or NaN
        where it has no drive.
    """
    words = (" ".join(constraint.name for constraint in leg.constraints) for leg in design.legs)
    found: dict[str, list[Any]] = {"constraints": list(words)}
    if design.driven:
        columns = zip(*map(_of_drive, design.drives), strict=True)
        found |= dict(zip(DRIVE, map(list, columns), strict=True))
    for side, points, lines, used in (
        ("base", design.base_points, design.base_directions, [x.base_line for x in design.legs]),
        (
            "platform",
            design.platform_points,
            design.platform_directions,
            [leg.platform_line for leg in design.legs],
        ),
    ):
        found |= dict(zip(POINTS[side], points.T.tolist(), strict=True))
        if any(used):
            found |= dict(zip(DIRECTIONS[side], lines.T.tolist(), strict=True))
    if design.strokes is not None:
        most = max(len(leg.constraints) for leg in design.legs)
        for names in STROKES[:most]:
            found |= {name: [math.nan] * design.n_legs for name in names}
        seen = [0] * design.n_legs
        for row, limits in zip(design.rows, design.strokes.tolist(), strict=True):
            for name, value in zip(STROKES[seen[row.leg]], limits, strict=True):
                found[name][row.leg] = value
            seen[row.leg] += 1
    return {name: found[name] for name in COLUMNS if name in found}


def _of_drive(drive: Any) -> tuple[Any, ...]:
    """Return what the columns `DRIVE` have for a drive or None."""
    if drive is None:
        return ("", *[math.nan] * 5)
    return drive.kind, drive.rod, float(drive.branch), *getattr(drive, "arm", [math.nan] * 3)


def check_columns(names: Sequence[Any], where: str) -> None:
    """Raise an error if a column is unknown, appears twice, or is missing.

    Raises
    ------
    UnknownName, InvalidInput
    """
    for i, name in enumerate(names):
        if name not in COLUMNS:
            raise UnknownName("column", str(name), COLUMNS, f"In {where}")
        if name in names[:i]:
            raise InvalidInput(expected(where, f"one column {brief(name)}", "two"))
    missing = [name for name in REQUIRED if name not in names]
    if missing:
        wanted = "the columns " + ", ".join(REQUIRED)
        raise InvalidInput(expected(where, wanted, f"none named {missing[0]!r}"))


def parameters_from_columns(columns: Mapping[str, Sequence[Any]], place: Place) -> dict[str, Any]:
    """Return the arguments of `Design` that the columns of a table give.

    Parameters
    ----------
    columns : mapping of sequences of one length
        Of which `check_columns` accepts the names.
    place : function
        Where a cell is, for errors.

    Returns
    -------
    dict

    Raises
    ------
    InvalidInput
        With the place of the first wrong cell.
    """
    number = len(columns[REQUIRED[0]])
    legs = [_leg(columns, i, place) for i in range(number)]
    found: dict[str, Any] = {"legs": legs}
    for i, leg in enumerate(legs):
        _check_unused(columns, i, leg, place)
    for side in ("base", "platform"):
        found[f"{side}_points"] = [
            [_number(columns, name, i, place, "point") for name in POINTS[side]]
            for i in range(number)
        ]
        found[f"{side}_directions"] = [
            _direction(columns, side, i, leg, place) for i, leg in enumerate(legs)
        ]
    found["strokes"] = [
        _limits(columns, names, i, place, distance=not constraint.signed)
        for i, leg in enumerate(legs)
        for names, constraint in zip(STROKES, leg.constraints, strict=False)
    ]
    if sum(len(leg.constraints) for leg in legs) < 6:
        wanted = "rows with at least six constraints"
        raise InvalidInput(expected("table", wanted, f"{number} rows"))
    return found


def _check_unused(columns: Mapping[str, Sequence[Any]], i: int, leg: Leg, place: Place) -> None:
    """Refuse a second pair of limits of a leg with one joint, and a part of a direction."""
    for names in STROKES[len(leg.constraints) :]:
        for name in names:
            if name in columns and not is_missing(columns[name][i]):
                wanted = f"nothing, as a leg {leg.name} has one actuated joint"
                raise InvalidInput(expected(place(i, name), wanted, brief(columns[name][i])))
    for axes in DIRECTIONS.values():
        given = [name for name in axes if name in columns and not is_missing(columns[name][i])]
        if given and len(given) < len(axes):
            lacking = next(name for name in axes if name not in given)
            wanted = f"a number, as {given[0]} has one"
            raise InvalidInput(expected(place(i, lacking), wanted, "none"))


def _leg(columns: Mapping[str, Sequence[Any]], i: int, place: Place) -> Leg:
    """Return the leg of a row; without a name it is D1."""
    given = columns["constraints"][i] if "constraints" in columns else None
    if is_missing(given) or given == "":
        given = "D1"
    if not isinstance(given, str):
        raise InvalidInput(expected(place(i, "constraints"), "a text", brief(given)))
    leg, kind = check_leg(given, place(i, "constraints")), None
    if "drive" in columns and not is_missing(columns["drive"][i]):
        kind = columns["drive"][i]
    if kind is None or (isinstance(kind, str) and kind == ""):
        for name in DRIVE[1:]:
            if name in columns and not is_missing(columns[name][i]):
                wanted = "nothing, as the leg has no drive"
                raise InvalidInput(expected(place(i, name), wanted, brief(columns[name][i])))
        return leg
    if not isinstance(kind, str) or kind not in DRIVES:
        wanted = " or ".join(map(repr, DRIVES)) + ", or nothing"
        raise InvalidInput(expected(place(i, "drive"), wanted, brief(kind)))
    if leg.name != "D1":
        wanted = "nothing, as only legs D1 can be driven at the base"
        raise InvalidInput(expected(place(i, "drive"), wanted, repr(kind)))
    return check_leg(_drive(columns, i, DRIVES[kind], place))


def _drive(columns: Mapping[str, Sequence[Any]], i: int, kind: type[Drive], place: Place) -> Drive:
    """Return the drive of a row; without a branch it is 1."""
    names = DRIVE[3:] if kind is Crank else ()
    for name in DRIVE[3:]:
        if not names and name in columns and not is_missing(columns[name][i]):
            wanted = f"nothing, as a {kind.kind} has no arm"
            raise InvalidInput(expected(place(i, name), wanted, brief(columns[name][i])))
    for name in ("rod", *names):
        if name not in columns:
            wanted = f"a column with this name, as the leg has a {kind.kind}"
            raise InvalidInput(expected(place(i, name), wanted, "none"))
    rod = _number(columns, "rod", i, place, "point")
    branch = _number(columns, "branch", i, place, "limit") if "branch" in columns else math.nan
    if not (math.isnan(branch) or branch in (-1.0, 1.0)):
        raise InvalidInput(expected(place(i, "branch"), "1 or -1, or nothing", f"{branch:g}"))
    chosen: dict[str, Any] = {"rod": rod, "branch": -1 if branch == -1.0 else 1}
    if names:
        chosen["arm"] = [_number(columns, name, i, place, "point") for name in names]
    try:
        return kind(**chosen)
    except InvalidInput as error:
        raise InvalidInput(f"{place(i, 'rod')}: {error}") from error


def _direction(
    columns: Mapping[str, Sequence[Any]], side: str, i: int, leg: Leg, place: Place
) -> list[float]:
    names = DIRECTIONS[side]
    if not (leg.base_line if side == "base" else leg.platform_line):
        return [math.nan] * 3
    for name in names:
        if name not in columns:
            wanted = f"a column with this name, as a leg {leg.name} has a line of the {side}"
            raise InvalidInput(expected(place(i, name), wanted, "none"))
    vector = [_number(columns, name, i, place, "point") for name in names]
    if not any(vector):
        wanted = "a direction other than zero"
        raise InvalidInput(expected(place(i, names[0]), wanted, str(vector)))
    return vector


def _limits(
    columns: Mapping[str, Sequence[Any]],
    names: tuple[str, str],
    i: int,
    place: Place,
    *,
    distance: bool,
) -> list[float]:
    low, high = (
        _number(columns, name, i, place, "limit") if name in columns else math.nan for name in names
    )
    if low > high:
        least, most = apart(low, high)
        wanted = f"at most {names[1]}, which is {most}"
        raise InvalidInput(expected(place(i, names[0]), wanted, least))
    if distance and below_zero(np.array([low, high])):
        side = int(not -math.inf < low < 0.0)
        wanted, got = "0 or more for a distance", apart((low, high)[side])[0]
        raise InvalidInput(expected(place(i, names[side]), wanted, got))
    return [low, high]


def _number(
    columns: Mapping[str, Sequence[Any]], name: str, i: int, place: Place, kind: str
) -> float:
    """Return the number of a cell; a limit may be missing or infinite, a point may not."""
    value = columns[name][i]
    wanted = "a finite number" if kind == "point" else "a number or nothing"
    try:
        if isinstance(value, str | bytes | bool) or type(value).__name__ == "bool":
            raise TypeError(value)
        found = math.nan if is_missing(value) else float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInput(expected(place(i, name), wanted, brief(value))) from error
    if kind == "point" and not math.isfinite(found):
        got = "nothing or NaN" if math.isnan(found) else brief(value)
        raise InvalidInput(expected(place(i, name), wanted, got))
    if math.isfinite(found) and abs(found) > LARGEST_NUMBER:
        wanted = f"a number of at most {LARGEST_NUMBER:g} in size"
        raise InvalidInput(expected(place(i, name), wanted, brief(value)))
    return found


def is_missing(value: Any) -> bool:
    """Whether a cell is empty: None, NaN, or NA of pandas."""
    empty = value is None or type(value).__name__ in ("NAType", "NaTType")
    return empty or (isinstance(value, float) and math.isnan(value))
