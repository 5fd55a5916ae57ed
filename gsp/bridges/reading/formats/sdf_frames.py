"""Poses, frames and joints of SDF, also where they are in a URDF file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from gsp.bridges.reading.mechanism.linkages import Freedom
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import brief
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

WORLD, MODEL = "world", "__model__"
# The freedoms of each type of joint, with the element of the axis of each.
KINDS: Mapping[str, tuple[tuple[str, str], ...]] = {
    "fixed": (),
    "revolute": (("turn", "axis"),),
    "continuous": (("turn", "axis"),),
    "prismatic": (("slide", "axis"),),
    "ball": (("ball", ""),),
    "universal": (("turn", "axis"), ("turn", "axis2")),
    "revolute2": (("turn", "axis"), ("turn", "axis2")),
}
QUATERNION, ANGLES = "quat_xyzw", "euler_rpy"
NO_LIMIT = 1e9  # as the default of SDF, 1e16


class Version(NamedTuple):
    """The version of a file, on which the axes of its joints depend."""

    number: tuple[int, int]

    @property
    def axes_in_model(self) -> bool:
        """Whether axes are in the axes of the model unless the file states others."""
        return self.number < (1, 5)

    @property
    def has_old_choice(self) -> bool:
        """Whether `use_parent_model_frame` states in which axes those of a joint are."""
        return (1, 5) <= self.number < (1, 7)


# That of elements <gazebo> in URDF, which are taken as the converter of Gazebo writes them.
CONVERTED = Version((1, 7))


def pose_of(file: XmlFile, node: Node, pose: Node) -> Pose:
    """Return the pose of an element <pose> of `node`; the identity of an empty one."""
    kind = pose.get("rotation_format", ANGLES)
    degrees = flag(file, node, "<pose> degrees", pose.get("degrees", "false"))
    if kind not in (ANGLES, QUATERNION):
        wanted = f"{ANGLES} or {QUATERNION}"
        file.fail(node, "<pose> rotation_format", wanted, brief(kind))
    if not (pose.text or "").strip():
        return Pose(np.zeros(3))
    if kind == QUATERNION:
        numbers = file.numbers(node, "<pose>", pose.text, 7)
        if degrees or not numbers[3:].any():
            wanted = "a quaternion other than zero, without degrees"
            file.fail(node, "<pose>", wanted, brief(pose.text))
        return Pose.from_quaternion(numbers[:3], numbers[3:])
    numbers = file.numbers(node, "<pose>", pose.text, 6)
    return Pose.from_rpy(numbers[:3], np.deg2rad(numbers[3:]) if degrees else numbers[3:])


def flag(file: XmlFile, node: Node, key: str, text: str | None) -> bool:
    """Return a truth value as SDF writes it."""
    given = (text or "").strip().lower()
    if given not in ("true", "false", "1", "0"):
        file.fail(node, key, "true or false", brief(text))
    return given in ("true", "1")


class Frames:
    """Places of links, joints and frames of a model, in the axes of the model."""

    def __init__(self, file: XmlFile, model: Node) -> None:
        self._file = file
        self._nodes: dict[str, Node] = {}
        links = [link.get("name", "") for link in model.iterfind("link")]
        self._canonical: str = model.get("canonical_link") or next(iter(links), "")
        for tag in ("link", "joint", "frame"):
            for node in model.iterfind(tag):
                name = file.attribute(node, "name")
                if name in self._nodes:
                    file.fail(node, "name", "a name of its own", brief(name))
                self._nodes[name] = node
        self._known = {MODEL: Pose(np.zeros(3))}
        self._open: set[str] = set()

    def place(self, name: str, asked: Node, key: str = "relative_to") -> Pose:
        """Return where a link, joint or frame is, which an element asks for."""
        if name in self._known:
            return self._known[name]
        if name not in self._nodes or name in self._open:
            got = brief(name) if name not in self._nodes else f"a ring of frames at {brief(name)}"
            self._file.fail(asked, key, "a link, joint or frame of the model", got)
        self._open.add(name)
        node = self._nodes[name]
        outer = self._file.text(node, "child") if node.tag == "joint" else MODEL
        outer = MODEL if outer == WORLD else outer
        pose = self._file.only(node, "pose")
        own = Pose(np.zeros(3))
        if node.tag == "frame":
            outer = node.get("attached_to") or MODEL
        if pose is not None:
            outer = pose.get("relative_to") or pose.get("frame") or outer
            own = pose_of(self._file, node, pose)
        found = self.place(outer, node).compose(own)
        self._open.discard(name)
        self._known[name] = found
        return found

    def links(self, node: Node) -> list[str]:
        """Return the links of a joint, which may name frames that are attached to them."""
        ends = [self._link(self._file.text(node, tag), node, tag) for tag in ("parent", "child")]
        if ends[0] == ends[1]:
            self._file.fail(node, "<child>", "another link than <parent>", brief(ends[1]))
        return ends

    def _link(self, name: str, asked: Node, tag: str) -> str:
        """Return the link of that name, or to which the frame of that name is attached."""
        seen: set[str] = set()
        while name != WORLD and (known := self._nodes.get(name)) is not None:
            if known.tag == "link":
                return name
            if name in seen:
                break
            seen.add(name)
            name = known.get("attached_to", "") or self._canonical
            if known.tag == "joint":
                name = self._file.text(known, "child")
        if name != WORLD:
            wanted = "a link of the model, or a frame or joint that is attached to one"
            self._file.fail(asked, f"<{tag}>", wanted, brief(name))
        return name


# Where a frame of a name is, for an element and its key.
Places = Callable[[str, Node, str], Pose]


def freedoms_of(
    file: XmlFile, node: Node, place: Pose, frames: Places, version: Version
) -> list[Freedom]:
    """Return the freedoms of a joint whose frame is at `place`."""
    kind, name = file.attribute(node, "type").lower(), file.attribute(node, "name")
    if kind not in KINDS:
        file.fail(node, "type", "one of " + ", ".join(KINDS), brief(kind))
    found = []
    for motion, tag in KINDS[kind]:
        if motion == "ball":
            found.append(Freedom(kind="ball", name=name, point=place.position))
            continue
        axis = file.child(node, tag)
        low, high = _limits(file, axis)
        found.append(
            Freedom(
                kind="turn" if motion == "turn" else "slide",
                name=name,
                point=place.position,
                axis=_direction(file, axis, place, frames, version),
                low=low,
                high=high,
            )
        )
    return found


def _direction(file: XmlFile, axis: Node, place: Pose, frames: Places, version: Version) -> Array:
    xyz = file.only(axis, "xyz")
    text = "0 0 1" if xyz is None or not xyz.text else xyz.text
    direction = file.direction(axis, "<xyz>", text)
    given = "" if xyz is None else xyz.get("expressed_in", "")
    old = file.only(axis, "use_parent_model_frame")
    in_model = version.axes_in_model
    if old is not None:
        in_model = flag(file, axis, "<use_parent_model_frame>", old.text)
        if in_model and not (version.has_old_choice or version.axes_in_model):
            wanted = "<xyz expressed_in=…>, as of version 1.7"
            file.fail(axis, "<use_parent_model_frame>", wanted, "true")
    if given:
        return np.asarray(frames(given, axis, "<xyz> expressed_in").rotation @ direction)
    return direction if in_model else np.asarray(place.rotation @ direction)


def _limits(file: XmlFile, axis: Node) -> tuple[float, float]:
    limit = file.only(axis, "limit")
    ends = []
    for tag, none in (("lower", -np.inf), ("upper", np.inf)):
        node = None if limit is None else file.only(limit, tag)
        text = "" if node is None else (node.text or "").strip()
        value = file.limit(axis, f"<{tag}>", text, none) if text else none
        ends.append(none if abs(value) >= NO_LIMIT else value)
    low, high = ends
    if low > high:
        file.fail(axis, "<lower>", f"at most <upper>, which is {high}", f"{low}")
    return low, high
