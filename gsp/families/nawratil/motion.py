"""K+ turned through its singularities: the screws by two methods, and that at the singularity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, expected
from gsp.families.nawratil.example_set import (
    BEST_ALPHA,
    BEST_H,
    example_design,
    example_pose,
)
from gsp.geometry.scalars import choose, dot, less
from gsp.geometry.vectors import EPS, Array
from gsp.indices import complex_deviation_rotation, control_number
from gsp.indices.motion import InstantaneousMotion, instantaneous_motion
from gsp.model.formulas import Placement, line_line, line_point
from gsp.model.posture import Posture

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["INTERVALS", "compare_screws", "singular_angle", "turned"]

Axis = Literal["x", "y"]

# Axes with a smaller sine between them count as parallel: the rounding of their directions, some
# 1e-16, would turn their common normal by 1e-7 and more.
PARALLEL_AXES_SINE = 1e-9

#: The intervals of the source: γ about the x-axis, δ about the y-axis [rad].
INTERVALS = {"x": (0.89, 1.39), "y": (-1.2, -0.7)}


def turned(axis: Axis, angle: ArrayLike) -> Posture:
    """Return K+ with its platform turned about the x- or y-axis through its centre.

    Parameters
    ----------
    axis : "x" or "y"
    angle : (...) array_like [rad]
        γ or δ.

    Returns
    -------
    Posture
        Of the batch shape of the angles.

    Raises
    ------
    InvalidInput
        On another axis, or angles that are not finite.

    *Source: Nawratil, §3.4*
    """
    axis = _axis(axis)
    values = check_array("angle", angle, ())
    turn = np.zeros((*values.shape, 3))
    turn[..., "xy".index(axis)] = values
    return example_design(BEST_ALPHA).at(example_pose(BEST_H, turn))


def singular_angle(axis: Axis) -> float:
    """Return γ or δ of the singular posture inside the interval of the source [rad].

    Parameters
    ----------
    axis : "x" or "y"

    Returns
    -------
    float [rad]

    Raises
    ------
    InvalidInput
        On another axis.

    Examples
    --------
    >>> round(singular_angle("y"), 6), round(singular_angle("x"), 6)
    (-0.951675, 1.143718)

    *Source: Nawratil, §3.4, δ ≈ −0.95 and γ ≈ 1.14*
    """
    from scipy.optimize import brentq

    axis = _axis(axis)
    low, high = INTERVALS[axis]

    def determinant(angle: float) -> float:
        return float(np.linalg.det(turned(axis, angle).jacobian))

    return float(brentq(determinant, low, high, xtol=4 * EPS))


def compare_screws(axis: Axis, angle: ArrayLike) -> pd.DataFrame:
    """Compare the screws near the singular posture with the one at it, method by method.

    Parameters
    ----------
    axis : "x" or "y"
    angle : (n,) array_like [rad]

    Returns
    -------
    pandas.DataFrame
        One row per angle: angle, sigma_r, control_number, then for the control number (c) and for
        Pottmann's linear complex (p): pitch_c, pitch_p, distance_c, distance_p (of the axes,
        along the common normal), angle_c, angle_p (between the axes, [rad]), and pitch_error_c,
        pitch_error_p.

    Raises
    ------
    InvalidInput
        On another axis, another shape, or angles that are not finite.

    *Source: Nawratil, §3.4, figures 5–7*
    """
    import pandas as pd

    values = check_array("angle", angle, (None,))
    if values.ndim != 1:
        raise InvalidInput(expected("angle", "shape (n,)", f"shape {values.shape}"))
    posture = turned(axis, values)
    true = instantaneous_motion(turned(axis, singular_angle(axis)))
    columns: dict[str, Array] = {
        "angle": values,
        "sigma_r": complex_deviation_rotation(posture),
        "control_number": control_number(posture),
    }
    motions = {
        "c": instantaneous_motion(posture),
        "p": instantaneous_motion(posture, "linear_complex"),
    }
    for name, motion in motions.items():
        distance, turn = between_axes(true, motion)
        columns[f"pitch_{name}"] = motion.pitch
        columns[f"distance_{name}"] = distance
        columns[f"angle_{name}"] = turn
        columns[f"pitch_error_{name}"] = np.abs(motion.pitch - true.pitch)
    return pd.DataFrame(columns)


def _axis(axis: Axis) -> Any:
    return arguments.one_of(*get_args(Axis))("axis", axis)


def between_axes(one: InstantaneousMotion, other: InstantaneousMotion) -> tuple[Array, Array]:
    """Distance [length] and angle [rad, 0 to π/2] of the screw axes of two motions."""
    check_type("one", one, InstantaneousMotion)
    check_type("other", other, InstantaneousMotion)
    # With an axis more, as the formulas of a leg divide by zero only for arrays.
    d, s, t = (
        list(np.moveaxis(vectors, -1, 0)[..., None])
        for vectors in (other.point - one.point, one.axis[..., :3], other.axis[..., :3])
    )
    lines = Placement(d=d, arm=[0.0, 0.0, 0.0], s=s, t=t, scale=0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        segment, beside = line_line(lines), line_point(lines)
    skew = less(PARALLEL_AXES_SINE, segment.sine)
    distance = choose(skew, segment.length, beside.length)
    return distance[..., 0], np.arctan2(segment.sine, np.abs(dot(s, t)))[..., 0]
