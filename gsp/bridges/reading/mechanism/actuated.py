"""Which joints of a leg are driven, and whether they are those of a leg of the catalogue."""

from __future__ import annotations

import re
from collections.abc import Sequence

from gsp.bridges.reading.mechanism.linkages import Freedom
from gsp.errors import InvalidInput, brief, expected

# Names of the passive and the driven joints in exported models: "leg4_slide", "d4", "theta4" …
PASSIVE = re.compile(r"leg\d+_(base_|platform_)?(slide|turn)|.*passive.*", re.IGNORECASE)
DRIVEN = re.compile(r"(d|theta)\d+")


def check_driven(freedoms: Sequence[Freedom], first: Freedom, where: str) -> None:
    """Raise an error if others than the slide of a leg, or its first joint, are driven.

    If the file states no actuators, this joint is taken for driven.

    Parameters
    ----------
    freedoms : sequence of Freedom
        Of the leg.
    first : Freedom
        The one whose actuator the leg has in the catalogue.
    where : str
        Names the leg in errors.

    Raises
    ------
    InvalidInput
    """
    _check_only(freedoms, [first], where)
    if first.active is False:
        _fail_passive(where, f"an actuator of the {first.kind} {brief(first.name)}")


def driven_of_two(
    freedoms: Sequence[Freedom], slide: Freedom, turn: Freedom, where: str
) -> list[Freedom]:
    """Return which of the slide and the turn between two lines are driven.

    It is what the file states, else what the names state that `export` gives to joints.

    Parameters
    ----------
    freedoms : sequence of Freedom
        Of the leg.
    slide, turn : Freedom
    where : str
        Names the leg in errors.

    Raises
    ------
    InvalidInput
        If others are driven, none of the two is, or it is not known which.
    """
    pair = [slide, turn]
    _check_only(freedoms, pair, where)
    stated = [_stated(x) for x in pair]
    if False in stated and None in stated:  # one of them is driven
        stated = [x is None for x in stated]
    if None in stated:
        wanted = f"which of {brief(slide.name)} and {brief(turn.name)} an actuator drives"
        got = "no statement: joints_at_zero in the file beside the model, or an actuator, is one"
        raise InvalidInput(expected(where, wanted, got))
    found = [x for x, driven in zip(pair, stated, strict=True) if driven]
    if not found:
        _fail_passive(where, "an actuator of the slide, of the turn, or of both")
    return found


def _stated(freedom: Freedom) -> bool | None:
    if freedom.active is not None:
        return freedom.active
    if PASSIVE.fullmatch(freedom.name):
        return False
    return True if DRIVEN.fullmatch(freedom.name) else None


def _check_only(freedoms: Sequence[Freedom], known: Sequence[Freedom], where: str) -> None:
    for freedom in freedoms:
        if freedom.active and freedom not in known:
            names = " and ".join(brief(x.name) for x in known)
            got = f"one that drives the {freedom.kind} {brief(freedom.name)}"
            raise InvalidInput(expected(where, f"actuators of {names} only", got))


def _fail_passive(where: str, wanted: str) -> None:
    got = "none, though the file states actuators"
    raise InvalidInput(expected(where, wanted, got))
