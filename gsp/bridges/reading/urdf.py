"""The linkage of a URDF file and of the loops beside it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from gsp.bridges.drives import NO_STROKE
from gsp.bridges.reading.beside import Beside, read_beside
from gsp.bridges.reading.linkages import Freedom, Link, Linkage
from gsp.bridges.reading.sdf import freedoms_of
from gsp.bridges.reading.xml_lines import Node, XmlFile
from gsp.errors import MalformedFile, brief, cut, expected
from gsp.geometry.pose import Pose

KINDS = {
    "fixed": (),
    "revolute": ("turn",),
    "continuous": ("turn",),
    "prismatic": ("slide",),
    "floating": None,
}


def read_urdf(path: Path, base: str = "", platform: str = "") -> Linkage:
    """Return the linkage of a URDF file.

    Its loops are those of the file `NAME.urdf.loops.json` beside it, as `gsp export` writes them,
    and joints in elements <gazebo> of other links.

    Raises
    ------
    MalformedFile
        With the file, line, element and key of the first mistake.
    """
    file = XmlFile(path)
    if file.root.tag != "robot":
        file.fail(file.root, "", "<robot>", f"<{cut(file.root.tag)}>")
    names = [file.attribute(link, "name") for link in file.root.iterfind("link")]
    beside = read_beside(path.with_name(path.name + ".loops.json"))
    places, joints = _tree(file, names)
    root = next(name for name in names if name not in {j.child for j in joints})
    links = [*joints, *_loops(file, beside, places), *_gazebo_loops(file, beside, places)]
    if len(links) == len(joints):
        wanted = "loops beside it in NAME.urdf.loops.json, or joints in <gazebo>"
        raise MalformedFile(expected(str(path), wanted, "none: the legs are open"))
    floating = {j.name for j in joints if not j.freedoms} & _floating(file)
    kept = [beside.applied(link) for link in links if link.name not in floating]
    return Linkage(
        name=file.root.get("name", ""),
        base=base or root,
        platform=platform or beside.platform,
        places=places,
        links=kept,
    )


def _floating(file: XmlFile) -> set[str]:
    return {x.get("name", "") for x in file.root.iterfind("joint") if x.get("type") == "floating"}


def _tree(file: XmlFile, names: list[str]) -> tuple[dict[str, Pose], list[Link]]:
    """Return the places of all links, and the joints of the tree."""
    nodes = {}
    for node in file.root.iterfind("joint"):
        ends = tuple(file.attribute(file.child(node, x), "link") for x in ("parent", "child"))
        for tag, name in zip(("parent", "child"), ends, strict=True):
            if name not in names:
                file.fail(node, f"<{tag}> link", "the name of a link", brief(name))
        if ends[1] in nodes:
            file.fail(node, "<child> link", "a link that is no child yet", brief(ends[1]))
        nodes[ends[1]] = (node, ends[0])
    roots = [name for name in names if name not in nodes]
    if len(roots) != 1:
        file.fail(file.root, "<link>", "one link that is no child", f"{len(roots)}")
    places = {roots[0]: Pose(np.zeros(3))}
    links: list[Link] = []
    waiting = dict(nodes)
    while waiting:
        ready = [child for child, (_, parent) in waiting.items() if parent in places]
        if not ready:
            node = next(iter(waiting.values()))[0]
            file.fail(node, "<parent> link", "a link of the tree from the root", "a ring of joints")
        for child in ready:
            node, parent = waiting.pop(child)
            place = places[parent].compose(_origin(file, node))
            places[child] = place
            links.append(_joint(file, node, parent, child, place))
    order = {file.attribute(node, "name"): i for i, (node, _) in enumerate(nodes.values())}
    links.sort(key=lambda link: order[link.name])
    return {name: places[name] for name in names}, links


def _joint(file: XmlFile, node: Node, parent: str, child: str, place: Pose) -> Link:
    name, kind = file.attribute(node, "name"), file.attribute(node, "type")
    if kind not in KINDS:
        file.fail(node, "type", "one of " + ", ".join(KINDS), brief(kind))
    freedoms = []
    for motion in KINDS[kind] or ():
        axis = node.find("axis")
        text = "1 0 0" if axis is None else axis.get("xyz", "1 0 0")
        direction = place.rotation @ file.direction(node, "<axis> xyz", text)
        low, high = _limits(file, node, kind)
        freedoms.append(
            Freedom(
                kind="turn" if motion == "turn" else "slide",
                name=name,
                point=place.position,
                axis=direction,
                low=low,
                high=high,
            )
        )
    return Link(name=name, parent=parent, child=child, freedoms=freedoms, where=file.where(node))


def _limits(file: XmlFile, node: Node, kind: str) -> tuple[float, float]:
    limit = node.find("limit")
    if limit is None or kind == "continuous":
        return -np.inf, np.inf
    low, high = (file.number(limit, key, 0.0) for key in ("lower", "upper"))
    if low > high:
        file.fail(limit, "lower", f"at most upper, which is {high}", f"{low}")
    return (
        low if low > -NO_STROKE else -np.inf,
        high if high < NO_STROKE else np.inf,
    )


def _origin(file: XmlFile, node: Node) -> Pose:
    origin = node.find("origin")
    if origin is None:
        return Pose(np.zeros(3))
    text = f"{origin.get('xyz', '0 0 0')} {origin.get('rpy', '0 0 0')}"
    return file.placement(node, "<origin> xyz, rpy", text)


def _loops(file: XmlFile, beside: Beside, places: Mapping[str, Pose]) -> Iterator[Link]:
    for loop in beside.loops:
        for key, name in (("link_1", loop.link_1), ("link_2", loop.link_2)):
            if name not in places:
                wanted = f"a link of {file.path.name}"
                where = f"{beside.path}, loop {brief(loop.name)}, {key}"
                raise MalformedFile(expected(where, wanted, brief(name)))
        there = places[loop.link_2].compose(loop.placement)
        shift = there.compose(places[loop.link_1].inverse())
        yield Link(name=f"loop {loop.name}", parent=loop.link_1, child=loop.link_2, shift=shift)


def _gazebo_loops(file: XmlFile, beside: Beside, places: Mapping[str, Pose]) -> Iterator[Link]:
    """Joints of SDF in <gazebo>, with the frame of the child, or a pose in it.

    Those of loops that are beside the file are left out: they are the same, without a placement.
    """
    known = {(loop.link_1, loop.link_2) for loop in beside.loops}
    for node in file.root.iterfind("gazebo/joint"):
        ends = [file.text(node, tag) for tag in ("parent", "child")]
        for tag, name in zip(("parent", "child"), ends, strict=True):
            if name not in places:
                file.fail(node, f"<{tag}>", "the name of a link", brief(name))
        if tuple(ends) in known:
            continue
        pose = node.find("pose")
        at = Pose(np.zeros(3)) if pose is None else file.placement(node, "<pose>", pose.text)
        place = places[ends[1]].compose(at)
        freedoms = freedoms_of(file, node, place)
        name = file.attribute(node, "name")
        yield Link(name=name, parent=ends[0], child=ends[1], freedoms=freedoms)
