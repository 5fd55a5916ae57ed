"""The linkage of an MJCF file, as MuJoCo compiles it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.arguments import LARGEST_NUMBER
from gsp.bridges.links.drives import NO_STROKE
from gsp.bridges.mujoco.program import load_mujoco, silent
from gsp.bridges.reading.formats.mujoco_constraints import actuators, equalities, loops, name_of
from gsp.bridges.reading.mechanism.linkages import Freedom, Link, Linkage
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import MalformedFile, brief, cut, expected
from gsp.files.cells import number_of
from gsp.geometry.pose import Pose

if TYPE_CHECKING:
    import mujoco

WORLD = "world"
LONGEST_REASON = 300  # characters
# Attributes that hold numbers, of which places and axes of bodies, joints and sites are made.
NUMBERS = (
    *(
        "anchor",
        "axis",
        "axisangle",
        "diaginertia",
        "euler",
        "fromto",
        "fullinertia",
        "mass",
        "pos",
    ),
    *("quat", "range", "ref", "relpose", "xyaxes", "zaxis"),
)


def read_mjcf(path: Path, base: str = "", platform: str = "") -> Linkage:
    """Return the linkage of a MuJoCo model, in the configuration in which it starts.

    Raises
    ------
    MissingSoftware
        If MuJoCo is not installed.
    MalformedFile
        With the file, and MuJoCo's reason with the line and element.
    """
    program = load_mujoco()
    root = XmlFile(path).root
    if root.tag != "mujoco":
        wanted = "<mujoco>"
        raise MalformedFile(expected(f"{path}, root element", wanted, f"<{cut(root.tag)}>"))
    _check_numbers(path, set())
    try:
        with silent(program):
            model = program.MjModel.from_xml_path(str(path))
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:LONGEST_REASON]
        raise MalformedFile(expected(str(path), "a model that MuJoCo reads", reason)) from error
    data = program.MjData(model)
    program.mj_kinematics(model, data)  # places alone: masses do not matter
    names = [name_of(program, model, "BODY", i) for i in range(model.nbody)]
    places = {
        name: Pose.from_quaternion(data.xpos[i], np.roll(data.xquat[i], -1))
        for i, name in enumerate(names)
    }
    driven, couplings = actuators(program, model)
    links = [
        *_tree(program, model, data, names, driven),
        *loops(program, model, data, names),
    ]
    title = bytes(model.names).split(b"\0")[0].decode()
    return Linkage(
        name=root.get("model", title),
        base=base or WORLD,
        platform=platform,
        likely=_free_body(program, model, names),
        places=places,
        links=links,
        couplings=[*couplings, *equalities(program, model)],
    )


def _check_numbers(path: Path, seen: set[Path]) -> None:
    """Raise MalformedFile for an attribute without numbers, with NaN, or infinite but for limits.

    An empty `anchor` ends MuJoCo 3 and 4 with an error after which it loads no further model in
    the same process: the next call waits without end. NaN is not named by MuJoCo.
    """
    file = XmlFile(path)
    for node in file.root.iter():
        for key in NUMBERS:
            text = node.get(key)
            if text is not None:
                _check_attribute(file, node, key, text)
        name = node.get("file") if node.tag == "include" else None
        included = path.parent / (name or "")
        if name and included not in seen and included.is_file():
            _check_numbers(included, seen | {included})


def _check_attribute(file: XmlFile, node: Node, key: str, text: str) -> None:
    parts = text.split()
    if not parts:
        file.fail(node, key, "numbers", "an empty text")
    most = np.inf if key == "range" else LARGEST_NUMBER
    if not all(abs(number_of(part)) <= most for part in parts):
        file.fail(node, key, "numbers" if key == "range" else "finite numbers", brief(text))


def _free_body(program: Any, model: mujoco.MjModel, names: list[str]) -> str:
    """Return the body that floats, if one does: in models of closed chains the platform."""
    free = [
        names[model.jnt_bodyid[j]]
        for j in range(model.njnt)
        if model.jnt_type[j] == int(program.mjtJoint.mjJNT_FREE)
    ]
    return free[0] if len(free) == 1 else ""


def _tree(
    program: Any,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    names: list[str],
    driven: set[int],
) -> Iterator[Link]:
    for i in range(1, model.nbody):
        first = model.body_jntadr[i]
        joints = range(first, first + model.body_jntnum[i]) if first >= 0 else range(0)
        kinds = [int(model.jnt_type[j]) for j in joints]
        if int(program.mjtJoint.mjJNT_FREE) in kinds:
            continue
        freedoms = [_freedom(program, model, data, j, driven) for j in joints]
        parent = names[model.body_parentid[i]]
        yield Link(name=f"joints of {names[i]}", parent=parent, child=names[i], freedoms=freedoms)


def _freedom(
    program: Any, model: mujoco.MjModel, data: mujoco.MjData, j: int, driven: set[int]
) -> Freedom:
    name, point = name_of(program, model, "JOINT", j), np.array(data.xanchor[j])
    active = j in driven if driven else None
    if model.jnt_type[j] == int(program.mjtJoint.mjJNT_BALL):
        return Freedom(kind="ball", name=name, point=point, active=active)
    value = float(model.qpos0[model.jnt_qposadr[j]])
    limits = not model.opt.disableflags & int(program.mjtDisableBit.mjDSBL_LIMIT)
    limited = limits and model.jnt_limited[j]
    ends = model.jnt_range[j] if limited else np.full(2, np.inf)
    low, high = np.where(np.abs(ends) < NO_STROKE, ends - value, [-np.inf, np.inf])
    return Freedom(
        kind="slide" if model.jnt_type[j] == int(program.mjtJoint.mjJNT_SLIDE) else "turn",
        name=name,
        point=point,
        axis=np.array(data.xaxis[j]),
        low=float(low),
        high=float(high),
        value=value,
        active=active,
    )
