"""What `gsp rank` says: what is computed, the best of the table, and the metadata."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from rich.table import Table

from gsp.cli.console import number, plain_table, say, stdout
from gsp.cli.options import box_text
from gsp.cli.plan import Plan
from gsp.indices import INDICES
from gsp.ranking import STATISTICS

if TYPE_CHECKING:
    import pandas as pd

BEST = 20
ARROWS = {"higher": "↑", "lower": "↓"}
# Columns that say what a row is, and the room that one index takes in the terminal.
FIXED = ("rank", "design", "class")
ROOM = 10


def headline(plan: Plan) -> None:
    """Print what will be computed, with every assumption."""
    number_of = f"{len(plan.designs)} design" + "s" * (len(plan.designs) > 1)
    on = f" on the anchor lines of {plan.template}" if plan.template else ""
    say(f"{number_of}{on}, {plan.samples} poses (Halton, seed {plan.seed})", "bold")
    say(f"Poses      {box_text(plan.box, plan.unit)} ({plan.box.order})")
    say(f"Length     {_length(plan)}")
    say(f"Ellipsoid  {_ellipsoid(plan)}")
    say("λ          relative to the largest |det J| of each design in the sample")


def _length(plan: Plan) -> str:
    if plan.length is not None:
        return f"{plan.length:g} {plan.unit}".rstrip()
    own = {design.characteristic_length for design in plan.designs}
    texts = sorted("none" if length is None else f"{length:g}" for length in own)
    return f"{', '.join(texts)} {plan.unit}".rstrip() + ", as the designs record it"


def _ellipsoid(plan: Plan) -> str:
    if plan.ellipsoid is None:
        return "as the designs record it"
    axes = " × ".join(f"{axis:.4g}" for axis in plan.ellipsoid.semi_axes)
    return f"semi-axes {axes} {plan.unit}, about the platform origin"


def left_out(plan: Plan, table: pd.DataFrame, chosen: tuple[str, ...] | None) -> Iterator[str]:
    """Say which indices were not computed, and what they need."""
    for name, index in INDICES.items():
        if chosen is None and index.routine and name not in table.attrs["indices"]:
            needs = {need for d in plan.designs for need in index.missing(d, plan.given(d))}
            texts = sorted(f"--{n}" if n in index.parameters else n for n in needs)
            yield f"{name} is left out: it needs {', '.join(texts)}"


def best_table(table: pd.DataFrame) -> Table:
    """Return the best rows: the mean of each index, as many as the terminal is wide."""
    by, names = table.attrs["by"], table.attrs["indices"]
    width = max(len(str(d)) for d in table["design"][:BEST])
    fit = max(1, (stdout().width - width - 30) // ROOM)
    shown = [by, *(name for name in names if name != by)][:fit]
    headings = [f"{INDICES[n].symbol} {ARROWS[INDICES[n].better]}" for n in shown]
    best = plain_table(
        *FIXED, *headings, "singular", "undefined",
        title=f"Best by {by} (means; {ARROWS['higher']} higher, {ARROWS['lower']} lower is better)",
        right=("rank", *headings, "singular", "undefined"),
    )  # fmt: skip
    for row in table.head(BEST).to_dict("records"):
        means = [number(row[f"{name}_mean"]) for name in shown]
        shares = [f"{row[share]:.2%}" if row[share] else "0" for share in ("singular", "undefined")]
        best.add_row(*(str(row[key]) for key in FIXED), *means, *shares)
    return best


def metadata(plan: Plan, table: pd.DataFrame) -> dict[str, Any]:
    """Return what is needed to read the table and to compute it again."""
    angles = ["rad"] * 3
    return {
        **{str(key): value for key, value in table.attrs.items()},
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "ellipsoid": table.attrs["ellipsoid"] or "as each design records it",
        "length": table.attrs["length"] or "as each design records it",
        "unit_of_length": plan.unit,
        "template": plan.template,
        "poses": {
            "number": plan.samples,
            "sequence": "Halton, scrambled",
            "seed": plan.seed,
            "order": plan.box.order,
            "low": plan.box.low.tolist(),
            "high": plan.box.high.tolist(),
            "units": [plan.unit] * 3 + angles,
        },
        "sources": {d.name: d.source for d in plan.designs} if not plan.template else {},
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
    yield "singular", {"meaning": "share of singular poses", "unit": "1"}
    yield "undefined", {"meaning": "share of poses with an undefined index", "unit": "1"}
