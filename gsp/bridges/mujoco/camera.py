"""Where a camera stands that sees all of a scene, as near as it can."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array

# Of the half width and half height of a picture; the rest is its margin.
FILLED = 0.94
# Of the interval of k; then the middle is that of the picture to less than a pixel.
MIDDLE_HALVINGS = 30


class View(NamedTuple):
    """A free camera of MuJoCo [m]."""

    lookat: Array
    distance: float


def fit(
    centres: Array,
    radii: Array,
    *,
    azimuth: float,
    elevation: float,
    field: float,
    aspect: float,
) -> View:
    """Return the nearest camera with a viewing direction that sees balls, in the middle.

    In axes of the camera (x to the right, y up, z ahead) a ball at x, z of radius r is within the
    right side of the picture, x - x₀ ≤ k (z - z₀), with k the tangent of half the field, if
    x₀ - k z₀ ≥ x - k z + r √(1 + k²). With the left side z₀ is bounded by the sum of the
    greatest right sides, and x₀ by their difference; y likewise. Of x and y one binds z₀. For the
    other the k is sought that binds it, too, so that both margins are equal.

    Parameters
    ----------
    centres : (m, 3) array [m]
    radii : (m,) array [m]
    azimuth, elevation : float [degrees]
        Of the viewing direction, as MuJoCo counts them.
    field : float [degrees]
        Of view, from bottom to top.
    aspect : float
        Width of the picture over its height.

    Returns
    -------
    View
    """
    a, e = np.deg2rad([azimuth, elevation])
    right = np.array([np.sin(a), -np.cos(a), 0.0])
    ahead = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    axes = np.stack((right, np.cross(right, ahead), ahead))
    seen = centres @ axes.T
    tall = float(np.tan(np.deg2rad(field) / 2.0)) * FILLED
    fields = (tall * aspect, tall)
    nearest = min(_middle(seen[:, i], seen[:, 2], radii, k)[1] for i, k in enumerate(fields))
    place = np.array([0.0, 0.0, nearest])
    for i, k in enumerate(fields):
        narrow, wide = 0.0, k
        for _ in range(MIDDLE_HALVINGS):
            half = (narrow + wide) / 2.0
            if _middle(seen[:, i], seen[:, 2], radii, half)[1] < nearest:
                narrow = half
            else:
                wide = half
        place[i] = _middle(seen[:, i], seen[:, 2], radii, wide)[0]
    middle = (seen[:, 2].min() + seen[:, 2].max()) / 2.0
    distance = float(middle - place[2])
    return View((place + np.array([0.0, 0.0, distance])) @ axes, distance)


def _middle(x: Array, z: Array, radii: Array, k: float) -> tuple[float, float]:
    """Return x₀ and the greatest z₀ of a camera that sees balls within a field of tangent k."""
    slack = radii * np.hypot(1.0, k) - k * z
    right, left = float((x + slack).max()), float((slack - x).max())
    return (right - left) / 2.0, -(right + left) / (2.0 * k)
