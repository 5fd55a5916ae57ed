"""|det J| and what is made of it: manipulability, and the quality index λ."""

from __future__ import annotations

import numpy as np

from gsp import determinant
from gsp.checks import check_positive
from gsp.geometry.matrices import absolute_determinant
from gsp.geometry.vectors import Array
from gsp.indices.record import Index, Properties
from gsp.indices.requirements import require_posture
from gsp.model.posture import Posture


def manipulability(posture: Posture, length: float | None = None) -> Array:
    """|det J|, or sqrt(det JᵀJ) for redundant designs.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        If given, the homogeneous Jacobian is taken, and the value has no unit. `gsp.evaluate` and
        `gsp.rank` never give it: their columns of |det J| are in the unit of the design.

    Returns
    -------
    (...) array [unit of the design, to the power 3 − k]
        ≥ 0; with k angular actuators its unit is the unit of the design to the power 3 − k.
        0 when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture, or the length is not positive.

    *Source: Nawratil, §3.1, after Yoshikawa; Lee2000, eq. (1).*
    """
    require_posture(posture)
    rows = posture.jacobian if length is None else posture.homogeneous(length)
    return np.where(posture.singular(length), 0.0, absolute_determinant(rows))


MANIPULABILITY = Index(
    "manipulability", "|det J|", manipulability, "higher", np.inf, 0.0,
    (), (), "", "length^(3 − n_A1)", "Nawratil, §3.1",
    Properties(True, True, True, False, False, True),
)  # fmt: skip


def quality_index(posture: Posture, maximum: float | None = None) -> Array:
    """Quality index of Lee and Duffy, λ = |det J| / |det J|max.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    maximum : float or None [unit of |det J|]
        |det J|max > 0, in the unit that `manipulability` has for the design. None finds it with
        `gsp.determinant.maximum`, which says how and over which poses: over all of them, or over
        the default box of a design with D2 or D4 rows.

    Returns
    -------
    (...) array [1]
        In [0, 1] if `maximum` is the maximum over poses that hold these (outside of the default
        box it may be larger); 0 when singular, NaN where the posture is undefined, and everywhere
        for a design that is singular in every pose.

    Raises
    ------
    InvalidInput
        If `maximum` is not a positive number.

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> quality_index(octahedron.at(gsp.Pose([[0, 0, 1], [0, 0, 2]]))).round(3)
    array([1.   , 0.512])

    *Source: Lee2000, eq. (1). That |det J|max of designs with D2 or D4 rows is taken over a
    stated domain of poses is ours.*
    """
    require_posture(posture)
    if maximum is None:
        largest = determinant.maximum(posture.design).value
    else:
        largest = check_positive("maximum", maximum)
    if largest == 0.0:
        return np.full(posture.shape, np.nan)
    return manipulability(posture) / largest


QUALITY_INDEX = Index(
    "quality_index", "λ", quality_index, "higher", 1.0, 0.0,
    ("maximum",), ("maximum",), "", "1", "Lee2000, eq. (1)",
    Properties(True, True, True, True, False, False),
)  # fmt: skip
