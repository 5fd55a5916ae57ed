"""Indices of planar postures: the spatial ones restricted to motions in the plane."""

from __future__ import annotations

import numpy as np

from gsp import arguments
from gsp.checks import check_positive
from gsp.errors import InvalidDesign, InvalidInput, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.matrices import (
    absolute_determinant,
    condition,
    defined_matrices,
    reciprocal_condition,
    singular_values,
    whiten,
)
from gsp.geometry.vectors import EPS, Array, dot, norm, unit
from gsp.planar.design import PlanarDesign
from gsp.planar.formulas import quarter_turn
from gsp.planar.posture import PlanarPosture

__all__ = [
    "condition_number",
    "condition_number_ellipsoid",
    "control_number",
    "cubic_eigenvalues",
    "ellipsoid_root",
    "manipulability",
    "maximum_determinant",
    "metrics",
    "perimeter",
    "quality_index",
]


@arguments.validated(posture=arguments.kind(PlanarPosture))
def condition_number(posture: PlanarPosture, length: float) -> Array:
    """Condition number of the homogeneous planar Jacobian, σ_max / σ_min.

    Parameters
    ----------
    posture : PlanarPosture, batch shape (...)
    length : float [unit of the design]
        Characteristic length L > 0.

    Returns
    -------
    (...) array [1]
        In [1, ∞]; inf when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a PlanarPosture, or `length` is not a number > 0.

    *Source: Nawratil, §2.1.1, restricted to the plane as §4.2 does for CDN_OE*
    """
    return condition(posture.singular_values(length))


@arguments.validated(posture=arguments.kind(PlanarPosture))
def condition_number_ellipsoid(
    posture: PlanarPosture, ellipsoid: Ellipsoid, length: float | None = None
) -> Array:
    """Condition number between actuator speeds and the speeds of an operation ellipsoid.

    Parameters
    ----------
    posture : PlanarPosture, batch shape (...)
    ellipsoid : Ellipsoid
        In platform axes, its z-axis normal to the plane; its height above the plane and its
        extent along z do not matter if an axis is parallel to z.
    length : float or None [unit of the design]
        Weight of A1 actuators; not used without them.

    Returns
    -------
    (...) array [1]
        In [1, ∞]; inf when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        On arguments of other types, or if `length` is not > 0.
    MissingParameter
        Without `length`, where there are A1 actuators.

    *Source: Nawratil, Definition 2 with the submatrices (36), for RPR legs; other legs are our
    extension.*
    """
    rows = posture.weighted(length) @ ellipsoid_root(ellipsoid, posture)
    return condition(singular_values(rows))


@arguments.validated(posture=arguments.kind(PlanarPosture))
def ellipsoid_root(ellipsoid: Ellipsoid, posture: PlanarPosture) -> Array:
    """Return X with D⁻¹ = X Xᵀ for the planar matrix D of the six vertices.

    D is Σ |v + ω s_i⊥|² over the vertices s_i as seen in the plane; about their centre it is
    diagonal.

    Parameters
    ----------
    ellipsoid : Ellipsoid
        In platform axes, its z-axis normal to the plane.
    posture : PlanarPosture, batch shape (...)

    Returns
    -------
    (..., 3, 3) array [1, and 1/unit in the last row]
        Upper triangular.

    Raises
    ------
    InvalidInput
        On arguments of other types.

    *Source: Nawratil, eqs. (12), (36)*
    """
    if not isinstance(ellipsoid, Ellipsoid):
        raise InvalidInput(expected("ellipsoid", "a gsp.Ellipsoid", type(ellipsoid).__name__))
    centre = ellipsoid.center[:2]
    spread = ((ellipsoid.vertices[:, :2] - centre) ** 2).sum()
    arm = (posture.pose.rotation @ centre[:, None])[..., 0]
    root = np.zeros((*posture.shape, 3, 3))
    root[..., 0, 0] = root[..., 1, 1] = 1.0 / np.sqrt(6.0)
    root[..., 2, 2] = 1.0 / np.sqrt(spread)
    root[..., :2, 2] = -_turned(arm) / np.sqrt(spread)
    return root


