"""The constraints and actuators of a compiled MuJoCo model, as loops and couplings of a linkage."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.bridges.reading.mechanism.linkages import Coupling, Freedom, Link
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    import mujoco

# Place of `torquescale` in the numbers of a weld constraint.
TORQUE_SCALE = 10
# How actuators act, with the words of messages.
TRANSMISSIONS = {
    "JOINT": "a joint",
    "JOINTINPARENT": "a joint",
    "TENDON": "a tendon through sites",
    "SITE": "a site",
    "SLIDERCRANK": "a slider-crank",
    "BODY": "a body",
}


def name_of(program: Any, model: mujoco.MjModel, kind: str, number: int) -> str:
    """Return the name of an object; its kind and number where it has none."""
    found = program.mj_id2name(model, getattr(program.mjtObj, f"mjOBJ_{kind}"), number)
    return found or f"{kind.lower()} {number}"


def actuators(program: Any, model: mujoco.MjModel) -> tuple[set[int], list[Coupling]]:
    """Return the joints that have actuators, and actuators of several joints as couplings.

    Adhesion, which is a force between bodies in contact, is left out.

    Raises
    ------
    InvalidInput
        For an actuator of sites, of a tendon through sites, or of a free joint.
    """
    kinds = {int(getattr(program.mjtTrn, f"mjTRN_{x}")): x for x in TRANSMISSIONS}
    driven: set[int] = set()
    couplings = []
    for i in range(model.nu):
        name = name_of(program, model, "ACTUATOR", i)
        where = f"<actuator>, {brief(name)}"
        kind = kinds.get(int(model.actuator_trntype[i]), "another transmission")
        if kind == "BODY":
            continue
        object_ = int(model.actuator_trnid[i, 0])
        joints = {"JOINT": [object_], "JOINTINPARENT": [object_]}.get(kind)
        if kind == "TENDON":
            joints = _joints_of_tendon(program, model, object_)
        free = int(program.mjtJoint.mjJNT_FREE)
        if not joints or any(model.jnt_type[j] == free for j in joints):
            got = "a free joint" if joints else TRANSMISSIONS.get(kind, kind)
            raise InvalidInput(expected(where, "an actuator of a slide or a hinge", got))
        driven.update(joints)
        if len(joints) > 1:
            names = tuple(name_of(program, model, "JOINT", j) for j in joints)
            got = "one actuator of " + " and ".join(map(brief, names))
            couplings.append(Coupling(where, names, got))
    return driven, couplings


def _joints_of_tendon(program: Any, model: mujoco.MjModel, tendon: int) -> list[int]:
    """Return the joints of a fixed tendon; none for one through sites."""
    first = int(model.tendon_adr[tendon])
    wraps = range(first, first + int(model.tendon_num[tendon]))
    if any(model.wrap_type[i] != int(program.mjtWrap.mjWRAP_JOINT) for i in wraps):
        return []
    return [int(model.wrap_objid[i]) for i in wraps]


def equalities(program: Any, model: mujoco.MjModel) -> Iterator[Coupling]:
    """Yield the active constraints between joints; those that are inactive are as if absent.

    Raises
    ------
    InvalidInput
        For an active constraint of another kind than connect, weld and joint.
    """
    connect, weld, joint = (
        int(getattr(program.mjtEq, f"mjEQ_{x}")) for x in ("CONNECT", "WELD", "JOINT")
    )
    for i in _active(program, model):
        kind = model.eq_type[i]
        if kind in (connect, weld):
            continue
        where = f"<equality>, {brief(name_of(program, model, 'EQUALITY', i))}"
        if kind != joint:
            wanted = "an active constraint connect, weld or joint"
            got = program.mjtEq(int(kind)).name.removeprefix("mjEQ_").lower()
            raise InvalidInput(expected(where, wanted, got))
        numbers = [int(x) for x in (model.eq_obj1id[i], model.eq_obj2id[i]) if x >= 0]
        names = tuple(name_of(program, model, "JOINT", j) for j in numbers)
        held = f"a constraint that holds the joint {brief(names[0])}"
        coupled = "a constraint between the joints " + " and ".join(map(brief, names))
        yield Coupling(where, names, held if len(names) == 1 else coupled)


def _active(program: Any, model: mujoco.MjModel) -> list[int]:
    """Return the constraints that act.

    Raises
    ------
    InvalidInput
        If there are some, but flags of the model disable all of them: the legs are open.
    """
    active = [i for i in range(model.neq) if model.eq_active0[i]]
    flags = program.mjtDisableBit
    for name, flag in (
        ("equality", flags.mjDSBL_EQUALITY),
        ("constraint", flags.mjDSBL_CONSTRAINT),
    ):
        if active and model.opt.disableflags & int(flag):
            raise InvalidInput(expected(f"<flag>, {name}", "enable, for the loops", "disable"))
    return active


def loops(
    program: Any, model: mujoco.MjModel, data: mujoco.MjData, names: list[str]
) -> Iterator[Link]:
    """Yield the active connect and weld constraints between bodies or sites.

    A weld without torque leaves all turns free, as connect does.
    """
    connect, weld = (int(getattr(program.mjtEq, f"mjEQ_{x}")) for x in ("CONNECT", "WELD"))
    for i in _active(program, model):
        if model.eq_type[i] not in (connect, weld):
            continue
        name = name_of(program, model, "EQUALITY", i)
        bodies, points = _ends(program, model, data, i)
        ball = model.eq_type[i] == connect or model.eq_data[i, TORQUE_SCALE] == 0.0
        freedoms = [Freedom(kind="ball", name=name, point=points[0])] if ball else []
        shift = Pose(points[1] - points[0])
        if not ball:
            sites = model.eq_objtype[i] == int(program.mjtObj.mjOBJ_SITE)
            shift = _site_shift(model, data, i) if sites else _weld_shift(model, data, i, bodies)
        yield Link(
            name=name,
            parent=names[bodies[0]],
            child=names[bodies[1]],
            freedoms=freedoms,
            where=f"<equality>, {brief(name)}",
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


def _site_shift(model: mujoco.MjModel, data: mujoco.MjData, i: int) -> Pose:
    """Return the gap of a weld of two sites, whose frames are the same when it is closed."""
    one, two = (
        Pose(np.array(data.site_xpos[k]), data.site_xmat[k].reshape(3, 3))
        for k in (int(model.eq_obj1id[i]), int(model.eq_obj2id[i]))
    )
    return two.compose(one.inverse())
