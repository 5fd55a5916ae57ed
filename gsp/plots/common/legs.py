"""Legs of a design in space: rods, the lines on which they slide, rails, cranks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gsp.geometry.vectors import Array, norm
from gsp.model.posture import Posture
from gsp.plots.common.style import LEGS

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

# Lengths as shares of the size of the drawing: how far a line is drawn beyond what lies on it, and
# the length of a cylinder.
LINE_EXTENSION, CYLINDER_LENGTH = 0.12, 0.07
# How far from the foot a line is drawn toward its anchor, in sizes of the mechanism: an anchor may
# be anywhere on its line.
MOST_OF_LINE = 0.5
# Place of the actuated joint of a leg, as a share from base to platform.
ACTUATED = 0.55


def draw_leg(ax: Axes3D, posture: Posture, i: int, bottom: Array, top: Array, size: float) -> None:
    """Draw one leg with its joints, unless it is undefined."""
    kind = posture.design.legs[i]
    if np.isnan(posture.segments.platform_feet[i]).any():
        return
    colour = LEGS[kind.name]
    slides = _slides(posture, i, bottom, top)
    for slide in slides.values():
        _cylinder(ax, *slide, colour, size)
    if kind.drive is not None:
        _driven(ax, posture, i, bottom, top, slides["base"][1])
        return
    for side, foot in (("base", bottom), ("platform", top)):
        if side not in slides:
            _ball(ax, foot, colour)
    _rod(ax, bottom, top, colour, prismatic=kind.joints[1].kind == "P", size=size)


def ends_of_lines(posture: Posture, i: int, bottom: Array, top: Array, size: float) -> Array:
    """Return the ends (n, 3) [length] of the lines on which a leg slides, as they are drawn."""
    if np.isnan(posture.segments.platform_feet[i]).any():
        return np.empty((0, 3))
    ends = [_ends(*slide, size) for slide in _slides(posture, i, bottom, top).values()]
    return np.reshape(ends, (-1, 3))


def _slides(
    posture: Posture, i: int, bottom: Array, top: Array
) -> dict[str, tuple[Array, Array, Array]]:
    """Return the lines on which a leg slides, or its crank turns: anchor, foot and direction."""
    design, lines, kind = posture.design, posture.lines, posture.design.legs[i]
    base, along = design.base_points[i], design.base_directions[i]
    if kind.drive is not None:
        turns = kind.joints[0].kind == "R"
        # The crank starts at the foot of its tip on the axis.
        return {
            "base": (base, base + ((bottom - base) @ along) * along if turns else bottom, along)
        }
    found = {}
    if kind.base_line:
        found["base"] = (base, bottom, lines.s[i])
    if kind.platform_line:
        found["platform"] = (posture.pose.position + lines.arm[i], top, lines.t[i])
    return found


def _driven(ax: Axes3D, posture: Posture, i: int, tip: Array, top: Array, start: Array) -> None:
    """Draw a rod with its joints, and the crank from a point on its axis, if it has one."""
    kind = posture.design.legs[i]
    colour = LEGS[kind.name]
    ax.plot(*np.stack((tip, top)).T, color=colour, linewidth=2.0, solid_capstyle="round")
    for end in (tip, top):
        _ball(ax, end, colour)
    if kind.joints[0].kind == "R":
        ax.plot(*np.stack((start, tip)).T, color=colour, linewidth=4.2, solid_capstyle="round")


def _ball(ax: Axes3D, place: Array, colour: str) -> None:
    """Draw a spherical joint."""
    ax.scatter(*place, s=34, color=colour, edgecolor="white", linewidth=0.8, zorder=5)


def _rod(
    ax: Axes3D, bottom: Array, top: Array, colour: str, *, prismatic: bool, size: float
) -> None:
    """Draw a leg: a thin rod that moves in a thick one, and the actuated joint between them."""
    middle = bottom + ACTUATED * (top - bottom)
    ax.plot(*np.stack((bottom, top)).T, color=colour, linewidth=2.0, solid_capstyle="round")
    ax.plot(*np.stack((bottom, middle)).T, color=colour, linewidth=4.2, solid_capstyle="round")
    if prismatic:
        ax.scatter(*middle, s=30, marker="s", color=colour, edgecolor="white", linewidth=0.8)
        return
    length = float(norm(top - bottom))
    if length > 0.0:
        half = min(0.5 * CYLINDER_LENGTH * size / length, 0.2) * (top - bottom)
        ax.plot(*np.stack((middle - half, middle + half)).T, color=colour, linewidth=7.0)


def _cylinder(
    ax: Axes3D, anchor: Array, foot: Array, direction: Array, colour: str, size: float
) -> None:
    """Draw a cylindrical joint on its line through anchor and foot."""
    ends = _ends(anchor, foot, direction, size)
    ax.plot(*ends.T, color=colour, linewidth=0.9, linestyle=(0, (4, 3)))
    bar = foot + CYLINDER_LENGTH * size * np.array([[-0.5], [0.5]]) * direction
    ax.plot(*bar.T, color=colour, linewidth=7.0, solid_capstyle="butt")


def _ends(anchor: Array, foot: Array, direction: Array, size: float) -> Array:
    """Return the two ends of the line of a cylindrical joint, as far as it is drawn."""
    most = MOST_OF_LINE * size
    places = np.sort(np.clip([(anchor - foot) @ direction, 0.0], -most, most))
    beyond = LINE_EXTENSION * size * np.array([-1.0, 1.0])
    return np.asarray(foot + (places + beyond)[:, None] * direction)
