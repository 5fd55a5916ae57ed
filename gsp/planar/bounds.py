"""The strokes of a planar design, as quantities between bounds."""

from __future__ import annotations

from functools import partial

import numpy as np

from gsp.checks import check_type
from gsp.errors import MissingParameter
from gsp.geometry.vectors import Array
from gsp.limits.kinds import joint_quantities
from gsp.limits.quantities import BoundedQuantities, Quantities, point_distances
from gsp.model.design.checks import check_bounds, open_strokes
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose


def planar_bounds(design: PlanarDesign) -> BoundedQuantities:
    """Return the strokes of a planar design as quantities between bounds, for poses in space."""
    check_type("design", design, PlanarDesign)
    if design.strokes is None:
        raise MissingParameter(f"planar design {design.name!r}: expected strokes, received none")
    strokes = open_strokes(design.strokes, len(design.joint_names))
    check_bounds(strokes[:, 0], strokes[:, 1], design.joint_names)
    quantities = Quantities(partial(_values, design), partial(_rows, design))
    if design.between_points:
        quantities = point_distances(
            _in_space(design.base_points), _in_space(design.platform_points)
        )
    (low, high), scale = strokes.T, design.rms_radius
    sizes = np.where(design.angular, 1.0, scale)
    return BoundedQuantities(joint_quantities(design), low, high, quantities, scale, sizes)


def _values(design: PlanarDesign, position: Array, rotation: Array) -> Array:
    return design.at(_pose(position, rotation)).joints


def _rows(design: PlanarDesign, position: Array, rotation: Array) -> tuple[Array, Array]:
    posture = design.at(_pose(position, rotation))
    rows = np.zeros((*posture.joints.shape, 6))
    rows[..., [0, 1, 5]] = posture.jacobian
    return posture.joints, rows


def _pose(position: Array, rotation: Array) -> PlanarPose:
    return PlanarPose(position[..., :2], np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0]))


def _in_space(points: Array) -> Array:
    return np.concatenate((points, np.zeros((len(points), 1))), axis=1)
