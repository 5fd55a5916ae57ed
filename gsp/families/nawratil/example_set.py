"""The example set S_K(α, h) of `Nawratil`: designs and poses, and the determinant over it.

Axes are those of the source, with the base origin moved into the base plane.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.families.fitting import fitting
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.posture import Posture

_KAPPA = np.sqrt(2.0 * np.sqrt(5.0) - 2.0)

#: α and h of the posture K+, and its control number. *Source: Nawratil, eq. (25)*
BEST_ALPHA = float(-np.arctan((np.sqrt(5.0) * _KAPPA - np.sqrt(15.0)) / 5.0))
BEST_H = float(_KAPPA / 4.0)
BEST_CONTROL_NUMBER = float(np.sqrt(2.0 * np.sqrt(5.0) - 4.0))

# π/6 may be rounded up.
ALPHA = arguments.within(0.0, np.pi / 6.0 + 1e-15, "an angle in [0, π/6]")


@arguments.validated(alpha=arguments.one(ALPHA))
def example_design(alpha: float) -> Design:
    """Return the hexapod of the example set S_K with design parameter α.

    Base and platform anchors lie on circles of radius 1, in pairs at the angles ∓α of a triangle
    and, on the platform, of the triangle turned by 60°.

    Parameters
    ----------
    alpha : float [rad]
        In [0, π/6]; 0 is the octahedron, π/6 is singular at every height.

    Raises
    ------
    InvalidInput
        If α is not in [0, π/6].

    Examples
    --------
    >>> import gsp
    >>> posture = example_design(BEST_ALPHA).at(example_pose(BEST_H))
    >>> float(gsp.indices.control_number(posture).round(3))
    0.687

    *Source: Nawratil, §3.4*
    """
    base = np.repeat(np.arange(3) * 2.0 * np.pi / 3.0, 2) + np.tile([-alpha, alpha], 3)
    platform = base.reshape(3, 2)[:, ::-1] + np.array([-np.pi / 3.0, np.pi / 3.0])
    return Design(
        ["D1"] * 6,
        _on_circle(base),
        _on_circle(platform.ravel()),
        name=f"nawratil-example-{np.rad2deg(alpha):.4g}deg",
        source="Nawratil, §3.4",
    )


@arguments.validated(h=arguments.moderate)
def example_pose(h: ArrayLike, turn: ArrayLike = (0.0, 0.0, 0.0)) -> Pose:
    """Return the pose of S_K with posture parameter h, the platform a height 2h above the base.

    Parameters
    ----------
    h : (...) array_like [unit]
        The source takes h > 0; at h = 0 the platform lies in the base plane.
    turn : (..., 3) array_like [rad]
        Roll, pitch, yaw about the centre of the platform; δ is (0, δ, 0), γ is (γ, 0, 0).

    Returns
    -------
    Pose, batch shape (...)

    Raises
    ------
    InvalidInput
        On a wrong shape, or numbers that are not finite.

    *Source: Nawratil, §3.4*
    """
    height = np.asarray(h, dtype=np.float64)
    zero = np.zeros_like(height)
    return Pose.from_rpy(np.stack((zero, zero, 2.0 * height), axis=-1), turn)


@fitting
@arguments.validated(alpha=ALPHA, h=arguments.within(0.0, arguments.LARGEST_NUMBER))
def example_determinant(alpha: ArrayLike, h: ArrayLike) -> Array:
    """Return |det J| in the example set: 54 (c s h)³ / (s² + h²)³, s = sin(π/6 − α), c = cos.

    Its maximum over h is 27/4 c³, at h = s; over all the set it has none, but grows towards 27/4
    at the singular end α = π/6, h = 0.

    Parameters
    ----------
    alpha, h : array_like that broadcast, shape (...) [rad], [unit]
        α in [0, π/6], h ≥ 0.

    Returns
    -------
    (...) array [unit³]
        NaN at α = π/6, h = 0, where the legs have no length.

    Raises
    ------
    InvalidInput
        On numbers outside of their range, or shapes that do not broadcast together.

    *Source: ours; Nawratil, figure 3, shows it.*
    """
    angle = np.maximum(np.pi / 6.0 - np.asarray(alpha, dtype=np.float64), 0.0)
    height, sine = np.asarray(h, dtype=np.float64), np.sin(angle)
    half = np.hypot(sine, height)
    with np.errstate(invalid="ignore"):
        value = 54.0 * (np.cos(angle) * (sine / half) * (height / half)) ** 3
    return np.asarray(value, dtype=np.float64)


def over_example_set(function: Callable[[Posture], Array], alpha: ArrayLike, h: ArrayLike) -> Array:
    """Evaluate a function of postures over a grid of the example set.

    Parameters
    ----------
    function : Posture, batch shape (n,) -> (n,) array
        An index, with its parameters filled in.
    alpha : (m,) array_like [rad]
    h : (n,) array_like [unit]

    Returns
    -------
    (n, m) array [unit of the function]
        One row per height, one column per α, as contour plots take it.

    Raises
    ------
    InvalidInput
        On a wrong shape, or numbers that are not finite.

    *Source: Nawratil, §3.4.*
    """
    pose = example_pose(check_array("h", h, (None,), axes=1))
    alphas = check_array("alpha", alpha, (None,), axes=1)
    if not alphas.size or not callable(function):
        wanted = "a function of postures, and shape (m,)"
        raise InvalidInput(expected("function, alpha", wanted, brief((function, alpha))))
    columns = [np.asarray(function(example_design(a).at(pose))) for a in alphas]
    shape = columns[0].shape
    if shape != pose.shape:
        wanted = f"a function that returns shape {pose.shape}"
        raise InvalidInput(expected("function", wanted, f"shape {shape}"))
    return np.stack(columns, axis=1)


def _on_circle(angle: Array) -> Array:
    """Points of the unit circle in the plane z = 0, shape (n, 3)."""
    return np.stack((np.cos(angle), np.sin(angle), np.zeros_like(angle)), axis=1)
