"""A design at a pose seen from above: joints with their names, legs with their numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.checks import check_items, check_type
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import INK, style
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design, check_undriven
from gsp.model.posture import Posture
from gsp.plots.common.bodies import hull
from gsp.plots.common.labels import covered, drawn_places, free_places
from gsp.plots.common.style import BLUE, GREY, LEGS, SHORT_NAME, axes_or_new, plain, title_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Joints nearer than this share of the size of the drawing are one.
SAME_JOINT = 1e-6
# Places of the number of a leg, as shares from base to platform, the preferred first.
PLAN_NUMBER_PLACES = (0.42, 0.5, 0.34, 0.58, 0.27, 0.65, 0.2, 0.72, 0.8)
# Sizes in points: a letter of a name, the height of a name, the circle of a number, the mark of a
# joint, and the distances of a label from its joint.
LETTER_WIDTH = 5.6
LETTER_HEIGHT = 12.0
JOINT_CIRCLE = 14.0
JOINT_MARK = 8.0
LABEL_DISTANCES = (14.0, 20.0, 28.0, 38.0)
# The margin of the axes, as a share of the drawing, for labels outside of the joints.
MARGIN_SHARE = 0.14
# Directions of labels from joints, and what turning one by 180° costs [area of a letter].
LABEL_ANGLES, OPPOSITE_COST = np.arange(24) * np.pi / 12.0, 1.0
# How much worse a name on a line is than on another name or a mark, as an area: lines are thin.
STRUCK_SHARE = 3.0


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
    check_undriven("design", design)
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
    found = check_items(what, names, f"{n} names")
    if len(found) != n or not all(isinstance(name, str) for name in found):
        raise InvalidInput(expected(what, f"{n} names", brief(names)))
    return found


def _draw(ax: Axes, posture: Posture, low: tuple[str, ...], high: tuple[str, ...]) -> None:
    segments, anchors = posture.segments, posture.pose.position + posture.lines.arm
    there = np.asarray(~np.isnan(segments.platform_feet).any(axis=1))
    bottoms = np.where(there[:, None], segments.base_feet, posture.design.base_points)
    tops = np.where(there[:, None], segments.platform_feet, anchors)
    seen = np.concatenate((bottoms, tops))[:, :2]
    size = float(np.ptp(seen, axis=0).max()) or 1.0
    _outline(ax, bottoms, GREY, size)
    _outline(ax, tops, BLUE, size)
    legs = [int(leg) for leg in np.flatnonzero(there)]
    for i in legs:
        colour = LEGS[posture.design.legs[i].name]
        ends = np.stack((bottoms[i, :2], tops[i, :2]))
        ax.plot(*ends.T, color=colour, linewidth=2.0, solid_capstyle="round")
    unit = f" [{plain(posture.design.unit)}]" if posture.design.unit else ""
    name = title_text(posture.design.name, SHORT_NAME)
    ax.set(xlabel=f"x{unit}", ylabel=f"y{unit}", title=name)
    _limits(ax, seen, size)
    joints = [
        *_joints(ax, bottoms[:, :2], low, GREY, SAME_JOINT * size),
        *_joints(ax, tops[:, :2], high, BLUE, SAME_JOINT * size),
    ]
    _write(ax, joints, np.stack((bottoms, tops), axis=1)[legs, :, :2], legs, posture.design)


def _outline(ax: Axes, points: Array, colour: str, size: float) -> None:
    """Fill the faces of the hull of joints, as seen from above."""
    faces, edges = hull(points, size)
    for face in faces:
        ax.fill(face[:, 0], face[:, 1], color=colour, alpha=0.1, linewidth=0.0)
    for edge in edges:
        ax.plot(edge[:, 0], edge[:, 1], color=colour, linewidth=1.0)


def _limits(ax: Axes, seen: Array, size: float) -> None:
    """Set equal scales and limits with a margin; joints on a line keep a picture of some height."""
    middle = 0.5 * (seen.min(axis=0) + seen.max(axis=0))
    half = np.maximum(0.5 * np.ptp(seen, axis=0), 0.25 * size) + MARGIN_SHARE * size
    ax.set(
        xlim=(middle[0] - half[0], middle[0] + half[0]),
        ylim=(middle[1] - half[1], middle[1] + half[1]),
        aspect="equal",
    )


def _joints(
    ax: Axes, points: Array, names: tuple[str, ...], colour: str, near: float
) -> list[tuple[str, Array, Array]]:
    """Mark the joints of a body; return text, place and the centre of the body for each mark."""
    groups = _together(points, near)
    places = points[[group[0] for group in groups]]
    for x, y in places:
        ax.plot(x, y, "o", color=colour, markersize=6.0, markeredgecolor="white", zorder=5)
    texts = [" = ".join(dict.fromkeys(_written(names[i]) for i in group)) for group in groups]
    return [(text, at, places.mean(axis=0)) for text, at in zip(texts, places, strict=True)]


def _write(
    ax: Axes, joints: list[tuple[str, Array, Array]], spans: Array, legs: list[int], design: Design
) -> None:
    """Write the numbers of legs, which span (k, 2, 2), and the names of joints."""
    from matplotlib.patheffects import withStroke

    ax.apply_aspect()
    found = _places(ax, joints, spans)
    middle: dict[str, Any] = {"ha": "center", "va": "center", "color": INK}
    for leg, (x, y) in zip(legs, found, strict=False):
        edge = {
            "boxstyle": "circle,pad=0.2",
            "facecolor": "white",
            "linewidth": 0.8,
            "edgecolor": LEGS[design.legs[leg].name],
        }
        ax.text(x, y, str(leg + 1), fontsize=7, zorder=6, bbox=edge, **middle)
    outline = [withStroke(linewidth=3.0, foreground="white")]
    for (text, *_), (x, y) in zip(joints, found[len(legs) :], strict=True):
        ax.text(x, y, text, fontsize=9, zorder=7, path_effects=outline, **middle)


def _places(ax: Axes, joints: list[tuple[str, Array, Array]], spans: Array) -> list[list[float]]:
    """Return free places for the numbers of legs and the names of joints, in units of the data.

    They are chosen one by one, so that none covers another, a mark, or the edge of the axes;
    names avoid the lines as well.
    """
    per_point = ax.figure.dpi / 72.0
    ends = _seen(ax, spans) / per_point
    places, centres = (_seen(ax, np.array([j[k] for j in joints])) / per_point for k in (1, 2))
    circles = [_along(*span) for span in ends]
    sizes = np.array([(LETTER_WIDTH * _letters(text), LETTER_HEIGHT) for text, *_ in joints])
    inside = np.array(ax.bbox.extents).reshape(2, 2) / per_point
    around = [_around(*one, places, inside) for one in zip(places, centres, sizes, strict=True)]
    marks = np.concatenate((places - 0.5 * JOINT_MARK, places + 0.5 * JOINT_MARK), axis=1)
    taken = np.concatenate((marks, _outside(np.array(ax.bbox.extents) / per_point)))
    wide = np.full((len(circles), 2), JOINT_CIRCLE)
    numbers = free_places([c[0] for c in circles], wide, taken, [c[1] for c in circles])
    middles = np.array(numbers).reshape(-1, 2)
    rings = np.concatenate((middles - 0.5 * JOINT_CIRCLE, middles + 0.5 * JOINT_CIRCLE), axis=1)
    # Numbers are on the legs, names beside all lines.
    lines = drawn_places(ax)
    taken = np.concatenate((taken, rings, lines))
    costs = [
        cost + STRUCK_SHARE * covered(at, size, lines)
        for (at, cost), size in zip(around, sizes, strict=True)
    ]
    names = free_places([a[0] for a in around], sizes, taken, costs)
    back = ax.transData.inverted().transform(np.array([*numbers, *names]) * per_point)
    return [[float(x), float(y)] for x, y in back]


def _outside(extents: Array) -> Array:
    """Return the four rectangles around axes, (4, 4), which labels must not enter."""
    left, bottom, right, top = extents.tolist()
    far = 10.0 * (right - left + top - bottom)
    return np.array(
        [
            (left - far, bottom - far, left, top + far),
            (right, bottom - far, right + far, top + far),
            (left, bottom - far, right, bottom),
            (left, top, right, top + far),
        ]
    )


def _seen(ax: Axes, points: Array) -> Array:
    """Return points of the drawing in pixels, (..., 2)."""
    flat = ax.transData.transform(points.reshape(-1, 2))
    return np.asarray(flat).reshape(points.shape)


def _along(bottom: Array, top: Array) -> tuple[Array, Array]:
    """Return places for the number of a leg [points], (k, 2), and their costs.

    They lie on the leg, or beside it if that is short.
    """
    on = bottom + np.array(PLAN_NUMBER_PLACES)[:, None] * (top - bottom)
    beside = bottom + np.concatenate([far * _ways(0.0) for far in LABEL_DISTANCES])
    short = float(norm(top - bottom)) < 3.0 * JOINT_CIRCLE
    places = np.asarray(np.concatenate((on, beside)) if short else on, dtype=np.float64)
    return places, np.asarray(np.arange(len(places)) * 1e-2, dtype=np.float64)


def _around(
    place: Array, centre: Array, size: Array, others: Array, inside: Array
) -> tuple[Array, Array]:
    """Return places for the name of a joint [points], (k, 2), and their costs.

    They are moved so that the name is inside of the axes, if these are wide enough. Outward from
    the centre of the body costs least. A place that is nearer to another joint costs the area of
    a hundred letters, and moving a name by its height that of its square.
    """
    out = place - centre
    start = float(np.arctan2(out[1], out[0])) if norm(out) > JOINT_MARK else 0.5 * np.pi
    ways, turns = _ways(start), np.minimum(LABEL_ANGLES, 2.0 * np.pi - LABEL_ANGLES) / np.pi
    stretch = 0.5 * np.maximum(size - (2.0 * LETTER_WIDTH, LETTER_HEIGHT), 0.0)
    wanted = np.concatenate([place + ways * (far + stretch) for far in LABEL_DISTANCES])
    low, high = inside[0] + 0.5 * size, inside[1] - 0.5 * size
    places = np.clip(wanted, np.minimum(low, inside.mean(axis=0)), np.maximum(low, high))
    far = np.repeat(np.array(LABEL_DISTANCES) / LABEL_DISTANCES[0] - 1.0, len(turns))
    cost = OPPOSITE_COST * np.tile(turns, len(LABEL_DISTANCES)) + far
    cost = cost * LETTER_WIDTH * LETTER_HEIGHT + norm(places - wanted) * LETTER_HEIGHT
    apart = norm(places[:, None] - others)
    nearer = (apart < norm(places - place)[:, None] - 1e-6).any(axis=1)
    return places, cost + np.where(nearer, 100.0 * LETTER_WIDTH * LETTER_HEIGHT, 0.0)


def _ways(start: float) -> Array:
    """Return directions all round from an angle [rad], (k, 2)."""
    return np.stack((np.cos(start + LABEL_ANGLES), np.sin(start + LABEL_ANGLES)), axis=-1)


def _letters(text: str) -> float:
    """Return about how many letters wide a text is, without the signs that set it as a formula."""
    return float(len(text) - text.count(r"$_{\mathrm{") * len(r"$_{\mathrm{}}$"))


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
