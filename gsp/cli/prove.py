"""`gsp prove`: compare the mechanisms with Pinocchio."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gsp.catalogue import mechanism
from gsp.files import check_writable, write_text

if TYPE_CHECKING:
    from gsp.bridges.proof import Proof


def prove(
    names: Annotated[
        list[str] | None, typer.Argument(help="Mechanisms, such as 'D1^6'; default all 195.")
    ] = None,
    poses: Annotated[int, typer.Option(help="Postures a mechanism.", min=1)] = 20,
    seed: Annotated[int, typer.Option(help="Of dimensions and poses.", min=0)] = 1,
    out: Annotated[Path | None, typer.Option(help="Write the page, in Markdown.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite files that exist.")] = False,
) -> None:
    """Compare all rates with a multibody model in Pinocchio, at random dimensions and poses.

    Exit status 1 if a difference is above 1e-9.
    """
    if out is not None:
        check_writable(out, overwrite=force)
    proof = _with_progress(names, poses, seed)
    if out is not None:
        write_text(out, proof.markdown(), overwrite=force)
    _tell(proof)
    if not proof.holds:
        raise typer.Exit(1)


def _with_progress(names: list[str] | None, poses: int, seed: int) -> Proof:
    from rich.console import Console
    from rich.progress import Progress

    from gsp.bridges import proof

    chosen = [mechanism(name) for name in names] if names else None
    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("proving", total=None)
        return proof.prove(
            chosen, poses, seed, lambda done, total: bar.update(task, completed=done, total=total)
        )


def _tell(proof: Proof) -> None:
    worst = proof.table[["closure", "actuators", "passive"]].max()
    verdict = "all agree" if proof.holds else "NOT all agree"
    print(
        f"{len(proof.table)} mechanisms, {int(proof.table['poses'].sum())} postures: {verdict} "
        f"to 1e-9; largest differences: loops {worst['closure']:.1e}, actuator rates "
        f"{worst['actuators']:.1e}, passive rates {worst['passive']:.1e}"
    )
