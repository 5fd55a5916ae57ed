"""The designs of the rows of a table, as the scene draws them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from gsp.app.explorer.content import NAME
from gsp.app.scene.drawing import drawing, pose_numbers
from gsp.app.scene.pages import packed
from gsp.app.state.session import started
from gsp.checks import check_items, is_a
from gsp.errors import GspError, InvalidInput, expected
from gsp.exploration.space import Space
from gsp.geometry.pose import Pose
from gsp.model.design import Design

# Significant digits of anchors.
ANCHOR_DIGITS = 6


def designs_of_rows(table: pd.DataFrame, designs: Any) -> list[Design | str]:
    """Return the design of each row, or why there is none.

    Parameters
    ----------
    table : pandas.DataFrame
    designs : Space, or sequence of Design
        Designs are found by their names in the column "design", without that column by their
        order.

    Raises
    ------
    InvalidInput
        On other types, two designs of one name, or if no row has a design.
    """
    found = _of_space(table, designs) if is_a(designs, Space) else _of_list(table, designs)
    if all(isinstance(one, str) for one in found):
        raise InvalidInput(expected("designs", "a design for some of the rows", str(found[0])))
    return found


def _of_space(table: pd.DataFrame, space: Space) -> list[Design | str]:
    missing = [name for name in space.names if name not in table]
    if missing:
        wanted = "a space whose parameters are columns of the table"
        raise InvalidInput(expected("designs", wanted, f"no column {missing[0]}"))
    columns = {name: table[name].tolist() for name in space.names}
    found: list[Design | str] = []
    for row in range(len(table)):
        try:
            found.append(space.design(**{name: values[row] for name, values in columns.items()}))
        except GspError as error:
            found.append(str(error))
    return found


def _of_list(table: pd.DataFrame, designs: Any) -> list[Design | str]:
    given = check_items("designs", designs, "a gsp.Space, or designs")
    for one in given:
        if not is_a(one, Design):
            raise InvalidInput(expected("designs", "a gsp.Space, or designs", type(one).__name__))
    if NAME not in table:
        if len(given) != len(table):
            wanted = f"{len(table)} designs, one per row"
            raise InvalidInput(expected("designs", wanted, len(given)))
        return list(given)
    by_name = {one.name: one for one in given}
    if len(by_name) < len(given):
        names = [one.name for one in given]
        twice = next(name for name in names if names.count(name) > 1)
        raise InvalidInput(expected("designs", "different names", f"two of {twice!r}"))
    return [by_name.get(name, "no design of this name was given") for name in table[NAME]]


def chosen_rows(found: Sequence[Design | str], front: Sequence[int], most: int) -> list[int]:
    """Return the rows whose designs are drawn: those of the front, and of the others evenly."""
    there = [row for row, one in enumerate(found) if not isinstance(one, str)]
    first = [row for row in front if not isinstance(found[row], str)][:most]
    others = sorted(set(there) - set(first))
    count = min(most - len(first), len(others))
    places = np.linspace(0, max(len(others) - 1, 0), count).round().astype(int)
    return sorted({*first, *(others[place] for place in places.tolist())})


def packed_spaces(
    found: Sequence[Design | str], rows: Sequence[int], pose: Pose | None
) -> tuple[str, int]:
    """Return what the scene draws of the designs, packed, and of how many rows.

    One entry per row of the table: a drawing with its place and its anchors, a text that states
    why there is none, or None if it was left out.
    """
    entries: list[Any] = [one if isinstance(one, str) else None for one in found]
    for row in rows:
        design = found[row]
        if not isinstance(design, str):
            entries[row] = _drawn(design, pose)
    count = sum(isinstance(one, dict) for one in entries)
    return packed(json.dumps(entries, allow_nan=False).encode()), count


def _drawn(design: Design, pose: Pose | None) -> dict[str, Any] | str:
    try:
        state = started(design, pose)
        (place,) = pose_numbers(design, state.pose)
        return {
            "drawing": drawing(state),
            "place": {**place, "screw": None},
            "legs": [leg.name for leg in design.legs],
            "base": _digits(design.base_points),
            "platform": _digits(design.platform_points),
            "unit": design.unit,
        }
    except GspError as error:
        return str(error)


def _digits(points: Any) -> list[list[float]]:
    """Return points with few digits; zero has no sign."""
    return [[float(f"{x:.{ANCHOR_DIGITS}g}") + 0.0 for x in point] for point in points.tolist()]
