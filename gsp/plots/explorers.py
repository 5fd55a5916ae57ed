"""Tables of designs on a page in which points, lines and designs are linked."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

import pandas as pd

from gsp.exploration.sides import Objectives
from gsp.exploration.space import Space
from gsp.geometry.pose import Pose
from gsp.model.design import Design

if TYPE_CHECKING:
    from gsp.app.explorer.figure import ExplorerFigure


def explorer(
    table: pd.DataFrame,
    objectives: Objectives,
    *,
    designs: Space | Sequence[Design] | None = None,
    columns: Sequence[str] | None = None,
    by: str | None = None,
    pose: Pose | None = None,
    most: int = 1000,
) -> ExplorerFigure:
    """Return a table of designs as an interactive page, for notebooks and as a file.

    Two columns are plotted against each other as in `front`, with the Pareto front and its knee.
    A pointer on a design shows its values, those of your own columns too. A click shows its design
    in space, its anchors and all its values. A range that is marked on an axis of the parallel
    coordinates dims all designs outside of it. The page needs no network.

    Parameters
    ----------
    table : pandas.DataFrame
        Such as of `gsp.exploration.explore`, `optimise`, `assess` or `pareto`, with any other
        columns.
    objectives : at least two columns, or mapping from columns to "higher" or "lower"
        See `gsp.exploration.pareto`. The front is that of all of them; the first two are the axes.
    designs : Space, sequence of Design, or None
        The space of the table, or its designs: by their names in the column "design", without
        that column by their order. By default no design is shown in space.
    columns : sequence of str, or None
        From 2 to 12 columns of the parallel coordinates, as in `parallel`. By default parameters,
        objectives and `by`.
    by : str, or None
        The column of numbers that colours points and lines; by default "score", or the first
        objective of a table without it.
    pose : Pose of batch shape (), or None [unit of the designs]
        At which designs are shown; by default the home pose of each.
    most : int
        How many designs the page contains in space: those of the front, and of the others evenly.

    Returns
    -------
    ExplorerFigure
        With `write(path)`, which writes an .html file. Rows that have no place in a picture, as a
        value is infinite or undefined, are counted on the page.

    Raises
    ------
    InvalidInput
        As `front` and `parallel`, on designs that do not fit the table, several poses, or most < 1.
    MissingSoftware
        Without the extra `plots`, which contains plotly; with designs also without `app`, which
        contains three.js.

    Examples
    --------
    >>> import pandas as pd
    >>> table = pd.DataFrame({"cost": [1, 2, 3, 2], "reach": [1.0, 3.0, 3.5, 2.0]})
    >>> explorer(table, {"cost": "lower", "reach": "higher"})
    ExplorerFigure('4 designs, 3 on the front')
    """
    figure: ExplorerFigure = import_module("gsp.app.explorer.figure").explorer_figure(
        table, objectives, designs=designs, columns=columns, by=by, pose=pose, most=most
    )
    return figure
