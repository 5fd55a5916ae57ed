"""Numbers, placements, joint values and inertias in the XML of models, in metres and kilograms."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from gsp.bridges.links.motions import Chain
from gsp.bridges.links.shapes import Body
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design

Node = ElementTree.Element
# What the shapes of a link are for, in URDF and SDF.
PURPOSES = ("visual", "collision")
ENTRIES = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}


# What XML cannot contain, and names that SDF keeps for itself.
NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
RESERVED = re.compile("world|__.*__")


def title_of(design: Design) -> str:
    """Return the name of a model that its format allows: of the design, else its mechanism."""
    name = NO_XML.sub("", design.name).replace("::", "_")
    if RESERVED.fullmatch(name.strip()):
        name = f"model {name.strip()}"
    return name if name.strip() else design.mechanism.name


def joined(numbers: ArrayLike) -> str:
    """Return numbers as text that reads back bit by bit, with spaces between them."""
    return " ".join(repr(float(x)) for x in np.asarray(numbers).ravel())


def roll_pitch_yaw(place: Pose) -> Array:
    """Return angles in rad; at a pitch of 90° roll and yaw are not unique, and any are valid."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        return place.angles("rpy")


def metric(pose: Pose, metres: float) -> Pose:
    """Return a pose in metres; `metres` is the length of its unit."""
    return Pose(pose.position * metres, pose.rotation)


def joint_values(design: Design, pose: Pose, metres: float) -> dict[str, float]:
    """Return the values of the actuated joints at a pose [m, rad], by their names."""
    values = design.at(pose).joints * np.where(design.angular, 1.0, metres)
    return dict(zip(design.joint_names, values.tolist(), strict=True))


def base_slides(chains: Iterable[Chain], metres: float) -> dict[str, float]:
    """Return the values of the passive slides along lines of the base [m], by their names."""
    motions = [motion for chain in chains for motion in chain.base]
    passive = [motion for motion in motions if motion.kind == "slide" and not motion.active]
    return {motion.name: float(motion.value) * metres for motion in passive}


def moments(body: Body, metres: float) -> dict[str, str]:
    """Return "ixx", "ixy" … of a body about its centre of mass [kg m²], as text."""
    matrix = body.inertia * metres**2
    return {name: repr(float(matrix[at])) for name, at in ENTRIES.items()}


def written(root: Node) -> str:
    """Return the text of an XML file."""
    ElementTree.indent(root)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def numbers_of(pose: Pose) -> dict[str, list[float]]:
    """Return position and rotation (x, y, z, w) as lists."""
    return {"position": pose.position.tolist(), "rotation": pose.quaternion.tolist()}
