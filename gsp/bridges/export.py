"""Writing a design as a model file of another program."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from gsp.bridges.mjcf import to_mjcf
from gsp.bridges.pinocchio_model import to_pinocchio
from gsp.bridges.solids import Solids
from gsp.bridges.urdf import to_urdf
from gsp.design import Design
from gsp.errors import UnknownName
from gsp.files import check_writable, write_file, write_text
from gsp.pose import Pose

Fill = Callable[[Path], object]


def export(
    design: Design,
    pose: Pose,
    form: str,
    path: str | PathLike[str],
    solids: Solids | None = None,
    *,
    overwrite: bool = False,
) -> tuple[Path, ...]:
    """Write a design as a model for another program.

    Parameters
    ----------
    design : Design
    pose : Pose
        A single pose, at which all legs are defined: where the model starts.
    form : "mjcf", "urdf" or "pinocchio"
        See `to_mjcf`, `to_urdf` and `to_pinocchio`. The last is written by Pinocchio itself as
        XML (read it with `Model.loadFromXML(path, "model")`).
    path : path
        Of the model. The loops of "urdf" and "pinocchio", and the configuration, go beside it
        to a file of the same name that ends in `.loops.json`.
    solids : Solids or None
        Sizes and masses of the links.
    overwrite : bool
        Whether files that exist may be replaced.

    Returns
    -------
    tuple of Path
        The files written.

    Raises
    ------
    UnknownName
        If there is no such form.
    UndefinedPosture, MissingParameter, InvalidInput
        If the model cannot be made; nothing is written then.
    UnwritableOutput
        If a file exists already, or the folder cannot be written.
    """
    if form not in FORMS:
        raise UnknownName("form", form, FORMS)
    target = Path(path)
    beside = target.with_suffix(".loops.json")
    fills = FORMS[form](design, pose, solids)
    files = dict(zip((target, beside), fills, strict=False))
    for file in files:
        check_writable(file, overwrite=overwrite)
    for file, fill in files.items():
        fill(file)
    return tuple(files)
