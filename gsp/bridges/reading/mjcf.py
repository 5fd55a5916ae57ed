"""The linkage of an MJCF file, as MuJoCo compiles it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.arguments import LARGEST_NUMBER
from gsp.bridges.mujoco.simulation import load_mujoco
from gsp.bridges.reading.linkages import Freedom, Link, Linkage
from gsp.bridges.reading.xml_lines import Node, XmlFile
from gsp.errors import MalformedFile, brief, cut, expected
from gsp.files.cells import number_of
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

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
        model = program.MjModel.from_xml_path(str(path))
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:LONGEST_REASON]
        raise MalformedFile(expected(str(path), "a model that MuJoCo reads", reason)) from error
    data = program.MjData(model)
    program.mj_kinematics(model, data)  # forces may not exist
    names = [_name(program, model, "BODY", i) for i in range(model.nbody)]
    places = {
        name: Pose.from_quaternion(data.xpos[i], np.roll(data.xquat[i], -1))
        for i, name in enumerate(names)
    }
    driven = _driven(program, model)
    links = [
        *_tree(program, model, data, names, driven),
        *_loops(program, model, data, names),
    ]
    title = bytes(model.names).split(b"\0")[0].decode()
    return Linkage(
        name=root.get("model", title),
        base=base or WORLD,
        platform=platform or _free_body(program, model, names),
        places=places,
        links=links,
    )


def _check_numbers(path: Path, seen: set[Path]) -> None:
    """Raise MalformedFile for an attribute without numbers, or with NaN or infinite ones.

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
    if not all(abs(number_of(part)) <= LARGEST_NUMBER for part in parts):
        file.fail(node, key, "finite numbers", brief(text))


def _name(program: Any, model: mujoco.MjModel, kind: str, number: int) -> str:
    """Return the name of an object; its kind and number where it has none."""
    found = program.mj_id2name(model, getattr(program.mjtObj, f"mjOBJ_{kind}"), number)
    return found or f"{kind.lower()} {number}"


def _free_body(program: Any, model: mujoco.MjModel, names: list[str]) -> str:
    """Return the body that floats, if one does: in models of closed chains the platform."""
    free = [
        names[model.jnt_bodyid[j]]
        for j in range(model.njnt)
        if model.jnt_type[j] == int(program.mjtJoint.mjJNT_FREE)
    ]
    return free[0] if len(free) == 1 else ""


def _driven(program: Any, model: mujoco.MjModel) -> set[int]:
    """Return the joints that have actuators."""
    kinds = (int(program.mjtTrn.mjTRN_JOINT), int(program.mjtTrn.mjTRN_JOINTINPARENT))
    return {
        int(model.actuator_trnid[i, 0])
        for i in range(model.nu)
        if model.actuator_trntype[i] in kinds
    }


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
    name, point = _name(program, model, "JOINT", j), np.array(data.xanchor[j])
    if model.jnt_type[j] == int(program.mjtJoint.mjJNT_BALL):
        return Freedom(kind="ball", name=name, point=point)
    value = float(model.qpos0[model.jnt_qposadr[j]])
    low, high = (model.jnt_range[j] - value) if model.jnt_limited[j] else (-np.inf, np.inf)
    return Freedom(
        kind="slide" if model.jnt_type[j] == int(program.mjtJoint.mjJNT_SLIDE) else "turn",
        name=name,
        point=point,
        axis=np.array(data.xaxis[j]),
        low=float(low),
        high=float(high),
        value=value,
        active=j in driven if driven else None,
    )


def _loops(
    program: Any, model: mujoco.MjModel, data: mujoco.MjData, names: list[str]
) -> Iterator[Link]:
    """Connect and weld constraints between bodies or sites."""
    connect, weld = (int(getattr(program.mjtEq, f"mjEQ_{x}")) for x in ("CONNECT", "WELD"))
    for i in range(model.neq):
        if model.eq_type[i] not in (connect, weld):
            continue
        name = _name(program, model, "EQUALITY", i)
        bodies, points = _ends(program, model, data, i)
        ball = model.eq_type[i] == connect
        freedoms = [Freedom(kind="ball", name=name, point=points[0])] if ball else []
        shift = Pose(points[1] - points[0])
        if not ball and model.eq_objtype[i] == int(program.mjtObj.mjOBJ_BODY):
            shift = _weld_shift(model, data, i, bodies)
        yield Link(
            name=name,
            parent=names[bodies[0]],
            child=names[bodies[1]],
            freedoms=freedoms,
            shift=shift,
        )


def _ends(
    program: Any, model: mujoco.MjModel, data: mujoco.MjData, i: int
) -> tuple[list[int], list[Array]]:
    """Return the bodies of a constraint, and where each has the point that they share."""
    objects = [int(model.eq_obj1id[i]), int(model.eq_obj2id[i])]
    if model.eq_objtype[i] == int(program.mjtObj.mjOBJ_SITE):
        bodies = [int(model.site_bodyid[k]) for k in objects]
        return bodies, [np.array(data.site_xpos[k]) for k in objects]
    if model.eq_type[i] == int(program.mjtEq.mjEQ_CONNECT):
        anchors = model.eq_data[i, :3], model.eq_data[i, 3:6]
    else:
        anchors = model.eq_data[i, 3:6], model.eq_data[i, :3]
    points = [
        data.xpos[k] + data.xmat[k].reshape(3, 3) @ anchor
        for k, anchor in zip(objects, anchors, strict=True)
    ]
    return objects, points


def _weld_shift(model: mujoco.MjModel, data: mujoco.MjData, i: int, bodies: list[int]) -> Pose:
    """Return how the second body would move if the first closed the weld: the gap."""
    one, two = (Pose.from_quaternion(data.xpos[k], np.roll(data.xquat[k], -1)) for k in bodies)
    relative = Pose.from_quaternion(np.zeros(3), np.roll(model.eq_data[i, 6:10], -1))
    # In the frame of the first body: where the second is when the weld is closed.
    turned = one.rotation @ relative.rotation
    first, second = model.eq_data[i, 3:6], model.eq_data[i, :3]
    at = one.position + one.rotation @ first - turned @ second
    return two.compose(Pose(at, turned).inverse())
