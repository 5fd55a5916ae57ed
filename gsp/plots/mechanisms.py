"""A design at a pose in space: base, platform, numbered legs by type, joints by kind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.checks import check_type
from gsp.errors import InvalidInput, expected
from gsp.figures import style
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.legs import DRIVEN_LEGS
from gsp.model.legs import LEGS as KINDS
from gsp.model.posture import Posture
from gsp.plots.common.bodies import body, ellipsoid, enclose, frame
from gsp.plots.common.labels import SpaceNote, write_in_space
from gsp.plots.common.legs import draw_leg, ends_of_lines
from gsp.plots.common.style import BLUE, GREY, LEGS, VERMILION, space_or_new, title_text

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from mpl_toolkits.mplot3d import Axes3D

# Lengths as shares of the size of the drawing: that of the axes of a frame, and points that are
# drawn as one.
AXES_LENGTH, SAME_POINT = 0.2, 0.01
# Distance, in sizes of the mechanism, beyond which a frame is not drawn, as the mechanism would be
# too small.
FAR_FRAME_SIZES = 3.0
# Order of the numbers of legs: above bodies and joints, which matplotlib counts from 4 on.
NUMBERS_ABOVE = 1000
# Places of the number of a leg, as shares from base to platform, the preferred first.
NUMBER_PLACES = (0.3, 0.25, 0.35, 0.4, 0.2, 0.45, 0.65, 0.7, 0.75, 0.8, 0.15, 0.85)


def mechanism(design: Design, pose: Pose | None = None, ax: Axes3D | None = None) -> Axes3D:
    """Return axes in space with a design drawn at a pose.

    Base and platform are the convex hulls of their joints. Legs are numbered, coloured by their
    constraints, and drawn from the foot on the base to the foot on the platform; a ball is a
    spherical joint, a bar on a dashed line a cylindrical one, a square a prismatic one. Of a leg
    that is driven at the base the rod is drawn, and the rail or the axis with the crank. The
    operation ellipsoid is drawn if the design has one. A leg that is undefined at the pose is left
    out, and the title names it; so is a frame whose origin is farther than three sizes of the
    mechanism from it.

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
        On wrong types, or if there is no pose, a batch of them, or one that is not finite.
    MissingSoftware
        Without matplotlib.

    Examples
    --------
    >>> import gsp
    >>> axes = mechanism(gsp.catalogue.design("nawratil-k-plus"))
    """
    check_type("design", design, Design)
    pose = design.home if pose is None else pose
    if pose is None:
        raise InvalidInput(expected("pose", "a single pose", "none, and no home pose"))
    check_type("pose", pose, Pose)
    if pose.shape or not np.isfinite(pose.position).all() or not np.isfinite(pose.rotation).all():
        raise InvalidInput(expected("pose", "a single pose of finite numbers", pose))
    with style():
        axes = space_or_new(ax, 7.6, 6.4)
        _draw(axes, design.at(pose))
        return axes


def _draw(ax: Axes3D, posture: Posture) -> None:
    points, size = extent(posture)
    draw_parts(ax, posture, size)
    frames, far, letters = _frames(ax, posture.pose, size, points.mean(axis=0))
    lines = line_ends(posture, size)
    _dress(ax, posture, np.concatenate((points, frames, lines)), size, far)
    write_in_space(ax, letters + _numbers(posture, size))


def extent(posture: Posture) -> tuple[Array, float]:
    """Return what a drawing encloses, feet and corners around the ellipsoid, (n, 3), and its size.

    The size [length] is never 0.
    """
    bottoms, tops = _feet(posture)
    points = np.concatenate((bottoms, tops, _base_corners(posture, bottoms)))
    if posture.design.ellipsoid is not None:
        centre, axes = _ellipsoid(posture)
        points = np.concatenate((points, centre + norm(axes) * np.array([[-1.0], [1.0]])))
    return points, float(np.ptp(points, axis=0).max()) or posture.design.rms_radius or 1.0


def line_ends(posture: Posture, size: float) -> Array:
    """Return the ends (n, 3) [length] of the lines on which legs slide, in a drawing of a size."""
    feet = enumerate(zip(*_feet(posture), strict=True))
    return np.concatenate([ends_of_lines(posture, i, *ends, size) for i, ends in feet])


def draw_parts(ax: Axes3D, posture: Posture, size: float) -> None:
    """Draw base, platform, legs with their joints, and the operation ellipsoid if there is one.

    Parameters
    ----------
    ax : three-dimensional matplotlib Axes
    posture : Posture of batch shape ()
    size : float [length]
        Of the drawing.
    """
    bottoms, tops = _feet(posture)
    if posture.design.ellipsoid is not None:
        ellipsoid(ax, *_ellipsoid(posture), VERMILION)
    body(ax, _base_corners(posture, bottoms), GREY, size)
    body(ax, tops, BLUE, size)
    for i, feet in enumerate(zip(bottoms, tops, strict=True)):
        draw_leg(ax, posture, i, *feet, size)


def _ellipsoid(posture: Posture) -> tuple[Array, Array]:
    """Return the centre (3,) of the operation ellipsoid and its semi-axes (3, 3) as columns."""
    own, pose = posture.design.ellipsoid, posture.pose
    assert own is not None
    axes = pose.rotation @ own.rotation * own.semi_axes
    return pose.position + pose.rotation @ own.center, axes


def _feet(posture: Posture) -> tuple[Array, Array]:
    """Return the feet of the legs on base and platform, (n, 3) each; anchors where undefined."""
    anchors = posture.pose.position + posture.lines.arm
    bottoms, tops = posture.segments.base_feet, posture.segments.platform_feet
    return (
        np.where(np.isnan(bottoms), posture.design.base_points, bottoms),
        np.where(np.isnan(tops), anchors, tops),
    )


def _base_corners(posture: Posture, bottoms: Array) -> Array:
    """Return the feet of the legs on the base, (n, 3); base points where a drive moves the foot."""
    moved = np.array([drive is not None for drive in posture.design.drives])
    return np.where(moved[:, None], posture.design.base_points, bottoms)


def _frames(
    ax: Axes3D, pose: Pose, size: float, middle: Array
) -> tuple[Array, list[str], list[SpaceNote]]:
    """Draw the frames of base and platform, once if they are equal.

    A frame farther than `FAR_FRAME_SIZES` sizes from the middle of the mechanism is left out.

    Returns
    -------
    (k, 3) array [length]
        The tips of their axes.
    list of str
        The frames that are left out.
    list of SpaceNote
        The letters of their axes and their names.
    """
    length = AXES_LENGTH * size
    near = float(norm(pose.position)) < SAME_POINT * length
    frames = [("O", np.zeros(3), np.eye(3), 1.0), ("P", pose.position, pose.rotation, 1.0)]
    if near and np.abs(pose.rotation - np.eye(3)).max() < SAME_POINT:
        frames = [("O = P", np.zeros(3), np.eye(3), 1.0)]
    elif near:
        frames[1] = (*frames[1][:3], -1.0)
    tips, missing, notes = [np.empty((0, 3))], [], list[SpaceNote]()
    for name, origin, rotation, side in frames:
        if norm(origin - middle) > FAR_FRAME_SIZES * size:
            missing.append(name)
            continue
        notes += frame(ax, origin, rotation, length, name, side)
        tips.append(origin + length * rotation.T)
    return np.concatenate(tips), missing, notes


def _numbers(posture: Posture, size: float) -> list[SpaceNote]:
    """Return the number of each leg at places on it; legs at the same place share one label."""
    bottoms, tops = _feet(posture)
    along = np.array(NUMBER_PLACES)[:, None, None]
    places = bottoms + along * (tops - bottoms)
    groups: list[list[int]] = []
    for i in range(len(bottoms)):
        near = (g for g in groups if norm(places[0, g[0]] - places[0, i]) < SAME_POINT * size)
        group = next(near, None)
        if group is None:
            groups.append([i])
        else:
            group.append(i)
    return [
        SpaceNote(
            ", ".join(str(i + 1) for i in group),
            # Of several legs at one place the label is there, as farther on they may part.
            places[:1, group[0]] if len(group) > 1 else places[:, group[0]],
            _framed(LEGS[posture.design.legs[group[0]].name]),
        )
        for group in groups
    ]


def _framed(colour: str) -> dict[str, Any]:
    edge = {"facecolor": "white", "linewidth": 0.7, "edgecolor": colour}
    return {"fontsize": 6.5, "zorder": NUMBERS_ABOVE, "bbox": {"boxstyle": "round,pad=0.2", **edge}}


def _dress(ax: Axes3D, posture: Posture, points: Array, size: float, far: Sequence[str]) -> None:
    """Set limits with equal scales, labels, title and legend."""
    enclose(ax, points, posture.design.unit, size)
    ax.legend(handles=legend_entries(posture.design), loc="upper left", bbox_to_anchor=(-0.02, 1.0))
    ax.set_title(_title(posture, far), fontsize=11)


def legend_entries(design: Design) -> list[Artist]:
    """Return the entries of the legend: kinds of legs, joints and bodies that are there."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    names = {leg.name for leg in design.legs}
    handles: list[Artist] = [
        Line2D(
            [],
            [],
            color=LEGS[k.name],
            linewidth=3.5,
            label=k.name if k.name == k.chain else f"{k.name} ({k.chain})",
        )
        for k in (*KINDS, *DRIVEN_LEGS)
        if k.name in names
    ]
    looks = {
        "S": {"linestyle": "", "marker": "o"},
        "P": {"linestyle": "", "marker": "s", "markersize": 5},
        "C": {"linestyle": (0, (4, 3)), "linewidth": 0.9, "marker": "_", "markeredgewidth": 5},
        "R": {"linewidth": 4.2, "marker": ""},
    }
    kinds = {joint.kind for leg in design.legs for joint in leg.joints}
    handles += [
        Line2D([], [], color=GREY, label=f"{kind} joint", **look)  # type: ignore[arg-type]
        for kind, look in looks.items()
        if kind in kinds
    ]
    handles += [Patch(color=c, alpha=0.3, label=t) for c, t in ((GREY, "base"), (BLUE, "platform"))]
    if design.ellipsoid is not None:
        handles.append(Patch(color=VERMILION, alpha=0.3, label="operation ellipsoid"))
    return handles


def _title(posture: Posture, far: Sequence[str]) -> str:
    design = posture.design
    kind = f"${design.mechanism.latex}$"
    unnamed = design.name in ("", design.mechanism.name)
    name = kind if unnamed else f"{title_text(design.name)}   {kind}"
    missing = ", ".join(entry.joint for entry in posture.undefined)
    notes = [title_text(f"undefined here: {missing}")] if missing else []
    notes += [f"far outside: frame {name}" for name in far]
    return "\n".join([name, *notes])
