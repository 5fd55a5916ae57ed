"""Links and joints of a model file, as all readers return them: `Linkage`.

Everything is in metres and in the axes of the world, in the configuration in which the file has
its links.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

NO_SHIFT = Pose(np.zeros(3))


@dataclass(frozen=True, eq=False, kw_only=True)
class Freedom:
    """One freedom of a joint.

    Attributes
    ----------
    kind : "ball", "slide" or "turn"
    name : str
        Of the joint in the file.
    point : (3,) array [m]
        Of the joint; on the axis of a turn.
    axis : (3,) array
        Unit vector of a slide or a turn: positive values move the links behind it that way.
    low, high : float [m, rad]
        Limits, counted from the configuration of the file; infinite for none.
    value : float [m, rad]
        What the joint variable counts in this configuration; NaN if it is not known.
    active : bool or None
        Whether an actuator drives it; None if the file states no actuators.
    """

    kind: Literal["ball", "slide", "turn"]
    name: str
    point: Array
    axis: Array = field(default_factory=lambda: np.full(3, np.nan))
    low: float = -np.inf
    high: float = np.inf
    value: float = np.nan
    active: bool | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class Link:
    """A joint between two bodies of the file, or what closes a loop.

    Attributes
    ----------
    name : str
    parent, child : str
        Names of bodies.
    freedoms : sequence of Freedom
        From the parent to the child; empty where they are fixed to each other.
    where : str
        Place in the file, for errors.
    shift : Pose
        Moves what is seen from the parent to where the child is: the gap of a loop that the file
        has open.
    """

    name: str
    parent: str
    child: str
    freedoms: Sequence[Freedom] = ()
    where: str = ""
    shift: Pose = NO_SHIFT


class Coupling(NamedTuple):
    """What lets joints move together only, or holds one.

    Attributes
    ----------
    where : str
        Place in the file, for errors.
    joints : tuple of str
        Names of the joints.
    got : str
        What it is, for errors.
    """

    where: str
    joints: tuple[str, ...]
    got: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Linkage:
    """The bodies and joints of a file.

    Attributes
    ----------
    name : str
        Of the model.
    base : str
        Name of the body that does not move.
    platform : str
        Name of the platform, "" to find it.
    likely : str
        Name of the body that may be the platform, if the most chains lead to it.
    places : mapping of name to Pose
        Of all bodies.
    links : sequence of Link
    couplings : sequence of Coupling
    """

    name: str
    base: str
    platform: str = ""
    likely: str = ""
    places: Mapping[str, Pose]
    links: Sequence[Link]
    couplings: Sequence[Coupling] = ()
