"""Headings of tables in LaTeX: the symbols of indices, with their statistics and units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from gsp.files.tables import escaped
from gsp.indices import INDICES
from gsp.ranking import STATISTICS

if TYPE_CHECKING:
    import pandas as pd

GREEK = {"λ": r"\lambda", "σ": r"\sigma", "φ": r"\varphi"}
WORDS = {"q05": r"5\,\%", "q95": r"95\,\%"}
_POWER = re.compile(r"(.+)\^\(?(-?\d+)\)?")


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
