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


def draw_leg(ax: Axes3D, posture: Posture, i: int, bottom: Array, top: Array, size: float) -> Array:
    """Draw one leg with its joints, and return the ends of the lines that it slides on."""
    design, lines = posture.design, posture.lines
    kind = design.legs[i]
    if np.isnan(posture.segments.platform_feet[i]).any():
        return np.empty((0, 3))
    colour = LEGS[kind.name]
    if kind.drive is not None:
        return _driven(ax, posture, i, bottom, top, size)
    ends = []
    for slides, foot, anchor, direction in (
        (kind.base_line, bottom, design.base_points[i], lines.s[i]),
        (kind.platform_line, top, posture.pose.position + lines.arm[i], lines.t[i]),
    ):
        if slides:
            ends.append(_cylinder(ax, anchor, foot, direction, colour, size))
        else:
            ax.scatter(*foot, s=34, color=colour, edgecolor="white", linewidth=0.8, zorder=5)
    _rod(ax, bottom, top, colour, prismatic=kind.joints[1].kind == "P", size=size)
    return np.concatenate(ends) if ends else np.empty((0, 3))


def _driven(ax: Axes3D, posture: Posture, i: int, tip: Array, top: Array, size: float) -> Array:
    """Draw a rod with its slider on the rail or its crank on the axis; return the line's ends."""
    design = posture.design
    colour, line, base = LEGS[design.legs[i].name], design.base_directions[i], design.base_points[i]
    ax.plot(*np.stack((tip, top)).T, color=colour, linewidth=2.0, solid_capstyle="round")
    for end in (tip, top):
        ax.scatter(*end, s=34, color=colour, edgecolor="white", linewidth=0.8, zorder=5)
    if design.legs[i].joints[0].kind == "R":
        # The crank starts at the foot of its tip on the axis.
        centre = base + ((tip - base) @ line) * line
        ax.plot(*np.stack((centre, tip)).T, color=colour, linewidth=4.2, solid_capstyle="round")
        return _cylinder(ax, base, centre, line, colour, size)
    return _cylinder(ax, base, tip, line, colour, size)


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
) -> Array:
    """Draw a cylindrical joint on its line through anchor and foot; return the line's ends."""
    most = MOST_OF_LINE * size
    places = np.sort(np.clip([(anchor - foot) @ direction, 0.0], -most, most))
    ends = foot + (places + LINE_EXTENSION * size * np.array([-1.0, 1.0]))[:, None] * direction
    ax.plot(*ends.T, color=colour, linewidth=0.9, linestyle=(0, (4, 3)))
    bar = foot + CYLINDER_LENGTH * size * np.array([[-0.5], [0.5]]) * direction
    ax.plot(*bar.T, color=colour, linewidth=7.0, solid_capstyle="butt")
    return np.asarray(ends)
