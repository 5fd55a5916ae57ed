"""Rotation matrices: from named angle sets and rotation vectors, and their check."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import InvalidInput, InvalidRotation, brief, expected
from gsp.geometry.vectors import Array

# How far RᵀR may be from I, element by element, for R to count as a rotation.
ROTATION_TOLERANCE = 1e-9

# Named angle sets: scipy's sequence (capitals turn about moving axes) and the order of the angles.
ANGLE_SETS = MappingProxyType(
    {
        # R = Rz(γ) Ry(β) Rx(α), as pinocchio.rpy. Source: TozKucuk2016, verified on its joints.
        "rpy": ("xyz", (0, 1, 2)),
        # R = Ry(β) Rx(α) Rz(γ): approach vector by α and β, roll γ. Source: Workspace-3, §3.2.
        "approach-roll": ("YXZ", (1, 0, 2)),
    }
)


def rotation_from_angles(angles: ArrayLike, order: str = "rpy", *, degrees: bool = False) -> Array:
    """Rotation matrices from three angles, shape (..., 3) to (..., 3, 3).

    Parameters
    ----------
    angles : (..., 3) array_like [rad, or degrees]
    order : str
        "rpy" (R = Rz Ry Rx), "approach-roll" (R = Ry(β) Rx(α) Rz(γ) of (α, β, γ)), or a sequence
        of `scipy.spatial.transform.Rotation.from_euler` such as "ZYX" or "xyz".

    Raises
    ------
    InvalidInput
        On a wrong shape, numbers that are not finite, or an unknown order.
    """
    from scipy.spatial.transform import Rotation

    values = check_array("angles", angles, (3,))
    sequence, places = angle_set(order)
    turn = Rotation.from_euler(sequence, values[..., places].reshape(-1, 3), degrees=degrees)
    return np.asarray(turn.as_matrix(), dtype=np.float64).reshape(*values.shape, 3)


def angle_set(order: str) -> tuple[str, tuple[int, int, int]]:
    """Sequence for scipy, and the place of each of its angles in the set; checked."""
    from scipy.spatial.transform import Rotation

    try:
        sequence, places = ANGLE_SETS.get(order, (order, (0, 1, 2)))
        Rotation.from_euler(sequence, np.zeros((1, 3)))
    except (TypeError, ValueError) as error:
        wanted = ", ".join(ANGLE_SETS) + ' or a sequence of three axes such as "ZYX"'
        raise InvalidInput(expected("order", wanted, brief(order))) from error
    return sequence, places


def rotation_from_vector(vector: ArrayLike) -> Array:
    """Rotation matrices from rotation vectors (axis × angle [rad]), (..., 3) to (..., 3, 3)."""
    from scipy.spatial.transform import Rotation

    values = check_array("rotation vector", vector, (3,))
    turn = Rotation.from_rotvec(values.reshape(-1, 3))
    return np.asarray(turn.as_matrix(), dtype=np.float64).reshape(*values.shape, 3)


def angle_axes(angles: Array, order: str = "rpy") -> Array:
    """Axes, in base axes, about which each angle of a set turns: ω = Σ axis_i · rate_i.

    Parameters
    ----------
    angles : (..., 3) array [rad]
    order : str
        See `rotation_from_angles`.

    Returns
    -------
    (..., 3, 3) array
        Its columns are the axes of the three angles.
    """
    from scipy.spatial.transform import Rotation

    sequence, places = angle_set(order)
    # Turns about fixed axes are those about moving axes in the opposite order.
    moving = (0, 1, 2) if sequence.isupper() else (2, 1, 0)
    axes, before = np.empty((*angles.shape, 3)), np.eye(3)
    for i in moving:
        place = places[i]
        axes[..., :, place] = before @ np.eye(3)["XYZ".index(sequence[i].upper())]
        turn = Rotation.from_euler(sequence[i].upper(), angles[..., place].reshape(-1, 1))
        before = before @ turn.as_matrix().reshape(*angles.shape, 3)
    return axes


def check_rotation(what: str, value: ArrayLike) -> Array:
    """Return `value` as rotation matrices (..., 3, 3), or raise InvalidRotation."""
    matrix = check_array(what, value, (3, 3))
    with np.errstate(over="ignore", invalid="ignore"):
        defect = np.abs(np.swapaxes(matrix, -1, -2) @ matrix - np.eye(3)).max(axis=(-2, -1))
        determinant = np.linalg.det(matrix)
    bad = ~(defect <= ROTATION_TOLERANCE) | (determinant < 0.0)
    if bad.any():
        where = tuple(int(i) for i in np.argwhere(bad)[0])
        got = f"|RᵀR − I| = {defect[where]:.3g} and det R = {determinant[where]:.6g}"
        place = f"at index {list(where)}" if where else ""
        raise InvalidRotation(expected(what, "a rotation matrix (RᵀR = I, det R = 1)", got, place))
    return matrix
