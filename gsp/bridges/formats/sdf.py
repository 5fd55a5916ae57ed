"""A design as SDF: all links, spherical joints, and joints that close the loops."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from gsp.bridges.formats.contacts import NAMESPACE, ignore_own_contacts
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
from gsp.bridges.links.drives import UNLIMITED, Drives, JointLimit, joint_limits, limit_at_zero
from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain, Motion
from gsp.bridges.links.shapes import Body, Capsule
from gsp.bridges.links.solids import Solids, capsules, check_solids, fixed_to_platform
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.pose import Pose
from gsp.model.design import Design

VERSION = "1.9"


@read_only_tuple
class Sdf(NamedTuple):
    """A model in SDF, and the joint variables where its joints are zero.

    Attributes
    ----------
    text : str
    joints : mapping of joint name to value [m, rad]
        Joint variables of the design where the joints of the model are zero. The variable of an
        actuator is the sum of this number and the value of its joint in the model.
    platform : Pose of shape ()
        Of the platform where the joints are zero [m].
    slides : mapping of joint name to value [m]
        The same as `joints` of passive slides along lines of the base: how far the legs are from
        the anchors.
    """

    text: str
    joints: Mapping[str, float]
    platform: Pose
    slides: Mapping[str, float]

    def beside(self) -> str:
        """Return joint variables and pose as JSON; rotations are (x, y, z, w)."""
        place = numbers_of(self.platform)
        content = {
            "joints_at_zero": dict(self.joints),
            "slides_at_zero": dict(self.slides),
            "platform_at_zero": place,
        }
        return json.dumps(content, indent=2) + "\n"


def to_sdf(
    design: Design, pose: Pose, solids: Solids | None = None, drives: Drives | None = None
) -> Sdf:
    """Return a design as an SDF model with closed loops.

    The base is fixed to the world, and each leg ends in a joint whose child is the platform, so
    that the platform is the child of one joint per leg. Spherical joints are joints of type "ball".
    A cylindrical one is a slide and a turn with a light link between them. All joints are zero at
    the pose. Actuated joints have their names of `Posture.joint_names`; `Sdf.joints` has their
    values at the pose. Lengths are metres, for every unit of the design.

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

    Returns
    -------
    Sdf

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
    >>> to_sdf(design, design.home).text.count("<child>platform</child>")
    6
    """
    chains = linkage(design, pose)
    metres = check_solids(solids).unit(design)
    bodies = capsules(design, chains, solids)
    limits = joint_limits(design, pose, drives, metres)
    root = ElementTree.Element("sdf", {"version": VERSION, "xmlns:drake": NAMESPACE})
    model = ElementTree.SubElement(root, "model", name=title_of(design), canonical_link="base")
    _add_link(model, "base", Pose(np.zeros(3)), bodies["base"], metres)
    _add_joint(model, "base_to_world", "fixed", "world", "base")
    _add_link(model, "platform", pose, fixed_to_platform(chains, bodies), metres)
    for chain in chains:
        _add_leg(model, chain, bodies, limits, metres)
    ignore_own_contacts(model)
    values, slides = joint_values(design, pose, metres), base_slides(chains, metres)
    return Sdf(written(root), values, metric(pose, metres), slides)


def _add_leg(
    model: Node,
    chain: Chain,
    bodies: Mapping[str, tuple[Capsule, ...]],
    limits: Mapping[str, JointLimit],
    metres: float,
) -> None:
    parent, place, name = "base", chain.foot, chain.name
    for end, motions in (
        (f"{name}_lower", chain.base),
        (f"{name}_upper", chain.middle),
        ("platform", chain.platform),
    ):
        for motion in motions:
            place = place.compose(motion.placement)
            child = end if motion is motions[-1] else f"{motion.name}_link"
            limit = limit_at_zero(limits, motion, metres)
            at = metric(chain.head, metres) if child == "platform" else None
            if child != "platform":
                _add_link(model, child, place, bodies[child if child == end else "split"], metres)
            _add_joint(model, motion.name, KINDS[motion.kind], parent, child, motion, limit, at)
            parent = child


KINDS = {"ball": "ball", "slide": "prismatic", "turn": "revolute"}


def _add_link(model: Node, name: str, place: Pose, parts: Sequence[Capsule], metres: float) -> None:
    add, body = ElementTree.SubElement, Body.of(parts)
    link = add(model, "link", name=name)
    _add_pose(link, metric(place, metres))
    inertial = add(link, "inertial")
    _add_pose(inertial, Pose(body.centre * metres))
    add(inertial, "mass").text = repr(body.mass)
    inertia = add(inertial, "inertia")
    for entry, value in moments(body, metres).items():
        add(inertia, entry).text = value
    for number, part in enumerate(parts, 1):
        for purpose in PURPOSES:
            node = add(link, purpose, name=f"{name}_{number}_{purpose}")
            _add_pose(node, metric(part.frame, metres))
            shape = add(add(node, "geometry"), "capsule" if part.length > 0.0 else "sphere")
            add(shape, "radius").text = repr(part.radius * metres)
            if part.length > 0.0:
                add(shape, "length").text = repr(part.length * metres)


def _add_joint(
    model: Node,
    name: str,
    kind: str,
    parent: str,
    child: str,
    motion: Motion | None = None,
    limit: JointLimit = UNLIMITED,
    place: Pose | None = None,
) -> None:
    """Add a joint; its frame is that of the child, or at `place` in the child."""
    add = ElementTree.SubElement
    joint = add(model, "joint", name=name, type=kind)
    if place is not None:
        _add_pose(joint, place)
    add(joint, "parent").text, add(joint, "child").text = parent, child
    if motion is None or motion.kind == "ball":
        return
    axis = add(joint, "axis")
    add(axis, "xyz").text = joined(motion.axis)
    limits = add(axis, "limit")
    if not motion.active:  # else Drake takes it for an actuator
        limit = limit._replace(effort=0.0)
    for what, number in zip(("lower", "upper", "effort", "velocity"), limit, strict=True):
        if np.isfinite(number):
            add(limits, what).text = repr(number)


def _add_pose(node: Node, place: Pose) -> None:
    numbers = np.concatenate((place.position, roll_pitch_yaw(place)))
    ElementTree.SubElement(node, "pose").text = joined(numbers)
