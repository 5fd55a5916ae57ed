"""Designs for a task: `gsp rank --task`, and the lines and the table of the best it prints."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import typer

from gsp.cli import interrupts
from gsp.cli.outputs.console import Table, counted, number, plain_table, say, show_table, warn
from gsp.cli.ranking.candidates import Candidates
from gsp.cli.ranking.files import keys_of, outputs, save, stopped
from gsp.cli.ranking.report import BEST, designs_text, facts_of, infinite_note
from gsp.exploration import Task, assess
from gsp.exploration.demands import FORCE, TORQUE, is_loaded
from gsp.exploration.proving import CLOSED, FOUND, PROVEN, proven
from gsp.exploration.task import HIGH, LOW, RESOLUTION
from gsp.exploration.volumes import volumes
from gsp.limits.kinds import Kind
from gsp.ranking.restrictions import VIOLATED

if TYPE_CHECKING:
    import pandas as pd

# Options of `gsp rank` whose values a task has.
OF_TASK = ("box", "order", "samples", "seed", "by", "indices", "length", "ellipsoid", "feasible")
# Proofs of a design are parts of their own.
STORED = "{} finished parts are kept"
WITHOUT_SCORE = "no pose is within the limits, or a wanted value is undefined"


def rank_for_task(
    found: Candidates,
    task: Task,
    *,
    origin: Path,
    out: Path | None,
    columns: list[str] | None,
    resume: bool,
    plot: bool | None,
    workers: int | None,
    force: bool,
) -> None:
    """Assess designs for a task, print the best, and write table, metadata and picture."""
    with outputs(out, plot, force, resume) as files:
        for line in found.notes():
            warn(line)
        try:
            with interrupts.concluded_by(lambda: stopped(files.parts, STORED)):
                table = assess(
                    found.designs, task, workers=workers, parts=files.parts, resume=resume
                )
        except KeyboardInterrupt:
            raise typer.Exit(stopped(files.parts, STORED)) from None
        without = without_score(table)
        for line in [*([without] if without else []), *infinite_note(table)]:
            warn(line)
        say(f"{designs_text(found)}, task {origin}", "bold")
        show_table(best_by_score(table, keys_of(table)[1:], task))
        if columns is None and files.table.suffix.lower() == ".tex":
            columns = [*keys_of(table), *score_columns(table, task)]
        means = table[[f"{name}_mean" for name in task.indices]]
        if files.picture and not means.notna().any(axis=None):
            warn("no picture: no mean is defined")
            files = files._replace(picture=False)
        save(table, facts_of(found, table), files, force, columns)


def without_score(table: pd.DataFrame, failed: int = 0) -> str:
    """Return a line on designs without a score, "" if there are none.

    Parameters
    ----------
    table : pandas.DataFrame
    failed : int
        Number of rows without a design.
    """
    without = int(table["score"].isna().sum()) - failed
    return f"{counted(without, 'design')} without a score: {WITHOUT_SCORE}" if without else ""


def own_columns(task: Task) -> list[str]:
    """Return the columns of a task that no other ranking has: score, proofs, forces, violations."""
    ends, kinds = (PROVEN, FOUND, CLOSED), get_args(Kind)
    return [
        "score",
        *(f"{wish.index}_{end}" for wish in proven(task) for end in ends),
        *(f"{w.index}_{end}" for w in volumes(task) for end in (LOW, HIGH, RESOLUTION)),
        *((FORCE, TORQUE) if is_loaded(task) else ()),
        *(f"{VIOLATED}{kind}" for kind in (kinds if task.limits is not None else ())),
    ]


def score_columns(table: pd.DataFrame, task: Task) -> list[str]:
    """Return the columns with the score, what is wanted, feasible poses, and forces."""
    also = [name for name in ("feasible", FORCE, TORQUE) if name in table]
    return ["score", *(wish.column for wish in task.wanted), *also]


def best_by_score(table: pd.DataFrame, labels: Sequence[str], task: Task) -> Table:
    """Return the best rows: the columns of labels, score and what is wanted."""
    import pandas as pd

    names = ["rank", *labels, *score_columns(table, task)]
    numeric = [name for name in names if pd.api.types.is_numeric_dtype(table[name])]
    best = plain_table(*names, title="Best by score", right=tuple(numeric))
    scored = table[table["score"].notna()].sort_values("rank", kind="stable")
    for row in scored.head(BEST).to_dict("records"):
        best.add_row(f"{row['rank']:.0f}", *(_text(row[name]) for name in names[1:]))
    return best


def _text(value: Any) -> str:
    return number(value) if isinstance(value, float) else str(value)
