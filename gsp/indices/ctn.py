"""CTN: the control number."""

from __future__ import annotations

import numpy as np

from gsp.geometry.matrices import defined_matrices, reciprocal_condition, singular_values, whiten
from gsp.geometry.vectors import Array
from gsp.indices.record import ALL_SIX, Index, Invariance
from gsp.indices.requirements import require_posture
from gsp.indices.spectra import whitened_extremes
from gsp.model.posture import Posture
from gsp.model.posture.assembled import finite_rows
from gsp.model.posture.slopes import Slopes


def control_number(posture: Posture, length: float | None = None) -> Array:
    """Control number: ratio of the extreme gains from actuator rates to passive joint rates.

    sqrt(λ₋ / λ₊) of the generalised eigenvalues of (T, JᵀJ), where T sums the squared rates of
    the passive joints. They are the σ⁻² of J R⁻¹ with T = RᵀR, and neither T nor JᵀJ is formed.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        Characteristic length L > 0 that passive slides are divided by and A1 speeds multiplied
        with; needed only for legs with cylindrical joints.

    Returns
    -------
    (...) array [1]
        In [0, 1]; 0 when singular, 1 at best, NaN where the posture is undefined.

    Raises
    ------
    MissingParameter
        If a leg has cylindrical joints and no length is given.

    *Source: Nawratil, Definition 3 and eqs. (18)–(22), for UPS legs. Ours: legs with cylindrical
    joints, for which ζ_i adds the squares of the passive slide rates over L to the squared turn
    rates of the unit vector of the leg (of the common normal, for CCC) seen from base and
    platform; of an A1 leg the slide along the common normal is passive, too.*
    """
    require_posture(posture)
    rates = finite_rows(posture, posture.weighted(length))
    rows = whiten(rates, posture.passive_rates(length))
    # A twist that moves no passive joint exists at singular postures only (Nawratil, Theorem 4).
    finite = defined_matrices(rows)
    values = singular_values(np.where(finite[..., None, None], rows, 0.0))
    return np.where(posture.defined, reciprocal_condition(values), np.nan)


def _slope(slopes: Slopes, length: float | None = None) -> Array:
    posture = slopes.posture
    return whitened_extremes(
        posture.weighted(length),
        posture.passive_rates(length),
        slopes.weighted(length),
        slopes.passive_rates(length),
    ).reciprocal


CONTROL_NUMBER = Index(
    name="control_number",
    symbol="CTN",
    function=control_number,
    slope=_slope,
    better="higher",
    best=1.0,
    worst=0.0,
    parameters=("length",),
    needs=(),
    length_for="cylindrical",
    unit_power="1",
    source="Nawratil, Definition 3",
    properties=ALL_SIX,
    invariance=Invariance(),
)
