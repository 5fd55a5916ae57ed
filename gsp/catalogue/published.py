"""The published designs: one TOML file each in `catalogue/designs/`."""

from __future__ import annotations

import pandas as pd

from gsp.design import Design, read_design
from gsp.errors import UnknownDesign
from gsp.knowledge import knowledge


def design_names() -> tuple[str, ...]:
    """Return the names of the published designs, sorted."""
    return tuple(sorted(path.stem for path in knowledge("catalogue", "designs").glob("*.toml")))


def design(name: str) -> Design:
    """Return a published design by its name.

    Raises
    ------
    UnknownDesign
        With the nearest names.

    Examples
    --------
    >>> design("toz-kucuk-2016-d3-6").mechanism.name
    'D3^6'
    """
    if not isinstance(name, str) or name not in design_names():
        raise UnknownDesign("design", str(name), design_names())
    return read_design(knowledge("catalogue", "designs", f"{name}.toml"))


def designs() -> pd.DataFrame:
    """Return a table of the published designs: name, mechanism, legs, unit, length, source."""
    return pd.DataFrame(
        [
            {
                "name": d.name,
                "mechanism": d.mechanism.name,
                "n_legs": d.n_legs,
                "unit": d.unit,
                "characteristic_length": d.characteristic_length,
                "source": d.source,
            }
            for d in map(design, design_names())
        ]
    )
