"""The published planar designs: one TOML file each in `catalogue/planar/`."""

from __future__ import annotations

from gsp.errors import UnknownDesign, brief
from gsp.files.knowledge import knowledge
from gsp.planar.design import PlanarDesign, read_planar_design


def planar_design_names() -> tuple[str, ...]:
    """Return the names of the published planar designs, sorted."""
    return tuple(sorted(path.stem for path in knowledge("catalogue", "planar").glob("*.toml")))


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
    if not isinstance(name, str) or name not in planar_design_names():
        shown = name if isinstance(name, str) else brief(name)
        raise UnknownDesign("planar design", shown, planar_design_names())
    return read_planar_design(knowledge("catalogue", "planar", f"{name}.toml"))
