"""|det J| (manipulability), and the quality index λ."""

from __future__ import annotations

import warnings

import numpy as np

from gsp import determinant
from gsp.checks import check_positive
from gsp.geometry.matrices import absolute_determinant, log_and_inverse
from gsp.geometry.vectors import Array
from gsp.indices.record import Index, Invariance, Properties
from gsp.indices.requirements import require_posture
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Slopes


def manipulability(posture: Posture, length: float | None = None) -> Array:
    """Return |det J|, or sqrt(det JᵀJ) for redundant designs.

    Without a length it is that of the dimensional Jacobian, in the unit of the design, and
    commensurable with `gsp.determinant.maximum`; with a length it is that of the homogeneous
    Jacobian, which has no unit and must not be divided by such a maximum.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        If given, the homogeneous Jacobian is taken: for six rows, k of them angles, the value is
        divided by length^(3 − k). `gsp.evaluate` and `gsp.rank` never give it: their columns of
        |det J| are in the unit of the design.

    Returns
    -------
    (...) array [unit^(3 − k)]
        ≥ 0, for six rows of which k are angles (A1): the three columns of moments have the unit
        of length, and rows of angles are 1/length times those of distances. Redundant designs
        with A1 rows have no unit, as the powers differ among the terms of det JᵀJ.
        0 when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture or `length` not a positive number.

    *Source: Nawratil, §3.1, after Yoshikawa; Lee2000, eq. (1).*

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> posture = octahedron.at(gsp.Pose([0.0, 0.0, 1.0]))
    >>> float(manipulability(posture).round(3)), float(manipulability(posture, length=0.5).round(3))
    (1.299, 10.392)
    """
    require_posture(posture)
    rows = posture.jacobian if length is None else posture.homogeneous(length)
    return np.where(posture.singular(length), 0.0, absolute_determinant(rows))


def _slope(slopes: Slopes) -> Array:
    """Return |det J| tr(J⁻¹ dJ)."""
    values = manipulability(slopes.posture)
    inverse = log_and_inverse(slopes.posture.jacobian)[1]
    # The trace of a product is the inner product of one factor with the other one transposed.
    traces = np.einsum("...ji,...kij->...k", inverse, slopes.jacobian)
    return np.asarray(np.where(values > 0.0, values, np.nan)[..., None] * traces)


MANIPULABILITY = Index(
    name="manipulability",
    symbol="|det J|",
    function=manipulability,
    slope=_slope,
    better="higher",
    best=np.inf,
    worst=0.0,
    parameters=(),
    needs=(),
    length_for="",
    unit_power="length^(3 − n_A1)",
    source="Nawratil, §3.1",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=True,
        motion_invariant=True,
        similarity_invariant=False,
        geometric=False,
        real_time=True,
    ),
    invariance=Invariance(),
    of_determinant=True,
)


def quality_index(posture: Posture, maximum: float | None = None) -> Array:
    """Return the quality index of Lee and Duffy, λ = |det J| / |det J|max.

    Both are those of the dimensional Jacobian. A found maximum that some pose exceeds is replaced,
    in the store as well, with a MaximumWarning, and λ is computed with the better one.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    maximum : float or None [unit of |det J|]
        |det J|max > 0, in the unit that `manipulability` has for the design without a length.
        None finds it with `gsp.determinant.maximum`, whose record states how and over which poses:
        over all of them, or, where |det J| has no bound over all poses, near the home pose.

    Returns
    -------
    (...) array [1]
        In [0, 1] for poses in the domain of the maximum, to rounding; it may be larger outside,
        and with a `maximum` that is given. 0 when singular, NaN where the posture is undefined.
        For a design that is singular in every pose |det J|max is 0, and λ = 0/0 is NaN, but 0 with
        a `maximum` that is given. For redundant designs with A1 actuators it depends on the unit
        of length, as det JᵀJ adds values of unlike units.

    Raises
    ------
    InvalidInput
        If `maximum` is not a positive number.
    MissingParameter
        If |det J| has no bound over all poses and the design has no home pose.

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> quality_index(octahedron.at(gsp.Pose([[0, 0, 1], [0, 0, 2]]))).round(3)
    array([1.   , 0.512])

    *Source: Lee2000, eq. (1). That |det J|max of designs whose |det J| has no bound is taken over
    a stated domain of poses is ours.*
    """
    require_posture(posture)
    if maximum is not None:
        return manipulability(posture) / check_positive("maximum", maximum)
    found = determinant.reference(posture.design)
    if found.value == 0.0:
        return np.full(posture.shape, np.nan)
    values = manipulability(posture)
    found = determinant.mended(found, posture.design, posture.pose, values / found.value)
    left_out = determinant.outside(found, posture.pose)
    if left_out:
        warnings.warn(
            f"λ at {left_out} of {posture.pose.size} poses: they are not in the domain of the "
            f"maximum of |det J| of {posture.design.name or 'the design'}, and λ may exceed 1",
            determinant.MaximumWarning,
            stacklevel=2,
        )
    return values / found.value


QUALITY_INDEX = Index(
    name="quality_index",
    symbol="λ",
    function=quality_index,
    better="higher",
    best=1.0,
    worst=0.0,
    parameters=("maximum",),
    needs=("maximum",),
    length_for="",
    unit_power="1",
    source="Lee2000, eq. (1)",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=True,
        motion_invariant=True,
        similarity_invariant=True,
        geometric=False,
        real_time=False,
    ),
    invariance=Invariance(),
    of_determinant=True,
    share_of="manipulability",
)