@arguments.validated(
    posture=arguments.kind(PlanarPosture), length=arguments.optional(arguments.size)
)
def control_number(posture: PlanarPosture, length: float | None = None) -> Array:
    """Control number: ratio of the extreme gains from actuator rates to passive joint rates.

    Parameters
    ----------
    posture : PlanarPosture, batch shape (...)
    length : float or None [unit of the design]
        Characteristic length that passive slides are divided by and A1 speeds multiplied with;
        needed only for legs with passive slides, that is all but RPR legs.

    Returns
    -------
    (...) array [1]
        In [0, 1]; 0 when singular, and where the lines of an A1 leg are parallel, as its passive
        slides are then arbitrarily fast; NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a PlanarPosture, or `length` is not a number > 0.
    MissingParameter
        Without `length`, where it is needed.

    *Source: Nawratil, Definition 3 with the submatrices (36), for RPR legs; other legs are our
    extension, in which squared slide rates over L join the squared turn rates, as in space.*
    """
    rows = whiten(posture.weighted(length), posture.passive_rates(length))
    finite = defined_matrices(rows)
    values = singular_values(np.where(finite[..., None, None], rows, 0.0))
    return np.where(posture.defined, reciprocal_condition(values), np.nan)


@arguments.validated(posture=arguments.kind(PlanarPosture))
def manipulability(posture: PlanarPosture) -> Array:
    """|det J|, or sqrt(det JᵀJ) for redundant designs, shape (...) [unit, or 1 with an angle].

    Parameters
    ----------
    posture : PlanarPosture, batch shape (...)

    Raises
    ------
    InvalidInput
        If `posture` is not a PlanarPosture.

    *Source: Lee2000, chapter 1; Nawratil, §3.1*
    """
    return absolute_determinant(posture.jacobian)


@arguments.validated(posture=arguments.kind(PlanarPosture))
def quality_index(posture: PlanarPosture, maximum: float | None = None) -> Array:
    """Quality index λ = |det J| / |det J|max, shape (...) [1].

    Parameters
    ----------
    posture : PlanarPosture, batch shape (...)
    maximum : float or None [unit of |det J|]
        |det J|max > 0; default `maximum_determinant` of the design, for three RPR legs.

    Raises
    ------
    InvalidInput
        If `maximum` is not a number > 0, or `posture` is not a PlanarPosture.
    InvalidDesign
        Without `maximum`, where there is no closed form; see `maximum_determinant`.

    *Source: Lee2000, chapter 1*
    """
    if maximum is None:
        maximum = maximum_determinant(posture.design)
    return manipulability(posture) / check_positive("maximum", maximum)


@arguments.validated(design=arguments.kind(PlanarDesign))
def maximum_determinant(design: PlanarDesign) -> float:
    """Return the largest |det J| over all poses of a design with three RPR legs [unit].

    Half the perimeter of the platform triangle, where the legs bisect its outer angles; and, as
    base and platform can be exchanged, no more than half the perimeter of the base triangle.

    Parameters
    ----------
    design : PlanarDesign

    Raises
    ------
    InvalidDesign
        If the legs are not three RPR legs, if base or platform anchors lie on a line or coincide,
        or if no pose reaches the smaller of the two values (the triangles are wound in opposite
        ways, for example), so that there is no closed form.

    Examples
    --------
    >>> import numpy as np
    >>> triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
    >>> round(maximum_determinant(PlanarDesign(["D1"] * 3, 2 * triangle, triangle)), 12)
    1.5

    *Source: Lee2000, chapter 1: (l1 + l2 + l3)/2 for a general platform triangle. That the smaller
    perimeter decides, and when it can be reached by a given base, is ours.*
    """
    if design.n_legs != 3 or not design.between_points:
        got = " ".join(leg.name for leg in design.legs)
        raise InvalidDesign(expected("maximum_determinant", "three RPR legs (D1)", got))
    small, large = sorted((design.platform_points, design.base_points), key=perimeter)
    if not _can_be_reached(small, large):
        got = "anchors for which no pose has it, or anchors on a line"
        raise InvalidDesign(expected("maximum_determinant", "a reachable maximum", got))
    return perimeter(small) / 2.0


@arguments.validated(triangle=arguments.array(3, 2))
def perimeter(triangle: Array) -> float:
    """Return the sum of the sides of a triangle.

    Parameters
    ----------
    triangle : (3, 2) array [length]
        Its corners.

    Returns
    -------
    float [length]

    Raises
    ------
    InvalidInput
        On another shape, or numbers that are not finite.

    *Source: Lee2000, chapter 1, for its use in the maximum of |det J|*
    """
    return float(norm(triangle - np.roll(triangle, 1, axis=0)).sum())


