"""Tables of poses that are printed: columns of a pose, and the first rows of a table."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

from gsp.cli.outputs.console import number, plain_table, say, show_table
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import POSE_COLUMNS, rounded
from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    import pandas as pd

# Rows of a table that are printed.
PRINTED = 20


def pose_columns(pose: Pose, order: str) -> dict[str, Array]:
    """Return position and angles in degrees of poses, by the names of `POSE_COLUMNS`."""
    angles = np.atleast_2d(pose.angles(order, degrees=True))
    values = np.concatenate((np.atleast_2d(pose.position), angles), axis=1)
    return dict(zip(POSE_COLUMNS, values.T, strict=True))


def print_rows(table: pd.DataFrame, columns: Sequence[str], *, text: Collection[str] = ()) -> None:
    """Print columns of the first rows of a table; those of `text` as they are."""
    printed = plain_table(*columns, right=tuple(c for c in columns if c not in text))
    for row in _rounded(table.head(PRINTED)).to_dict("records"):
        cells = ((name, row[name]) for name in columns)
        printed.add_row(*(str(x) if name in text else number(x, 7) for name, x in cells))
    show_table(printed)
    if len(table) > PRINTED:
        say(f"{len(table) - PRINTED} more rows; --out FILE writes all of them.")


def _rounded(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table with rounding errors of positions and of angles as 0."""
    for columns in (list(POSE_COLUMNS[:3]), list(POSE_COLUMNS[3:])):
        if set(columns) <= set(table.columns):
            values = rounded(table[columns].to_numpy(dtype=np.float64))
            table = table.assign(**dict(zip(columns, values.T, strict=True)))
    return table
