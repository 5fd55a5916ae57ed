"""A design at a pose seen from above: joints with their names, legs with their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gsp.checks import check_type
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.posture import Posture
from gsp.plots.common.bodies import hull
from gsp.plots.common.style import BLUE, GREY, INK, LEGS, axes_or_new, plain, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Lengths as shares of the size of the drawing: joints that are drawn as one, joints whose names
# avoid each other, and the distance of a name from its joint.
TOGETHER, CLOSE, AWAY = 0.01, 0.13, 0.055
# Place of the number of a leg, as a share from base to platform.
NUMBER = 0.42


def plan_view(
    design: Design,
    pose: Pose | None = None,
    ax: Axes | None = None,
    *,
    base_names: Sequence[str] | None = None,
    platform_names: Sequence[str] | None = None,
) -> Axes:
    """Return axes with a design at a pose, projected along the z-axis of the base.

    Base and platform are drawn as the outlines of their joints. A letter after "_" in a name is
    written below the line. Joints at one place share a mark and, if their names differ, are
    labelled with all of them. Legs carry their numbers, from 1; a leg that is undefined at the
    pose is left out.

    Parameters
    ----------
    design : Design
    pose : Pose of shape (), default the home pose of the design
    ax : plane matplotlib Axes, optional
    base_names, platform_names : sequences of str, optional
        A name for each leg's joint; default a_1, a_2, … and b_1, b_2, …

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        On wrong types, if there is no pose or a batch of them, or on a wrong number of names.
    MissingSoftware
        Without matplotlib.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    >>> base, platform = gsp.families.lee.joint_names("lee-3-3")
    >>> axes = plan_view(design, gsp.Pose([0, 0, 1]), base_names=base, platform_names=platform)
    """
    check_type("design", design, Design)
    pose = design.home if pose is None else pose
    if pose is None:
        raise InvalidInput(expected("pose", "a single pose", "none, and no home pose"))
    check_type("pose", pose, Pose)
    if pose.shape or not np.isfinite(pose.position).all() or not np.isfinite(pose.rotation).all():
        raise InvalidInput(expected("pose", "a single pose of finite numbers", pose))
    low = _check_names("base_names", base_names, "a", design.n_legs)
    high = _check_names("platform_names", platform_names, "b", design.n_legs)
    with style():
        axes = axes_or_new(ax, 5.2, 5.2)
        _draw(axes, design.at(pose), low, high)
        return axes


def _check_names(what: str, names: Sequence[str] | None, letter: str, n: int) -> tuple[str, ...]:
    if names is None:
        return tuple(f"{letter}_{i + 1}" for i in range(n))
    if isinstance(names, str) or not isinstance(names, Sequence):
        raise InvalidInput(expected(what, f"{n} names", brief(names)))
    if len(names) != n or not all(isinstance(name, str) for name in names):
        raise InvalidInput(expected(what, f"{n} names", brief(names)))
    return tuple(names)


def _draw(ax: Axes, posture: Posture, low: tuple[str, ...], high: tuple[str, ...]) -> None:
    segments, anchors = posture.segments, posture.pose.position + posture.lines.arm
    there = np.asarray(~np.isnan(segments.platform_feet).any(axis=1))
    bottoms = np.where(there[:, None], segments.base_feet, posture.design.base_points)
    tops = np.where(there[:, None], segments.platform_feet, anchors)
    size = float(np.ptp(np.concatenate((bottoms, tops))[:, :2], axis=0).max()) or 1.0
    _outline(ax, bottoms, GREY, size)
    _outline(ax, tops, BLUE, size)
    for i in (int(leg) for leg in np.flatnonzero(there)):
        _leg(ax, bottoms[i, :2], tops[i, :2], i + 1, LEGS[posture.design.legs[i].name])
    _joints(ax, bottoms[:, :2], low, GREY, size)
    _joints(ax, tops[:, :2], high, BLUE, size)
    unit = f" [{plain(posture.design.unit)}]" if posture.design.unit else ""
    ax.set(xlabel=f"x{unit}", ylabel=f"y{unit}", title=plain(posture.design.name))
    ax.set_aspect("equal")
    ax.margins(0.12)


def _outline(ax: Axes, points: Array, colour: str, size: float) -> None:
    """Fill the faces of the hull of joints, as seen from above."""
    faces, edges = hull(points, size)
    for face in faces:
        ax.fill(face[:, 0], face[:, 1], color=colour, alpha=0.1, linewidth=0.0)
    for edge in edges:
        ax.plot(edge[:, 0], edge[:, 1], color=colour, linewidth=1.0)


def _leg(ax: Axes, bottom: Array, top: Array, number: int, colour: str) -> None:
    ax.plot(*np.stack((bottom, top)).T, color=colour, linewidth=2.0, solid_capstyle="round")
    x, y = bottom + NUMBER * (top - bottom)
    ax.text(
        x, y, str(number), fontsize=7, ha="center", va="center", color=INK, zorder=6,
        bbox={
            "boxstyle": "circle,pad=0.2", "facecolor": "white", "edgecolor": colour,
            "linewidth": 0.8,
        },
    )  # fmt: skip


def _joints(ax: Axes, points: Array, names: tuple[str, ...], colour: str, size: float) -> None:
    """Mark joints, and write their names away from the centre and from joints close by."""
    groups = _together(points, TOGETHER * size)
    places = points[[group[0] for group in groups]]
    for group, place in zip(groups, places, strict=True):
        x, y = place + AWAY * size * _outward(place, places, size)
        label = " = ".join(dict.fromkeys(_written(names[i]) for i in group))
        ax.plot(*place, "o", color=colour, markersize=6.0, markeredgecolor="white", zorder=5)
        ax.text(x, y, label, fontsize=9, ha="center", va="center", color=INK, zorder=7)


def _outward(place: Array, places: Array, size: float) -> Array:
    """Return the direction from the centre of places, turned away from those close by: (2,)."""
    away = place - places.mean(axis=0)
    length = float(norm(away))
    direction = away / length if length > TOGETHER * size else np.array([0.0, 1.0])
    for other in places:
        apart = place - other
        distance = float(norm(apart))
        if 0.0 < distance < CLOSE * size:
            direction = direction + 1.5 * apart / distance
    length = float(norm(direction))
    return np.asarray(direction / length if length > 0.0 else away)


def _together(points: Array, near: float) -> list[list[int]]:
    """Return the numbers of points in groups that lie at one place."""
    groups: list[list[int]] = []
    for i, point in enumerate(points):
        group = next((g for g in groups if norm(points[g[0]] - point) < near), None)
        if group is None:
            groups.append([i])
        else:
            group.append(i)
    return groups


def _written(name: str) -> str:
    """Return a name with what follows "_" below the line."""
    head, _, tail = name.partition("_")
    text = plain(head)
    return rf"{text}$_{{\mathrm{{{tail}}}}}$" if tail.isalnum() else plain(name)
