"""A design as URDF: its tree of links, and the loops, for which URDF has no element."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from gsp import arguments
from gsp.bridges.formats.contacts import NAMESPACE, disable_contacts_in_mujoco, ignore_own_contacts
from gsp.bridges.formats.loops import Loop, add_ball_constraints, add_gazebo_joints, loop_of
from gsp.bridges.formats.markup import (
    PURPOSES,
    Node,
    base_slides,
    joined,
    joint_values,
    metric,
    moments,
    numbers_of,
    roll_pitch_yaw,
    title_of,
    written,
)
from gsp.bridges.links.drives import (
    NO_STROKE,
    UNLIMITED,
    Drives,
    JointLimit,
    joint_limits,
    limit_at_zero,
)
from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain, Motion, X, Z
from gsp.bridges.links.shapes import Body, Capsule
from gsp.bridges.links.solids import Solids, capsules, check_solids
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross
from gsp.model.design import Design

# What is written where there is no limit, as URDF demands numbers: m or rad; N or N m; m/s or
# rad/s.
NO_LIMIT = JointLimit(-NO_STROKE, NO_STROKE, 1e6, 1e3)


@read_only_tuple
class Urdf(NamedTuple):
    """A tree in URDF, and the loops and the pose, which URDF cannot contain.

    Attributes
    ----------
    text : str
    loops : tuple of Loop
    joints : mapping of joint name to value [m, rad]
        Joint variables of the design where the joints of the tree are zero. The variable of an
        actuator is the sum of this number and the value of its joint in the tree.
    platform : Pose of shape ()
        Of the platform in the base where the joints of the tree are zero [m].
    slides : mapping of joint name to value [m]
        The same as `joints` of passive slides along lines of the base: how far the legs are from
        the anchors.
    """

    text: str
    loops: tuple[Loop, ...]
    joints: Mapping[str, float]
    platform: Pose
    slides: Mapping[str, float]

    def beside(self) -> str:
        """Return loops, joint variables and pose as JSON; rotations are (x, y, z, w)."""
        content = {
            "loops": [loop.numbers for loop in self.loops],
            "joints_at_zero": dict(self.joints),
            "slides_at_zero": dict(self.slides),
            "platform_at_zero": numbers_of(self.platform),
        }
        return json.dumps(content, indent=2) + "\n"


@arguments.validated(floating=arguments.flag)
def to_urdf(
    design: Design,
    pose: Pose,
    solids: Solids | None = None,
    drives: Drives | None = None,
    *,
    floating: bool = True,
) -> Urdf:
    """Return the tree of a design as URDF, with its loops beside it.

    The tree is the base, the platform on a floating joint, and the open legs. Lengths are metres,
    for every unit of the design. All joints are zero at the pose, so that the loops are closed in
    the configuration in which programs start. A spherical joint is three turns about z, y and x
    ("leg1_base_z" …), a cylindrical one a slide and a turn, with light links between them. Actuated
    joints have their names of `Posture.joint_names`; `Urdf.joints` has their values at the pose.
    Tags `drake:ball_constraint` close the loops in Drake, joints in <gazebo> in Gazebo with an
    engine that has loops, and other programs pass over both.

    Parameters
    ----------
    design : Design
        Any mechanism, redundant ones and drives at the base included.
    pose : Pose
        A single pose, at which all legs are defined.
    solids : Solids or None
        Sizes and masses of the links; default thin aluminium.
    drives : Drives or None
        Greatest forces and speeds. Strokes of the design are the limits of the joints.
    floating : bool
        False: the platform is fixed to the end of leg 1 instead of a floating joint, and that leg
        has no loop. Some programs have no floating joints within a tree.

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
        If `pose` is a batch or beyond a stroke, or `drives` does not fit the design.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> tree = to_urdf(design, design.home)
    >>> tree.loops[0].link_1, round(tree.joints["d1"], 6)
    ('leg1_platform', 0.143909)
    """
    chains = linkage(design, pose)
    metres = check_solids(solids).unit(design)
    bodies = capsules(design, chains, solids)
    limits = joint_limits(design, pose, drives, metres)
    name = {"name": title_of(design)}
    root = ElementTree.Element("robot", name | {"xmlns:drake": NAMESPACE})
    _add_link(root, "base", bodies["base"], metres)
    _add_link(root, "platform", bodies["platform"], metres)
    held = "base_to_platform" if floating else "leg1_to_platform"
    if floating:
        _add_joint(root, held, "floating", "base", "platform", metric(pose, metres))
    for chain in chains:
        _add_leg(root, chain, bodies, limits, metres)
    ends = {chain: f"{chain.name}_platform" for chain in chains}
    if not floating:
        place = metric(chains[0].head.inverse(), metres)
        _add_joint(root, held, "fixed", ends.pop(chains[0]), "platform", place)
    _add_transmissions(root, chains)
    loops = [loop_of(chain, end, metres, design.rms_radius) for chain, end in ends.items()]
    ignore_own_contacts(root)
    disable_contacts_in_mujoco(root)
    add_ball_constraints(root, loops)
    add_gazebo_joints(root, loops, held, metric(pose, metres) if floating else None)
    values = joint_values(design, pose, metres)
    slides = base_slides(chains, metres)
    return Urdf(written(root), tuple(loops), values, metric(pose, metres), slides)


def _add_leg(
    root: Node,
    chain: Chain,
    bodies: Mapping[str, tuple[Capsule, ...]],
    limits: Mapping[str, JointLimit],
    metres: float,
) -> None:
    parent, place = "base", chain.foot
    rail = f"{chain.name}_{'rail' if chain.leg.platform_line else 'ball'}"
    groups = (
        ("lower", chain.base, f"{chain.name}_lower"),
        ("upper", chain.middle, f"{chain.name}_upper"),
        ("platform", chain.platform, rail),
    )
    for ending, motions, body in groups:
        steps = [(motion, *step) for motion in motions for step in _steps(motion)]
        for motion, name, kind, axis, first in steps:
            last = name == steps[-1][1]
            child = f"{chain.name}_{ending}" if last else f"{name}_link"
            if first:
                place = place.compose(motion.placement)
            limit = limit_at_zero(limits, motion, metres)
            _add_link(root, child, bodies[body if last else "split"], metres)
            _add_joint(root, name, kind, parent, child, metric(place, metres), axis, limit)
            parent, place = child, Pose(np.zeros(3))


def _steps(motion: Motion) -> Iterator[tuple[str, str, Array, bool]]:
    """URDF joints of a motion: name, type, axis, whether it is the first."""
    if motion.kind == "slide":
        yield motion.name, "prismatic", motion.axis, True
    elif motion.kind == "turn":
        yield motion.name, "continuous", motion.axis, True
    else:
        for letter, axis in (("z", Z), ("y", cross(Z, X)), ("x", X)):
            yield f"{motion.name}_{letter}", "continuous", axis, letter == "z"


def _add_link(root: Node, name: str, parts: Sequence[Capsule], metres: float) -> None:
    link = ElementTree.SubElement(root, "link", name=name)
    _add_inertia(link, Body.of(parts), metres)
    for part in parts:
        sizes = {"radius": repr(part.radius * metres)}
        if part.length > 0.0:
            sizes["length"] = repr(part.length * metres)
        for purpose in PURPOSES:
            node = ElementTree.SubElement(link, purpose)
            _add_origin(node, metric(part.frame, metres))
            shape = ElementTree.SubElement(node, "geometry")
            ElementTree.SubElement(shape, "cylinder" if part.length > 0.0 else "sphere", sizes)


def _add_inertia(link: Node, body: Body, metres: float) -> None:
    inertial = ElementTree.SubElement(link, "inertial")
    _add_origin(inertial, Pose(body.centre * metres))
    ElementTree.SubElement(inertial, "mass", value=repr(body.mass))
    ElementTree.SubElement(inertial, "inertia", moments(body, metres))


def _add_joint(
    root: Node,
    name: str,
    kind: str,
    parent: str,
    child: str,
    place: Pose,
    axis: Array | None = None,
    limit: JointLimit = UNLIMITED,
) -> None:
    if kind == "continuous" and np.isfinite([limit.least, limit.greatest]).any():
        kind = "revolute"  # a continuous joint has no limits of its angle
    joint = ElementTree.SubElement(root, "joint", name=name, type=kind)
    _add_origin(joint, place)
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    if axis is not None:
        ElementTree.SubElement(joint, "axis", xyz=joined(axis))
    numbers = [own if np.isfinite(own) else none for own, none in zip(limit, NO_LIMIT, strict=True)]
    names = ("lower", "upper", "effort", "velocity")
    if kind in ("prismatic", "revolute"):
        written_limits = dict(zip(names, map(repr, numbers), strict=True))
        ElementTree.SubElement(joint, "limit", written_limits)
    elif np.isfinite([limit.effort, limit.speed]).any():
        written_limits = dict(zip(names[2:], map(repr, numbers[2:]), strict=True))
        ElementTree.SubElement(joint, "limit", written_limits)


def _add_transmissions(root: Node, chains: Sequence[Chain]) -> None:
    """State which joints are driven, as Drake and ROS read it."""
    add = ElementTree.SubElement
    for motion in (motion for chain in chains for motion in chain.motions if motion.active):
        transmission = add(root, "transmission", name=f"{motion.name}_transmission")
        add(transmission, "type").text = "transmission_interface/SimpleTransmission"
        joint = add(transmission, "joint", name=motion.name)
        add(joint, "hardwareInterface").text = "hardware_interface/EffortJointInterface"
        actuator = add(transmission, "actuator", name=f"{motion.name}_actuator")
        add(actuator, "mechanicalReduction").text = "1"


def _add_origin(node: Node, place: Pose) -> None:
    angles = joined(roll_pitch_yaw(place))
    ElementTree.SubElement(node, "origin", xyz=joined(place.position), rpy=angles)
