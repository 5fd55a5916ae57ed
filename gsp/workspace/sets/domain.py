"""Boxes and half-spaces that hold all positions, from strokes and limits of the position."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array, norm
from gsp.limits import Limits
from gsp.model.design import Design

# Shares of lengths by which domains are enlarged for rounding.
OUTWARD_SHARE = 1e-9
# Axes of a plane whose components are nearer than this to 0 count as axes of the base [1].
ALIGNED = 1e-15


def position_box(design: Design, strokes: Array, half_spaces: Array) -> tuple[Array, Array]:
    """Return the least and greatest coordinates of a box that holds all positions, (3,) each.

    Raises InvalidInput if strokes and half-spaces do not bound them.
    """
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    base, platform = [], []
    for row, (_, most) in zip(design.rows, strokes, strict=True):
        leg = design.legs[row.leg]
        if (leg.base_line and leg.platform_line) or not np.isfinite(most):
            continue
        a, radius = design.base_points[row.leg], most + norm(design.platform_points[row.leg])
        if not leg.cylindrical:
            low, high = np.maximum(low, a - radius), np.minimum(high, a + radius)
        if not leg.platform_line:
            base.append((_across(design.base_directions[row.leg], leg.base_line), a, radius))
        if not leg.base_line:
            apart = radius + norm(a - design.base_points[0])
            platform.append(
                (_across(design.platform_directions[row.leg], leg.platform_line), 0.0 * a, apart)
            )
    low, high = _ellipsoid(base, np.zeros(3), low, high, free=False)
    low, high = _ellipsoid(platform, design.base_points[0], low, high, free=True)
    low, high = cut_faces(low, high, half_spaces)
    # A box that is tilted in the frame: no face bounds a coordinate, but the corners do.
    if len(half_spaces) == 6:
        corners = _corners(half_spaces)
        reach = OUTWARD_SHARE * np.abs(corners).max()
        low = np.maximum(low, corners.min(axis=0) - reach)
        high = np.minimum(high, corners.max(axis=0) + reach)
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        wanted = "bounds of x, y and z, as the strokes do not bound the position"
        got = "too few" if len(half_spaces) else "none"
        raise InvalidInput(expected("limits.position", wanted, got))
    return low, high


def cut_faces(low: Array, high: Array, half_spaces: Array) -> tuple[Array, Array]:
    """Return a box cut by those half-spaces n · p ≥ c whose boundary is parallel to a face."""
    low, high = low.copy(), high.copy()
    for *normal, least in half_spaces:
        k = int(np.argmax(np.abs(normal)))
        if abs(abs(normal[k]) - 1.0) <= ALIGNED:
            if normal[k] > 0.0:
                low[k] = max(low[k], least)
            else:
                high[k] = min(high[k], -least)
    return low, high


def _corners(half_spaces: Array) -> Array:
    """Corners of a box of six half-spaces, least and greatest x, y and z of the base: (8, 3)."""
    normals, least = half_spaces[0::2, :3], half_spaces[0::2, 3]
    ends = np.stack((least, -half_spaces[1::2, 3]))
    chosen = np.array([[i >> k & 1 for k in range(3)] for i in range(8)])
    return np.asarray(ends[chosen, np.arange(3)] @ normals)


def _across(direction: Array, line: bool) -> Array:
    return np.eye(3) - np.outer(direction, direction) if line else np.eye(3)


def _ellipsoid(
    parts: list[tuple[Array, Array, float]], centre: Array, low: Array, high: Array, *, free: bool
) -> tuple[Array, Array]:
    """Cut a box by Σ |P (x − a)|² ≤ Σ r²; `free` if x may be turned about the centre."""
    if not parts:
        return low, high
    form: Array = np.sum([p for p, _, _ in parts], axis=0)
    roots = np.linalg.eigvalsh(form)
    # One leg bounds the position only across its line. The sum of several bounds it in all
    # directions, but hardly along lines that are nearly parallel.
    if roots[0] <= 1e-6 * roots[-1]:
        return low, high
    middle = np.linalg.solve(form, np.sum([p @ a for p, a, _ in parts], axis=0))
    rest = sum(r * r - float((middle - a) @ p @ (middle - a)) for p, a, r in parts)
    square = max(rest, 0.0) * (np.full(3, 1.0 / roots[0]) if free else np.diag(np.linalg.inv(form)))
    reach = np.sqrt(square) * (1.0 + OUTWARD_SHARE)
    start = centre if free else middle
    return np.maximum(low, start - reach), np.minimum(high, start + reach)


def half_spaces_of(limits: Limits, origin: Array, frame: Array) -> Array:
    """Return the half-spaces of the limits of the position, in the frame: shape (m, 4)."""
    if limits.position is None:
        return np.zeros((0, 4))
    half_spaces = []
    for k, (low, high) in enumerate(np.asarray(limits.position, dtype=np.float64)):
        normal = frame[:, k]
        if np.isfinite(low):
            half_spaces.append([*normal, low - origin[k]])
        if np.isfinite(high):
            half_spaces.append([*-normal, origin[k] - high])
    return np.array(half_spaces).reshape(-1, 4)


def one_half_space(half_space: Any, origin: Array, frame: Array) -> Array:
    """Return a half-space in the axes of the frame, its normal of length 1: shape (1 or 0, 4)."""
    if half_space is None:
        return np.zeros((0, 4))
    given = check_array("half_space", half_space, (4,))
    size = float(norm(given[:3])) if given.ndim == 1 else 0.0
    if not size > 0.0:
        wanted = "a normal that is not zero, and a number"
        raise InvalidInput(expected("half_space", wanted, brief(half_space)))
    normal = frame @ given[:3] / size
    normal = np.where(np.abs(normal) <= ALIGNED, 0.0, normal)
    return np.array([[*normal, (given[3] - given[:3] @ origin) / size]])
