"""The positions that satisfy the strokes at the present rotation, as a surface for the scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from gsp.app.scene.drawing import origin_of, rounded
from gsp.app.state.motion import has_strokes
from gsp.app.state.session import Session
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, dot
from gsp.model.design.checks import open_strokes

# Points on each side of the grids, odd: the first two find where the region is, the last draws it.
GRIDS = (25, 25, 37)
# Steps of a grid that the next one has around what was found: a region may have edges between the
# points.
MARGIN_STEPS = 2
# Half the side of the first grid, around the first pose, in sizes of the design, where no distance
# of two points bounds the position.
UNBOUNDED_REACH = 1.5


@dataclass(frozen=True, eq=False, kw_only=True)
class Surface:
    """The boundary of a region, as triangles.

    Attributes
    ----------
    origin : (3,) array [unit of the design]
        Of the drawing, from which the scene gets places.
    vertices : (n, 3) array [unit of the design]
        In base axes.
    faces : (m, 3) array of int
        Corners, seen from outside against the clock.
    cut : bool
        Whether the region goes on beyond the part that was looked at.
    volume, volume_error : float [unit³]
        Estimate of the volume of the region, and of its error. The volume inside of the surface is
        somewhat smaller, as edges of the region are cut off between the points of the grid.
    """

    origin: Array
    vertices: Array
    faces: NDArray[np.int64]
    cut: bool
    volume: float
    volume_error: float

    def numbers(self) -> dict[str, Any]:
        """Return what the scene gets: coordinates, and numbers of corners."""
        size = float(np.ptp(self.vertices, axis=0).max())
        return {
            "vertices": rounded(self.vertices - self.origin, size),
            "faces": self.faces.ravel().tolist(),
        }


def region_of(state: Session) -> Surface:
    """Return the positions that are feasible at the present rotation, of the part where it is.

    The strokes are evaluated on a grid, and the surface is interpolated: it is a picture, and no
    proof (see `gsp.workspace.fixed_orientation`). It is the connected part around the present
    position; if that is not feasible, all parts.

    Parameters
    ----------
    state : Session

    Raises
    ------
    InvalidInput
        If no joint has limits, or no position is feasible.
    """
    if not has_strokes(state.design):
        raise InvalidInput(expected("limits", "limits of the joints; set them in Legs", "none"))
    low, high = _bounds(state)
    cut = False
    for number, points in enumerate(GRIDS):
        left, part = _sampled(state, low, high, points)
        if not part.any() and number == 0:  # a small region may be around the present position
            reach = np.maximum(high - state.pose.position, state.pose.position - low)
            low, high = state.pose.position - reach, state.pose.position + reach
            left, part = _sampled(state, low, high, points)
        if not part.any():
            raise InvalidInput(
                expected("limits", "feasible positions at the present rotation", "none")
            )
        step = (high - low) / (points - 1)
        found = np.argwhere(part)
        cut |= bool(number == 0 and ((found == 0) | (found == points - 1)).any())
        first = low
        low, high = (
            first + (found.min(axis=0) - MARGIN_STEPS) * step,
            first + (found.max(axis=0) + MARGIN_STEPS) * step,
        )
    # Other parts, and the faces of the grid, are outside.
    left = np.where(ndimage.binary_dilation(part) | (left <= 0.0), left, -np.abs(left))
    vertices, faces = _closed(left, first, step)
    # What is missing falls with the square of the step, also where edges are cut off: a third of
    # the difference to twice the step (Richardson).
    inside = volume_in(vertices, faces)
    missing = (inside - volume_in(*_closed(left[::2, ::2, ::2], first, 2.0 * step))) / 3.0
    return Surface(
        origin=origin_of(state.design),
        vertices=vertices,
        faces=faces,
        cut=cut,
        volume=inside + missing,
        volume_error=abs(missing),
    )


def _sampled(
    state: Session, low: Array, high: Array, points: int
) -> tuple[Array, NDArray[np.bool_]]:
    """Return what is left of the strokes on a grid, and which points are of the region."""
    grid = [np.linspace(a, b, points) for a, b in zip(low, high, strict=True)]
    left = _left(state, np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1))
    return left, _part(state, left > 0.0, low, high)


def _closed(left: Array, first: Array, step: Array) -> tuple[Array, NDArray[np.int64]]:
    """Return the surface around the positive values of a grid, whose outside is negative."""
    vertices, faces = surface(np.pad(left, 1, constant_values=-float(np.abs(left).max())))
    return first + (vertices - 1.0) * step, faces


def volume_in(vertices: Array, faces: NDArray[np.int64]) -> float:
    """Return the volume inside of a closed surface [unit³ of the corners]."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(dot(a, np.cross(b, c)).sum() / 6.0)


