"""Indices over a region on the command line: means, extremes, shares, and their picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from gsp.cli.outputs.console import Table, number, plain_table, say, show_table
from gsp.errors import EmptyWorkspace, UnknownIndex
from gsp.indices import INDICES, index_names
from gsp.model.design import Design
from gsp.rounding import rounded_down, rounded_up

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from gsp.workspace import IndexSample, Region
    from gsp.workspace.sets.inside.worst import Worst

# Boxes of the search for a proven worst value, besides the cells of the region: up to 5 s of CPU
# time for six SPS legs.
WORST_BOXES = 100_000


@dataclass(frozen=True, kw_only=True)
class IndicesOver:
    """Indices over a region.

    Attributes
    ----------
    names : tuple of str
        Names of the indices.
    bounds : tuple of str
        Bounds of them whose shares are wanted.
    length : float or None [unit of the design]
    samples : int
        How many poses are drawn.
    seed : int
    """

    names: tuple[str, ...]
    bounds: tuple[str, ...]
    length: float | None
    samples: int
    seed: int


@dataclass(frozen=True, kw_only=True)
class Content:
    """What is written and drawn of a region instead of its cells: a table, and axes."""

    table: Callable[[], pd.DataFrame]
    draw: Callable[[], Axes]


def read_indices(
    design: Design, texts: Sequence[str], length: float | None
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of indices, and those texts that are bounds, such as "λ >= 0.3".

    Raises
    ------
    InvalidInput, MissingParameter, UnknownIndex
    """
    from gsp.evaluation.request import choose_indices
    from gsp.evaluation.settings import Job, settings_of
    from gsp.limits.limits import threshold

    names: list[str] = []
    bounds = [text for text in texts or () if set(text) & set("<>=≤≥")]
    for text in texts or ():
        found = (threshold("--index", text)[0].name,) if text in bounds else index_names(text)
        names += [name for name in found if name not in names]
    choose_indices(names, [Job(design, settings_of(design, length, None, None))])
    return tuple(names), tuple(bounds)


def print_sample(region: Region, wanted: IndicesOver, order: str) -> Content | None:
    """Print means, extremes and shares of indices over a region; return what can be written."""
    if region.empty:
        say("no indices: the region is proven empty")
        return None
    sample = region.index_sample(
        wanted.names, wanted.samples, length=wanted.length, rng=wanted.seed
    )
    drawn = f"{wanted.samples} poses that are drawn evenly from the region"
    say(f"Indices at {drawn}, ± one standard error")
    ends = {name: _worst(region, name, wanted.length) for name in wanted.names}
    show_table(_table(sample, ends))
    for bound in wanted.bounds:
        share = sample.share_where(bound)
        words = " ".join(bound.split())
        say(f"Share of the poses with {words}: {_with_error(share.value, share.error)}")
    from gsp.plots import workspace as plots

    first = next(iter(sample.values))
    draw = partial(plots.index_map, sample, first, worst=ends.get(first))
    return Content(table=partial(sample.to_dataframe, order), draw=draw)


def _table(sample: IndexSample, ends: Mapping[str, Worst | None]) -> Table:
    columns = ("mean", "worst found", "proven", "global", "undefined")
    table = plain_table("index", "unit", *columns, right=columns)
    design = sample.region.problem.design
    for name, row in sample.summary().iterrows():
        index = INDICES[str(name)]
        end = ends[index.name]
        lower = index.better == "lower"
        sign, rounded = ("≤", rounded_up) if lower else ("≥", rounded_down)
        found, proven = row["worst"], None
        if end is not None:
            # The search for the bound often finds a worse pose than those that were drawn.
            found, proven = (np.fmax if lower else np.fmin)(found, end.value), end.bound
        table.add_row(
            index.symbol,
            index.unit(design),
            _with_error(row["mean"], row["mean_error"]),
            number(float(found)),
            "–" if proven in (None, index.worst) else f"{sign} {number(rounded(proven, 4))}",
            _with_error(row["global"], row["global_error"]),
            f"{100.0 * row['undefined']:.3g} %",
        )
    return table


def _worst(region: Region, name: str, length: float | None) -> Worst | None:
    """Return the worst value that is known, and its proven bound; None where there is no proof."""
    if not (region.all_rotations or region.kind == "orientations"):
        return None
    try:
        return region.worst(name, length=length, budget=WORST_BOXES)
    except (EmptyWorkspace, UnknownIndex):
        return None


def _with_error(value: float, error: float) -> str:
    return f"{number(value)} ± {number(error, 2)}"
