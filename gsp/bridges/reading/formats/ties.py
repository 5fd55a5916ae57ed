"""Elements beside the formats that tie links or joints: of Drake, URDF+ and plugins of Gazebo."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from gsp.bridges.reading.mechanism.linkages import Coupling, Link
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import brief

TIES = re.compile(r"constraint$|coupling|loop|mimic|drake:joint$")


def check_ties(file: XmlFile, nodes: Sequence[Node], loops: Sequence[Link] = ()) -> None:
    """Raise MalformedFile for one of these elements, but for those between the links of a loop."""
    known = {frozenset((loop.parent, loop.child)) for loop in loops}
    for node in nodes:
        ends = frozenset(x.get("name", "") for x in node if "_body_" in x.tag)
        if TIES.search(node.tag) and ends not in known:
            wanted = "joints of the format, and no constraints but those of its loops"
            file.fail(node, "", wanted, node.tag)


def plugin_couplings(file: XmlFile, plugins: Iterable[Node]) -> Iterator[Coupling]:
    """Yield the joints that plugins of Gazebo couple, in SDF and in URDF."""
    for node in plugins:
        tied = node.find("mimicJoint")
        if tied is not None:
            names = (file.text(node, "joint"), (tied.text or "").strip())
            yield Coupling(file.where(node), names, f"a plugin of a mimic of {brief(names[1])}")