def _bounds(state: Session) -> tuple[Array, Array]:
    """Return a box that has the region, where distances of two points bound it."""
    design = state.design
    strokes = open_strokes(design.strokes, len(design.joint_names))
    middle = np.asarray(state.pose.position)
    low, high = (middle + side * UNBOUNDED_REACH * state.size for side in (-1.0, 1.0))
    shells = [
        (design.base_points[row.leg] - state.pose.rotation @ design.platform_points[row.leg], most)
        for row, most in zip(design.rows, strokes[:, 1], strict=True)
        if row.constraint.name == "D1" and np.isfinite(most)
    ]
    if shells:
        low = np.max([centre - most for centre, most in shells], axis=0)
        high = np.min([centre + most for centre, most in shells], axis=0)
    if (low >= high).any():
        raise InvalidInput(expected("limits", "feasible positions at the present rotation", "none"))
    return low, high


def _left(state: Session, positions: Array) -> Array:
    """Return what is left of the strokes, the least of all joints as a share; outside negative."""
    design = state.design
    joints = design.at(Pose(positions, state.pose.rotation)).joints
    low, high = open_strokes(design.strokes, len(design.joint_names)).T
    scale = np.where(design.angular, 1.0, state.size)
    left = np.minimum(joints - low, high - joints) / scale
    return np.asarray(np.nan_to_num(left, nan=-1.0, posinf=1.0).min(axis=-1))


def _part(state: Session, inside: NDArray[np.bool_], low: Array, high: Array) -> NDArray[np.bool_]:
    """Return the connected part of the present position, or all of a region without it."""
    parts, _ = ndimage.label(inside)
    here = np.rint((state.pose.position - low) / (high - low) * (np.array(inside.shape) - 1))
    if (here < 0).any() or (here >= inside.shape).any():
        return inside
    number = parts[tuple(here.astype(int))]
    return np.asarray(parts == number) if number else inside


def surface(values: Array) -> tuple[Array, NDArray[np.int64]]:
    """Return the surface on which values of a grid are zero: corners in steps, and triangles.

    Each cell of the grid with values of both signs has one corner, the mean of the zeros on its
    edges; each edge of the grid with a zero joins the corners of its four cells. The values on the
    faces of the grid are negative.

    *Source: "surface nets" of Gibson (1998), with the mean of the zeros*
    """
    positive = values > 0.0
    cells = tuple(n - 1 for n in values.shape)
    total, count = np.zeros((*cells, 3)), np.zeros(cells)
    crossed = []
    for axis in range(3):
        a, b = _along(values, axis)
        cross = (a > 0.0) != (b > 0.0)
        at = np.argwhere(cross)
        zero = at.astype(np.float64)
        zero[:, axis] += a[cross] / (a[cross] - b[cross])
        crossed.append((at, positive[tuple(at.T)]))
        # The four cells around an edge.
        for i in (0, 1):
            for j in (0, 1):
                cell = at.copy()
                cell[:, (axis + 1) % 3] -= i
                cell[:, (axis + 2) % 3] -= j
                np.add.at(total, tuple(cell.T), zero)
                np.add.at(count, tuple(cell.T), 1.0)
    used = count > 0.0
    number = np.cumsum(used).reshape(cells) - 1
    faces = [_quads(number, at, inner, axis) for axis, (at, inner) in enumerate(crossed)]
    return total[used] / count[used][:, None], np.concatenate(faces)


def _along(values: Array, axis: int) -> tuple[Array, Array]:
    """Return the values at both ends of the edges of a grid along an axis."""
    n = values.shape[axis]
    return values.take(range(n - 1), axis), values.take(range(1, n), axis)


def _quads(
    number: NDArray[np.int64], at: NDArray[np.int64], inner: NDArray[np.bool_], axis: int
) -> NDArray[np.int64]:
    """Return two triangles for each edge with a zero, its first end inside or not."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    corners = []
    for di, dj in ((1, 1), (0, 1), (0, 0), (1, 0)):
        cell = at.copy()
        cell[:, i] -= di
        cell[:, j] -= dj
        corners.append(number[tuple(cell.T)])
    quads = np.stack(corners, axis=-1)
    quads[~inner] = quads[~inner][:, ::-1]
    return np.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]))
