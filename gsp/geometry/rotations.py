"""Rotation matrices: from named angle sets and back, their angle, and their check."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, plain_text, reading
from gsp.errors import InvalidRotation, expected
from gsp.geometry.vectors import Array, Mask, norm

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

# Largest difference of an element of RᵀR from I for R to count as a rotation, and for R of single
# precision.
ROTATION_TOLERANCE = 1e-9
SINGLE_TOLERANCE = 1e-6

# Named angle sets: scipy's sequence (capitals turn about moving axes) and the order of the angles.
ANGLE_SETS = MappingProxyType(
    {
        # R = Rz(γ) Ry(β) Rx(α), as pinocchio.rpy. Source: TozKucuk2016, verified on its joints.
        "rpy": ("xyz", (0, 1, 2)),
        # R = Ry(β) Rx(α) Rz(γ): approach vector by α and β, roll γ. Source: Workspace-3, §3.2.
        "approach-roll": ("YXZ", (1, 0, 2)),
    }
)


@arguments.validated(degrees=arguments.flag)
def rotation_from_angles(angles: ArrayLike, order: str = "rpy", *, degrees: bool = False) -> Array:
    """Return rotation matrices from three angles.

    Parameters
    ----------
    angles : (..., 3) array_like [rad, or degrees]
    order : str
        "rpy" (R = Rz Ry Rx), "approach-roll" (R = Ry(β) Rx(α) Rz(γ) of (α, β, γ)), or a sequence
        of `scipy.spatial.transform.Rotation.from_euler` such as "ZYX" or "xyz".
    degrees : bool
        Whether the angles are in degrees.

    Returns
    -------
    (..., 3, 3) array [1]

    Raises
    ------
    InvalidInput
        On a wrong shape, numbers that are not finite, or an unknown order.

    *Source: Murray1994, chapter 2: products of rotations about coordinate axes.*
    """
    from scipy.spatial.transform import Rotation

    values = check_array("angles", angles, (3,))
    sequence, places = angle_set(order)
    turn = Rotation.from_euler(sequence, values[..., places].reshape(-1, 3), degrees=degrees)
    return np.asarray(turn.as_matrix(), dtype=np.float64).reshape(*values.shape, 3)


def angle_set(order: str) -> tuple[str, tuple[int, int, int]]:
    """Return scipy's sequence, and the place of each of its angles in the set; checked."""
    from scipy.spatial.transform import Rotation

    wanted = ", ".join(ANGLE_SETS) + ' or a sequence of three axes such as "ZYX"'
    order = plain_text(order)
    with reading("order", wanted, order):
        sequence, places = ANGLE_SETS.get(order, (order, (0, 1, 2)))
        Rotation.from_euler(sequence, np.zeros((1, 3)))
    return sequence, places


@arguments.validated(rotation=arguments.array(3, 3, finite=False), degrees=arguments.flag)
def angles_from_rotation(rotation: Array, order: str = "rpy", *, degrees: bool = False) -> Array:
    """Return the three angles of rotations in a named order: the inverse of `rotation_from_angles`.

    Parameters
    ----------
    rotation : (..., 3, 3) array [1]
        Rotations, or NaN.
    order : str
        See `rotation_from_angles`.
    degrees : bool
        Whether the angles are returned in degrees.

    Returns
    -------
    (..., 3) array [rad, or degrees]
        NaN where the rotation is NaN. Where the second turn aligns the axes of the others, the
        third angle of scipy's sequence is 0.

    Raises
    ------
    InvalidInput
        On an unknown order.
    InvalidRotation
        On a matrix that is neither a rotation nor NaN.

    *Source: Murray1994, chapter 2: the inverse of products of rotations about coordinate axes.*
    """
    sequence, places = angle_set(order)
    finite = np.isfinite(rotation).all(axis=(-2, -1))
    check_rotation("rotation", rotation[finite])
    turn, known = known_rotations(rotation)
    turned = turn.as_euler(sequence, degrees=degrees, suppress_warnings=True)  # type: ignore[call-overload]
    named = np.where(known[:, None], turned[:, np.argsort(places)], np.nan)
    return np.asarray(named, dtype=np.float64).reshape(rotation.shape[:-1])


def known_rotations(rotation: Array) -> tuple[Rotation, Mask]:
    """Return rotations (..., 3, 3) as scipy's, (n,), and which of them are finite, (n,).

    Scipy raises an error for a batch with a NaN, such as the poses of a failed search; such an
    element is replaced by the identity.
    """
    from scipy.spatial.transform import Rotation

    flat = rotation.reshape(-1, 3, 3)
    known = np.asarray(np.isfinite(flat).all(axis=(-2, -1)))
    return Rotation.from_matrix(np.where(known[:, None, None], flat, np.eye(3))), known


def _in_moving_order(sequence: str) -> tuple[int, int, int]:
    """Return the letters of a sequence, by number, as its turns follow about moving axes.

    Turns about fixed axes are those about moving axes in the opposite order.
    """
    return (0, 1, 2) if sequence.isupper() else (2, 1, 0)


def moving_places(order: str) -> list[int]:
    """Return the place, in an angle set, of each angle in the order of moving axes."""
    sequence, places = angle_set(order)
    return [places[i] for i in _in_moving_order(sequence)]


