"""Bodies of a MuJoCo model with their joints and shapes, as elements of its text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import MappingProxyType
from xml.etree import ElementTree

import numpy as np

from gsp.bridges.formats.markup import Node, joined
from gsp.bridges.links.motions import Chain, Motion
from gsp.bridges.links.shapes import Capsule
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

# Capsules that are shorter [m] are written as spheres; they have no direction.
SHORTEST_CAPSULE = 1e-13
# Those that are shorter [m] are written with a frame: MuJoCo refuses ends within 1e-7 m.
SHORTEST_BY_ENDS = 1.01e-7
# Largest height and width of a picture of a model, in pixels.
LARGEST_PICTURE = (1200, 1600)
COLOURS = MappingProxyType(
    {
        "base": "0.35 0.37 0.40 1",
        "platform": "0.13 0.25 0.45 1",
        "D1": "0.80 0.25 0.20 1",
        "D2": "0.90 0.60 0.10 1",
        "D3": "0.20 0.60 0.35 1",
        "D4": "0.10 0.55 0.75 1",
        "A1": "0.55 0.30 0.65 1",
        "D4 A1": "0.35 0.35 0.80 1",
        "PSS": "0.48 0.36 0.00 1",
        "RSS": "0.70 0.20 0.45 1",
        "rod": "0.75 0.77 0.80 1",
    }
)


def moved(start: Pose, motions: Sequence[Motion]) -> Pose:
    """Return the place of a body after the joints that carry it."""
    for motion in motions:
        start = start.compose(motion.placement)
    return start


def add_body(parent: Node, name: str, place: Pose, motions: Sequence[Motion], unit: float) -> Node:
    """Add a body with its joints, and return it; `unit` is that of the design [m]."""
    body = ElementTree.SubElement(parent, "body", {"name": name} | frame_of(place, unit))
    for motion in motions:
        attributes = {"name": motion.name, "class": "slide" if motion.kind == "slide" else "turn"}
        if motion.kind == "ball":
            attributes["type"] = "ball"
        else:
            attributes["type"] = "slide" if motion.kind == "slide" else "hinge"
            attributes["axis"] = joined(motion.axis)
            attributes["ref"] = repr(metric(motion, unit))
        ElementTree.SubElement(body, "joint", attributes)
    return body


def add_geoms(body: Node, parts: Iterable[Capsule], colour: str, unit: float) -> None:
    """Add the capsules of a body."""
    for part in parts:
        shape = {
            "size": repr(part.radius * unit),
            "mass": repr(part.mass),
            "rgba": COLOURS[colour],
        }
        if SHORTEST_CAPSULE < part.length * unit <= SHORTEST_BY_ENDS:
            shape["size"] = joined(np.array([part.radius, 0.5 * part.length]) * unit)
            shape |= frame_of(part.frame, unit)
        elif part.length * unit > SHORTEST_BY_ENDS:
            shape["fromto"] = joined(np.concatenate((part.start, part.end)) * unit)
        else:
            shape |= {"type": "sphere", "pos": joined(part.start * unit)}
        ElementTree.SubElement(body, "geom", shape)


def metric(motion: Motion, unit: float) -> float:
    """Return the value of a joint [m, rad]."""
    return float(motion.value) * (unit if motion.kind == "slide" else 1.0)


def frame_of(pose: Pose, unit: float) -> dict[str, str]:
    """Return a pose as the attributes of an element."""
    return {"pos": joined(pose.position * unit), "quat": joined(wxyz(pose))}


def wxyz(pose: Pose) -> Array:
    """Return the quaternion of a pose as MuJoCo orders it."""
    return np.roll(pose.quaternion, 1)


def configuration(
    start: Iterable[Chain], chains: Iterable[Chain], pose: Pose, unit: float
) -> list[float]:
    """Return the coordinates (qpos) of a model at a pose, in the order of the model [m, rad].

    Parameters
    ----------
    start : iterable of Chain
        The legs at the pose of the model.
    chains : iterable of Chain
        The legs at `pose`.
    pose : Pose of shape ()
    unit : float [m]
        Length of the design's unit.
    """
    values: list[float] = []
    for first, chain in zip(start, chains, strict=True):
        ends = len(chain.motions) if chain.leg.platform_line else -len(chain.platform)
        for own, motion in zip(first.motions[:ends], chain.motions[:ends], strict=True):
            if motion.kind == "ball":  # the turn since the pose of the model
                turn = Pose(np.zeros(3), np.asarray(own.value).T @ np.asarray(motion.value))
                values += wxyz(turn).tolist()
            else:  # a CCC leg may slide the other way than in the model
                values.append(metric(motion, unit) * float(motion.axis @ own.axis))
    return [*values, *(pose.position * unit), *wxyz(pose)]
