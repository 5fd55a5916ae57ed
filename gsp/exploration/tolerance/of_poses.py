"""`pose_tolerance`: where manufactured copies stand if they are driven as the design."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.arguments import bounded_array
from gsp.errors import InvalidInput, expected
from gsp.exploration.tolerance.deviations import (
    Deviations,
    error_values,
    standard_deviations,
)
from gsp.exploration.tolerance.shares import shares
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames import log3
from gsp.geometry.frames.changes import twists_about_point
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.kinematics.forward_solution import forward
from gsp.model.design import Design, check_undriven
from gsp.model.dimensions import Dimensions
from gsp.progress import Progress, Report, meter
from gsp.statics.accuracy import pose_errors

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, kw_only=True)
class PoseTolerance(ReadOnly):
    """Result of `pose_tolerance`, for m copies and p coordinates of their dimensions.

    Displacements (δ, θ) are those of the point in base axes, and the rotation vector of the turn.

    Attributes
    ----------
    gain : (..., 6, p) array [mixed]
        Displacement per error of a coordinate, to first order.
    first_order : (..., 6, 6) array [mixed]
        Covariance of the displacement to first order.
    displacements : (m, ..., 6) array [unit, rad]
        Of the copies; NaN where forward kinematics finds no pose from the nominal one.
    errors : (m, p) array [unit, rad]
        Of the dimensions of the copies.
    names : tuple of str
        Of the coordinates: see `Deviations.sample`.
    """

    gain: Array
    first_order: Array
    displacements: Array
    errors: Array
    names: tuple[str, ...]
    _dimensions: Dimensions
    _spread: Array

    @property
    def mean(self) -> Array:
        """Mean displacement of the copies, shape (..., 6) [unit, rad]."""
        known = ~np.isnan(self.displacements)
        total = np.where(known, self.displacements, 0.0).sum(axis=0)
        with np.errstate(invalid="ignore"):
            return np.asarray(total / known.sum(axis=0))

    @property
    def covariance(self) -> Array:
        """Covariance of the displacements of the copies, shape (..., 6, 6) [mixed]."""
        found = self.displacements - self.mean
        known: Mask = np.asarray(~np.isnan(found).any(axis=-1))
        found = np.where(known[..., None], found, 0.0)
        number = known.sum(axis=0)[..., None, None]
        products = np.einsum("m...i,m...j->...ij", found, found)
        return np.asarray(products / np.where(number > 1, number - 1.0, np.nan))

    @property
    def lost(self) -> Array:
        """Share [1] of the copies for which no pose was found, shape (...), in [0, 1]."""
        return np.asarray(np.isnan(self.displacements).any(axis=-1).mean(axis=0))

    def quantiles(self, share: float = 0.95) -> Array:
        """Return bounds of |δ| and |θ| that a share of the copies that were found keeps.

        Parameters
        ----------
        share : float [1]
            In [0, 1].

        Returns
        -------
        (..., 2) array [unit, rad]

        Raises
        ------
        InvalidInput
            On another number.
        """
        part = arguments.share("share", share)
        halves = np.stack(np.split(self.displacements, 2, axis=-1), axis=-2)
        sizes = np.sort(np.linalg.norm(halves, axis=-1), axis=0).reshape(len(halves), -1)
        found = [
            np.quantile(x[: (~np.isnan(x)).sum()], part) if x[0] >= 0 else np.nan for x in sizes.T
        ]
        return np.array(found).reshape(halves.shape[1:-1])

    def shares(self) -> pd.DataFrame:
        """Return which errors matter most: shares of the variances, to first order.

        Returns
        -------
        pandas.DataFrame
            One row per part of a leg, the greatest share of the position on top: part, leg (from
            1), position and rotation: shares of the expected |δ|² and |θ|², over all poses.
        """
        squares = (self.gain * self._spread) ** 2
        per = squares.reshape(-1, 6, len(self.names))
        known = ~np.isnan(per).any(axis=(1, 2))
        variances = {
            "position": per[known, :3].sum(axis=(0, 1)),
            "rotation": per[known, 3:].sum(axis=(0, 1)),
        }
        return shares(self._dimensions, variances)


@arguments.validated(
    design=check_undriven,
    pose=arguments.kind(Pose, "a gsp.Pose"),
    deviations=arguments.kind(Deviations, "a gsp.exploration.Deviations"),
    samples=arguments.integer(2),
    seed=arguments.integer(0),
)
def pose_tolerance(
    design: Design,
    pose: Pose,
    deviations: Deviations,
    *,
    point: ArrayLike = (0.0, 0.0, 0.0),
    samples: int = 1024,
    seed: int = 0,
    progress: Progress = None,
) -> PoseTolerance:
    """Return where manufactured copies of a design stand if they are driven as the design.

    The readings of the joints are those of the design at the pose; the copy then stands where its
    own dimensions and zero points put it, by forward kinematics: quasi-Monte Carlo. To first order,
    (δ, θ) = −J⁻¹ ∂(readings)/∂(dimensions) · errors.

    Parameters
    ----------
    design : Design
        With six actuators.
    pose : Pose of batch shape (...) [unit]
    deviations : Deviations
    point : (3,) array_like [unit]
        Whose displacement is given, in platform axes.
    samples : int
        Number of copies; a power of two is best.
    seed : int
    progress : see `gsp.rank`

    Returns
    -------
    PoseTolerance
        NaN where the posture of the design is undefined or singular.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type or value, sizes that do not fit the design, or other than six
        actuators.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> errors = gsp.exploration.Deviations(base_points=1e-4, joints=1e-4)
    >>> found = gsp.exploration.pose_tolerance(d, d.home, errors, samples=64)
    >>> found.displacements.shape
    (64, 6)
    """
    if len(design.joint_names) != 6:
        raise InvalidInput(expected("design", "six actuators", len(design.joint_names)))
    arm = bounded_array("point", point, (3,))
    if arm.ndim != 1:
        raise InvalidInput(expected("point", "a single point", f"shape {arm.shape}"))
    dimensions = Dimensions.of(design)
    spread = standard_deviations(deviations, dimensions)
    values = error_values(deviations, dimensions, samples, seed)
    gain = _gain(dimensions, pose, pose.rotation @ arm)
    half = gain * spread
    with meter(progress, "copies") as report:
        found = _displacements(dimensions, pose, values, arm, report)
    return PoseTolerance(
        gain=gain,
        first_order=half @ np.swapaxes(half, -1, -2),
        displacements=found,
        errors=values,
        names=dimensions.names,
        _dimensions=dimensions,
        _spread=spread,
    )


def _gain(dimensions: Dimensions, pose: Pose, arm: Array) -> Array:
    """Return displacements (..., 6, p) of a point at `arm` per error, to first order."""
    posture = dimensions.design.at(pose)
    of_origin = -pose_errors(posture, 1.0).gain @ dimensions.reading_slopes(posture)
    twists = np.swapaxes(of_origin, -1, -2)
    return np.swapaxes(twists_about_point(twists, arm[..., None, :]), -1, -2)


def _displacements(
    dimensions: Dimensions, pose: Pose, values: Array, arm: Array, report: Report
) -> Array:
    """Return the displacements (m, ..., 6) of copies."""
    readings = dimensions.design.at(pose).joints
    place, back = pose.position + pose.rotation @ arm, np.swapaxes(pose.rotation, -1, -2)
    found = np.empty((len(values), *pose.shape, 6))
    for i, errors in enumerate(values):
        joints = readings + dimensions.zero_points(errors)
        there = forward(dimensions.at(errors), joints, pose).pose
        found[i, ..., :3] = there.position + there.rotation @ arm - place
        found[i, ..., 3:] = log3(there.rotation @ back)
        report(i + 1, len(values))
    return found
