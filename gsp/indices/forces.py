"""F_max: the greatest actuator force that a wrench of unit size needs."""

from __future__ import annotations

import numpy as np

from gsp import arguments
from gsp.geometry.matrices import defined_matrices, full_rank
from gsp.geometry.vectors import Array
from gsp.indices.record import AT_PLATFORM_ORIGIN, Index, Properties
from gsp.indices.requirements import require_posture, with_singular_drives
from gsp.indices.spectra import REPEATED_GAP, inverse_and_slopes, shared_slope
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Slopes


def greatest_force(posture: Posture, length: float) -> Array:
    """Greatest force of an actuator over all external wrenches of unit size.

    The size of a wrench is sqrt(|f|² + |m|²/L²), with the moment m about the platform origin.
    Torques of A1 actuators are divided by L. It is the greatest norm of a row of J⁻ᵀ, with J
    homogeneous; of redundant designs that of the pseudo-inverse, whose forces have the least sum
    of squares. A payload of weight G whose centre is up to a distance L from the platform origin
    has a size of at most √2 G.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float [unit of the design]
        Characteristic length L > 0.

    Returns
    -------
    (...) array [1]
        In (0, ∞]; inf when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture, or the length is not positive.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.hexapod(1.0, 0.4, 0.6, 0.4, 1.2)
    >>> bool(greatest_force(d.at(d.home), 0.5) > 1 / 6)
    True

    *Source: ours; forces by J⁻ᵀ as in `Posture.actuator_forces`.*
    """
    return np.asarray(_forces(posture, length).max(axis=-1))


def _forces(posture: Posture, length: float) -> Array:
    """Return the greatest force of each actuator, shape (..., n): smooth where J is regular."""
    require_posture(posture)
    rows = posture.homogeneous(arguments.size("length", length))
    known = defined_matrices(rows)
    # J = U S Vᵀ: row i of the pseudo-inverse of Jᵀ has the norm of row i of U S⁻¹.
    left, values, _ = np.linalg.svd(
        np.where(known[..., None, None], rows, 0.0), full_matrices=False
    )
    regular = known & full_rank(values)
    inverses = 1.0 / np.where(regular[..., None], values, 1.0)
    norms = np.sqrt(((left * inverses[..., None, :]) ** 2).sum(axis=-1))
    undefined = with_singular_drives(posture, np.where(known, np.inf, np.nan), np.inf)
    return np.where(regular[..., None], norms, undefined[..., None])


def _slope(slopes: Slopes, length: float) -> Array:
    """Return the derivative of the greatest norm of a column of J⁺.

    Actuators with equal forces need equal slopes.
    """
    rows = slopes.posture.homogeneous(length)
    whole, moved = inverse_and_slopes(rows, slopes.homogeneous(length))
    inverse = whole[..., None, :, :]
    norms = np.linalg.norm(inverse, axis=-2)
    with np.errstate(invalid="ignore", divide="ignore"):
        each = (inverse * moved).sum(axis=-2) / norms
        greatest = norms.max(axis=-1, keepdims=True)
        chosen = (greatest - norms <= REPEATED_GAP * greatest)[..., 0, :]
    found = shared_slope(each[..., None] * np.eye(rows.shape[-2]), chosen)
    regular = np.isfinite(greatest_force(slopes.posture, length))[..., None]
    return np.where(regular, found, np.nan)


GREATEST_FORCE = Index(
    name="greatest_force",
    symbol="F_max",
    function=greatest_force,
    slope=_slope,
    better="lower",
    best=0.0,
    worst=np.inf,
    parameters=("length",),
    needs=("length",),
    length_for="",
    unit_power="1",
    source="ours",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=True,
        motion_invariant=True,
        similarity_invariant=True,
        # A force, not a motion.
        geometric=False,
        real_time=True,
    ),
    invariance=AT_PLATFORM_ORIGIN,
    routine=False,
    of_actuators=_forces,
)