def moving_axes(order: str) -> Array:
    """Return the coordinate axes about which the angles of a set turn, in that order: (3, 3)."""
    sequence, _ = angle_set(order)
    letters = [sequence[i].upper() for i in _in_moving_order(sequence)]
    return np.array([np.eye(3)["XYZ".index(letter)] for letter in letters])


def angle_axes(angles: Array, order: str = "rpy") -> Array:
    """Return the axes, in base axes, about which each angle of a set turns: ω = Σ axis_i · rate_i.

    Parameters
    ----------
    angles : (..., 3) array [rad]
    order : str
        See `rotation_from_angles`.

    Returns
    -------
    (..., 3, 3) array [1]
        Its columns are the axes of the three angles.

    Raises
    ------
    InvalidInput
        On an unknown order.
    """
    from scipy.spatial.transform import Rotation

    sequence, places = angle_set(order)
    axes, before = np.empty((*angles.shape, 3)), np.eye(3)
    for i in _in_moving_order(sequence):
        place = places[i]
        axes[..., :, place] = before @ np.eye(3)["XYZ".index(sequence[i].upper())]
        turn = Rotation.from_euler(sequence[i].upper(), angles[..., place].reshape(-1, 1))
        before = before @ turn.as_matrix().reshape(*angles.shape, 3)
    return axes


def skew_part(rotation: Array) -> Array:
    """Return the vectors of the skew parts ½ (R − Rᵀ) of rotations: sin θ times the axis.

    Parameters
    ----------
    rotation : (..., 3, 3) array [1]

    Returns
    -------
    (..., 3) array [1]
        To first order the rotation vector of a short turn.

    *Source: Murray1994, chapter 2: the axis of a rotation.*
    """
    r = rotation
    x, y, z = (r[..., i, j] - r[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0)))
    return 0.5 * np.stack((x, y, z), axis=-1)


def angle_of(rotation: Array) -> Array:
    """Return the angles of rotations, in [0, π].

    From the sine and the cosine, so that no digits are lost near 0 and π.

    Parameters
    ----------
    rotation : (..., 3, 3) array [1]

    Returns
    -------
    (...) array [rad]

    *Source: Murray1994, chapter 2: the angle of a rotation, from its trace.*
    """
    cosine = 0.5 * (np.trace(rotation, axis1=-2, axis2=-1) - 1.0)
    return np.asarray(np.arctan2(norm(skew_part(rotation)), cosine))


def check_rotation(what: str, value: ArrayLike, *, finite: bool = True) -> Array:
    """Return rotation matrices, checked.

    Parameters
    ----------
    what : str
        What they are, for the message.
    value : (..., 3, 3) array_like [1]
        Of an array of single precision, the nearest rotations are returned.
    finite : bool
        Whether NaN is an error; otherwise matrices with NaN are accepted.

    Returns
    -------
    (..., 3, 3) array [1]

    Raises
    ------
    InvalidInput
        On a wrong shape, or numbers that are not finite.
    InvalidRotation
        Where RᵀR is not I within `ROTATION_TOLERANCE`, of single precision within
        `SINGLE_TOLERANCE`, or det R < 0.
    """
    matrix = check_array(what, value, (3, 3), finite=finite)
    single = getattr(value, "dtype", None) == np.float32
    with np.errstate(over="ignore", invalid="ignore"):
        defect = np.abs(np.swapaxes(matrix, -1, -2) @ matrix - np.eye(3)).max(axis=(-2, -1))
        determinant = np.linalg.det(matrix)
    bad = ~(defect <= (SINGLE_TOLERANCE if single else ROTATION_TOLERANCE)) | (determinant < 0.0)
    if not finite:
        bad &= ~np.isnan(matrix).any(axis=(-2, -1))
    if bad.any():
        where = tuple(int(i) for i in np.argwhere(bad)[0])
        got = f"|RᵀR − I| = {defect[where]:.3g} and det R = {determinant[where]:.6g}"
        place = f"at index {list(where)}" if where else ""
        raise InvalidRotation(expected(what, "a rotation matrix (RᵀR = I, det R = 1)", got, place))
    return nearest_rotations(matrix) if single else matrix


def nearest_rotations(matrix: Array) -> Array:
    """Return the rotations that are nearest to matrices of positive determinant; NaN remains.

    U Vᵀ of the singular value decomposition U S Vᵀ, nearest in the Frobenius norm.

    Parameters
    ----------
    matrix : (..., 3, 3) array [1]
        Of matrices of negative determinant the nearest reflections are returned.

    Returns
    -------
    (..., 3, 3) array [1]
    """
    known = ~np.isnan(matrix).any(axis=(-2, -1))
    left, _, right = np.linalg.svd(matrix[known])
    nearest = matrix.copy()
    nearest[known] = left @ right
    return nearest


def congruences(arms: Array, images: Array) -> tuple[Array, Array]:
    """Return the orthogonal Q that moves vectors nearest to others, and that of the other det Q.

    Q minimises Σ |Q x − y|². For vectors in a plane both are equally near.

    Parameters
    ----------
    arms, images : (n, 3) arrays
        The vectors x and y.

    Returns
    -------
    two (3, 3) arrays [1]
    """
    left, _, right = np.linalg.svd(arms.T @ images)
    return right.T @ left.T, right.T @ np.diag([1.0, 1.0, -1.0]) @ left.T
