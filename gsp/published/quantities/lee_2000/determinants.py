"""|det J|, λ and ranks of the platforms of `Lee2000` at given poses; the octahedron's volume."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from gsp.families import lee
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import manipulability, quality_index
from gsp.published.quantities.lee_2000.brackets import brackets
from gsp.published.quantities.lee_2000.optima import best_height, central_maximum
from gsp.published.quantities.lee_2000.platforms import platform, pose

RANK = 1e-12


def determinant(
    family: str,
    a: float,
    b: float,
    h: float,
    theta: float = 0.0,
    x: float = 0.0,
    y: float = 0.0,
    normalised: bool = True,
    **letters: float,
) -> float:
    """|det J| with the platform parallel to the base; |det J*| if not normalised."""
    posture = platform(family, a, b, **letters).at(pose(h, theta, x, y))
    scale = 1.0 if normalised else float(posture.joints.prod())
    return float(manipulability(posture)) * scale


def quality(
    family: str,
    a: float,
    b: float,
    h: float,
    theta: float = 0.0,
    x: float = 0.0,
    y: float = 0.0,
    **letters: float,
) -> float:
    """λ by the largest |det J| along the vertical, with the platform parallel to the base."""
    maximum = central_maximum(family, a, b, **letters)
    posture = platform(family, a, b, **letters).at(pose(h, theta, x, y))
    return float(quality_index(posture, maximum))


def quality_at_height(
    family: str, height_ratio: float, a: float, b: float, **letters: float
) -> float:
    """λ of the central configuration at h / h_m, h_m being where λ is found to be largest."""
    h = height_ratio * best_height(family, a, b, **letters)
    return quality(family, a, b, h, **letters)


def rank(family: str, a: float, b: float, h: float, theta: float = 0.0, **letters: float) -> int:
    """Rank of J in the central configuration, turned by theta."""
    posture = platform(family, a, b, **letters).at(pose(h, theta))
    return int((singular_values(posture.homogeneous(a)) > RANK).sum())


def general_rank(family: str, a: float, b: float, **letters: float) -> int:
    """Largest rank of J over 50 random poses."""
    poses = Pose.sample([(-a, a)] * 3, [(-2.0, 2.0)] * 3, 50, rng=1)
    values = singular_values(platform(family, a, b, **letters).at(poses).homogeneous(a))
    return int((values > RANK).sum(axis=-1).max())


def octahedron_volume(a: float, b: float, h: float) -> float:
    """Volume of the convex hull of the vertices of the 3-3."""
    design = lee.octahedral_3_3(a, b)
    vertices = np.concatenate(
        (design.base_points[::2], design.platform_points[::2] + [0.0, 0.0, h])
    )
    return float(ConvexHull(vertices).volume)


def special_turn(theta_deg: float) -> Array:
    """[rank of J, vanishing brackets of the first product, and of the second] of a turned 3-3."""
    theta = float(np.deg2rad(theta_deg))
    zero = [
        int((np.abs(brackets(product, 1.0, 2.0, 1.0, theta)) < RANK).sum()) for product in (1, 2)
    ]
    return np.array([rank("lee-3-3", 1.0, 2.0, 1.0, theta), *zero])


def most_about_parallel_axes(angle: float) -> float:
    """Largest |det J| of the 3-3 turned by an angle [deg] about random verticals."""
    design = lee.octahedral_3_3(1.0, 2.0)
    foot = np.random.default_rng(0).uniform(-2.0, 2.0, (50, 3)) * [1.0, 1.0, 0.0]
    turn = pose(0.0, float(np.deg2rad(angle))).rotation
    position = foot + ([0.0, 0.0, 1.0] - foot) @ turn.T
    return float(manipulability(design.at(Pose(position, turn))).max())


QUANTITIES = (
    determinant,
    quality,
    quality_at_height,
    rank,
    general_rank,
    octahedron_volume,
    special_turn,
    most_about_parallel_axes,
)
