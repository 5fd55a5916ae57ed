"""What the scene draws, as plain numbers: once per design, and little at each pose."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.app.state.reading import Reading, gauges_at
from gsp.app.state.session import Session, size_of
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.plots.common.bodies import hull
from gsp.plots.common.style import LEGS

# Significant digits of what is sent; a screen has four.
DRAWING_DIGITS = 5
# An anchor is far if its distance from the median of all is more than so many median distances.
FAR_ANCHOR = 5.0
# Pitch of a screw [share of the size] that is rounding.
NO_PITCH = 1e-12


def drawing(state: Session) -> dict[str, Any]:
    """Return what is drawn of a design: bodies, kinds of legs and joints, labels, ellipsoid.

    Points of the base are in base axes, those of the platform in platform axes; one triangle is
    three numbers of points.
    """
    design = _with_near_anchors(state.design)
    size = _extent(design, state.pose)
    names = iter(design.joint_names)
    return {
        "size": size,
        "unit": design.unit,
        "base": _body(design.base_points, size),
        "platform": _body(design.platform_points, size),
        "legs": [
            {
                "kinds": [joint.kind for joint in leg.joints],
                "active": [joint.active for joint in leg.joints],
                "colour": LEGS[leg.name],
                "label": str(i + 1),
                "joints": ", ".join(next(names) for _ in leg.constraints),
                "base": _rounded(design.base_points[i]),
                "platform": _rounded(design.platform_points[i]),
                "base_line": _line(design.base_directions[i], leg.base_line),
                "platform_line": _line(design.platform_directions[i], leg.platform_line),
            }
            for i, leg in enumerate(design.legs)
        ],
        "ellipsoid": _ellipsoid(design),
    }


def placement(state: Session, reading: Reading, colour: str) -> dict[str, Any]:
    """Return what changes with the pose: about half a kilobyte as JSON.

    Parameters
    ----------
    state : Session
    reading : Reading
    colour : str
        Of the platform.

    Returns
    -------
    dict
        "position", "rotation" (by rows), "feet" (six numbers per leg in base axes, None where
        undefined), "colour", "screw" (point, direction and pitch, or None).
    """
    screw = None
    if reading.screw is not None:
        point, axis, pitch = reading.screw
        pitch = pitch if abs(pitch) > NO_PITCH * state.design.rms_radius else 0.0
        screw = [*_rounded(point), *_rounded(axis), *_rounded([pitch])]
    (numbers,) = pose_numbers(state.design, state.pose)
    return {**numbers, "colour": colour, "screw": screw}


def pose_numbers(design: Design, poses: Pose) -> list[dict[str, Any]]:
    """Return "position", "rotation" and "feet" of `placement` for each of several poses."""
    segments = design.at(poses).segments
    feet = np.concatenate((segments.base_feet, segments.platform_feet), axis=-1)
    return [
        {
            "position": _rounded(position),
            "rotation": _rounded(rotation.ravel()),
            "feet": [None if np.isnan(foot).any() else _rounded(foot) for foot in ends],
        }
        for position, rotation, ends in zip(
            poses.position.reshape(-1, 3),
            poses.rotation.reshape(-1, 3, 3),
            feet.reshape(-1, *feet.shape[-2:]),
            strict=True,
        )
    ]


def film(state: Session, poses: Pose, index: str) -> list[dict[str, Any]]:
    """Return the placements at several poses, coloured by an index, without a screw axis."""
    return [
        {**numbers, "colour": merit_colour(share), "screw": None}
        for numbers, share in zip(
            pose_numbers(state.design, poses), gauges_at(state, index, poses).tolist(), strict=True
        )
    ]


def merit_colour(share: float) -> str:
    """Return the colour of a merit in [0, 1]: vermilion, yellow, blue; grey for NaN."""
    if not np.isfinite(share):
        return "#7A8AA0"
    stops = np.array([[213.0, 94.0, 0.0], [240.0, 200.0, 66.0], [0.0, 114.0, 178.0]])
    place = 2.0 * min(max(share, 0.0), 1.0)
    low = min(int(place), 1)
    mixed = stops[low] + (place - low) * (stops[low + 1] - stops[low])
    return "#" + "".join(f"{round(x):02X}" for x in mixed)


def _with_near_anchors(design: Design) -> Design:
    """Return the design with anchors that are far away slid along their lines to the others.

    No joint value and no row changes, and the mechanism fills the picture.
    """
    near = {}
    for side in ("base", "platform"):
        points, lines = getattr(design, f"{side}_points"), getattr(design, f"{side}_directions")
        away = points - np.median(points, axis=0)
        far = norm(away) > FAR_ANCHOR * np.median(norm(away))
        along = np.where(np.isfinite(lines) & far[:, None], lines, 0.0)
        near[f"{side}_points"] = points - (away * along).sum(axis=1)[:, None] * along
    return design.replace(**near)


def _extent(design: Design, pose: Pose) -> float:
    """Return the size of the drawing: that of the anchors at the first pose [unit]."""
    anchors = pose.position + design.platform_points @ pose.rotation.T
    points = np.concatenate((design.base_points, anchors))
    spread = float(np.ptp(points, axis=0).max())
    return float(f"{spread or size_of(design):.3g}")


def _body(points: Array, size: float) -> dict[str, Any]:
    """Return the convex hull of anchors: corners and edges; one that is a point has none."""
    faces, edges = hull(points, size)
    corners = [_rounded(p) for face in faces for p in _triangles(face)]
    return {"faces": corners, "edges": [_rounded(p) for edge in edges for p in edge]}


def _triangles(face: Array) -> list[Array]:
    """Return the corners of the triangles of a convex polygon, three per triangle."""
    found: list[Array] = []
    for i in range(1, len(face) - 1):
        found += [face[0], face[i], face[i + 1]]
    return found


def _line(direction: Array, needed: bool) -> list[float] | None:
    return _rounded(direction) if needed else None


def _ellipsoid(design: Design) -> dict[str, Any] | None:
    own = design.ellipsoid
    if own is None:
        return None
    return {
        "semi_axes": _rounded(own.semi_axes),
        "center": _rounded(own.center),
        "rotation": _rounded(own.rotation.ravel()),
    }


def _rounded(values: ArrayLike) -> list[float]:
    """Return numbers with few digits; zero has no sign."""
    flat = np.asarray(values, dtype=np.float64).ravel()
    return [float(f"{x:.{DRAWING_DIGITS}g}") + 0.0 for x in flat]
