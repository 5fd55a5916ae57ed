"""The ordinary ways, for UPS legs: a loop over the poses with numpy and scipy.

`plain` computes all indices; `peer` is the way of a public hexapod class (StewartPlatform_py of
Flamisell), written anew: rotation by scipy, legs by broadcasting, one SVD per pose, and only the
indices that it has (condition number, smallest singular value, determinant).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from scipy.spatial.transform import Rotation

import gsp
from benchmarks.cases import ELLIPSOID, LENGTH


def skew(x):
    return np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def ellipsoid_metric(r):
    """D of Nawratil, from the six vertices."""
    total = np.zeros((6, 6))
    for vertex in ELLIPSOID.vertices:
        speed = np.hstack((np.eye(3), -skew(r @ vertex)))
        total += speed.T @ speed
    return total


def passive_metric(u, sizes, arms):
    """T of Nawratil: the rates of the leg directions, seen from base and platform."""
    total = np.zeros((6, 6))
    for x, size, arm in zip(u, sizes, arms, strict=True):
        project = (np.eye(3) - np.outer(x, x)) / size
        seen = np.hstack((project, -project @ skew(arm)))
        turned = seen + np.hstack((np.zeros((3, 3)), skew(x)))
        total += seen.T @ seen + turned.T @ turned
    return total


def spread(metric, normal):
    values = scipy.linalg.eigh(metric, normal, eigvals_only=True)
    return np.sqrt(values[-1] / values[0])


def plain(design: gsp.Design, pose: gsp.Pose) -> np.ndarray:
    out = np.empty((5, pose.size))
    for i in range(pose.size):
        p, r = pose.position[i], pose.rotation[i]
        arms = design.platform_points @ r.T
        d = p + arms - design.base_points
        sizes = np.linalg.norm(d, axis=1)
        u = d / sizes[:, None]
        jacobian = np.hstack((u, np.cross(arms, u)))
        scaled = jacobian / np.array([1, 1, 1, LENGTH, LENGTH, LENGTH])
        values = np.linalg.svd(scaled, compute_uv=False)
        normal = jacobian.T @ jacobian
        out[0, i] = values[0] / values[-1]
        out[1, i] = spread(ellipsoid_metric(r), normal)
        out[2, i] = 1 / spread(passive_metric(u, sizes, arms), normal)
        out[3, i] = abs(np.linalg.det(jacobian))
        out[4, i] = values[-1]
    return out


def peer(design: gsp.Design, position: np.ndarray, angles: np.ndarray) -> np.ndarray:
    out = np.empty((3, len(position)))
    for i in range(len(position)):
        r = Rotation.from_euler("xyz", angles[i]).as_matrix()
        legs = np.repeat(position[i][:, None], 6, axis=1) + r @ design.platform_points.T
        legs = legs - design.base_points.T
        lengths = np.linalg.norm(legs, axis=0)
        n = legs / lengths
        jacobian = np.concatenate((n, np.cross(r @ design.platform_points.T, n, axis=0))).T
        s = np.linalg.svd(jacobian, compute_uv=False)
        out[:, i] = s[0] / s[-1], s[-1], abs(np.linalg.det(jacobian))
    return out
