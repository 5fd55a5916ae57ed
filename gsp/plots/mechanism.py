"""A design at a pose in space: base, platform, legs by type, and the lines they sit on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.legs import LEGS as KINDS
from gsp.model.posture import Posture
from gsp.plots.style import BLUE, GREY, INK, LEGS, new_axes, style

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

# How far a line is drawn beyond what lies on it, as a share of the size of the design.
BEYOND = 0.12
CYLINDER = 0.07
FRAME = 0.28


def mechanism(design: Design, pose: Pose | None = None, ax: Axes3D | None = None) -> Axes3D:
    """Draw a design at a pose.

    Legs are coloured by their constraints and drawn from the foot on the base to the foot on the
    platform; a ball is a spherical joint, a bar a cylindrical one, on its dashed line. A leg
    that is not defined at the pose is left out, and the title says so.

    Parameters
    ----------
    design : Design
    pose : Pose of shape (), default the home pose of the design
    ax : three-dimensional matplotlib Axes, optional

    Returns
    -------
    mpl_toolkits.mplot3d.Axes3D

    Raises
    ------
    InvalidInput
        If there is no pose, or a batch of them.
    MissingSoftware
        Without matplotlib.
    """
    pose = design.home if pose is None else pose
    if pose is None or pose.shape:
        raise InvalidInput(expected("pose", "a single pose", pose or "none, and no home pose"))
    with style():
        axes: Any = new_axes(7.6, 6.4, projection="3d") if ax is None else ax
        _draw(axes, design.at(pose))
        return axes


def _draw(ax: Axes3D, posture: Posture) -> None:
    design, pose = posture.design, posture.pose
    platform = pose.position + posture.lines.arm
    _body(ax, design.base_points, GREY)
    _body(ax, platform, BLUE)
    _frame(ax, np.zeros(3), np.eye(3), FRAME * design.size, "O")
    _frame(ax, pose.position, pose.rotation, FRAME * design.size, "P")
    seen: list[Array] = [design.base_points, platform]
    for i in range(design.n_legs):
        seen += _leg(ax, posture, i)
    _dress(ax, posture, np.concatenate(seen))


def _body(ax: Axes3D, points: Array, colour: str) -> None:
    """Fill the outline of anchor points, and mark them."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    outline = _outline(points)
    if outline is not None:
        ax.add_collection3d(
            Poly3DCollection(
                [outline], facecolor=colour, alpha=0.16, edgecolor=colour, linewidth=1.0
            )
        )


def _outline(points: Array) -> Array | None:
    """Return the corners of the convex hull of points in the plane that fits them best."""
    center = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - center)
    flat = (points - center) @ axes[:2].T
    try:
        return np.asarray(center + flat[ConvexHull(flat).vertices] @ axes[:2])
    except QhullError:
        return None


def _frame(ax: Axes3D, origin: Array, rotation: Array, size: float, name: str) -> None:
    for axis, letter in zip(rotation.T, "xyz", strict=True):
        tip = origin + size * axis
        ax.plot(*np.stack((origin, tip)).T, color=INK, linewidth=0.9)
        ax.text(*(origin + 1.15 * size * axis), letter, fontsize=7, color=INK, ha="center")
    ax.text(*(origin - 0.12 * size * rotation.sum(axis=1)), name, fontsize=8, color=INK, ha="right")


def _leg(ax: Axes3D, posture: Posture, i: int) -> list[Array]:
    """Draw one leg, and return the points that it needs room for."""
    design = posture.design
    kind, lines, segments = design.legs[i], posture.lines, posture.segments
    top, bottom = segments.platform_feet[i], segments.base_feet[i]
    if np.isnan(top).any():
        return []
    colour, size = LEGS[kind.name], design.size
    anchor = posture.pose.position + lines.arm[i]
    _tube(ax, bottom, top, colour)
    for side, foot, own, direction in (
        (kind.base_line, bottom, design.base_points[i], lines.s[i]),
        (kind.platform_line, top, anchor, lines.t[i]),
    ):
        if side:
            _line(ax, np.stack((own, foot)), direction, colour, size)
        else:
            ax.scatter(*foot, s=34, color=colour, edgecolor="white", linewidth=0.8, zorder=5)
    return [np.stack((bottom, top))]


def _tube(ax: Axes3D, bottom: Array, top: Array, colour: str) -> None:
    """Draw a leg: thin rod in a thick cylinder that takes its lower part."""
    middle = bottom + 0.55 * (top - bottom)
    ax.plot(*np.stack((bottom, top)).T, color=colour, linewidth=2.0, solid_capstyle="round")
    ax.plot(*np.stack((bottom, middle)).T, color=colour, linewidth=4.2, solid_capstyle="round")


def _line(ax: Axes3D, points: Array, direction: Array, colour: str, size: float) -> None:
    """Draw the line of a cylindrical joint through its anchor and foot, and the joint itself."""
    anchor, foot = points
    places = np.sort(np.array([0.0, (foot - anchor) @ direction]))
    ends = anchor + (places + BEYOND * size * np.array([-1.0, 1.0]))[:, None] * direction
    ax.plot(*ends.T, color=colour, linewidth=0.9, linestyle=(0, (4, 3)))
    bar = foot + CYLINDER * size * np.array([[-0.5], [0.5]]) * direction
    ax.plot(*bar.T, color=colour, linewidth=7.0, solid_capstyle="butt")


def _dress(ax: Axes3D, posture: Posture, points: Array) -> None:
    """Set limits with equal scales, labels, title and legend."""
    from matplotlib.lines import Line2D

    design = posture.design
    low, high = points.min(axis=0), points.max(axis=0)
    spans = high - low
    spans = np.maximum(spans, 0.25 * spans.max())
    middle = (low + high) / 2.0
    for axis, (start, end) in zip(
        "xyz", zip(middle - spans / 2, middle + spans / 2, strict=True), strict=True
    ):
        getattr(ax, f"set_{axis}lim")(start, end)
        unit = f" [{design.unit}]" if design.unit else ""
        getattr(ax, f"set_{axis}label")(axis + unit)
    ax.set_box_aspect(spans / spans.max(), zoom=1.05)
    ax.view_init(elev=24, azim=-58)
    _quiet_panes(ax)
    there = [kind for kind in KINDS if kind in design.legs]
    handles = [
        Line2D([], [], color=LEGS[k.name], linewidth=3.5, label=f"{k.name} ({k.chain})")
        for k in there
    ]
    handles += [
        Line2D([], [], linestyle="", marker="o", color=GREY, label="S joint"),
        Line2D(
            [], [], linestyle=(0, (4, 3)), linewidth=0.9, marker="s", color=GREY, label="C joint"
        ),
    ]
    ax.legend(handles=handles, loc="upper left", bbox_to_anchor=(-0.02, 1.0))
    ax.set_title(_title(posture), fontsize=11)


def _title(posture: Posture) -> str:
    design = posture.design
    kind, plain = f"${design.mechanism.latex}$", design.name.replace("$", r"\$")
    name = kind if design.name in ("", design.mechanism.name) else f"{plain}   {kind}"
    missing = ", ".join(entry.joint for entry in posture.undefined)
    return name + (f"\nundefined here: {missing}" if missing else "")


def _quiet_panes(ax: Axes3D) -> None:
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.pane.set_facecolor("white")
        axis.pane.set_edgecolor("#E8EAED")
        axis.set_tick_params(labelsize=7, colors="#5B616B")
