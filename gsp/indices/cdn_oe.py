"""CDN_OE: the condition number with an operation ellipsoid."""

from __future__ import annotations

import numpy as np

from gsp.checks import check_type
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.matrices import condition, singular_values
from gsp.geometry.vectors import Array
from gsp.indices.record import ALL_SIX, ON_PLATFORM, Index
from gsp.indices.requirements import require_posture, with_singular_drives
from gsp.indices.spectra import extremes
from gsp.model.posture import Posture
from gsp.model.posture.assembled import finite_rows
from gsp.model.posture.slopes import Slopes


def condition_number_ellipsoid(
    posture: Posture, ellipsoid: Ellipsoid, length: float | None = None
) -> Array:
    """Condition number between actuator speeds and the speeds of an operation ellipsoid.

    sqrt(λ⁺ / λ⁻) of the generalised eigenvalues of (D, JᵀJ), where D measures how fast the six
    vertices of the ellipsoid move. They are the σ⁻² of J L_D⁻ᵀ, so JᵀJ is never formed.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    ellipsoid : Ellipsoid
        In platform axes.
    length : float or None [unit of the design]
        Weight of A1 actuators, which count with the speed L·θ̇; not used without them.

    Returns
    -------
    (...) array [1]
        In [1, ∞]; inf when singular, NaN where the posture is undefined.

    Raises
    ------
    MissingParameter
        If the design has A1 actuators and no length is given.

    *Source: Nawratil, Definition 2 and eqs. (10)–(14), for UPS legs; other legs and the weight of
    A1 actuators are our extension.*
    """
    require_posture(posture)
    check_type("ellipsoid", ellipsoid, Ellipsoid)
    finite = finite_rows(posture, posture.weighted(length))
    rows = ellipsoid.whiten(finite, posture.pose.rotation)
    return with_singular_drives(posture, condition(singular_values(rows)), np.inf)


def _slope(slopes: Slopes, ellipsoid: Ellipsoid, length: float | None = None) -> Array:
    posture = slopes.posture
    rotation = posture.pose.rotation
    rows = ellipsoid.whiten(posture.weighted(length), rotation)
    # Linear in the Jacobian: the ellipsoid is fixed.
    return extremes(
        rows, ellipsoid.whiten(slopes.weighted(length), rotation[..., None, :, :])
    ).condition


CONDITION_NUMBER_ELLIPSOID = Index(
    name="condition_number_ellipsoid",
    symbol="CDN_OE",
    function=condition_number_ellipsoid,
    slope=_slope,
    better="lower",
    best=1.0,
    worst=np.inf,
    parameters=("ellipsoid", "length"),
    needs=("ellipsoid",),
    length_for="angular",
    unit_power="1",
    source="Nawratil, Definition 2",
    properties=ALL_SIX,
    invariance=ON_PLATFORM,
)
