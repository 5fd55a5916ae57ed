"""Elements beside the formats that tie links or joints: of Drake, URDF+ and plugins of Gazebo."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from gsp.bridges.reading.mechanism.ends import TOLERANCE
from gsp.bridges.reading.mechanism.linkages import Coupling, Link
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import brief
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import cross, norm

TIES = re.compile(r"constraint$|coupling|loop|mimic|drake:joint$")
BALL = "drake:ball_constraint"


def check_ties(
    file: XmlFile,
    nodes: Sequence[Node],
    loops: Sequence[Link] = (),
    places: Mapping[str, Pose] = MappingProxyType({}),
) -> None:
    """Raise MalformedFile for such an element, but for balls of Drake that a loop has as well.

    Parameters
    ----------
    file : XmlFile
    nodes : sequence of elements
    loops : sequence of Link
    places : mapping of name to Pose
        Of all links, where there are loops.
    """
    known = {frozenset((loop.parent, loop.child)): loop for loop in reversed(loops)}
    for node in nodes:
        if not TIES.search(node.tag):
            continue
        ends = frozenset(x.get("name", "") for x in node if "_body_" in x.tag)
        if node.tag != BALL or ends not in known:
            wanted = "joints of the format, and no constraints but those of its loops"
            file.fail(node, "", wanted, node.tag)
        _check_ball(file, node, known[ends], places)


def _check_ball(file: XmlFile, node: Node, loop: Link, places: Mapping[str, Pose]) -> None:
    """Raise MalformedFile unless a loop keeps the two points of a ball constraint together."""
    points = {}
    for body, at in (("A", "AP"), ("B", "BQ")):
        link = file.attribute(file.child(node, f"{BALL}_body_{body}"), "name")
        there = file.child(node, f"{BALL}_p_{at}")
        own = file.numbers(node, f"{BALL}_p_{at} value", there.get("value"), 3)
        points[link] = places[link].position + places[link].rotation @ own
    shown = loop.shift.position + loop.shift.rotation @ points[loop.parent]
    away = float(norm(shown - points[loop.child]))
    for freedom in loop.freedoms:
        arm = points[loop.child] - freedom.point
        if freedom.kind == "turn":
            arm = cross(freedom.axis, arm)
        away = np.inf if freedom.kind == "slide" else max(away, float(norm(arm)))
    size = max(float(norm(place.position - shown)) for place in places.values())
    if away > TOLERANCE * size:
        wanted = f"a point that {brief(loop.name)} holds as well"
        file.fail(node, "", wanted, f"one that misses by {away:.3g} m")


def plugin_couplings(file: XmlFile, plugins: Iterable[Node]) -> Iterator[Coupling]:
    """Yield the joints that plugins of Gazebo couple, in SDF and in URDF."""
    for node in plugins:
        tied = node.find("mimicJoint")
        if tied is not None:
            names = (file.text(node, "joint"), (tied.text or "").strip())
            yield Coupling(file.where(node), names, f"a plugin of a mimic of {brief(names[1])}")
