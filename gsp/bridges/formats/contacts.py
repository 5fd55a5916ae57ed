"""Tags by which simulators leave out contacts of a model with itself.

The links of a leg overlap, and legs end within the platform. Gazebo and PyBullet have no contacts
within a model unless they are told to; Drake and MuJoCo have.
"""

from __future__ import annotations

from xml.etree import ElementTree

from gsp.bridges.formats.markup import Node

# Declares the prefix of Drake's tags; without it a strict reader of XML refuses them.
NAMESPACE = "http://drake.mit.edu"
GROUP = "links"


def ignore_own_contacts(model: Node) -> None:
    """Add the tag by which Drake ignores contacts between the links of a URDF or SDF.

    Parameters
    ----------
    model : element
        <robot> of URDF, or <model> of SDF, where the names of links are texts.
    """
    in_text = model.tag == "model"
    group = ElementTree.SubElement(model, "drake:collision_filter_group", name=GROUP)

    def add(tag: str, key: str, name: str) -> None:
        node = ElementTree.SubElement(group, tag, {} if in_text else {key: name})
        node.text = name if in_text else None

    for link in model.iterfind("link"):
        add("drake:member", "link", link.get("name", ""))
    add("drake:ignored_collision_filter_group", "name", GROUP)


def disable_contacts_in_mujoco(robot: Node) -> None:
    """Add the tag by which MuJoCo has no contacts of a URDF, as it can't have some of them."""
    option = ElementTree.SubElement(ElementTree.SubElement(robot, "mujoco"), "option")
    ElementTree.SubElement(option, "flag", contact="disable")
