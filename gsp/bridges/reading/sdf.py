"""The linkage of an SDF file: one model, with joints that close its loops."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from gsp.bridges.reading.beside import Beside, read_beside
from gsp.bridges.reading.linkages import Freedom, Link, Linkage
from gsp.bridges.reading.xml_lines import Node, XmlFile
from gsp.errors import brief, cut
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


def read_sdf(path: Path, base: str = "", platform: str = "") -> Linkage:
    """Return the linkage of the first model of an SDF file.

    Raises
    ------
    MalformedFile
        With the file, line, element and key of the first mistake.
    """
    file = XmlFile(path)
    model = file.root.find("model")
    if model is None:
        model = file.root.find("world/model")
    if file.root.tag != "sdf" or model is None:
        file.fail(file.root, "", "<sdf> with a <model>", f"<{cut(file.root.tag)}> without one")
    frames = _Frames(file, model)
    names = [file.attribute(link, "name") for link in model.iterfind("link")]
    places = {name: frames.place(name) for name in names}
    stem = path.name if path.suffix == ".sdf" else path.stem
    beside = read_beside(path.with_name(stem + ".joints.json"))
    links = [_joint(file, node, frames, beside) for node in model.iterfind("joint")]
    fixed = [x for x in links if WORLD in (x.parent, x.child)]
    root = fixed[0].child if fixed and fixed[0].parent == WORLD else ""
    root = root or (fixed[0].parent if fixed else model.get("canonical_link") or names[0])
    return Linkage(
        name=model.get("name", ""),
        base=base or root,
        platform=platform,
        places=places,
        links=[x for x in links if x not in fixed],
    )


class _Frames:
    """Places of links, joints and frames of a model, in the axes of the model."""

    def __init__(self, file: XmlFile, model: Node) -> None:
        self._file = file
        self._nodes: dict[str, Node] = {}
        for tag in ("link", "joint", "frame"):
            for node in model.iterfind(tag):
                name = file.attribute(node, "name")
                if name in self._nodes:
                    file.fail(node, "name", "a name of its own", brief(name))
                self._nodes[name] = node
        self._known = {MODEL: Pose(np.zeros(3)), WORLD: Pose(np.zeros(3))}
        self._open: set[str] = set()

    def place(self, name: str, asked: Node | None = None) -> Pose:
        """Return where a link, joint or frame is."""
        if name in self._known:
            return self._known[name]
        if name not in self._nodes or name in self._open:
            node = asked if asked is not None else next(iter(self._nodes.values()))
            got = brief(name) if name not in self._nodes else f"a ring of frames at {brief(name)}"
            self._file.fail(node, "relative_to", "a link, joint or frame of the model", got)
        self._open.add(name)
        node = self._nodes[name]
        default = self._file.text(node, "child") if node.tag == "joint" else MODEL
        pose = node.find("pose")
        outer = default
        own = Pose(np.zeros(3))
        if node.tag == "frame":
            outer = node.get("attached_to") or MODEL
        if pose is not None:
            outer = pose.get("relative_to") or pose.get("frame") or outer
            own = self._file.placement(node, "<pose>", pose.text)
        found = self.place(outer, node).compose(own)
        self._open.discard(name)
        self._known[name] = found
        return found

    def links(self, node: Node) -> list[str]:
        """Return parent and child of a joint."""
        ends = [self._file.text(node, tag) for tag in ("parent", "child")]
        for tag, name in zip(("parent", "child"), ends, strict=True):
            known = self._nodes.get(name)
            if name != WORLD and (known is None or known.tag != "link"):
                self._file.fail(node, f"<{tag}>", "the name of a link of the model", brief(name))
        return ends


def _joint(file: XmlFile, node: Node, frames: _Frames, beside: Beside) -> Link:
    parent, child = frames.links(node)
    name = file.attribute(node, "name")
    place = frames.place(name)
    freedoms = freedoms_of(file, node, place, frames)
    link = Link(name=name, parent=parent, child=child, freedoms=freedoms, where=file.where(node))
    return beside.applied(link)


def freedoms_of(
    file: XmlFile, node: Node, place: Pose, frames: _Frames | None = None
) -> list[Freedom]:
    """Return the freedoms of a joint whose frame is at `place`."""
    kind, name = file.attribute(node, "type"), file.attribute(node, "name")
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
                axis=_direction(file, axis, place, frames),
                low=low,
                high=high,
            )
        )
    return found


def _direction(file: XmlFile, axis: Node, place: Pose, frames: _Frames | None) -> Array:
    xyz = axis.find("xyz")
    text = "0 0 1" if xyz is None or not xyz.text else xyz.text
    direction = file.direction(axis, "<xyz>", text)
    given = "" if xyz is None else xyz.get("expressed_in", "")
    old = axis.find("use_parent_model_frame")
    if given and frames is not None:
        return np.asarray(frames.place(given, axis).rotation @ direction)
    if old is not None and (old.text or "").strip() in ("1", "true"):
        return direction
    return np.asarray(place.rotation @ direction)


def _limits(file: XmlFile, axis: Node) -> tuple[float, float]:
    limit = axis.find("limit")
    ends = []
    for tag, none in (("lower", -np.inf), ("upper", np.inf)):
        node = None if limit is None else limit.find(tag)
        text = "" if node is None else (node.text or "").strip()
        if not text or "inf" in text.lower():
            ends.append(none)
        else:
            value = float(file.numbers(axis, f"<{tag}>", text, 1)[0])
            ends.append(none if abs(value) >= 1e9 else value)
    low, high = ends
    if low > high:
        file.fail(axis, "<lower>", f"at most <upper>, which is {high}", f"{low}")
    return low, high
