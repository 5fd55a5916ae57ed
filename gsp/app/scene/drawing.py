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

# Digits of what is sent, of the size of the design; a screen has four.
DRAWING_DIGITS = 5
# A base is far from its frame beyond so many sizes: then places are sent from its middle.
FAR_FRAME = 10.0
# An anchor is far if its distance from the median of all is more than so many median distances.
FAR_ANCHOR = 5.0
# Pitch of a screw [share of the size] that is rounding.
NO_PITCH = 1e-12


def drawing(state: Session) -> dict[str, Any]:
    """Return what is drawn of a design: bodies, kinds of legs and joints, labels, ellipsoid.

    Points of the base are in base axes, from "origin" on; those of the platform in platform axes.
    One triangle is three numbers of points.
    """
    design, origin = _with_near_anchors(state.design), origin_of(state.design)
    size = _extent(design, state.pose)
    names = iter(design.joint_names)
    base = design.base_points - origin
    return {
        "size": size,
        "unit": design.unit,
        "origin": origin.tolist(),
        "base": _body(base, size),
        "platform": _body(design.platform_points, size),
        "legs": [
            {
                "kinds": [joint.kind for joint in leg.joints],
                "active": [joint.active for joint in leg.joints],
                "colour": LEGS[leg.name],
                "label": str(i + 1),
                "joints": ", ".join(next(names) for _ in leg.constraints),
                "base": rounded(base[i], size),
                "platform": rounded(design.platform_points[i], size),
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
        undefined), "colour", "screw" (point, direction and pitch, or None). Places are from the
        origin of the drawing on.
    """
    screw = None
    if reading.screw is not None:
        point, axis, pitch = reading.screw
        size = size_of(state.design)
        pitch = pitch if abs(pitch) > NO_PITCH * size else 0.0
        place = rounded(point - origin_of(state.design), size)
        screw = [*place, *rounded(axis), float(f"{pitch:.{DRAWING_DIGITS}g}")]
    (numbers,) = pose_numbers(state.design, state.pose)
    return {**numbers, "colour": colour, "screw": screw}


def pose_numbers(design: Design, poses: Pose) -> list[dict[str, Any]]:
    """Return "position", "rotation" and "feet" of `placement` for each of several poses."""
    segments, origin, size = design.at(poses).segments, origin_of(design), size_of(design)
    feet = np.concatenate((segments.base_feet, segments.platform_feet), axis=-1)
    feet = feet - np.tile(origin, 2)
    arm = max(1.0, float(norm(design.platform_points).max()) / size)
    return [
        {
            "position": rounded(position, size),
            "rotation": rounded(rotation.ravel(), 1.0 / arm),
            "feet": [None if np.isnan(foot).any() else rounded(foot, size) for foot in ends],
        }
        for position, rotation, ends in zip(
            (poses.position - origin).reshape(-1, 3),
            poses.rotation.reshape(-1, 3, 3),
            feet.reshape(-1, *feet.shape[-2:]),
            strict=True,
        )
    ]


def origin_of(design: Design) -> Array:
    """Return the point from which places are sent: of bases far from their frame the middle.

    A graphics processor has seven digits.
    """
    middle = np.median(design.base_points, axis=0)
    far = float(norm(middle)) > FAR_FRAME * size_of(design)
    return middle if far else np.zeros(3)


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
    corners = [rounded(p, size) for face in faces for p in _triangles(face)]
    return {"faces": corners, "edges": [rounded(p, size) for edge in edges for p in edge]}


def _triangles(face: Array) -> list[Array]:
    """Return the corners of the triangles of a convex polygon, three per triangle."""
    found: list[Array] = []
    for i in range(1, len(face) - 1):
        found += [face[0], face[i], face[i + 1]]
    return found


def _line(direction: Array, needed: bool) -> list[float] | None:
    return rounded(direction) if needed else None


def _ellipsoid(design: Design) -> dict[str, Any] | None:
    own = design.ellipsoid
    if own is None:
        return None
    size = float(np.max(own.semi_axes))
    return {
        "semi_axes": rounded(own.semi_axes, size),
        "center": rounded(own.center, size),
        "rotation": rounded(own.rotation.ravel()),
    }


def rounded(values: ArrayLike, size: float = 1.0) -> list[float]:
    """Return numbers with the digits that a drawing of a size needs; zero has no sign.

    >>> rounded([0.123456789, 12345.6789, -1e-9]), rounded([12345.6789], 1e4)
    ([0.12346, 12345.6789, 0.0], [12345.7])
    """
    places = DRAWING_DIGITS - int(np.floor(np.log10(size)))
    flat = np.asarray(values, dtype=np.float64).ravel()
    return [round(x, places) + 0.0 for x in flat.tolist()]
