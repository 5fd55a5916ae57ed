"""The rigidity rate: the self-motion that a posture has among the similarities."""

from __future__ import annotations

import numpy as np

from gsp.errors import InvalidInput, expected
from gsp.geometry.matrices import defined_matrices, log_and_inverse
from gsp.geometry.vectors import Array, dot, norm
from gsp.indices.record import ALL_SIX, ON_PLATFORM, Index
from gsp.indices.requirements import require_posture
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Slopes


def rigidity_rate(posture: Posture) -> Array:
    """Angle between the self-motion among similarities and the subgroup of Euclidean motions.

    With the platform allowed to grow, v + ω × x + κ x, six locked actuators leave one motion
    (v, ω, κ): φ = arctan(|κ| / |ω|). Only the platform, not the base, is allowed to grow, so the
    value changes when base and platform are exchanged.

    Parameters
    ----------
    posture : Posture, batch shape (...)
        Of a design with six actuators.

    Returns
    -------
    (...) array [rad]
        In [0, π/2]; 0 when singular, π/2 when the platform would grow without turning, NaN where
        the posture is undefined.

    Raises
    ------
    InvalidInput
        If the design does not have six actuators.

    *Source: Nawratil, §3.1, after Lang, Mick and Röschel. The source leaves the invariant form on
    the similarities open; the forms |ω|² and κ² are, up to factors, the only invariant ones, and
    we take both factors as 1. Singular postures have 0 for every motion (ours: a translation
    has no angle). Legs other than UPS are our extension: their lines grow with the platform.*
    """
    require_posture(posture)
    number = len(posture.joint_names)
    if number != 6:
        raise InvalidInput(expected("rigidity_rate", "a design with six actuators", number))
    legs = [row.leg for row in posture.design.rows]
    arms = posture.lines.arm - posture.lines.arm.mean(axis=-2, keepdims=True)
    growth = dot(posture.jacobian[..., :3], arms[..., legs, :]) / posture.design.rms_radius
    rows = np.concatenate((posture.about_centre, growth[..., None]), axis=-1)
    motion = _kernel(rows)
    angle = np.arctan2(np.abs(motion[..., 6]), norm(motion[..., 3:6]))
    return np.where(posture.singular(), 0.0, angle)


def _kernel(matrix: Array) -> Array:
    """Return unit vectors that (..., 6, 7) matrices map to zero, shape (..., 7)."""
    defined = defined_matrices(matrix)
    safe = np.where(defined[..., None, None], matrix, 0.0)
    right = np.linalg.svd(safe, full_matrices=True)[2]
    return np.where(defined[..., None], right[..., -1, :], np.nan)


def _slope(slopes: Slopes) -> Array:
    """Return the derivative of arctan(1 / |ω|), with the motion x = −J⁻¹ g for κ = 1.

    The growth g has the components f · R b. That of another centre differs by a translation.
    """
    posture = slopes.posture
    legs = [row.leg for row in posture.design.rows]
    arms = posture.lines.arm[..., legs, :][..., None, :, :]
    turns = posture.pose.rotation[..., None, None, :, :]
    moved = (turns @ slopes.directions.anchors[:, legs, 3:6, None])[..., 0]
    rows = posture.jacobian[..., None, :, :]
    growth = (dot(rows[..., :3], arms))[..., None]
    rise = (dot(slopes.jacobian[..., :3], arms) + dot(rows[..., :3], moved))[..., None]
    inverse = log_and_inverse(posture.jacobian)[1][..., None, :, :]
    motion = -inverse @ growth
    turn = motion[..., 3:, 0]
    rate = (-inverse @ (rise + slopes.jacobian @ motion))[..., 3:, 0]
    size = norm(turn)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = -dot(turn, rate) / (size * (1.0 + size**2))
    usable = posture.defined & ~posture.singular()
    return np.where(usable[..., None] & (size > 0.0), found, np.nan)


RIGIDITY_RATE = Index(
    name="rigidity_rate",
    symbol="φ",
    function=rigidity_rate,
    slope=_slope,
    better="higher",
    best=np.pi / 2,
    worst=0.0,
    parameters=(),
    needs=(),
    length_for="",
    unit_power="1",
    source="Nawratil, §3.1",
    properties=ALL_SIX,
    invariance=ON_PLATFORM,
    actuators=6,
    routine=False,
)
