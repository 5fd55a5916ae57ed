"""`gsp prove`: compare the mechanisms with Pinocchio and MuJoCo."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gsp.bridges.proof import POSTURE_BYTES, Proof
from gsp.bridges.proof import prove as compare
from gsp.catalogue import mechanism
from gsp.checks import check_memory
from gsp.cli.inputs.options import Force
from gsp.cli.outputs.console import counted, say
from gsp.files.writing import check_writable, write_text


def prove(
    names: Annotated[
        list[str] | None,
        typer.Argument(help="Mechanisms, such as 'D1^6'. Default: all 195.", show_default=False),
    ] = None,
    poses: Annotated[int, typer.Option(help="Postures per mechanism.", min=1)] = 20,
    seed: Annotated[int, typer.Option(help="Seed of dimensions and poses.", min=0)] = 1,
    mujoco: Annotated[bool, typer.Option("--mujoco", help="Compare with MuJoCo as well.")] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the comparison to this file (.md).", metavar="FILE", show_default=False
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Compare all joint rates with those of a multibody model, at random dimensions and poses.

    The model, in Pinocchio, has all links, joints and loops, and does not use the rows of `gsp`.

    The exit status is 1 if a relative difference is above 1e-9.

    **Examples**

    - `gsp prove`

    - `gsp prove "D4^3 A1^3" "D2^3 D3^3" --poses 200 --mujoco --out proof.md`
    """
    if out is not None:
        check_writable(out, overwrite=force, suffixes=(".md",))
    check_memory("--poses", poses, POSTURE_BYTES, "postures")
    chosen = [mechanism(name) for name in names] if names else None
    programs = ("pinocchio", "mujoco") if mujoco else ("pinocchio",)
    proof = compare(chosen, poses, seed, programs)
    if out is not None:
        write_text(out, proof.markdown(), overwrite=force)
    say(_verdict(proof))
    if not proof.holds:
        raise typer.Exit(1)


def _verdict(proof: Proof) -> str:
    worst = ", ".join(f"{name} {value:.1e}" for name, value in proof.differences.max().items())
    verdict = "all agree" if proof.holds else "NOT all agree"
    postures = int(proof.table["poses"].sum())
    what = f"{counted(len(proof.table), 'mechanism')}, {counted(postures, 'posture')}"
    return f"{what}: {verdict} to 1e-9; largest differences: {worst}"
