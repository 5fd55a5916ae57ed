"""Indices along a motion and over a plane of positions, and the catalogue ranked at a pose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from gsp.app.state.reading import missing_words, powers, settings
from gsp.app.state.session import Session, started
from gsp.catalogue import instantiate, mechanisms
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, Index
from gsp.model.design import Design
from gsp.sweeps.paths import plane, translation, turn

MOTIONS = ("x", "y", "z", "turn about x", "turn about y", "turn about z")
PLANES = ("xy", "xz", "yz")
# Points of a curve and of each side of a map; an odd number has the present pose in the middle.
CURVE_POINTS, MAP_POINTS = 121, 31
# Reach of plots to either side, in sizes of the design and degrees.
CURVE_REACH, CURVE_REACH_DEG = 1.0, 90.0
# Slow indices are left out of plots: they need compiled code, which takes seconds where it is not
# cached. Afterwards they take some 30 µs per pose of a plot.
PLOTTED = tuple(name for name, index in INDICES.items() if not index.slow)


@dataclass(frozen=True, eq=False, kw_only=True)
class Curve:
    """An index along a motion through the present pose.

    Attributes
    ----------
    index : Index
    places : (n,) array [unit of the design, or degrees]
        Coordinates of positions; angles from the present pose.
    here : float [of the places]
        The present pose.
    values : (n,) array [unit of the index]
    label, unit : str
        Of the axis of the index.
    axis : str
        Label of the motion with its unit.
    """

    index: Index
    places: Array
    here: float
    values: Array
    label: str
    axis: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Map:
    """An index over a plane of positions around the present one, with the present rotation.

    Attributes
    ----------
    index : Index
    first, second : (n,) arrays [unit of the design]
        Coordinates of positions.
    values : (n, n) array [unit of the index]
        values[i, j] at first[i], second[j].
    axes : tuple of str
        Labels.
    """

    index: Index
    first: Array
    second: Array
    values: Array
    axes: tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Ranked:
    """A mechanism of the catalogue at the present pose, with its merit.

    Attributes
    ----------
    name, group : str
    value : float [unit of the index]
        NaN where it has none.
    reason : str
        Why it has none, or "".
    """

    name: str
    group: str
    value: float
    reason: str = ""


def curve(state: Session, name: str, motion: str) -> Curve:
    """Return an index along a motion through the present pose.

    Parameters
    ----------
    state : Session
    name : str
        Of the index.
    motion : one of `MOTIONS`
        Along or about axes of the base; turns are about the platform origin.

    Raises
    ------
    GspError
        On other names, or where the index misses a parameter.
    """
    index = _index(name)
    if motion not in MOTIONS:
        raise InvalidInput(expected("motion", ", ".join(MOTIONS), repr(motion)))
    letter, unit = motion[-1], state.design.unit
    if motion in ("x", "y", "z"):
        # Places stay when the platform moves along the axis, so that only the cursor moves.
        here = float(state.pose.position["xyz".index(letter)])
        first = float(started(state.design).pose.position["xyz".index(letter)])
        places = first + np.linspace(-1.0, 1.0, CURVE_POINTS) * CURVE_REACH * state.size
        path, label = translation(state.pose, letter, places - here), _with_unit(letter, unit)
    else:
        here, places = 0.0, np.linspace(-CURVE_REACH_DEG, CURVE_REACH_DEG, CURVE_POINTS)
        path, label = turn(state.pose, letter, places), f"{motion} [°]"
    return Curve(
        index=index,
        places=places,
        here=here,
        values=_values(state, index, path.pose),
        label=_label(state, index),
        axis=label,
    )


def map_over(state: Session, name: str, axes: str) -> Map:
    """Return an index over a plane of positions: "xy", "xz" or "yz" of the base.

    Raises
    ------
    GspError
        On other names, or where the index misses a parameter.
    """
    index = _index(name)
    if axes not in PLANES:
        raise InvalidInput(expected("plane", ", ".join(PLANES), repr(axes)))
    steps = np.linspace(-1.0, 1.0, MAP_POINTS) * CURVE_REACH * state.size
    path = plane(state.pose, steps, steps, (axes[0], axes[1]))
    here = [float(state.pose.position["xyz".index(letter)]) for letter in axes]
    return Map(
        index=index,
        first=here[0] + steps,
        second=here[1] + steps,
        values=_values(state, index, path.pose),
        axes=(_with_unit(axes[0], state.design.unit), _with_unit(axes[1], state.design.unit)),
    )


def ranking(state: Session, name: str, template: Design) -> tuple[Ranked, ...]:
    """Return the 195 mechanisms on a template at the present pose, best first.

    λ is not ranked, as each mechanism has its own maximum of |det J|.

    Parameters
    ----------
    state : Session
    name : str
        Of the index.
    template : Design
        The pose and the length are taken in its unit.
    """
    index = _index(name)
    if index.share_of:
        raise InvalidInput(expected("index", "one without a maximum of its own", "λ"))
    found = [_ranked(state, index, design) for design in on_template(template)]
    merits = [float(index.merit(np.asarray(one.value))) for one in found]
    order = np.argsort([-m if np.isfinite(m) else np.inf for m in merits], kind="stable")
    return tuple(found[i] for i in order)


@lru_cache(maxsize=8)
def on_template(template: Design) -> tuple[Design, ...]:
    """Return the 195 mechanisms on the anchor lines of a template; those that have none there not.

    Designs are hashed by identity, and published ones are always the same objects.
    """
    found = []
    for mechanism in mechanisms():
        try:
            found.append(instantiate(mechanism, template))
        except GspError:  # an anchor at the origin has no radial line
            continue
    return tuple(found)


def _ranked(state: Session, index: Index, design: Design) -> Ranked:
    here, kind = replace(state, design=design), design.mechanism
    value, reason = float("nan"), missing_words(here, index)
    if not reason:
        value = float(_values(here, index, state.pose))
        reason = "undefined at this pose" if np.isnan(value) else ""
    return Ranked(name=kind.name, group=kind.group, value=value, reason=reason)


def _index(name: str) -> Index:
    if name not in PLOTTED:
        raise InvalidInput(expected("index", ", ".join(PLOTTED), repr(name)))
    return INDICES[name]


def _values(state: Session, index: Index, pose: Pose) -> Array:
    """Return an index of the design of a state at poses, by numpy: nothing has to be compiled."""
    given = settings(state)
    missing = index.missing(state.design, given.given())
    if missing:
        raise InvalidInput(index.missing_message(missing[0], state.design))
    return np.asarray(index.function(state.design.at(pose), **given.for_index(index)))


def _with_unit(text: str, unit: str) -> str:
    return f"{text} [{unit}]" if unit else text


def _label(state: Session, index: Index) -> str:
    unit = index.unit(state.design)
    return index.symbol if unit in ("1", "mixed") else f"{index.symbol} [{powers(unit)}]"
