"""`gsp maximum`: the maximum of |det J| of a design."""

from __future__ import annotations

import json
from typing import Annotated

import numpy as np
import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import DesignName
from gsp.cli.inputs.poses import read_box
from gsp.cli.outputs.console import counted, say, warn
from gsp.cli.outputs.postures import box_text
from gsp.determinant import Maximum, Neighbourhood
from gsp.determinant import maximum as find
from gsp.determinant.domain import SearchRegion
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import PoseBox
from gsp.geometry.pose.texts import pose_text
from gsp.indices import INDICES
from gsp.model.design import Design


def maximum(
    design: DesignName,
    box: Annotated[
        str | None,
        typer.Option(
            help='Poses to search: "x0:x1 y0:y1 z0:z1 a0:a1 b0:b1 c0:c1", lengths in the unit of '
            'the design, roll, pitch and yaw in degrees; or "all". Default: all poses where '
            "|det J| is bounded, else those near the home pose.",
            metavar="BOX",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            help="Search again, with this seed. Default: the stored maximum, if there is one.",
            min=0,
            show_default=False,
        ),
    ] = None,
    no_store: Annotated[
        bool, typer.Option("--no-store", help="Neither read nor write the store of maxima.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Print the largest |det J| of a design, by which the quality index λ is normalised.

    **Examples**

    - `gsp maximum toz-kucuk-2016-d3-6`

    - `gsp maximum mine.toml --box "-10:10 -10:10 90:110 -20:20 -20:20 -20:20" --seed 1`
    """
    found = find_design(design)
    domain = box if box in (None, "all") else read_box(box)
    if isinstance(domain, PoseBox) and not (domain.high > domain.low).any():
        raise InvalidInput(expected("--box", "a box with some width", "a single pose"))
    best = find(found, domain, seed, store=not no_store)  # type: ignore[arg-type]
    if as_json:
        say(json.dumps(_facts(found, best), indent=2))
        return
    _print(found, best)


def _facts(design: Design, best: Maximum) -> dict[str, object]:
    pose = best.pose
    where = (
        None
        if pose is None
        else {"position": pose.position.tolist(), "rotation": pose.rotation.tolist()}
    )
    facts = {"design": design.name, "unit": unit_of(design), **best.facts(), "pose": where}
    # JSON has no infinity.
    return {k: None if v == float("inf") else v for k, v in facts.items()}


def unit_of(design: Design) -> str:
    """Return the unit of |det J| of a design, "" if it has none."""
    unit = INDICES["manipulability"].unit(design)
    return "" if unit == "1" else unit


def _print(design: Design, best: Maximum) -> None:
    say(f"|det J|max  {best.value:.12g} {unit_of(design)}".rstrip(), "bold")
    if best.pose is None:
        warn("the design is singular in every pose")
    else:
        say(f"at          {pose_text(best.pose, design.unit)}")
    say(f"over        {region_text(best.domain, design.unit)}")
    say(f"by          {best.method}{_confidence(best)}")
    if not best.attained:
        warn("no pose attains the value: it is a limit of |det J|, and the pose is near to it")
    if not best.converged:
        warn("the search has not converged: the value is a lower bound; try other seeds")


def region_text(region: SearchRegion, unit: str) -> str:
    """Return a region of poses as one line, angles in degrees."""
    if region is None:
        return "all poses"
    if not isinstance(region, Neighbourhood):
        return box_text(region, unit)
    centre = ", ".join(f"{x:.4g}" for x in region.centre)
    reach = f"{region.displacement:.4g} {unit}".rstrip()
    angle = f"{np.rad2deg(region.angle):.4g}°"
    return f"poses near home: ({centre}) displaced by at most {reach}, rotation by at most {angle}"


def _confidence(best: Maximum) -> str:
    if best.proven:
        proof = ", and it equals a proven bound of |det J|"
    else:
        proof = ""
    if best.proven and not best.starts:
        return proof
    seed = "" if best.seed is None else f", seed {best.seed}"
    return (
        f": the largest local maximum, found {counted(best.agreed, 'time')} by "
        f"{counted(best.starts, 'start')}; {best.n_local_maxima} local "
        f"{'maximum' if best.n_local_maxima == 1 else 'maxima'} found, "
        f"{best.expected_unseen:.2g} more expected; "
        f"{counted(best.evaluations, 'evaluation')}{seed}{proof}"
    )