def _can_be_reached(small: Array, large: Array) -> bool:
    """Whether the corners of `large` can lie on the outer bisectors of `small`, one on each.

    With normals n_i and w_i > 0 so that Σ w_i n_i = 0, the three conditions n_i · (x + R b_i) =
    n_i · a_i leave Σ w_i n_i · R b_i = Σ w_i n_i · a_i for the angle of R alone: A cos + B sin = C.
    """
    to_next, to_last = (unit(np.roll(small, k, axis=0) - small) for k in (-1, 1))
    normal = to_next + to_last  # along the inner bisectors, normal to the outer ones
    if not np.isfinite(normal).all() or norm(normal).min() <= 16 * EPS:
        return False
    n = unit(normal)
    rolled = [np.roll(n, -k, axis=0) for k in (1, 2)]
    weights = dot(rolled[0], _turned(rolled[1]))
    wanted = (weights * dot(n, small)).sum()
    cosine, sine = ((weights * dot(n, x)).sum() for x in (large, _turned(large)))
    return bool(np.hypot(cosine, sine) >= abs(wanted) * (1.0 - 1e-12) and abs(wanted) > 0.0)


@arguments.validated(metric=arguments.array(3, 3), rates=arguments.array(3, 3))
def cubic_eigenvalues(metric: Array, rates: Array) -> Array:
    """Generalised eigenvalues of symmetric 3 × 3 matrices, by the formula for cubics.

    The roots of det(A − λ B) = 0, descending, by the cosines of a third of an angle. It takes the
    products JᵀJ that the other functions avoid, and so has half of their digits. It is included
    because the source mentions that the planar case has an explicit solution.

    Parameters
    ----------
    metric, rates : (..., 3, 3) arrays [units of A and B]
        A (D or T) and B (N), B positive definite.

    Returns
    -------
    (..., 3) array [unit of A over that of B]
        Descending.

    Raises
    ------
    InvalidInput
        On arrays of other shapes, numbers that are not finite, or B that is not positive definite.

    *Source: Nawratil, §4.2 (the remark after (36))*
    """
    # Products of the largest numbers stay finite.
    a, b = (np.abs(x).max(axis=(-2, -1), keepdims=True) for x in (metric, rates))
    a = np.where(a > 0.0, a, 1.0)
    with np.errstate(invalid="ignore"):
        scaled = np.nan_to_num(rates / b)
    if (np.linalg.eigvalsh(scaled)[..., 0] <= 0.0).any():
        raise InvalidInput(expected("rates", "positive definite matrices", "others"))
    m = np.linalg.inv(scaled) @ (metric / a)
    mean = np.trace(m, axis1=-2, axis2=-1)[..., None, None] / 3.0
    deviation = m - mean * np.eye(3)
    p = np.trace(deviation @ deviation, axis1=-2, axis2=-1) / 6.0
    size = np.sqrt(np.maximum(p, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = np.linalg.det(deviation) / (2.0 * size**3)
    angle = np.arccos(np.clip(np.nan_to_num(cosine), -1.0, 1.0)) / 3.0
    turns = np.array([0.0, -2.0, 2.0]) * np.pi / 3.0
    roots = mean[..., 0] + 2.0 * size[..., None] * np.cos(angle[..., None] + turns)
    return np.asarray(np.sort(roots, axis=-1)[..., ::-1] * (a / b)[..., 0])


@arguments.validated(
    posture=arguments.kind(PlanarPosture), length=arguments.optional(arguments.size)
)
def metrics(
    posture: PlanarPosture, ellipsoid: Ellipsoid | None = None, length: float | None = None
) -> tuple[Array, Array | None, Array]:
    """Return the matrices N, D and T of a posture for twists (v_x, v_y, ω), (..., 3, 3) each.

    Parameters
    ----------
    posture : PlanarPosture, batch shape (...)
    ellipsoid : Ellipsoid or None
        In platform axes, its z-axis normal to the plane.
    length : float or None [unit of the design]
        L > 0; needed for legs with passive slides or A1 actuators only.

    Returns
    -------
    three (..., 3, 3) arrays [N, D: 1, unit, unit² for v, v and ω, ω; T: these over unit²]
        D is None without an ellipsoid.

    Raises
    ------
    InvalidInput
        On arguments of other types, or if `length` is not > 0.
    MissingParameter
        Without `length`, where it is needed.

    *Source: Nawratil, eq. (36), with the rotation last instead of first*
    """
    rows, passive = posture.weighted(length), posture.passive_rates(length)
    n, t = (np.swapaxes(x, -1, -2) @ x for x in (rows, passive))
    if ellipsoid is None:
        return n, None, t
    inverse = np.linalg.inv(ellipsoid_root(ellipsoid, posture))
    return n, np.swapaxes(inverse, -1, -2) @ inverse, t


def _turned(x: Array) -> Array:
    """Vectors turned by a right angle, counter-clockwise, shape (..., 2)."""
    return np.stack(quarter_turn([x[..., 0], x[..., 1]]), axis=-1)
