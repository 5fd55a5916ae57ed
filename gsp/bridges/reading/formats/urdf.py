"""The linkage of a URDF file and of the loops beside it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from gsp.bridges.links.drives import NO_STROKE
from gsp.bridges.reading.formats.beside import read_beside
from gsp.bridges.reading.formats.ties import check_ties, plugin_couplings
from gsp.bridges.reading.formats.urdf_loops import gazebo_loops, loops_beside
from gsp.bridges.reading.mechanism.linkages import Coupling, Freedom, Link, Linkage
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import MalformedFile, brief, cut, expected
from gsp.geometry.pose import Pose

# The keys of limits of a joint, with the number of no limit.
ENDS = (("lower", -np.inf), ("upper", np.inf))
COMMAND = "command_interface"
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
    file.refuse_macros()
    names = file.names(file.root.findall("link"))
    nodes = file.root.findall("joint")
    beside = read_beside(path.with_name(path.name + ".loops.json"))
    beside.check_joints(file.names(nodes))
    places, joints = _tree(file, names)
    children = {joint.child for joint in joints}
    root = next(name for name in names if name not in children)
    loops = [*loops_beside(file, beside, places), *gazebo_loops(file, beside, places, joints)]
    if not loops:
        wanted = "loops beside it in NAME.urdf.loops.json, or joints in <gazebo>"
        raise MalformedFile(expected(str(path), wanted, "none: the legs are open"))
    check_ties(file, list(file.root), loops, places)
    floating = {x.get("name", "") for x in nodes if x.get("type") == "floating"}
    driven = _driven(file, {x.name for x in joints})
    beside.check_driven(driven)
    links = [_stated(x, driven) for x in joints if x.name not in floating] + loops
    return Linkage(
        name=file.root.get("name", ""),
        base=base or root,
        platform=platform,
        likely=beside.platform,
        places=places,
        links=[beside.applied(link) for link in links],
        couplings=list(_couplings(file)),
    )


def _driven(file: XmlFile, names: set[str]) -> set[str]:
    """Return the joints for which the file has a transmission or an interface of commands.

    Within <ros2_control> not every joint needs a transmission.
    """
    commanded = [x for x in file.root.iterfind("ros2_control/joint") if x.find(COMMAND) is not None]
    found: set[str] = set()
    for nodes, all_of_them in (
        (file.root.findall("transmission"), True),
        (commanded, True),
        (file.root.findall("ros2_control/transmission"), False),
    ):
        joints = nodes if nodes is commanded else _with_motors(file, nodes)
        stated = {file.attribute(node, "name"): node for node in joints}
        for name in sorted(stated.keys() - names):
            file.fail(stated[name], "name", "the name of a joint", brief(name))
        other = found ^ stated.keys() if all_of_them else stated.keys() - found
        for name in sorted(other if found and stated else ()):
            wanted = "the joints that have an actuator in the rest of the file"
            got = f"{'none' if name in found else 'one'} for {brief(name)}"
            file.fail(stated.get(name, nodes[0]), "", wanted, got)
        found |= stated.keys()
    return found


def _with_motors(file: XmlFile, transmissions: Sequence[Node]) -> list[Node]:
    """Return the joints of transmissions, each of which must have an actuator of its own."""
    found: list[Node] = []
    motors: set[str] = set()
    for node in transmissions:
        joints, own = node.findall("joint"), node.findall("actuator")
        if len(joints) > len(own):
            count = "the joint" if len(joints) == 1 else f"each of {len(joints)} joints"
            file.fail(node, "<actuator>", f"one for {count}", f"{len(own)}")
        for motor in {x.get("name", "") for x in own} - {""}:
            if motor in motors:
                file.fail(node, "<actuator>", "one of no other transmission", brief(motor))
            motors.add(motor)
        found += joints
    return found


def _stated(link: Link, driven: set[str]) -> Link:
    """Return a joint whose freedoms know whether they are driven, where the file states it."""
    if not driven:
        return link
    freedoms = [replace(x, active=link.name in driven) for x in link.freedoms]
    return replace(link, freedoms=freedoms)


def _couplings(file: XmlFile) -> Iterator[Coupling]:
    for node in file.root.iterfind("joint"):
        mimic = file.only(node, "mimic")
        if mimic is not None:
            names = (file.attribute(node, "name"), file.attribute(mimic, "joint"))
            yield Coupling(file.where(node), names, f"<mimic> of {brief(names[1])}")
    for node in file.root.iterfind("ros2_control/joint"):
        for param in node.iterfind("param[@name='mimic']"):
            names = (file.attribute(node, "name"), (param.text or "").strip())
            yield Coupling(file.where(node), names, f"a mimic of {brief(names[1])}")
    yield from plugin_couplings(file, file.root.iterfind("gazebo/plugin"))


def _tree(file: XmlFile, names: list[str]) -> tuple[dict[str, Pose], list[Link]]:
    """Return the places of all links, and the joints of the tree."""
    nodes, known = {}, set(names)
    for node in file.root.iterfind("joint"):
        ends = tuple(file.attribute(file.child(node, x), "link") for x in ("parent", "child"))
        for tag, name in zip(("parent", "child"), ends, strict=True):
            if name not in known:
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
        axis = file.only(node, "axis")
        text = "1 0 0" if axis is None else axis.get("xyz", "")
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
    limit = file.only(node, "limit")
    if limit is None or kind == "continuous":
        return -np.inf, np.inf
    low, high = (file.limit(limit, key, limit.get(key, "0"), none) for key, none in ENDS)
    if low > high:
        file.fail(limit, "lower", f"at most upper, which is {high}", f"{low}")
    return (
        low if low > -NO_STROKE else -np.inf,
        high if high < NO_STROKE else np.inf,
    )


def _origin(file: XmlFile, node: Node) -> Pose:
    origin = file.only(node, "origin")
    if origin is None:
        return Pose(np.zeros(3))
    position = file.numbers(node, "<origin> xyz", origin.get("xyz", "0 0 0"), 3)
    turn = origin.get("quat_xyzw")
    if turn is None:
        return Pose.from_rpy(
            position, file.numbers(node, "<origin> rpy", origin.get("rpy", "0 0 0"), 3)
        )
    quaternion = file.numbers(node, "<origin> quat_xyzw", turn, 4)
    if not quaternion.any() or origin.get("rpy") is not None:
        file.fail(
            node, "<origin> quat_xyzw", "a quaternion other than zero, and no rpy", brief(turn)
        )
    return Pose.from_quaternion(position, quaternion)
