"""A design as a model file of another program."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import partial
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from gsp import arguments
from gsp.bridges.formats.sdf import to_sdf
from gsp.bridges.formats.urdf import to_urdf
from gsp.bridges.links.drives import Drives
from gsp.bridges.links.solids import Solids
from gsp.bridges.mujoco.mjcf import to_mjcf
from gsp.bridges.pinocchio.model import to_pinocchio
from gsp.checks import check_text
from gsp.errors import InvalidInput, UnknownName, expected
from gsp.files.names import file_stem
from gsp.files.writing import check_writable, write_file
from gsp.geometry.pose import Pose
from gsp.model.design import Design

# Of the file beside a model: what the format cannot contain.
BESIDE = MappingProxyType(
    {"urdf": ".urdf.loops.json", "pinocchio": ".pinocchio.loops.json", "sdf": ".sdf.joints.json"}
)
Fill = Callable[[Path], object]


@arguments.validated(path=arguments.path, floating=arguments.flag, overwrite=arguments.flag)
def export(
    design: Design,
    pose: Pose,
    form: str,
    path: str | PathLike[str],
    solids: Solids | None = None,
    drives: Drives | None = None,
    *,
    floating: bool = True,
    overwrite: bool = False,
) -> tuple[Path, ...]:
    """Write a design as a model for another program.

    Parameters
    ----------
    design : Design
    pose : Pose
        A single pose, at which all legs are defined and the model is assembled.
    form : "mjcf", "urdf", "sdf" or "pinocchio"
        See `to_mjcf`, `to_urdf`, `to_sdf` and `to_pinocchio`. The last is written by Pinocchio
        itself as XML (read it with `pin.Model().loadFromXML(path, "model")`).
    path : path
        Of the model. The loops of "urdf" and "pinocchio", and the values of the joints, are written
        to a second file beside it, whose name ends in `.urdf.loops.json` or
        `.pinocchio.loops.json`; those of the joints of "sdf" in `.sdf.joints.json`.
    solids : Solids or None
        Sizes and masses of the links.
    drives : Drives or None
        Greatest forces and speeds of the actuators.
    floating : bool
        False: the platform of a URDF is fixed to the end of leg 1; see `to_urdf`.
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
        If the model cannot be made, or another form than "urdf" is not to be floating; nothing is
        written then.
    UnwritableOutput
        If a file exists already, or the folder cannot be written.
    """
    if check_text("form", form) not in FORMS:
        raise UnknownName("form", form, FORMS)
    target = Path(path)
    beside = target.with_name(target.stem.removesuffix(f".{form}") + BESIDE.get(form, ""))
    if not floating and form != "urdf":
        raise InvalidInput(expected("floating", f"True for {form}", "False"))
    filler = FORMS[form] if floating else partial(_fill_urdf, floating=False)
    fills = filler(design, pose, solids, drives)
    files = dict(zip((target, beside), fills, strict=False))
    for file in files:
        check_writable(file, overwrite=overwrite)
    for file, fill in files.items():
        write_file(file, fill, overwrite=overwrite)
    return tuple(files)


@arguments.validated(name=arguments.text)
def default_file(name: str, form: str) -> str:
    """Return the name of the file to which a design of this name is exported by default.

    It has no parts of a path, is not hidden, and differs from those of the other forms.

    Parameters
    ----------
    name : str
        Of the design.
    form : "mjcf", "urdf", "sdf" or "pinocchio"

    Returns
    -------
    str

    Raises
    ------
    UnknownName
        If there is no such form.

    Examples
    --------
    >>> default_file("../my press", "pinocchio")
    'my-press.pinocchio.xml'
    """
    if check_text("form", form) not in FORMS:
        raise UnknownName("form", form, FORMS)
    return file_stem(name) + ENDINGS[form]


Filler = Callable[[Design, Pose, Solids | None, Drives | None], tuple[Fill, ...]]


def _fill_mjcf(
    design: Design, pose: Pose, solids: Solids | None, drives: Drives | None
) -> tuple[Fill, ...]:
    return (_text(to_mjcf(design, pose, solids, drives)),)


def _fill_urdf(
    design: Design,
    pose: Pose,
    solids: Solids | None,
    drives: Drives | None,
    *,
    floating: bool = True,
) -> tuple[Fill, ...]:
    tree = to_urdf(design, pose, solids, drives, floating=floating)
    return (_text(tree.text), _text(tree.beside()))


def _fill_sdf(
    design: Design, pose: Pose, solids: Solids | None, drives: Drives | None
) -> tuple[Fill, ...]:
    model = to_sdf(design, pose, solids, drives)
    return (_text(model.text), _text(model.beside()))


def _fill_pinocchio(
    design: Design, pose: Pose, solids: Solids | None, drives: Drives | None
) -> tuple[Fill, ...]:
    machine = to_pinocchio(design, pose, solids, drives)
    loops = [
        {
            "name": loop.name,
            "joint_1": machine.model.names[loop.joint1_id],
            "joint_2": machine.model.names[loop.joint2_id],
            "position": loop.joint2_placement.translation.tolist(),
            "rotation": Pose.from_se3(loop.joint2_placement).quaternion.tolist(),
        }
        for loop in machine.constraints
    ]
    content = {"loops": loops, "configuration": machine.configuration.tolist()}
    beside = json.dumps(content, indent=2) + "\n"
    return (lambda path: machine.model.saveToXML(str(path), "model"), _text(beside))


def _text(text: str) -> Fill:
    return lambda path: path.write_text(text, encoding="utf-8")


FORMS: Mapping[str, Filler] = MappingProxyType(
    {"mjcf": _fill_mjcf, "urdf": _fill_urdf, "sdf": _fill_sdf, "pinocchio": _fill_pinocchio}
)
SUFFIXES = MappingProxyType({"mjcf": ".xml", "urdf": ".urdf", "sdf": ".sdf", "pinocchio": ".xml"})
# Of default names: exports of one design to several forms do not write the same file.
ENDINGS = MappingProxyType({**SUFFIXES, "pinocchio": ".pinocchio.xml"})
