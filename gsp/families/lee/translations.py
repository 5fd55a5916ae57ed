"""The octahedral 3-3 platform translated parallel to its base: Lee2000, chapter 4."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.families.fitting import fitting
from gsp.families.lee.hexagons import central_maximum
from gsp.families.lee.platforms import ROOT3
from gsp.geometry.vectors import Array

# The twelfth power of the distance is finite up to it.
LARGEST_DISTANCE = 1e25
CHECKS = {
    "a": arguments.size,
    "b": arguments.size,
    "x": arguments.moderate,
    "y": arguments.moderate,
    "z": arguments.moderate,
}
DISTANCE = arguments.within(0.0, LARGEST_DISTANCE)


@fitting
@arguments.validated(**CHECKS)
def translated_leg_lengths(a: float, b: float, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Leg lengths l_1 … l_6 with the platform's centre at (x, y) and the height z: (..., 6) [unit].

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    x, y, z : array_like that broadcast, shape (...) [unit]
        Centre of the platform.

    Returns
    -------
    (..., 6) array [unit]

    Raises
    ------
    InvalidInput
        On sides, heights or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eq. (39).*
    """
    offsets = np.array(
        [
            [(a - b) / 2.0, (a + b) / (2.0 * ROOT3)],
            [a / 2.0, (a - 2.0 * b) / (2.0 * ROOT3)],
            [-a / 2.0, (a - 2.0 * b) / (2.0 * ROOT3)],
            [(b - a) / 2.0, (a + b) / (2.0 * ROOT3)],
            [b / 2.0, (b - 2.0 * a) / (2.0 * ROOT3)],
            [-b / 2.0, (b - 2.0 * a) / (2.0 * ROOT3)],
        ]
    )
    x, y, z = (np.asarray(v, dtype=np.float64)[..., None] for v in (x, y, z))
    return np.asarray(np.hypot(np.hypot(offsets[:, 0] + x, offsets[:, 1] + y), z))


@fitting
@arguments.validated(**CHECKS)
def translated_determinant(a: float, b: float, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """|det J| with the platform's centre at (x, y) and the height z [unit³].

    Only the leg lengths change: a shear leaves the numerator as it is.

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    x, y, z : array_like that broadcast, shape (...) [unit]
        Centre of the platform.

    Returns
    -------
    (...) array [unit³]
        NaN where a leg has no length.

    Raises
    ------
    InvalidInput
        On sides, heights or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eq. (38).*
    """
    lengths = np.sort(translated_leg_lengths(a, b, x, y, z), axis=-1)
    height = np.abs(np.asarray(z, dtype=np.float64))[..., None]
    # Divided before it is multiplied, so that products of large lengths do not overflow.
    with np.errstate(invalid="ignore", divide="ignore"):
        ratios = a * (height / lengths[..., :3]) * (b / lengths[..., 3:])
    return np.asarray(0.75 * ROOT3 * ratios.prod(axis=-1))


@fitting
@arguments.validated(**CHECKS)
def translated_quality(a: float, b: float, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """λ with the platform's centre at (x, y) and the height z, with |det J|m for maximum [1].

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    x, y, z : array_like that broadcast, shape (...) [unit]
        Centre of the platform.

    Returns
    -------
    (...) array [1]
        ≥ 0; at most 1 with the centres above each other.

    Raises
    ------
    InvalidInput
        On sides, heights or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eq. (40).*

    >>> translated_quality(1.0, 2.0, 0.0, 0.0, 1.0).round(12)
    np.float64(1.0)
    """
    return translated_determinant(a, b, x, y, z) / central_maximum(a, b)


@fitting
@arguments.validated(r=DISTANCE, theta=arguments.moderate)
def quality_polar(r: ArrayLike, theta: ArrayLike) -> Array:
    """λ of the 3-3 with a = 1, b = 2 at the height 1 and (x, y) = r (cos θ, sin θ) [1].

    Parameters
    ----------
    r : (...) array_like [unit]
        Distance of the centre from the axis, in [0, 1e25].
    theta : (...) array_like [rad]

    Returns
    -------
    (...) array [1]

    Raises
    ------
    InvalidInput
        On distances outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eq. (41); θ in rad.*
    """
    return quality_polar_bound(r, np.cos(6.0 * np.asarray(theta, dtype=np.float64)))


@fitting
@arguments.validated(r=DISTANCE, cosine=arguments.within(-1.0, 1.0))
def quality_polar_bound(r: ArrayLike, cosine: ArrayLike) -> Array:
    """Eq. (41) with cos 6θ given: 1 makes the upper bound (42), −1 the lower bound (43) [1].

    Parameters
    ----------
    r : (...) array_like [unit]
        Distance of the centre from the axis, in [0, 1e25].
    cosine : (...) array_like [1]
        cos 6θ, in [−1, 1].

    Returns
    -------
    (...) array [1]

    Raises
    ------
    InvalidInput
        On numbers outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eqs. (41)–(43).*

    >>> round(float(quality_polar_bound(2**0.5, 1.0) - quality_polar_bound(2**0.5, -1.0)), 5)
    0.00203
    """
    r2, c = np.asarray(r, dtype=np.float64) ** 2, np.asarray(cosine, dtype=np.float64)
    inner = ((r2 + 6.0) * r2 + 21.0) * r2 + 50.0 - 2.0 * c
    return np.asarray(8.0 / np.sqrt(((inner * r2 + 84.0) * r2 + 96.0) * r2 + 64.0))
