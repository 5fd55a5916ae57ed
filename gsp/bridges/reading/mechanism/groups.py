"""Bodies of a linkage that are fixed to each other, also by loops that the file has open."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from gsp.bridges.reading.mechanism.linkages import Link, Linkage
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose


@dataclass(frozen=True, eq=False, kw_only=True)
class Groups:
    """Which bodies are fixed to each other, and how far the file has them apart.

    Attributes
    ----------
    first : mapping of name to name
        For each body the first of those to which it is fixed, which names the group.
    closed : mapping of name to Pose
        For each body how it moves when the fixed loops of its group are closed and the first body
        stays: the identity but where the file has a loop open.
    """

    first: Mapping[str, str]
    closed: Mapping[str, Pose]

    def across(self, one: str, other: str, shift: Pose) -> Pose:
        """Return a shift to one body of a group as a shift to another."""
        inside = self.closed[other].inverse().compose(self.closed[one])
        return inside.compose(shift)


def rigid_groups(linkage: Linkage) -> Groups:
    """Return the groups of a linkage.

    Raises
    ------
    InvalidInput
        If two bodies are fixed to each other twice.
    """
    near: dict[str, list[tuple[str, Pose]]] = {name: [] for name in linkage.places}
    order = {name: i for i, name in enumerate(linkage.places)}
    root = dict(zip(linkage.places, linkage.places, strict=True))

    def first_of(name: str) -> str:
        while root[name] != name:
            name = root[name]
        return name

    for link in linkage.links:
        if link.freedoms:
            continue
        ends = sorted(map(first_of, (link.parent, link.child)), key=order.__getitem__)
        if ends[0] == ends[1]:
            _fail_repeated(link)
        root[ends[1]] = ends[0]
        near[link.parent].append((link.child, link.shift.inverse()))
        near[link.child].append((link.parent, link.shift))
    first = {name: first_of(name) for name in linkage.places}
    closed: dict[str, Pose] = {}
    for name in dict.fromkeys(first.values()):
        closed[name] = Pose(np.zeros(3))
        waiting = [name]
        while waiting:
            at = waiting.pop()
            for body, move in near[at]:
                if body not in closed:
                    closed[body] = closed[at].compose(move)
                    waiting.append(body)
    return Groups(first=first, closed=closed)


def _fail_repeated(link: Link) -> NoReturn:
    wanted = f"bodies {brief(link.parent)} and {brief(link.child)} to be fixed to each other once"
    got = "a second time, also through other bodies"
    raise InvalidInput(expected(link.where or f"joint {brief(link.name)}", wanted, got))
