"""A design as URDF: its tree of links, and the loops, which URDF cannot contain."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from gsp.bridges.linkage import Chain, Motion, X, Z, linkage
from gsp.bridges.solids import Body, Capsule, Solids, capsules, check_solids
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross
from gsp.model.design import Design

Node = ElementTree.Element
EFFORT_LIMIT, VELOCITY_LIMIT = "1e6", "1e3"  # N or N m; m/s or rad/s: URDF demands numbers


class Loop(NamedTuple):
    """One loop to close: link_1 is welded to link_2 where `placement` lies on link_2.

    Attributes
    ----------
    name : str
        Of the leg, "leg1" ….
    link_1, link_2 : str
        The last link of the leg, and "platform".
    placement : Pose
        Where the frame of link_1 lies in that of link_2 when the loop is closed [m].
    """

    name: str
    link_1: str
    link_2: str
    placement: Pose


class Urdf(NamedTuple):
    """A tree in URDF, and the loops and the pose, which URDF cannot contain.

    Attributes
    ----------
    text : str
    loops : tuple of Loop
    configuration : mapping of joint name to value [m, rad]
        The posture. The floating joint "base_to_platform" is not in it: its value is `platform`.
    platform : Pose
        Of the platform in the base [m].
    """

    text: str
    loops: tuple[Loop, ...]
    configuration: Mapping[str, float]
    platform: Pose

    def beside(self) -> str:
        """Return loops, configuration and pose as JSON; rotations are (x, y, z, w)."""
        loops = [
            {
                "name": loop.name,
                "link_1": loop.link_1,
                "link_2": loop.link_2,
                **_numbers(loop.placement),
            }
            for loop in self.loops
        ]
        content = {
            "loops": loops,
            "configuration": dict(self.configuration),
            "platform": _numbers(self.platform),
        }
        return json.dumps(content, indent=2) + "\n"


def to_urdf(design: Design, pose: Pose, solids: Solids | None = None) -> Urdf:
    """Return the tree of a design as URDF, with its loops beside it.

    The tree is the base, the platform on a floating joint, and the open legs; lengths are metres,
    for every unit of the design. A spherical joint is three turns about z, y and x
    ("leg1_base_z" …), a cylindrical one a slide and a turn. Actuated joints have their names of
    `Posture.joint_names`.

    Parameters
    ----------
    design : Design
        Any mechanism, redundant ones included.
    pose : Pose
        A single pose, at which all legs are defined.
    solids : Solids or None
        Sizes and masses of the links; default thin aluminium.

    Returns
    -------
    Urdf

    Raises
    ------
    UndefinedPosture
        If a leg is not defined at the pose, or one of its joint axes has no direction.
    MissingParameter
        If the unit of the design is unknown: give `solids.metres`.
    InvalidInput
        If `pose` is a batch.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> tree = to_urdf(design, design.home)
    >>> tree.loops[0].link_1, round(tree.configuration["d1"], 6)
    ('leg1_platform', 0.143909)
    """
    chains = linkage(design, pose)
    metres = check_solids(solids).unit(design)
    bodies = capsules(design, chains, solids)
    root = ElementTree.Element("robot", name=design.name or design.mechanism.name)
    _add_link(root, "base", bodies["base"], metres)
    _add_link(root, "platform", bodies["platform"], metres)
    _add_joint(root, "base_to_platform", "floating", "base", "platform", Pose(np.zeros(3)))
    configuration: dict[str, float] = {}
    for chain in chains:
        configuration |= _add_leg(root, chain, bodies, metres)
    _limit(root, design, metres)
    ElementTree.indent(root)
    loops = [
        Loop(c.name, f"{c.name}_platform", "platform", _metric(c.head, metres)) for c in chains
    ]
    text = '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"
    return Urdf(text, tuple(loops), configuration, _metric(pose, metres))


def _add_leg(
    root: Node, chain: Chain, bodies: Mapping[str, tuple[Capsule, ...]], metres: float
) -> dict[str, float]:
    """Add the links and joints of a leg, and return the values of its joints."""
    parent, place = "base", _metric(chain.foot, metres)
    values: dict[str, float] = {}
    solid = {
        "lower": bodies[f"{chain.name}_lower"],
        "upper": bodies[f"{chain.name}_upper"],
        "platform": bodies.get(f"{chain.name}_rail", ()),
    }
    joints = (("lower", chain.base), ("upper", chain.middle), ("platform", chain.platform))
    for ending, motions in joints:
        steps = [step for motion in motions for step in _steps(motion, metres)]
        for name, kind, axis, value in steps:
            last = name == steps[-1][0]
            child = f"{chain.name}_{ending}" if last else f"{name}_link"
            _add_link(root, child, solid[ending] if last else (), metres)
            _add_joint(root, name, kind, parent, child, place, axis)
            values[name] = value
            parent, place = child, Pose(np.zeros(3))
    return values


def _steps(motion: Motion, metres: float) -> Iterator[tuple[str, str, Array, float]]:
    """URDF joints of a motion: name, type, axis, value."""
    if motion.kind == "slide":
        yield motion.name, "prismatic", motion.axis, float(motion.value) * metres
    elif motion.kind == "turn":
        yield motion.name, "continuous", motion.axis, float(motion.value)
    else:
        x, y, z = _angles(motion.placement)
        for letter, axis, value in (("z", Z, z), ("y", cross(Z, X), y), ("x", X, x)):
            yield f"{motion.name}_{letter}", "continuous", axis, float(value)


def _add_link(root: Node, name: str, parts: Sequence[Capsule], metres: float) -> None:
    link = ElementTree.SubElement(root, "link", name=name)
    if parts:
        _add_inertia(link, Body.of(parts), metres)
    for part in parts:
        visual = ElementTree.SubElement(link, "visual")
        _add_origin(visual, _metric(part.frame, metres))
        shape = ElementTree.SubElement(visual, "geometry")
        sizes = {"radius": repr(part.radius * metres)}
        if part.length > 0.0:
            sizes["length"] = repr(part.length * metres)
        ElementTree.SubElement(shape, "cylinder" if part.length > 0.0 else "sphere", sizes)


def _add_inertia(link: Node, body: Body, metres: float) -> None:
    inertial = ElementTree.SubElement(link, "inertial")
    _add_origin(inertial, Pose(body.centre * metres))
    ElementTree.SubElement(inertial, "mass", value=repr(body.mass))
    moments = body.inertia * metres**2
    names = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2),
             "izz": (2, 2)}  # fmt: skip
    ElementTree.SubElement(
        inertial, "inertia", {name: repr(float(moments[at])) for name, at in names.items()}
    )


def _add_joint(
    root: Node,
    name: str,
    kind: str,
    parent: str,
    child: str,
    place: Pose,
    axis: Array | None = None,
) -> None:
    joint = ElementTree.SubElement(root, "joint", name=name, type=kind)
    _add_origin(joint, place)
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    if axis is not None:
        ElementTree.SubElement(joint, "axis", xyz=_text(axis))
    if kind == "prismatic":
        _add_limit(joint, np.array([-1e9, 1e9]))


def _limit(root: Node, design: Design, metres: float) -> None:
    """Write the strokes of the actuators as limits."""
    if design.strokes is None:
        return
    joints = {joint.get("name", ""): joint for joint in root.iter("joint")}
    actuators = zip(design.joint_names, design.strokes, design.angular, strict=True)
    for name, stroke, angular in actuators:
        joint = joints[name]
        if not np.isfinite(stroke).all():
            continue
        if angular:
            joint.set("type", "revolute")  # a continuous joint has no limits
        for unlimited in joint.findall("limit"):
            joint.remove(unlimited)
        _add_limit(joint, stroke * (1.0 if angular else metres))


def _add_limit(joint: Node, interval: Array) -> None:
    lower, upper = (repr(float(bound)) for bound in interval)
    ElementTree.SubElement(
        joint, "limit", lower=lower, upper=upper, effort=EFFORT_LIMIT, velocity=VELOCITY_LIMIT
    )


def _add_origin(node: Node, place: Pose) -> None:
    ElementTree.SubElement(node, "origin", xyz=_text(place.position), rpy=_text(_angles(place)))


def _angles(place: Pose) -> Array:
    """Roll, pitch, yaw; at a pitch of 90° roll and yaw are not unique, and any pair is valid."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        return place.angles("rpy")


def _metric(pose: Pose, metres: float) -> Pose:
    return Pose(pose.position * metres, pose.rotation)


def _numbers(pose: Pose) -> dict[str, list[float]]:
    return {"position": pose.position.tolist(), "rotation": pose.quaternion.tolist()}


def _text(numbers: ArrayLike) -> str:
    return " ".join(repr(float(x)) for x in np.asarray(numbers).ravel())
