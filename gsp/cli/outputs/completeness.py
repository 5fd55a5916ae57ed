"""How much of what was wanted a region and its files have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from gsp.cli.outputs.console import counted, warn
from gsp.rounding import rounded_down

if TYPE_CHECKING:
    from gsp.workspace import LabelledBoundary, Region, Section

# Sums of the same cells in another order differ by less than this share.
BRACKET_ROUNDING = 1e-9


def check_reached(
    region: Region, wanted: float | None, unit: str, scale: float = 1.0, aim: str | None = None
) -> None:
    """Warn of a resolution that was not reached, and of a measure that is known badly.

    Badly: a search without a resolution would have gone on. Texts are in `unit`, 1/scale of that of
    the region; `aim` is one of `BRACKET_TOLERANCES`.
    """
    from gsp.workspace.sets.tree.growing import MOST_LEVELS

    why = "cells are not halved more often" if region.levels >= MOST_LEVELS else "the budget ended"
    end = f"undecided cells of up to {region.resolution * scale:.4g} {unit}".rstrip()
    if wanted is None:
        _check_known(region, aim or region.kind, f"{why} with {end}")
    elif not region.reached:
        size = f"{wanted * scale:.4g} {unit}".rstrip()
        warn(f"--resolution: {size} is not reached: {why} with {end}")
    else:
        _check_known(region, aim or region.kind, f"{end}; a finer --resolution would help")


def _check_known(region: Region, aim: str, why: str) -> None:
    """Warn of an area or a volume that is not known as well as a search without resolution aims."""
    from gsp.workspace.sets.questions import BRACKET_TOLERANCES

    if region.problem.unbounded_limits:
        why = "of a limit no bound over cells is known"
    low, high = region.bracket
    what = {"plane": "area", "orientations": "share"}.get(region.kind, "volume")
    known = (high - low) / (high + low) if high > 0.0 else 0.0
    if known > BRACKET_TOLERANCES[aim] * (1.0 + BRACKET_ROUNDING):
        nothing = "" if low > 0.0 else "nothing is proven inside, and "
        warn(f"{nothing}the {what} is known within ±{100.0 * known:.3g} % only: {why}")


def check_curves(boundary: LabelledBoundary, known: int) -> None:
    """Warn if curves are incomplete; `known` counts curves, and cells that one should pass."""
    if not known:
        what = "no curve was found, and of no cell it is proven that the boundary passes it"
        warn(f"{what}; a finer --resolution may help")
    if left := len(boundary.incomplete) + boundary.waiting:
        warn(f"{counted(left, 'curve')} not followed to an end")
    check_stopped(boundary.section)


def check_stopped(section: Section) -> None:
    """Warn if the search of curves ended at its greatest number of curves or steps."""
    if section.stopped_by is not None:
        unit = {"most": "curves", "budget": "steps along curves"}[section.stopped_by]
        found = counted(len(section.curves), "curve")
        warn(
            f"the search ended at the greatest number of {unit}, after {found}: others are missing"
        )


def share_in(region: Region, path: Path) -> str:
    """Return how much of the volume a file has: surfaces are those of what is proven inside."""
    from gsp.workspace.sets.shapes.files import SOLID

    if region.kind == "plane" or path.suffix.lower() not in SOLID:
        return ""
    low, high = region.bracket
    what = "orientations" if region.kind == "orientations" else "volume"
    share = rounded_down(100.0 * low / high, 3)
    return f": what is proven inside, at least {share:g} % of the {what}"
