"""The published designs: one TOML file each in `catalogue/designs/`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gsp.files.knowledge import design_file, design_files
from gsp.geometry.pose import Pose
from gsp.model.design import Design, read_design
from gsp.model.drives import drives_text

if TYPE_CHECKING:
    import pandas as pd


def design_names() -> tuple[str, ...]:
    """Return the names of the published designs, sorted."""
    return tuple(design_files("catalogue", "designs"))


def design(name: str) -> Design:
    """Return a published design by its name.

    Parameters
    ----------
    name : str
        The name of a file in `catalogue/designs/`, without its ending.

    Returns
    -------
    Design

    Raises
    ------
    UnknownDesign
        With the nearest names.

    Examples
    --------
    >>> design("toz-kucuk-2016-d3-6").mechanism.name
    'D3^6'
    """
    return read_design(design_file("design", name, "catalogue", "designs"))


def designs() -> pd.DataFrame:
    """Return a table of the published designs, one per row.

    Columns: name, mechanism, class, n_legs, drives ("6 cranks"; "" without drives at the base),
    unit, characteristic_length, pose (the one that the source studies, as text; the design has it
    as `home`), source.

    Examples
    --------
    >>> designs().set_index("name").loc["nawratil-k-plus", "mechanism"]
    'D1^6'
    """
    import pandas as pd

    return pd.DataFrame([_row(design(name)) for name in design_names()])


def _row(design: Design) -> dict[str, Any]:
    return {
        "name": design.name,
        "mechanism": design.mechanism.name,
        "class": design.mechanism.group,
        "n_legs": design.n_legs,
        "drives": drives_text(design.drives),
        "unit": design.unit,
        "characteristic_length": design.characteristic_length,
        "pose": "" if design.home is None else _pose(design.home),
        "source": design.source,
    }


def _pose(pose: Pose) -> str:
    """Position, and roll, pitch, yaw in degrees where the platform is turned."""
    position, turns = (
        [f"{x + 0.0:.6g}" for x in v] for v in (pose.position, pose.angles(degrees=True).round(9))
    )
    rpy = f", rpy ({', '.join(turns)})°" if set(turns) != {"0"} else ""
    return f"({', '.join(position)}){rpy}"
