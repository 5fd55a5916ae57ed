"""Output of `gsp rank`: its assumptions, the best rows, and the metadata."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.cli.outputs.console import Table, counted, number, plain_table, say, stdout
from gsp.cli.outputs.postures import box_text
from gsp.cli.ranking.candidates import Candidates
from gsp.cli.ranking.files import keys_of
from gsp.cli.ranking.plan import Plan
from gsp.indices import INDICES
from gsp.indices.table import ARROWS
from gsp.ranking import STATISTICS
from gsp.ranking.comparison import distinct_names

if TYPE_CHECKING:
    import pandas as pd

BEST = 20
# Designs of a message; the others are counted.
MOST_NAMED = 5
# Width of one index in the terminal.
INDEX_WIDTH = 10
# Columns of shares of the poses; the last two are not in every table.
SHARES = ("singular", "undefined", "within_strokes", "feasible")
# Sizes are printed where the largest exceeds the least by more than this factor.
SAME_SIZE = 1.2


def headline(plan: Plan) -> None:
    """Print what will be computed, with every assumption."""
    poses = f"{counted(plan.samples, 'pose')} (Halton, seed {plan.seed})"
    say(f"{designs_text(plan)}, {poses}", "bold")
    say(f"Poses      {box_text(plan.box, plan.unit)} ({plan.box.order})")
    if plan.feasible:
        say("           those within the strokes of each design")
    sizes = [design.rms_radius for design in plan.designs]
    if max(sizes) > SAME_SIZE * min(sizes):
        spread = f"{min(sizes):.4g} … {max(sizes):.4g} {plan.unit}".rstrip()
        say(f"Sizes      {spread} (rms radius of the anchors); all at the same poses")
    say(f"Length     {_length(plan)}")
    say(f"Ellipsoid  {_ellipsoid(plan)}")
    say("λ          relative to the largest |det J| of each design in the sample")


def designs_text(plan: Candidates) -> str:
    """Return the number of designs, and how many are mechanisms on a template, as text."""
    all_of, placed = len(plan.designs), plan.placed
    text = f"{all_of} design" + "s" * (all_of > 1)
    if not placed:
        return text
    if plan.mechanisms:
        several = "s" * (plan.mechanisms > 1)
        text += f" ({placed} placements of {plan.mechanisms} mechanism{several})"
    on = f"on the anchor lines of {plan.template}"
    return f"{text} {on}" if placed == all_of else f"{text}, {placed} of them {on}"


def _length(plan: Plan) -> str:
    if plan.length is not None:
        return f"{plan.length:g} {plan.unit}".rstrip()
    own = {design.characteristic_length for design in plan.designs}
    lengths = sorted(length for length in own if length is not None)
    texts = [f"{length:g} {plan.unit}".rstrip() for length in lengths] + ["none"] * (None in own)
    return ", ".join(texts) + ", as the designs record it"


def _ellipsoid(plan: Plan) -> str:
    if plan.ellipsoid is None:
        known = any(design.ellipsoid is not None for design in plan.designs)
        return "as the designs record it" if known else "none"
    axes = " × ".join(f"{axis:.4g}" for axis in plan.ellipsoid.semi_axes)
    return f"semi-axes {axes} {plan.unit}".rstrip() + ", about the platform origin"


def left_out(plan: Plan, table: pd.DataFrame, chosen: tuple[str, ...] | None) -> Iterator[str]:
    """Yield one line per index that was not computed, for infinite means, and for no value."""
    for name, index in INDICES.items():
        if chosen is None and index.routine and name not in table.attrs["indices"]:
            needs = {need for d in plan.designs for need in index.missing(d, plan.given(d))}
            texts = sorted(f"--{n}" if n in index.parameters else n for n in needs)
            yield f"{name} is left out: it needs {', '.join(texts)}"
    yield from infinite_note(table)
    by = table.attrs["by"]
    without = table.loc[table[f"{by}_mean"].isna(), "design"].tolist()
    if without:
        cause = "no pose is within the strokes" if plan.feasible else f"no pose has a {by}"
        yield f"{cause}: {_named(without)}"


def infinite_note(table: pd.DataFrame) -> Iterator[str]:
    """Yield one line on designs with infinite means, if there are some."""
    infinite = table.attrs.get("infinite_means", {})
    if infinite:
        means = table[[f"{name}_mean" for name in infinite]].to_numpy(dtype=float)
        named = _named(table.loc[np.isinf(means).any(axis=1), "design"].tolist())
        names = ", ".join(infinite)
        yield (
            f"infinite means of {names}, as poses are singular: {named}; the table has medians "
            "and quantiles"
        )


def _named(designs: list[str]) -> str:
    more = f" and {len(designs) - MOST_NAMED} more" if len(designs) > MOST_NAMED else ""
    return ", ".join(designs[:MOST_NAMED]) + more


def best_table(table: pd.DataFrame) -> Table:
    """Return the best rows: the means of as many indices as fit into the terminal."""
    by, names, keys = table.attrs["by"], table.attrs["indices"], keys_of(table)
    width = max(len(str(d)) for d in table["design"][:BEST])
    fit = max(1, (stdout().width - width - 30) // INDEX_WIDTH)
    shown = [by, *(name for name in names if name != by)][:fit]
    headings = [f"{INDICES[n].symbol} {ARROWS[INDICES[n].better]}" for n in shown]
    shares = [name for name in SHARES if name in table]
    best = plain_table(
        *keys,
        *headings,
        *shares,
        title=f"Best by {by} (means; {ARROWS['higher']} higher, {ARROWS['lower']} lower is better)",
        right=("rank", *headings, *shares),
    )
    for row in table.head(BEST).to_dict("records"):
        means = [number(row[f"{name}_mean"]) for name in shown]
        best.add_row(*(str(row[key]) for key in keys), *means, *(_share(row[s]) for s in shares))
    return best


def _share(value: float) -> str:
    """Return a share of poses in percent; "–" for a design without strokes."""
    return "–" if value != value else f"{value:.2%}" if value else "0"


def metadata(plan: Plan, table: pd.DataFrame) -> dict[str, Any]:
    """Return what is needed to read the table and to compute it again."""
    angles = ["rad"] * 3
    return {
        **facts_of(plan, table),
        "ellipsoid": table.attrs["ellipsoid"] or "as each design records it",
        "length": table.attrs["length"] or "as each design records it",
        "poses": {
            "number": plan.samples,
            "sequence": "Halton, scrambled",
            "seed": plan.seed,
            "order": plan.box.order,
            "low": plan.box.low.tolist(),
            "high": plan.box.high.tolist(),
            "units": [plan.unit] * 3 + angles,
        },
    }


def facts_of(found: Candidates, table: pd.DataFrame) -> dict[str, Any]:
    """Return what a table records, how its designs were found, and what its columns are."""
    names, sources = distinct_names(found.designs), [design.source for design in found.designs]
    return {
        **{str(key): value for key, value in table.attrs.items()},
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "unit_of_length": found.unit,
        "template": found.template,
        "placements": "all distinct ones" if found.mechanisms else "one per mechanism",
        "sources": dict(zip(names, sources, strict=True)) if not found.template else {},
        "columns": dict(_columns(table)),
    }


def _columns(table: pd.DataFrame) -> Iterator[tuple[str, dict[str, str]]]:
    for name in table.attrs["indices"]:
        index = INDICES[name]
        for statistic in STATISTICS:
            yield (
                f"{name}_{statistic}",
                {
                    "index": name,
                    "symbol": index.symbol,
                    "statistic": statistic,
                    "unit": table.attrs["units"][name],
                    "better": index.better,
                    "source": index.source,
                },
            )
    meanings = (
        "share of singular poses",
        "share of poses with an undefined index",
        "share of poses within the strokes of the design",
        "share of feasible poses; the other columns are about these",
    )
    for name, meaning in zip(SHARES, meanings, strict=True):
        if name in table:
            yield name, {"meaning": meaning, "unit": "1"}
