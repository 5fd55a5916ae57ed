"""The linkage of an SDF file: one model, with joints that close its loops."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from gsp.bridges.reading.formats.beside import Beside, read_beside
from gsp.bridges.reading.formats.sdf_frames import WORLD, Frames, Version, flag, freedoms_of
from gsp.bridges.reading.formats.ties import check_ties, plugin_couplings
from gsp.bridges.reading.mechanism.linkages import Coupling, Link, Linkage
from gsp.bridges.reading.texts.xml_lines import Node, XmlFile
from gsp.errors import brief, cut
from gsp.geometry.pose import Pose

# Older versions write poses in another way, and there is no second major version.
OLDEST = (1, 3)


def read_sdf(path: Path, base: str = "", platform: str = "") -> Linkage:
    """Return the linkage of the model of an SDF file, the only one with joints if there are more.

    Raises
    ------
    MalformedFile
        With the file, line, element and key of the first mistake.
    """
    file = XmlFile(path)
    file.refuse_macros()
    model = _model(file)
    version = _version(file)
    _check_parts(file, model)
    check_ties(file, [*model, *model.iterfind("joint/*")])
    frames = Frames(file, model)
    names = [file.attribute(link, "name") for link in model.iterfind("link")]
    if not names:
        file.fail(model, "<link>", "links", "none")
    places = {name: frames.place(name, model) for name in names}
    stem = path.name if path.suffix == ".sdf" else path.stem
    beside = read_beside(path.with_name(stem + ".joints.json"))
    nodes = model.findall("joint")
    beside.check_joints(file.names(nodes))
    joints = [_joint(file, node, frames, beside, version) for node in nodes]
    grounded = [x for x in joints if WORLD in (x.parent, x.child)]
    if grounded:
        places[WORLD] = Pose(np.zeros(3))
    fixed = [x for x in grounded if not x.freedoms]
    root = model.get("canonical_link") or names[0]
    if grounded:
        root = WORLD
    if fixed:
        root = fixed[0].child if fixed[0].parent == WORLD else fixed[0].parent
    return Linkage(
        name=model.get("name", ""),
        base=base or root,
        platform=platform,
        places=places,
        links=joints,
        couplings=list(_couplings(file, model)),
    )


def _model(file: XmlFile) -> Node:
    """Return the model that is meant."""
    models = file.root.findall("model") + file.root.findall("world/model")
    if file.root.tag != "sdf" or not models:
        file.fail(file.root, "", "<sdf> with a <model>", f"<{cut(file.root.tag)}> without one")
    joined = [x for x in models if x.find("joint") is not None]
    if len(joined) > 1:
        file.fail(joined[1], "", "one model with joints", "another")
    for node in file.root.iterfind("world/joint"):
        file.fail(node, "", "joints within a model", "one of the world")
    return (joined or models)[0]


def _version(file: XmlFile) -> Version:
    text = file.root.get("version", "")
    found = re.fullmatch(r"([0-9]{1,3})\.([0-9]{1,3})", text, re.ASCII)
    number = (int(found[1]), int(found[2])) if found else (0, 0)
    if not OLDEST <= number < (2, 0):
        wanted = f"{OLDEST[0]}.{OLDEST[1]} or later, below 2"
        file.fail(file.root, "version", wanted, brief(text) if text else "none")
    return Version(number)


def _check_parts(file: XmlFile, model: Node) -> None:
    """Refuse parts of a model that are in other files or models, and models that do not move."""
    for tag in ("include", "model"):
        for node in model.iterfind(tag):
            file.fail(node, "", "a model whose links and joints are its own", f"<{tag}> within it")
    static = file.only(model, "static")
    if static is not None and flag(file, model, "<static>", static.text):
        file.fail(model, "<static>", "false, as a mechanism moves", "true")


def _joint(file: XmlFile, node: Node, frames: Frames, beside: Beside, version: Version) -> Link:
    parent, child = frames.links(node)
    name = file.attribute(node, "name")
    freedoms = freedoms_of(file, node, frames.place(name, node), frames.place, version)
    link = Link(name=name, parent=parent, child=child, freedoms=freedoms, where=file.where(node))
    return beside.applied(link)


def _couplings(file: XmlFile, model: Node) -> Iterator[Coupling]:
    for node in model.iterfind("joint"):
        for mimic in (*node.iterfind("axis/mimic"), *node.iterfind("axis2/mimic")):
            names = (file.attribute(node, "name"), file.attribute(mimic, "joint"))
            got = f"<mimic> of {brief(names[1])}"
            yield Coupling(file.where(node), names, got)
    yield from plugin_couplings(file, model.iterfind("plugin"))
