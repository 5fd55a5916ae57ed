"""The loops of a mechanism that is exported as a tree, and tags that close them.

Drake and Gazebo each have own tags in URDF; programs pass over those that they do not know.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from gsp.bridges.formats.markup import Node, joined, metric, numbers_of, roll_pitch_yaw
from gsp.bridges.links.motions import Chain, X
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array


@read_only_tuple
class Loop(NamedTuple):
    """One loop to close: link_1 is fixed to link_2 where `placement` lies on link_2.

    Attributes
    ----------
    name : str
        Of the leg, "leg1" ….
    link_1, link_2 : str
        The last link of the leg, and "platform".
    placement : Pose of batch shape ()
        Where the frame of link_1 lies in that of link_2 when the loop is closed [m].
    points : (k, 3) array [m]
        Of link_1, in its frame: fixing these points to link_2 closes the loop as well. k = 1 where
        the leg ends in a spherical joint, its centre; k = 2 at a cylindrical one, on its line.
    """

    name: str
    link_1: str
    link_2: str
    placement: Pose
    points: Array

    @property
    def numbers(self) -> dict[str, object]:
        """What a file of loops has of it; rotations are (x, y, z, w)."""
        return {
            "name": self.name,
            "link_1": self.link_1,
            "link_2": self.link_2,
            **numbers_of(self.placement),
            "points": self.points.tolist(),
        }


def loop_of(chain: Chain, link: str, metres: float, size: float) -> Loop:
    """Return the loop of a leg.

    Two points on the line of a cylindrical joint leave the turn of its rail about that line open,
    which the joint leaves free as well.

    Parameters
    ----------
    chain : Chain
    link : str
        The last link of the leg.
    metres : float [m]
        Length of the design's unit.
    size : float [unit of the design]
        Distance of the points on a line from the anchor.
    """
    reach = np.array([-1.0, 1.0]) if chain.leg.platform_line else np.zeros(1)
    points = reach[:, None] * X * (size * metres)
    return Loop(chain.name, link, "platform", metric(chain.head, metres), points)


def add_ball_constraints(root: Node, loops: Iterable[Loop]) -> None:
    """Add the loops as Drake's tags: a ball constraint per point.

    A weld constraint of Drake has one compliance for its six rows. The light links within a joint
    turn so easily that it is then a thousand times too soft in translation, and loops open.
    """
    for loop in loops:
        for number, point in enumerate(loop.points, 1):
            name = loop.name if len(loop.points) == 1 else f"{loop.name}_{number}"
            ball = ElementTree.SubElement(root, "drake:ball_constraint", name=f"{name}_loop")
            there = loop.placement.position + loop.placement.rotation @ point
            for body, link, at, place in (
                ("A", loop.link_1, "AP", point),
                ("B", loop.link_2, "BQ", there),
            ):
                tag = f"drake:ball_constraint_body_{body}"
                ElementTree.SubElement(ball, tag, name=link)
                tag = f"drake:ball_constraint_p_{at}"
                ElementTree.SubElement(ball, tag, value=joined(place))


def add_gazebo_joints(
    root: Node, loops: Iterable[Loop], held: str, platform: Pose | None = None
) -> None:
    """Add the loops as joints of SDF, which Gazebo takes over when it converts URDF.

    The conversion leaves out a floating joint, and with it the place of the platform, which a frame
    of the same name has here. It unites links that a fixed joint connects if it is not told not to.

    Parameters
    ----------
    root : element
    loops : iterable of Loop
    held : str
        Joint that holds the platform.
    platform : Pose of batch shape () or None [m]
        Of the platform in the base if that joint is a floating one; None for a fixed one.
    """
    add = ElementTree.SubElement
    model = add(root, "gazebo")
    for loop in loops:
        joint = add(model, "joint", name=f"{loop.name}_loop", type="fixed")
        add(joint, "parent").text, add(joint, "child").text = loop.link_1, loop.link_2
    if platform is None:
        add(add(root, "gazebo", reference=held), "preserveFixedJoint").text = "true"
    else:
        frame = add(model, "frame", name=held, attached_to="base")
        add(frame, "pose").text = joined([*platform.position, *roll_pitch_yaw(platform)])
