"""`gsp explore`: a sample of a space of designs, evaluated for a task."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gsp.cli import interrupts
from gsp.cli.inputs.options import Force, Workers
from gsp.cli.inputs.spaces import read_space
from gsp.cli.outputs.console import Table, counted, number, plain_table, say, show_table, warn
from gsp.cli.ranking.files import check_outputs, parts_of, save, stopped
from gsp.cli.ranking.report import BEST
from gsp.exploration import Space, Task, explore, read_task

if TYPE_CHECKING:
    import pandas as pd

RESULT = Path("results/exploration.csv")
# Proofs of a design are parts of their own.
STORED = "{} finished parts are kept"
WITHOUT_SCORE = "no pose is within the limits, or a wanted value is undefined"


def explore_command(
    space: Annotated[
        Path,
        typer.Argument(
            help="A space (.toml): `make`, and the tables [ranges], [choices] and [fixed] of its "
            "arguments.",
            metavar="SPACE",
        ),
    ],
    task: Annotated[
        Path,
        typer.Option(
            help="A task (.toml): poses, limits, and what is wanted of which index.",
            metavar="FILE",
        ),
    ],
    samples: Annotated[int, typer.Option(help="Number of designs.", min=1)] = 1000,
    seed: Annotated[int, typer.Option(help="Seed of the sample of designs.", min=0)] = 0,
    method: Annotated[
        Literal["halton", "sobol"], typer.Option(help="Sequence of the sample.")
    ] = "halton",
    out: Annotated[
        Path | None,
        typer.Option(
            help="Table to write: .csv, .parquet, .xlsx, .md or .tex. Default: "
            "results/exploration.csv, or the first free exploration-2.csv, exploration-3.csv …",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Continue an interrupted run that had the same arguments."),
    ] = False,
    workers: Workers = None,
    force: Force = False,
) -> None:
    """Evaluate a sample of a space of designs for a task.

    Prints the best 20 and writes the whole table, in the order of the sample, and its metadata
    (.json).

    **Examples**

    - `gsp explore space.toml --task task.toml`

    - `gsp explore space.toml --task task.toml --samples 5000 --seed 1 --out designs.parquet`
    """
    designs, wanted = read_space(space), read_task(task)
    path, _ = check_outputs(out, False, force, resume, RESULT)
    try:
        with interrupts.concluded_by(lambda: stopped(path, STORED)):
            table = explore(
                designs,
                wanted,
                samples,
                seed=seed,
                method=method,
                workers=workers,
                parts=parts_of(path),
                resume=resume,
            )
    except KeyboardInterrupt:
        raise typer.Exit(stopped(path, STORED)) from None
    for line in notes(table):
        warn(line)
    say(f"{counted(len(table), 'design')} of {space} ({method}, seed {seed}), task {task}", "bold")
    show_table(best_table(table, designs, wanted))
    created = datetime.now(UTC).isoformat(timespec="seconds")
    facts = {"created": created, **{str(key): value for key, value in table.attrs.items()}}
    save(table, facts, path, False, force, list(table.columns))


def notes(table: pd.DataFrame) -> Sequence[str]:
    """Return one line on parameters without a design, and one on designs without a score."""
    lines = []
    failed = [text for text in table["error"] if text] if "error" in table else []
    if failed:
        lines.append(f"no design for {len(failed)} of {len(table)}; the first error: {failed[0]}")
    without = int(table["score"].isna().sum()) - len(failed)
    if without:
        lines.append(f"{counted(without, 'design')} without a score: {WITHOUT_SCORE}")
    return lines


def best_table(table: pd.DataFrame, space: Space, task: Task) -> Table:
    """Return the best rows: parameters, score and what is wanted."""
    import pandas as pd

    wanted = [wish.column for wish in task.wanted]
    shares = ["feasible"] if "feasible" in table else []
    names = ["rank", *space.names, "score", *wanted, *shares]
    numeric = [name for name in names if pd.api.types.is_numeric_dtype(table[name])]
    best = plain_table(*names, title="Best by score", right=tuple(numeric))
    scored = table[table["score"].notna()].sort_values("rank", kind="stable")
    for row in scored.head(BEST).to_dict("records"):
        texts = [
            number(row[name]) if isinstance(row[name], float) else str(row[name])
            for name in names[1:]
        ]
        best.add_row(f"{row['rank']:.0f}", *texts)
    return best
