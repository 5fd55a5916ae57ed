"""The loops of a URDF file: those beside it, and joints of SDF in elements <gazebo>."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from gsp.bridges.reading.formats.beside import Beside
from gsp.bridges.reading.formats.sdf_frames import CONVERTED, MODEL, WORLD, freedoms_of, pose_of
from gsp.bridges.reading.mechanism.linkages import Link
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import MalformedFile, brief, expected
from gsp.geometry.pose import Pose


def loops_beside(file: XmlFile, beside: Beside, places: Mapping[str, Pose]) -> Iterator[Link]:
    """Yield the loops of the file beside a model, with the gap that the model has."""
    for loop in beside.loops:
        where = f"{beside.path}, loop {brief(loop.name)}"
        for key, name in (("link_1", loop.link_1), ("link_2", loop.link_2)):
            if name not in places:
                wanted = f"a link of {file.path.name}"
                raise MalformedFile(expected(f"{where}, {key}", wanted, brief(name)))
        if loop.link_1 == loop.link_2:
            wanted = "another link than link_1"
            raise MalformedFile(expected(f"{where}, link_2", wanted, brief(loop.link_2)))
        there = places[loop.link_2].compose(loop.placement)
        yield Link(
            name=f"loop {loop.name}",
            parent=loop.link_1,
            child=loop.link_2,
            where=f"{beside.path.name}, loop {brief(loop.name)}",
            shift=there.compose(places[loop.link_1].inverse()),
        )


def gazebo_loops(
    file: XmlFile, beside: Beside, places: Mapping[str, Pose], joints: Sequence[Link]
) -> Iterator[Link]:
    """Yield joints of SDF in <gazebo>, with the frame of the child, or a pose in it or in another.

    Those of loops that are beside the file are left out: they are the same, without a placement. So
    is what fixes the root to the world.
    """
    known = {(loop.link_1, loop.link_2) for loop in beside.loops}
    # The frame of a joint of URDF is that of its child.
    frames = {joint.name: places[joint.child] for joint in joints} | dict(places)
    frames[MODEL] = Pose(np.zeros(3))
    (root,) = places.keys() - {joint.child for joint in joints}
    nodes = file.root.findall("gazebo/joint")
    file.names([*file.root.iterfind("joint"), *nodes])

    def frame(name: str, asked: Node, key: str) -> Pose:
        if name not in frames:
            file.fail(asked, key, "the name of a link or joint", brief(name))
        return frames[name]

    held = False
    for node in nodes:
        ends = [file.text(node, tag) for tag in ("parent", "child")]
        if WORLD not in places and WORLD in ends:
            if node.get("type") != "fixed" or root not in ends or held:
                wanted = f"one fixed joint at most of the world, with the root {brief(root)}"
                file.fail(node, "", wanted, " and ".join(map(brief, ends)))
            held = True
            continue
        for tag, name in zip(("parent", "child"), ends, strict=True):
            if name not in places:
                file.fail(node, f"<{tag}>", "the name of a link", brief(name))
        if tuple(ends) in known:
            if node.get("type") != "fixed":
                wanted = f"fixed, as the loop in {beside.path.name} is"
                file.fail(node, "type", wanted, brief(node.get("type")))
            continue
        pose = file.only(node, "pose")
        place = places[ends[1]]
        if pose is not None:
            outer = pose.get("relative_to") or ends[1]
            place = frame(outer, node, "<pose> relative_to").compose(pose_of(file, node, pose))
        freedoms = freedoms_of(file, node, place, frame, CONVERTED)
        name = file.attribute(node, "name")
        where = file.where(node)
        yield Link(name=name, parent=ends[0], child=ends[1], freedoms=freedoms, where=where)
