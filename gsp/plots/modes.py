"""All assembly modes of a design, one panel for each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gsp.checks import check_type
from gsp.errors import InvalidInput, expected
from gsp.figures import INK, style
from gsp.geometry.vectors import Array
from gsp.kinematics.driven.locked import held
from gsp.kinematics.modes import AssemblyModes
from gsp.model.design import Design
from gsp.plots.common.bodies import body
from gsp.plots.common.style import (
    BLUE,
    GREY,
    SHORT_NAME,
    VERMILION,
    space_panels,
    title_text,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D

# Most panels in a row, their side [inches], and the letters of a design's name in the title.
MOST_COLUMNS, MODES_PANEL_SIDE = 8, 1.7
# A scale for all panels may shrink the smallest mode by this factor.
MOST_SHRUNK = 5.0
# Differences of joint values between modes of a design at most, in its sizes and rad.
SAME_JOINT = 1e-6
# Colours of platforms by the sign of det J, -1, 0 and 1, and words for the signs.
SIDES = {-1.0: (VERMILION, "det J < 0"), 0.0: (GREY, "singular"), 1.0: (BLUE, "det J > 0")}


def assembly_modes(design: Design, modes: AssemblyModes) -> Figure:
    """Return a figure of all assembly modes: the platform and its legs at each of the real poses.

    The panels have one direction of view, and one scale unless the smallest mode would be shrunk
    to a fifth of its panel, as by a mode that is far away; the title states it. They are in the
    order of `modes.poses` and numbered from 1. The colour of the platform is the sign of det J.
    Base and platform go through their anchor points. Legs of D2, D3 and D4 are drawn between their
    feet on the lines, with the parts of the lines from the anchor points to the feet. Legs that are
    driven at the base are drawn as their rods, with lines from the base points to the tips; modes
    on other branches than those of the design are labelled.

    Parameters
    ----------
    design : Design
        The one of the modes.
    modes : AssemblyModes
        As `gsp.assembly_modes` returns them.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InvalidInput
        On wrong types, a design that has other joint values at each of the modes, or if there are
        no real modes.
    MissingSoftware
        Without matplotlib.

    Examples
    --------
    >>> import gsp
    >>> lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> modes = gsp.assembly_modes(lift, lift.at(lift.home).joints)
    >>> len(gsp.plots.assembly_modes(lift, modes).axes)
    8
    """
    check_type("design", design, Design)
    check_type("modes", modes, AssemblyModes)
    if len(modes.side) == 0:
        raise InvalidInput(expected("modes", "at least one real mode", f"none ({modes.status})"))
    fixed = held(design, modes.joints)[0] if design.driven else design
    posture = fixed.at(modes.poses)
    _check_joints(fixed, posture.joints)
    with style():
        anchors = modes.poses.position[:, None] + posture.lines.arm
        bottoms, tops = posture.segments.base_feet, posture.segments.platform_feet
        bottoms = np.where(np.isnan(bottoms), fixed.base_points, bottoms)
        tops = np.where(np.isnan(tops), anchors, tops)
        base = np.broadcast_to(design.base_points, anchors.shape)
        figure, panels = space_panels(len(anchors), MODES_PANEL_SIDE, _columns(len(anchors)))
        cubes, one_scale = _cubes(np.concatenate((base, bottoms, tops, anchors), axis=1))
        for i, ax in enumerate(panels):
            body(ax, base[i], GREY, _side(cubes[i]))
            body(ax, anchors[i], _colour(modes.side[i]), _side(cubes[i]))
            _draw_legs(ax, bottoms[i], tops[i])
            for ends in ((base[i], bottoms[i]), (anchors[i], tops[i])):
                _draw_lines(ax, *ends, SAME_JOINT * design.rms_radius)
            _frame(ax, cubes[i])
            label = f"{i + 1}" if modes.on_branches[i] else f"{i + 1}, other branch"
            ax.set_title(label, fontsize=8, y=0.97)
        _dress(figure, design, modes, one_scale)
        return figure


def _check_joints(design: Design, joints: Array) -> None:
    """Raise InvalidInput if joint values (n, m) differ between modes."""
    sizes = np.where(design.angular, 1.0, design.rms_radius)
    apart = np.abs(joints - joints[0]) / sizes
    if (apart > SAME_JOINT).any():  # undefined ones are not compared
        raise InvalidInput(
            expected("design", "the one of the modes", "one with other joint values")
        )


def _columns(panels: int) -> int:
    """Return the number of panels in a row, about five in a row for three below each other."""
    return min(MOST_COLUMNS, int(np.ceil(np.sqrt(1.6 * panels))))


def _colour(side: float) -> str:
    """Return the colour of a platform; grey where a leg is undefined, too."""
    return SIDES.get(float(side), SIDES[0.0])[0]


def _cubes(points: Array) -> tuple[Array, bool]:
    """Return the cube of each panel, (n, 2, 3) [length], and whether it is the same for all.

    Parameters
    ----------
    points : Array, (n, m, 3) [length]
    """
    own = np.array([_cube(panel) for panel in points])
    common = _cube(points.reshape(-1, 3))
    sides = own[:, 1, 0] - own[:, 0, 0]
    one_scale = float(common[1, 0] - common[0, 0]) <= MOST_SHRUNK * float(sides.min())
    return (np.broadcast_to(common, own.shape) if one_scale else own), one_scale


def _cube(points: Array) -> Array:
    """Return the least and greatest corner of a cube around points, (2, 3) [length]."""
    low, high = points.min(axis=0), points.max(axis=0)
    half = 0.5 * max(float((high - low).max()), np.finfo(float).tiny)
    return np.asarray((low + high) / 2.0 + half * np.array([[-1.0], [1.0]]))


def _side(cube: Array) -> float:
    """Return the side of a cube (2, 3) [length]."""
    return float(cube[1, 0] - cube[0, 0])


def _draw_legs(ax: Axes3D, bottoms: Array, tops: Array) -> None:
    """Draw legs between their feet (n, 3) [length]."""
    for bottom, top in zip(bottoms, tops, strict=True):
        ax.plot(*np.stack((bottom, top)).T, color=INK, linewidth=0.6)


def _draw_lines(ax: Axes3D, anchors: Array, feet: Array, least: float) -> None:
    """Draw the lines from anchors to feet, (n, 3) [length], that are not as near as `least`."""
    for ends in np.stack((anchors, feet), axis=1):
        if np.abs(ends[1] - ends[0]).max() > least:
            ax.plot(*ends.T, color=INK, linewidth=0.5, linestyle=":")


def _frame(ax: Axes3D, cube: Array) -> None:
    """Show a cube (2, 3) [length] without axes."""
    ax.set(xlim=cube[:, 0], ylim=cube[:, 1], zlim=cube[:, 2])
    ax.set_box_aspect((1.0, 1.0, 1.0), zoom=1.15)
    ax.view_init(elev=24, azim=-58)
    ax.set_axis_off()


def _dress(figure: Figure, design: Design, modes: AssemblyModes, one_scale: bool) -> None:
    """Set the title and a legend of the colours that occur."""
    from matplotlib.patches import Patch

    real = len(modes.side)
    name = title_text(design.name or "design", SHORT_NAME)
    found = f"{real} real of {modes.n_complex + modes.n_singular} complex modes"
    note = "" if modes.status == "found" else f" ({modes.status})"
    scales = "" if one_scale else "\neach panel has its own scale"
    figure.suptitle(f"{name}: {found}{note}{scales}", fontsize=11, fontweight="bold")
    colours = {_colour(side) for side in modes.side}
    handles = [Patch(color=c, alpha=0.4, label=text) for c, text in SIDES.values() if c in colours]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
