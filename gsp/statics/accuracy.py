"""Errors of the pose that follow from errors of the joint values, to first order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_type
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array
from gsp.model.posture import Posture
from gsp.statics.stiffness_matrix import per_actuator, weighted_inverse


@dataclass(frozen=True, eq=False, kw_only=True)
class PoseErrors(ReadOnly):
    """Result of `pose_errors`, as displacements (δ, θ) of the platform origin in base axes.

    Attributes
    ----------
    gain : (..., 6, n) array [mixed]
        Displacement per joint error, J⁻¹; of redundant designs that of the pose fitted to all
        joints with the weights 1 / error².
    worst : (..., 6) array [unit of the design, rad]
        Largest displacement along each coordinate if every joint error is at most as given.
    covariance : (..., 6, 6) array [mixed]
        Of the displacement if the given errors are standard deviations of independent joints.
    """

    gain: Array
    worst: Array
    covariance: Array

    @property
    def deviation(self) -> Array:
        """Standard deviations of the displacement, shape (..., 6) [unit of the design, rad].

        *Source: ours: the roots of the diagonal of the covariance*
        """
        return np.sqrt(np.diagonal(self.covariance, axis1=-2, axis2=-1))


def pose_errors(posture: Posture, joint_errors: ArrayLike) -> PoseErrors:
    """Return how errors of the joint values move the platform, to first order.

    Parameters
    ----------
    posture : Posture of batch shape (...)
    joint_errors : float, or (n,) or (..., n) array_like [unit of the design, rad]
        Sizes of the errors, > 0.

    Returns
    -------
    PoseErrors
        NaN where the posture is undefined or singular (see `Posture.singular`).

    Raises
    ------
    InvalidInput
        On other types or shapes, or errors that are not positive.

    *Source: ours, by the pseudoinverse of the Jacobian.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> gsp.statics.pose_errors(d.at(d.home), 0.01).worst.shape
    (6,)
    """
    check_type("posture", posture, Posture)
    errors = per_actuator("joint_errors", joint_errors, posture)
    scaled = weighted_inverse(posture, 1.0 / errors)
    return PoseErrors(
        gain=scaled / errors[..., None, :],
        worst=np.abs(scaled).sum(axis=-1),
        covariance=scaled @ np.swapaxes(scaled, -1, -2),
    )
