"""CDN_CL: the condition number with a length, and its reciprocal; the smallest singular value."""

from __future__ import annotations

import numpy as np

from gsp.geometry.matrices import condition, reciprocal_condition
from gsp.geometry.vectors import Array
from gsp.indices.record import ALL_SIX, AT_PLATFORM_ORIGIN, Index
from gsp.indices.requirements import require_posture
from gsp.indices.spectra import Extremes, extremes
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Slopes


def condition_number(posture: Posture, length: float) -> Array:
    """Condition number of the homogeneous Jacobian, σ_max / σ_min.

    Twists refer to the platform origin, so another origin gives another value.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float [unit of the design]
        Characteristic length L > 0.

    Returns
    -------
    (...) array [1]
        In [1, ∞]; inf when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `length` is not a positive number.

    *Source: Nawratil, §2.1.1 (concept A); TozKucuk2016, §4.3 for the homogeneous Jacobian.*
    """
    require_posture(posture)
    return condition(posture.singular_values(length))


def _extremes(slopes: Slopes, length: float) -> Extremes:
    return extremes(slopes.posture.homogeneous(length), slopes.homogeneous(length))


def _condition_slope(slopes: Slopes, length: float) -> Array:
    return _extremes(slopes, length).condition


def _reciprocal_slope(slopes: Slopes, length: float) -> Array:
    return _extremes(slopes, length).reciprocal


def _smallest_slope(slopes: Slopes, length: float) -> Array:
    return _extremes(slopes, length).low_rise


CONDITION_NUMBER = Index(
    name="condition_number",
    symbol="CDN_CL",
    function=condition_number,
    slope=_condition_slope,
    better="lower",
    best=1.0,
    worst=np.inf,
    parameters=("length",),
    needs=("length",),
    length_for="",
    unit_power="1",
    source="Nawratil, §2.1.1",
    properties=ALL_SIX,
    invariance=AT_PLATFORM_ORIGIN,
)


def local_conditioning(posture: Posture, length: float) -> Array:
    """Reciprocal of the condition number of the homogeneous Jacobian, σ_min / σ_max.

    Its mean over the poses of a workspace is the global conditioning index GCI. A singular pose
    counts as 0 in this mean, while it makes the mean of the condition number infinite.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float [unit of the design]
        Characteristic length L > 0.

    Returns
    -------
    (...) array [1]
        In [0, 1]; 0 when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `length` is not a positive number.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> bool(0.0 < local_conditioning(d.at(d.home), 95.0) < 1.0)
    True

    *Source: the indices of Gosselin and Angeles (1991), J. Mech. Design 113.*
    """
    require_posture(posture)
    return reciprocal_condition(posture.singular_values(length))


LOCAL_CONDITIONING = Index(
    name="local_conditioning",
    symbol="LCI",
    function=local_conditioning,
    slope=_reciprocal_slope,
    better="higher",
    best=1.0,
    worst=0.0,
    parameters=("length",),
    needs=("length",),
    length_for="",
    unit_power="1",
    source="Gosselin and Angeles (1991)",
    properties=ALL_SIX,
    invariance=AT_PLATFORM_ORIGIN,
    routine=False,
)


def minimum_singular_value(posture: Posture, length: float) -> Array:
    """Smallest singular value of the homogeneous Jacobian.

    Twists refer to the platform origin, so another origin gives another value.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float [unit of the design]
        Characteristic length L > 0.

    Returns
    -------
    (...) array [1]
        In [0, √(n/3)] for n actuated distances; 0 when singular, NaN where undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture, or the length is not positive.

    *Source: TozKucuk2016, §1 (named among the indices based on the inverse Jacobian).*
    """
    require_posture(posture)
    values = posture.singular_values(length)
    return np.where(reciprocal_condition(values) == 0.0, 0.0, values[..., -1])


MINIMUM_SINGULAR_VALUE = Index(
    name="minimum_singular_value",
    symbol="σ_min",
    function=minimum_singular_value,
    slope=_smallest_slope,
    better="higher",
    best=np.inf,
    worst=0.0,
    parameters=("length",),
    needs=("length",),
    length_for="",
    unit_power="1",
    source="TozKucuk2016, §1",
    properties=ALL_SIX,
    invariance=AT_PLATFORM_ORIGIN,
)
