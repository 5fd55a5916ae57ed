"""Vectorised numpy for UPS legs, as lean as it gets: stacked LAPACK in chunks of 2,000 poses."""

from __future__ import annotations

import numpy as np

import gsp
from benchmarks.cases import ELLIPSOID, LENGTH
from gsp.geometry.matrices import solve_right_triangular
from gsp.geometry.vectors import cross, skew

CHUNK = 2000


def stacked(design: gsp.Design, pose: gsp.Pose) -> np.ndarray:
    parts = [
        _chunk(design, pose.position[i : i + CHUNK], pose.rotation[i : i + CHUNK])
        for i in range(0, pose.size, CHUNK)
    ]
    return np.concatenate(parts, axis=1)


def _chunk(design, p, r):
    arms = design.platform_points @ r.transpose(0, 2, 1)
    d = p[:, None] + arms - design.base_points
    sizes = np.sqrt((d * d).sum(axis=-1))
    u = d / sizes[..., None]
    jacobian = np.concatenate((u, cross(arms, u)), axis=-1)
    values = np.linalg.svd(jacobian / np.repeat([1, LENGTH], 3), compute_uv=False)
    white = np.linalg.svd(ELLIPSOID.whiten(jacobian, r), compute_uv=False)
    root = np.linalg.cholesky(_passive(u, sizes, arms)).transpose(0, 2, 1)
    control = np.linalg.svd(solve_right_triangular(jacobian, root), compute_uv=False)
    return np.stack(
        (
            values[:, 0] / values[:, -1],
            white[:, 0] / white[:, -1],
            control[:, -1] / control[:, 0],
            np.abs(np.linalg.det(jacobian)),
            values[:, -1],
        )
    )


def _passive(u, sizes, arms):
    """T = Σ AᵀA + BᵀB over the legs, by one product of stacked 36 × 6 matrices."""
    project = (np.eye(3) - u[..., :, None] * u[..., None, :]) / sizes[..., None, None]
    turning = -project @ skew(arms)
    seen = np.concatenate((project, turning), axis=-1)
    turned = np.concatenate((project, turning + skew(u)), axis=-1)
    rows = np.concatenate((seen, turned), axis=1).reshape(len(u), 36, 6)
    return rows.transpose(0, 2, 1) @ rows
