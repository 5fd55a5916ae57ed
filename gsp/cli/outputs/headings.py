"""Headings of tables in LaTeX: symbols of indices, joints, poses and twists, with units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from gsp.files.tables import escaped, joint_symbol
from gsp.geometry.frames.changes import TWIST_NAMES
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.indices import INDICES
from gsp.ranking import STATISTICS

if TYPE_CHECKING:
    import pandas as pd

    from gsp.model.design import Design

GREEK = {"λ": r"\lambda", "σ": r"\sigma", "φ": r"\varphi"}
WORDS = {"q05": r"5\,\%", "q95": r"95\,\%"}
_POWER = re.compile(r"(.+)\^\(?(-?\d+)\)?")
TWIST_SYMBOLS = {name: name.replace("omega", r"\omega").join("$$") for name in TWIST_NAMES}


def latex_headings(table: pd.DataFrame) -> dict[str, str]:
    """Return the headings of the columns of a table that are of indices, as LaTeX.

    Parameters
    ----------
    table : pandas.DataFrame
        With columns that are named as indices, or as one and a statistic; `attrs["units"]` has
        their units.
    """
    units = table.attrs.get("units")
    known: Mapping[str, Any] = units if isinstance(units, Mapping) else {}
    found = {}
    for column in map(str, table.columns):
        name, _, statistic = column.rpartition("_")
        if statistic not in STATISTICS:
            name, statistic = column, ""
        if name in INDICES:
            words = f" {WORDS.get(statistic, statistic)}" if statistic else ""
            found[column] = latex_symbol(INDICES[name].symbol) + words + _unit(known.get(name, ""))
    return found


def motion_headings(design: Design) -> dict[str, str]:
    """Return the headings of columns of poses, joints and twists of a design, as LaTeX."""
    places = {name: f"${name}$" + _unit(design.unit) for name in POSE_COLUMNS[:3]}
    angles = {name: name.replace("_", " ") + r" [$^\circ$]" for name in POSE_COLUMNS[3:]}
    joints = {
        name: joint_symbol(name) + _unit(unit)
        for name, unit in zip(design.joint_names, design.joint_units, strict=True)
    }
    return places | angles | joints | TWIST_SYMBOLS


def latex_symbol(symbol: str) -> str:
    r"""Return the symbol of an index as a formula.

    >>> print(latex_symbol("CDN_CL"), latex_symbol("σ_min"), latex_symbol("|det J|"))
    $\mathrm{CDN}_\mathrm{CL}$ $\sigma_\mathrm{min}$ $|\det J|$
    """
    stem, _, foot = symbol.partition("_")
    stem = GREEK.get(stem, stem.replace("det", r"\det"))
    stem = rf"\mathrm{{{stem}}}" if stem.isalpha() and len(stem) > 1 else stem
    return f"${stem}" + (rf"_\mathrm{{{foot}}}" if foot else "") + "$"


def _unit(unit: Any) -> str:
    """Return " [mm³]" as LaTeX; several, which differ from design to design, as a list."""
    parts = [part.strip() for part in str(unit).split(",")]
    written = [_power(part) for part in parts if part not in ("", "1")]
    return f" [{', '.join(written)}]" if written else ""


def _power(unit: str) -> str:
    found = _POWER.fullmatch(unit)
    return f"{escaped(found[1])}$^{{{found[2]}}}$" if found else escaped(unit)
