"""The chains of joints between base and platform of a linkage."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from gsp.bridges.reading.linkages import NO_SHIFT, Freedom, Link, Linkage
from gsp.errors import InvalidInput, UnknownName, brief, cut, expected
from gsp.geometry.pose import Pose

LEAST_CHAINS = 3  # three legs of two actuators each


class Step(NamedTuple):
    """A joint of a chain, walked from base to platform."""

    link: Link
    backwards: bool


class Path(NamedTuple):
    """The freedoms of a leg from base to platform, and the gap of its loop."""

    names: str
    freedoms: tuple[Freedom, ...]
    shift: Pose


def find_platform(linkage: Linkage) -> str:
    """Return the name of the platform: the body to which most chains lead from the base.

    Raises
    ------
    UnknownName
        If the linkage names a base or a platform that it does not have.
    InvalidInput
        If no body has at least three chains, or two have the same number.
    """
    for role, name in (("base", linkage.base), ("platform", linkage.platform)):
        if name and name not in linkage.places:
            raise UnknownName(role, name, linkage.places)
    if linkage.platform:
        return linkage.platform
    groups = _rigid_groups(linkage)
    counts: dict[str, int] = {}
    for group in dict.fromkeys(groups.values()):
        if group != groups[linkage.base]:
            counts[group] = len(_components(linkage, groups, group))
    most = max(counts.values(), default=0)
    best = [name for name, count in counts.items() if count == most]
    if most < LEAST_CHAINS:
        base = brief(linkage.base)
        wanted = f"a platform with at least {LEAST_CHAINS} chains of joints from {base}"
        raise InvalidInput(expected("model", wanted, f"{most} at most"))
    if len(best) > 1:
        wanted = "one body to which most chains lead"
        named = " and ".join(map(cut, best))
        raise InvalidInput(expected("model", wanted, named, "name it as platform"))
    return best[0]


def paths(linkage: Linkage, platform: str) -> tuple[Path, ...]:
    """Return the chains from the base to the platform, in the order of the file.

    Raises
    ------
    InvalidInput
        If the joints between them branch.
    """
    groups = _rigid_groups(linkage)
    found = []
    for bodies in _components(linkage, groups, groups[platform]):
        steps = _walk(linkage, groups, bodies, groups[platform])
        found.append(_path(steps))
    return tuple(found)


def _rigid_groups(linkage: Linkage) -> Mapping[str, str]:
    """Return for each body the first of those to which it is fixed."""
    first = {name: name for name in linkage.places}

    def root(name: str) -> str:
        while first[name] != name:
            name = first[name]
        return name

    order = {name: i for i, name in enumerate(linkage.places)}
    for link in linkage.links:
        if not link.freedoms:
            ends = sorted((root(link.parent), root(link.child)), key=order.__getitem__)
            first[ends[1]] = ends[0]
    return {name: root(name) for name in linkage.places}


def _components(linkage: Linkage, groups: Mapping[str, str], platform: str) -> list[frozenset[str]]:
    """Return the sets of groups between base and platform, those that touch both, in order."""
    base = groups[linkage.base]
    joints = [(groups[x.parent], groups[x.child]) for x in linkage.links if x.freedoms]
    found = []
    left = [g for g in dict.fromkeys(groups.values()) if g not in (base, platform)]
    while left:
        members, waiting = {left[0]}, [left[0]]
        while waiting:
            at = waiting.pop()
            for one, other in joints:
                for near, far in ((one, other), (other, one)):
                    if near == at and far not in (base, platform) and far not in members:
                        members.add(far)
                        waiting.append(far)
        left = [g for g in left if g not in members]
        touched = {y for x in joints for y in x if members & set(x)}
        if {base, platform} <= touched:
            found.append(frozenset(members))
    return found


def _walk(
    linkage: Linkage, groups: Mapping[str, str], bodies: frozenset[str], platform: str
) -> tuple[Step, ...]:
    """Return the joints of a chain in order; bodies that lead nowhere are left out."""
    edges = [
        link
        for link in linkage.links
        if link.freedoms and bodies & {groups[link.parent], groups[link.child]}
    ]
    edges = _without_dead_ends(edges, groups, bodies)
    at, steps, used = groups[linkage.base], [], set()
    while at != platform:
        ahead = [
            link
            for link in edges
            if link.name not in used and at in (groups[link.parent], groups[link.child])
        ]
        if len(ahead) != 1:
            joints = ", ".join(brief(link.name) for link in ahead) or "none"
            wanted = "a chain of joints without branches"
            raise InvalidInput(
                expected(f"leg at {brief(sorted(bodies)[0])}", wanted, f"joints {joints}")
            )
        backwards = groups[ahead[0].parent] != at
        steps.append(Step(ahead[0], backwards))
        used.add(ahead[0].name)
        at = groups[ahead[0].parent if backwards else ahead[0].child]
    return tuple(steps)


def _without_dead_ends(
    edges: Sequence[Link], groups: Mapping[str, str], bodies: Iterable[str]
) -> list[Link]:
    """Return joints without those to bodies that one joint holds, such as covers."""
    kept = list(edges)
    while True:
        ends = [groups[x] for link in kept for x in (link.parent, link.child)]
        loose = {body for body in bodies if ends.count(body) == 1}
        if not loose:
            return kept
        kept = [x for x in kept if not loose & {groups[x.parent], groups[x.child]}]


def _path(steps: Sequence[Step]) -> Path:
    freedoms: list[Freedom] = []
    shift = NO_SHIFT  # from what the base side sees to the side of the next joint
    for link, backwards in steps:
        if backwards:  # its freedoms are stated on the side of its parent, which is ahead
            shift = link.shift.inverse().compose(shift)
            freedoms += [_seen(x, shift, -1.0) for x in reversed(link.freedoms)]
        else:
            freedoms += [_seen(x, shift, 1.0) for x in link.freedoms]
            shift = link.shift.compose(shift)
    return Path(" ".join(step.link.name for step in steps), tuple(freedoms), shift)


def _seen(freedom: Freedom, shift: Pose, sign: float) -> Freedom:
    """Return a freedom as the base side sees it; backwards the parent moves, the other way."""
    back = shift.inverse()
    point = back.position + back.rotation @ freedom.point
    return replace(freedom, point=point, axis=sign * (back.rotation @ freedom.axis))
