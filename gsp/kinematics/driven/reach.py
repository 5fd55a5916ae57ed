"""Limits of drives at the base: where they reach a pose, and bounds of angles of cranks."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import Any

import numpy as np

from gsp.geometry.vectors import Array, cross
from gsp.model.design import Design
from gsp.model.drives import Crank, Slider
from gsp.model.rods import arm_axes


def crank_bounds(bounds: Array) -> Array:
    """Return bounds (n, 2) of angles of cranks that turn continuously [rad].

    The angle is in (−π, π], so a crank that turns beyond π has one near −π, which violates other
    bounds. Bounds that all angles satisfy become infinite.

    Parameters
    ----------
    bounds : (n, 2) array [rad]
        Least and greatest angles, ∓inf where there is none.
    """
    inner = np.clip(bounds, -np.pi, np.pi)
    limited = (inner[:, 0] > -np.pi) | (inner[:, 1] < np.pi)
    return np.where(limited[:, None], inner, [-np.inf, np.inf])


def reaches(design: Design, position: Array, rotation: Array) -> tuple[Array, Array]:
    """Return how far anchors are inside of what their drives reach, and the derivatives.

    With d from the base point to the anchor, in the notation of `gsp.model.rods`, these are
    (ℓ² − c²) / 2ℓ for a slider and (h² − C²) / 2 ℓ x² for a crank: positive where the two values of
    the drive are real and differ, and zero where the drive is singular. They are defined at all
    poses.

    Parameters
    ----------
    design : Design
    position, rotation : (3,) and (3, 3) arrays

    Returns
    -------
    values : (k,) array [length]
        Of the k legs that are driven at the base, in their order.
    rows : (k, 6) array [1, length]
        For the twist (v, ω).

    *Source: docs/drives.md; ours*
    """
    values: list[float] = []
    rows: list[Array] = []
    for leg, drive in enumerate(design.drives):
        if drive is None:
            continue
        arm = rotation @ design.platform_points[leg]
        d, s = position + arm - design.base_points[leg], design.base_directions[leg]
        value, slope = _REACHES[type(drive)](drive, d, s)
        values.append(value)
        rows.append(np.concatenate((slope, cross(arm, slope))))
    return np.array(values), np.array(rows).reshape(-1, 6)


def _of_slider(drive: Slider, d: Array, s: Array) -> tuple[float, Array]:
    across = d - (d @ s) * s
    return float(drive.rod**2 - across @ across) / (2.0 * drive.rod), -across / drive.rod


def _of_crank(drive: Crank, d: Array, s: Array) -> tuple[float, Array]:
    axial, x, _ = (np.array(vector) for vector in arm_axes(list(drive.arm), s.tolist()))
    d, square = d - axial, float(x @ x)
    across = d - (d @ s) * s
    level = 0.5 * (float(d @ d) + square - drive.rod**2)
    per = 1.0 / (2.0 * drive.rod * square)
    value = per * (square * float(across @ across) - level**2)
    return value, 2.0 * per * (square * across - level * d)


_REACHES: MappingProxyType[type[Any], Callable[..., tuple[float, Array]]] = MappingProxyType(
    {Slider: _of_slider, Crank: _of_crank}
)
