"""`gsp explore`: a sample of a space of designs, evaluated for a task."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from gsp.cli import interrupts
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import Force, Workers
from gsp.cli.outputs.console import counted, say, show_table, warn
from gsp.cli.ranking.files import outputs, save, stopped
from gsp.cli.ranking.tasks import STORED, best_by_score, without_score
from gsp.errors import InvalidInput
from gsp.exploration import explore, read_task
from gsp.exploration.space_reading import space_from_toml
from gsp.files.writing import read_text

if TYPE_CHECKING:
    import pandas as pd

RESULT = Path("results/exploration.csv")


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
    designs = space_from_toml(read_text(space), str(space), find_design)
    wanted = read_task(task)
    with outputs(out, False, force, resume, RESULT) as files:
        try:
            with interrupts.concluded_by(lambda: stopped(files.parts, STORED)):
                table = explore(
                    designs,
                    wanted,
                    samples,
                    seed=seed,
                    method=method,
                    workers=workers,
                    parts=files.parts,
                    resume=resume,
                )
        except KeyboardInterrupt:
            raise typer.Exit(stopped(files.parts, STORED)) from None
        except InvalidInput as error:  # of no sample there is a design
            raise InvalidInput(str(error).replace("space: ", f"{space}: ", 1)) from error
        for line in notes(table):
            warn(line)
        say(
            f"{counted(len(table), 'design')} of {space} ({method}, seed {seed}), task {task}",
            "bold",
        )
        show_table(best_by_score(table, designs.names, wanted))
        created = datetime.now(UTC).isoformat(timespec="seconds")
        facts = {"created": created, **{str(key): value for key, value in table.attrs.items()}}
        save(table, facts, files, force, list(table.columns))


def notes(table: pd.DataFrame) -> Sequence[str]:
    """Return one line on parameters without a design, and one on designs without a score."""
    lines = []
    failed = [text for text in table["error"] if text] if "error" in table else []
    if failed:
        lines.append(f"no design for {len(failed)} of {len(table)}; the first error: {failed[0]}")
    without = without_score(table, len(failed))
    return [*lines, without] if without else lines
