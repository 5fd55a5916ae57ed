"""The chains of joints between base and platform of a linkage."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

from gsp.bridges.reading.mechanism.groups import Groups, rigid_groups
from gsp.bridges.reading.mechanism.linkages import NO_SHIFT, Freedom, Link, Linkage
from gsp.errors import InvalidInput, UnknownName, brief, cut, expected
from gsp.geometry.pose import Pose

LEAST_CHAINS = 3  # three legs of two actuators each
# Most names of bodies in a message.
NAMES_SHOWN = 20


class Step(NamedTuple):
    """A joint of a chain, walked from base to platform."""

    link: Link
    backwards: bool


class Path(NamedTuple):
    """The names of the joints of a leg, its freedoms from base to platform, and its loop's gap."""

    names: str
    freedoms: tuple[Freedom, ...]
    shift: Pose


class Chains(NamedTuple):
    """What joins base and platform of a linkage.

    Attributes
    ----------
    platform : str
        Name of the platform.
    legs : tuple of Path
        Chains with bodies between base and platform, in the order of the file.
    guides : tuple of Link
        Joints between base and platform themselves.
    """

    platform: str
    legs: tuple[Path, ...]
    guides: tuple[Link, ...]


def chains_of(linkage: Linkage, *, chosen: bool = False) -> Chains:
    """Return the chains from the base to the platform.

    Parameters
    ----------
    linkage : Linkage
    chosen : bool
        Whether the user has named base or platform, so that other mechanisms do not matter.

    Raises
    ------
    UnknownName
        If the linkage names a base or a platform that it does not have.
    InvalidInput
        If no body has at least three chains, or two have the same number; if the joints between
        base and platform branch, or there are loops elsewhere; if the platform cannot move.
    """
    for role, name in (("base", linkage.base), ("platform", linkage.platform)):
        if name and name not in linkage.places:
            raise _unknown(role, name, list(linkage.places))
    groups = rigid_groups(linkage)
    platform = linkage.platform or _busiest(linkage, groups)
    end = groups.first[platform]
    if end == groups.first[linkage.base]:
        wanted = f"a platform that moves against the base {brief(linkage.base)}"
        raise InvalidInput(expected("model", wanted, f"{brief(platform)}, which is fixed to it"))
    joining, others = _components(linkage, groups, end)
    if not chosen:
        for bodies in others:
            _check_open(linkage, groups, bodies)
    legs = []
    for bodies in joining:
        steps = _walk(linkage, groups, bodies, end)
        legs.append(_path(linkage.base, platform, steps, groups))
    ends = {groups.first[linkage.base], end}
    guides = [x for x in linkage.links if x.freedoms and _ends(x, groups) == ends]
    return Chains(platform, tuple(legs), tuple(guides))


def _unknown(role: str, name: str, names: list[str]) -> UnknownName:
    more = len(names) - NAMES_SHOWN
    if more <= 0:
        return UnknownName(role, name, names)
    return UnknownName(
        role, name, names, f"Known: {', '.join(names[:NAMES_SHOWN])} and {more} more"
    )


def _busiest(linkage: Linkage, groups: Groups) -> str:
    """Return the body to which most chains lead from the base.

    Of bodies that are fixed to each other it is the likely one, else the one with most joints.
    """
    first = groups.first
    ends = Counter(name for link in linkage.links for name in (link.parent, link.child))
    joints = Counter(
        name for link in linkage.links if link.freedoms for name in _ends(link, groups)
    )
    counts = {
        group: len(_components(linkage, groups, group)[0])
        for group in dict.fromkeys(first.values())
        if group != first[linkage.base] and joints[group] >= LEAST_CHAINS
    }
    most = max(counts.values(), default=0)
    best = [name for name, count in counts.items() if count == most]
    if most < LEAST_CHAINS and first.get(linkage.likely) == first[linkage.base]:
        return linkage.likely
    if most < LEAST_CHAINS:
        base = brief(linkage.base)
        wanted = f"a platform with at least {LEAST_CHAINS} chains of joints from {base}"
        raise InvalidInput(expected("model", wanted, "none"))
    likely = first.get(linkage.likely, "")
    if likely in best:
        return linkage.likely
    if len(best) > 1:
        wanted = "one body to which most chains lead"
        named = " and ".join(map(cut, best))
        raise InvalidInput(expected("model", wanted, named, "name it as platform"))
    members = [name for name, group in first.items() if group == best[0]]
    return max(members, key=lambda name: ends[name])


def _ends(link: Link, groups: Groups) -> set[str]:
    return {groups.first[link.parent], groups.first[link.child]}


