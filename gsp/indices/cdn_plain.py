"""CDN: the plain condition number, which mixes units and depends on the frame."""

from __future__ import annotations

import numpy as np

from gsp.geometry.frames.changes import about_point
from gsp.geometry.matrices import condition, singular_values
from gsp.geometry.vectors import Array
from gsp.indices.record import Index, Invariance, Properties
from gsp.indices.requirements import require_posture
from gsp.indices.spectra import extremes
from gsp.model.posture import Posture
from gsp.model.posture.assembled import finite_rows
from gsp.model.posture.slopes import Slopes


def condition_number_plain(posture: Posture) -> Array:
    """Condition number of the inverse Jacobian without scaling, moments about the base origin.

    It changes with the unit of length and with the origin of the base frame, so values of
    different designs are not comparable. It is included because much of the literature prints it.

    Parameters
    ----------
    posture : Posture, batch shape (...)

    Returns
    -------
    (...) array [mixed]
        In [1, ∞]; inf when singular, and where the value is above 1e15, as for rows of mixed units
        in a very small or very large unit; NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture.

    *Source: Nawratil, §2.1 and eqs. (1), (5), after Salisbury and Craig. For legs other than UPS
    it is the same number of the same matrix: our extension.*
    """
    require_posture(posture)
    values = singular_values(_about_base(posture))
    return np.where(posture.singular(), np.inf, condition(values))


def _about_base(posture: Posture) -> Array:
    rows = finite_rows(posture, posture.jacobian)
    return about_point(rows, -posture.pose.position[..., None, :])


def _slope(slopes: Slopes) -> Array:
    posture = slopes.posture
    turned = about_point(slopes.jacobian, -posture.pose.position[..., None, None, :])
    found = extremes(_about_base(posture), turned).condition
    return np.where(posture.singular()[..., None], np.nan, found)


CONDITION_NUMBER_PLAIN = Index(
    name="condition_number_plain",
    symbol="CDN",
    function=condition_number_plain,
    slope=_slope,
    better="lower",
    best=1.0,
    worst=np.inf,
    parameters=(),
    needs=(),
    length_for="",
    unit_power="no power",
    source="Nawratil, §2.1",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=True,
        motion_invariant=False,
        similarity_invariant=False,
        geometric=False,
        real_time=True,
    ),
    invariance=Invariance(base_shift="changes", exchange="changes"),
    routine=False,
)
