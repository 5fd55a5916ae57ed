"""log |det J| and its gradient, tr(J⁻¹ ∂J/∂x)."""

from __future__ import annotations

import numpy as np

from gsp import arguments
from gsp.geometry.matrices import log_and_inverse
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design, check_undriven
from gsp.model.posture.derivatives import rows_and_derivatives


@arguments.validated(design=check_undriven, pose=arguments.kind(Pose, "a gsp.Pose"))
def log_determinant(design: Design, pose: Pose) -> tuple[Array, Array]:
    """Return log |det J| and its gradient along the six unit twists at the platform origin.

    For redundant designs it is ½ log det JᵀJ, with J⁺ in the place of J⁻¹.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...)

    Returns
    -------
    value : (...) array
        −inf where J is singular or not defined.
    gradient : (..., 6) array [1/length, 1]
        Along v_x, v_y, v_z, ω_x, ω_y, ω_z; zero where the value is −inf.

    Raises
    ------
    InvalidInput
        If `design` is not a Design, or `pose` is not a Pose.

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> value, gradient = log_determinant(octahedron, gsp.Pose([0.0, 0.0, 1.0]))
    >>> bool(np.abs(gradient).max() < 1e-12)
    True

    *Source: the rows of TozKucuk2016, eqs. (12)–(16); their derivatives are ours.*
    """
    rows, slopes = rows_and_derivatives(design.at(pose))
    value, inverse = log_and_inverse(rows)
    # The trace of a product is the inner product of one factor with the other one transposed.
    entries = rows.shape[-2] * 6
    factors = np.swapaxes(inverse, -1, -2).reshape(*pose.shape, 1, entries)
    with np.errstate(invalid="ignore", over="ignore"):
        gradient = (factors @ slopes.reshape(*pose.shape, entries, 6))[..., 0, :]
    usable = np.isfinite(value) & np.isfinite(gradient).all(axis=-1)
    return np.where(usable, value, -np.inf), np.where(usable[..., None], gradient, 0.0)