def _components(
    linkage: Linkage, groups: Groups, platform: str
) -> tuple[list[frozenset[str]], list[frozenset[str]]]:
    """Return the sets of groups that base and platform leave: those that touch both, and others."""
    base = groups.first[linkage.base]
    joints = [_ends(x, groups) for x in linkage.links if x.freedoms]
    near: dict[str, set[str]] = {}
    for ends in joints:
        for name in ends:
            near.setdefault(name, set()).update(ends)
    joining, others = list[frozenset[str]](), list[frozenset[str]]()
    seen = {base, platform}
    for group in dict.fromkeys(groups.first.values()):
        if group in seen:
            continue
        members, waiting, touched = {group}, [group], set()
        while waiting:
            around = near.get(waiting.pop(), set())
            touched |= around
            new = around - members - {base, platform}
            members |= new
            waiting += sorted(new)
        seen |= members
        (joining if {base, platform} <= touched else others).append(frozenset(members))
    return joining, others


def _check_open(linkage: Linkage, groups: Groups, bodies: frozenset[str]) -> None:
    """Refuse another mechanism with loops, of which base and platform may be meant as well."""
    ends = [_ends(x, groups) for x in linkage.links if x.freedoms]
    count = sum(bool(x & bodies) and len(x) > 1 for x in ends)
    outside = {name for x in ends if x & bodies for name in x} - bodies
    if count > len(bodies) - (not outside):
        wanted = "one mechanism with loops, or names of its base and platform"
        got = f"loops also at {brief(min(bodies, key=list(linkage.places).index))}"
        raise InvalidInput(expected("model", wanted, got))


def _walk(
    linkage: Linkage, groups: Groups, bodies: frozenset[str], platform: str
) -> tuple[Step, ...]:
    """Return the joints of a chain in order.

    Bodies that lead nowhere are left out, and joints that a weld of their bodies holds.
    """
    moving = [x for x in linkage.links if x.freedoms and len(_ends(x, groups)) > 1]
    edges = [x for x in moving if bodies & _ends(x, groups)]
    edges = _without_dead_ends(edges, groups, bodies)
    at, steps = groups.first[linkage.base], list[Step]()
    while at != platform:
        used = [step.link for step in steps]
        ahead = [x for x in edges if x not in used and at in _ends(x, groups)]
        if len(ahead) != 1:
            joints = ", ".join(brief(link.name) for link in ahead) or "none"
            wanted = "a chain of joints without branches"
            raise InvalidInput(
                expected(f"leg at {brief(sorted(bodies)[0])}", wanted, f"joints {joints}")
            )
        backwards = groups.first[ahead[0].parent] != at
        steps.append(Step(ahead[0], backwards))
        at = groups.first[ahead[0].parent if backwards else ahead[0].child]
    return tuple(steps)


def _without_dead_ends(edges: Sequence[Link], groups: Groups, bodies: Iterable[str]) -> list[Link]:
    """Return joints without those to bodies that one joint holds, such as covers."""
    kept = list(edges)
    while True:
        ends = [groups.first[x] for link in kept for x in (link.parent, link.child)]
        loose = {body for body in bodies if ends.count(body) == 1}
        if not loose:
            return kept
        kept = [x for x in kept if not loose & _ends(x, groups)]


def _path(base: str, platform: str, steps: Sequence[Step], groups: Groups) -> Path:
    freedoms: list[Freedom] = []
    at, shift = base, NO_SHIFT  # from what the base side sees to the side of the body `at`
    for link, backwards in steps:
        near, far = (link.child, link.parent) if backwards else (link.parent, link.child)
        shift = groups.across(at, near, shift)
        if backwards:  # its freedoms are stated on the side of its parent, which is ahead
            shift = link.shift.inverse().compose(shift)
            freedoms += [_seen(x, shift, -1.0) for x in reversed(link.freedoms)]
        else:
            freedoms += [_seen(x, shift, 1.0) for x in link.freedoms]
            shift = link.shift.compose(shift)
        at = far
    shift = groups.across(at, platform, shift)
    return Path(", ".join(dict.fromkeys(x.name for x in freedoms)), tuple(freedoms), shift)


def _seen(freedom: Freedom, shift: Pose, sign: float) -> Freedom:
    """Return a freedom as the base side sees it; backwards the parent moves, the other way."""
    back = shift.inverse()
    point = back.position + back.rotation @ freedom.point
    return replace(freedom, point=point, axis=sign * (back.rotation @ freedom.axis))
