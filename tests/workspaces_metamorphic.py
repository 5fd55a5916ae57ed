"""Quantities of workspaces, rankings and sweeps for the metamorphic suite: see `tests.quantities`.

Sets of positions are described by what does not depend on the frames: distances from the posture at
hand, along directions that anchors span. The platform is held in its orientation, so that its
origin may be anywhere.
"""

from __future__ import annotations

import numpy as np

import gsp
from gsp import sweeps, workspace
from tests import campaign

ROUNDING = 1e-9  # share of the size: ends of rays solve their equations to 1e-9 of it


def _plane(given):
    """The given position, and orthonormal axes along three anchors of the old order."""
    rows = [given.design.rows[k].leg for k in np.argsort(given.rows)]
    points = given.design.base_points[list(dict.fromkeys(rows))]
    axes = []
    for i in (1, len(points) // 2, *range(1, len(points))):
        step = points[i] - points[0]
        for axis in axes:
            step = step - (step @ axis) * axis
        length = np.linalg.norm(step)
        # Anchors of two legs may be one point, and three on one line.
        if length > 1e-3 * given.design.rms_radius and len(axes) < 2:
            axes.append(step / length)
    return given.pose.position[0], np.stack(axes)


def _around(given):
    """The design with strokes around its lengths at the given position."""
    lengths = given.posture.joints[0]
    return given.design.replace(strokes=np.stack((0.8 * lengths, 1.2 * lengths), axis=1))


def section_ends(given):
    """Distances of the ends of rays in a plane."""
    origin, axes = _plane(given)
    number = campaign.count(3, 6)
    rays = np.arange(number) * 2.0 * np.pi / number + 0.1
    found = workspace.section(
        _around(given),
        origin,
        axes,
        rotation=given.pose.rotation[0],
        rays=rays,
        starts=1,
        connecting=False,
    )
    return np.where(found.ends.maximal, found.ends.distance, np.nan)


def section_area(given):
    """The exact area of the section with a plane."""
    origin, axes = _plane(given)
    shells = workspace.exact_shells(_around(given), given.pose.rotation[0])
    return np.array([shells.section_area(origin, axes)])


def surface_ends(given):
    """Distances of the ends of rays in space, whose angles are those of the base axes."""
    found = workspace.surface(
        _around(given),
        given.pose.position[0],
        rotation=given.pose.rotation[0],
        counts=(campaign.count(2, 3), 3),
        starts=1,
    )
    return found.distance.ravel()


def _bounded(given):
    """The design with strokes of its distances around the given position."""
    strokes = _around(given).strokes
    return given.design.replace(strokes=np.where(given.design.angular[:, None], np.nan, strokes))


def _grid(given):
    """Points of a plane, the given position among them."""
    origin, axes = _plane(given)
    steps = 0.23 * given.design.rms_radius * np.arange(-2.0, 3.0)
    return origin + np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1) @ axes


def fixed_contains(given):
    """Where points of a plane are in the region of the given rotation."""
    region = workspace.fixed_orientation(
        _bounded(given), given.pose.rotation[0], plane=_plane(given), budget=1000, workers=1,
        progress=False,
    )  # fmt: skip
    return region.contains(_grid(given)).astype(float)


def fixed_area(given):
    """Whether the bracket of the area of a section holds the exact one."""
    plane, design = _plane(given), _bounded(given)
    region = workspace.fixed_orientation(
        design, given.pose.rotation[0], plane=plane, budget=10_000, workers=1, progress=False
    )
    exact = workspace.exact_shells(design, given.pose.rotation[0]).section_area(*plane)
    low, high = region.area
    return np.array([low <= exact <= high], dtype=float)


def _reachable(given):
    return workspace.reachable(
        _bounded(given), plane=_plane(given), budget=10_000, workers=1, progress=False
    )


def reachable_contains(given):
    """Where points of a plane are in the region of all rotations."""
    return _reachable(given).contains(_grid(given)).astype(float)


def reachable_area(given):
    """The bracket of the area of the region of all rotations in a plane."""
    return np.array(_reachable(given).area)


def ranked(given):
    """Statistics of the control number in a ranking, and the shares of poses."""
    table = gsp.rank([given.design], given.pose, ["CTN"], length=given.length, workers=1)
    return table[["control_number_mean", "control_number_min"]].to_numpy(float)[0]


def swept(given):
    """The control number along a path of the given poses."""
    steps = np.arange(float(given.pose.size))
    path = sweeps.Path({"distance": steps}, given.pose, "the poses", {"distance": "number"})
    return gsp.sweep(given.design, path, "CTN", length=given.length)["control_number"].to_numpy()


def times_unit(value, _, other):
    """Lengths are converted with the unit."""
    return value * other.unit


def times_unit_squared(value, _, other):
    """Areas are converted with the square of the unit."""
    return value * other.unit**2


def size_of_codes(expected, _, other):
    """Verdicts may be undecided, but never opposite: 1 inside, 0 undecided, −1 outside."""
    return np.full(expected.shape, 1.0 / np.finfo(float).eps / 200.0 / other.distance)


def size_of_ends(expected, given, other):
    """Ends are solved to a share of the size, more often than rounding."""
    size = given.design.rms_radius * other.unit
    return np.full(expected.shape, ROUNDING / np.finfo(float).eps / 200.0 * size)


def size_of_area(expected, given, other):
    """The area is a sum of arcs with radii of a few sizes."""
    return np.full(expected.shape, 1e2 * (given.design.rms_radius * other.unit) ** 2)
