"""k_x, k_y, k_z: the stiffness along the axes of the base, of actuators of unit stiffness."""

from __future__ import annotations

import numpy as np

from gsp import arguments
from gsp.geometry.vectors import Array
from gsp.indices.record import Index, Invariance, Properties
from gsp.indices.requirements import require_posture, with_singular_drives
from gsp.indices.spectra import inverse_and_slopes
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Slopes
from gsp.statics.stiffness_matrix import weighted_inverse


def stiffness_x(posture: Posture, length: float | None = None) -> Array:
    """Stiffness along the x-axis of the base, for actuators of unit stiffness: 1/(nᵀ K⁻¹ n).

    A force along n = (1, 0, 0) through the platform origin, divided by how far it moves that origin
    along n, while the platform is free to move across n and to turn. K is Jᵀ diag(k) J with k = 1
    for distances and L² for angles, so a value is in units of the stiffness of one actuator. It
    equals the least sum of the squared actuator rates of all motions whose velocity along n is 1,
    with angles counted as L·θ̇. Without drives at the base it is at most the number of distances.

    `gsp.statics.directional_stiffness` has other directions, moments, unlike actuators and preload.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        Characteristic length L > 0, of angular actuators; not used without them.

    Returns
    -------
    (...) array [stiffness of an actuator]
        In [0, ∞). 0 when singular, also where the motion that no actuator holds does not move the
        origin along n: the values of poses near such a one are larger. NaN where the posture is
        undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture, or the length is not a positive number.
    MissingParameter
        If the design has angular actuators and no length is given.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("dehaeze-cubic-centred")
    >>> float(gsp.indices.stiffness_x(d.at(d.home)).round(12))
    2.0

    *Source: the definition; K by Gosselin (1990), IEEE Trans. Robotics Autom. 6*
    """
    return _along(posture, length, axis=0)


def stiffness_y(posture: Posture, length: float | None = None) -> Array:
    """Stiffness along the y-axis of the base, for actuators of unit stiffness.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        Characteristic length L > 0, of angular actuators; not used without them.

    Returns
    -------
    (...) array [stiffness of an actuator]
        As `stiffness_x`.

    Raises
    ------
    InvalidInput, MissingParameter
        As `stiffness_x`.

    *Source: as `stiffness_x`*
    """
    return _along(posture, length, axis=1)


def stiffness_z(posture: Posture, length: float | None = None) -> Array:
    """Stiffness along the z-axis of the base, for actuators of unit stiffness.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        Characteristic length L > 0, of angular actuators; not used without them.

    Returns
    -------
    (...) array [stiffness of an actuator]
        As `stiffness_x`.

    Raises
    ------
    InvalidInput, MissingParameter
        As `stiffness_x`.

    *Source: as `stiffness_x`*
    """
    return _along(posture, length, axis=2)


def _along(posture: Posture, length: float | None, *, axis: int) -> Array:
    require_posture(posture)
    posture.weighted(length)  # raises an error if a length is missing or wrong
    scale = 1.0 if length is None else arguments.size("length", length)
    weights = np.where(posture.angular, scale, 1.0)
    # A row of (W J)⁺ is not zero: W J has full rank, or the row is NaN. A length of 1e-100 in a
    # design of a size of 1e90 makes it infinite.
    moved = weighted_inverse(posture, weights)[..., axis, :]
    with np.errstate(over="ignore"):
        found = 1.0 / (moved**2).sum(axis=-1)
    return with_singular_drives(posture, np.where(posture.singular(), 0.0, found), 0.0)


def _slope(slopes: Slopes, length: float | None, *, axis: int) -> Array:
    """Return the derivative of 1/|r|² for a row r of J⁺, homogeneous: −2 (r · dr)/|r|⁴."""
    posture = slopes.posture
    scale = posture.design.rms_radius if length is None else length
    inverse, moved = inverse_and_slopes(posture.homogeneous(scale), slopes.homogeneous(scale))
    row, rate = inverse[..., None, axis, :], moved[..., axis, :]
    with np.errstate(invalid="ignore", divide="ignore"):
        found = -2.0 * (row * rate).sum(axis=-1) / (row**2).sum(axis=-1) ** 2
    usable = posture.defined & ~posture.singular()
    return np.where(usable[..., None], found, np.nan)


# By name, and not by `partial`: records are compared by value, also with their copies by pickle.
def _slope_x(slopes: Slopes, length: float | None = None) -> Array:
    return _slope(slopes, length, axis=0)


def _slope_y(slopes: Slopes, length: float | None = None) -> Array:
    return _slope(slopes, length, axis=1)


def _slope_z(slopes: Slopes, length: float | None = None) -> Array:
    return _slope(slopes, length, axis=2)


STIFFNESS_X, STIFFNESS_Y, STIFFNESS_Z = (
    Index(
        name=f"stiffness_{name}",
        symbol=f"k_{name}",
        function=function,
        slope=slope,
        better="higher",
        best=np.inf,
        worst=0.0,
        parameters=("length",),
        needs=(),
        length_for="angular",
        unit_power="1",
        source="the definition; K by Gosselin (1990)",
        properties=Properties(
            non_negative=True,
            zero_iff_singular=True,
            # The axes are those of the base.
            motion_invariant=False,
            similarity_invariant=True,
            geometric=True,
            real_time=True,
        ),
        invariance=Invariance(base_turn="changes", platform_shift="changes", exchange="changes"),
        routine=False,
    )
    for name, function, slope in (
        ("x", stiffness_x, _slope_x),
        ("y", stiffness_y, _slope_y),
        ("z", stiffness_z, _slope_z),
    )
)
