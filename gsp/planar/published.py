"""The published planar designs: one TOML file each in `catalogue/planar/`."""

from __future__ import annotations

from gsp.files.knowledge import design_file, design_files
from gsp.planar.design import PlanarDesign, read_planar_design


def planar_design_names() -> tuple[str, ...]:
    """Return the names of the published planar designs, sorted."""
    return tuple(design_files("catalogue", "planar"))


def planar_design(name: str) -> PlanarDesign:
    """Return a published planar design by its name.

    Parameters
    ----------
    name : str
        The name of a file in `catalogue/planar/`, without its ending.

    Returns
    -------
    PlanarDesign

    Raises
    ------
    UnknownDesign
        With the nearest names.

    Examples
    --------
    >>> planar_design("lee-2000-planar").n_legs
    3
    """
    return read_planar_design(design_file("planar design", name, "catalogue", "planar"))
