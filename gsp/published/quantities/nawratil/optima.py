"""Quantities that `Nawratil` prints, beside indices of designs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize

from gsp import catalogue
from gsp.errors import InvalidInput, expected
from gsp.families.nawratil import example_design, example_pose, line_configuration
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.matrices import singular_values, whiten
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import condition_number, condition_number_ellipsoid, control_number
from gsp.model.design import Design
from gsp.model.posture import Posture
from gsp.published.quantities import common
from gsp.published.quantities.nawratil import matrices as source_matrices


def _between(base: Array, platform: Array) -> Posture:
    """UPS legs between points of one frame."""
    return Design(["D1"] * len(base), base, platform).at(Pose([0.0, 0.0, 0.0]))


def _ellipsoid(design: Design) -> Ellipsoid:
    if design.ellipsoid is None:
        raise InvalidInput(expected("design", "one with an ellipsoid", design.name))
    return design.ellipsoid


def k_plus(letter: str) -> float:
    """Return κ = 4 h, h or α [deg] of the published design K+: "kappa", "h" or "alpha"."""
    posture = common.posture("nawratil-k-plus")
    h = float(posture.pose.position[2]) / 2.0
    x, y, _ = posture.design.base_points[1]
    letters = {"kappa": 4.0 * h, "h": h, "alpha": float(np.rad2deg(np.arctan2(y, x)))}
    if letter not in letters:
        raise InvalidInput(expected("letter", "one of " + ", ".join(letters), letter))
    return letters[letter]


def ctn_of_example(alpha_deg: float, h: ArrayLike) -> Array:
    """Control number in the set S_K."""
    return control_number(example_design(np.deg2rad(alpha_deg)).at(example_pose(h)))


def best_of_example_set() -> Array:
    """[h, α in degrees, CTN] of the greatest control number in S_K, found by search.

    A grid over the whole set, h up to 3, gives the start of a simplex search.
    """
    angles, heights = np.linspace(0.0, 30.0, 31), np.linspace(0.01, 3.0, 300)
    values = np.array([ctn_of_example(angle, heights) for angle in angles])
    i, j = np.unravel_index(int(values.argmax()), values.shape)

    def loss(x: Array) -> float:
        return -float(ctn_of_example(float(np.clip(x[1], 0.0, 30.0)), x[0]))

    start = np.array([heights[j], angles[i]])
    best = minimize(loss, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    return np.array([best.x[0], best.x[1], -best.fun])


def eigenvalue_multiplicities(alpha_deg: float, h: float) -> list[int]:
    """How often each generalised eigenvalue of (T, N) occurs in S_K, the most frequent first."""
    return _multiplicities(example_design(np.deg2rad(alpha_deg)).at(example_pose(h)))


def eigenvalue_multiplicities_of(design: str) -> list[int]:
    """Count them likewise for a published design at its home."""
    return _multiplicities(common.posture(design))


def _multiplicities(posture: Posture) -> list[int]:
    values = np.sort(singular_values(whiten(posture.weighted(None), posture.passive_rates(None))))
    steps = np.flatnonzero(np.diff(values) > 1e-9 * values[-1]) + 1
    return sorted((len(part) for part in np.split(values, steps)), reverse=True)


def _exchanges(design: str) -> list[Posture]:
    """All designs that arise from exchanging base and platform anchors of some of the legs."""
    posture = common.posture(design)
    low = posture.design.base_points
    high = posture.pose.position + posture.lines.arm
    choices = product((False, True), repeat=len(low))
    masks = [np.array(choice)[:, None] for choice in choices]
    return [_between(np.where(m, high, low), np.where(m, low, high)) for m in masks]


def spread_over_exchanges(design: str) -> float:
    """Return the greatest less the least control number of the 2^n exchanges of anchors."""
    return float(np.ptp([control_number(posture) for posture in _exchanges(design)]))


def isotropic_exchanges(design: str) -> int:
    """Count the 2^n exchanges of anchors that have CTN = 1 and CDN_OE = 1, to 1e-12."""
    ellipsoid = _ellipsoid(catalogue.design(design))
    return sum(
        bool(abs(control_number(posture) - 1.0) <= 1e-12)
        and bool(abs(condition_number_ellipsoid(posture, ellipsoid) - 1.0) <= 1e-12)
        for posture in _exchanges(design)
    )


def anchors_in_ellipsoid_equation(design: str) -> Array:
    """x² + y² + z²/p² of all anchor points: least and greatest."""
    posture = common.posture(design)
    points = np.concatenate((posture.design.base_points, posture.design.platform_points))
    values = ((points / _ellipsoid(posture.design).semi_axes) ** 2).sum(axis=-1)
    return np.array([values.min(), values.max()])


def isotropic_indices(g: int, p: float, mu: float) -> Array:
    """[CDN_OE, CTN] of the design of 2 g legs for an ellipsoid (1, 1, p)."""
    posture = _between(*source_matrices.anchors(g, p, mu))
    condition = condition_number_ellipsoid(posture, Ellipsoid([1.0, 1.0, p]))
    return np.array([condition, control_number(posture)])


def planar_indices(g: int, p: float, height: float) -> Array:
    """[CDN_OE, CTN] of the g legs of the upper set, projected into the xy-plane."""
    flat = np.array([1.0, 1.0, 0.0])
    x, y = (points[:g] * flat for points in source_matrices.anchors(g, p, 0.0))
    n = source_matrices.normal_matrix(x, y - x)[source_matrices.PLANAR]
    d = source_matrices.ellipsoid_matrix(np.array([1.0, 1.0, p]), height)[source_matrices.PLANAR]
    t = source_matrices.angular_matrix(x, y)[source_matrices.PLANAR]
    ratio = source_matrices.root_of_eigenvalue_ratio
    return np.array([ratio(d, n), 1.0 / ratio(t, n)])


def ellipsoid_matrix(a: float, b: float, c: float) -> Array:
    """D of the vertices of an ellipsoid in its own axes."""
    return source_matrices.ellipsoid_matrix(np.array([a, b, c]))


def ellipsoid_diagonal(p: float) -> Array:
    """Diagonal of D for the ellipsoid (27)."""
    return np.diag(source_matrices.ellipsoid_matrix(np.array([1.0, 1.0, p])))


def normal_diagonal(g: int, r: float, h: float, t: float, mu: float) -> Array:
    """Diagonal of N for the lines (26)."""
    return np.diag(source_matrices.normal_matrix(*line_configuration(g, r, h, t, mu)))


def off_diagonal(g: int, r: float, h: float, t: float, mu: float) -> float:
    """Largest element of N beside the diagonal, for the lines (26)."""
    n = source_matrices.normal_matrix(*line_configuration(g, r, h, t, mu))
    return float(np.abs(n - np.diag(np.diag(n))).max())


def angular_differences(g: int, p: float, mu: float, a: float, b: float) -> Array:
    """[t11 − t22, t44 − t55, t55 − t66, largest beside the diagonal] of T on the lines (31)."""
    feet, directions = source_matrices.lines_for(g, p, mu)
    t = source_matrices.angular_matrix(feet + a * directions, feet + b * directions)
    d = np.diag(t)
    beside = np.abs(t - np.diag(d)).max()
    return np.array([d[0] - d[1], d[3] - d[4], d[4] - d[5], beside])


def characteristic_length(radius: float) -> float:
    """CL with D = 6 CL² L, for a sphere of a radius."""
    d = np.diag(source_matrices.ellipsoid_matrix(np.full(3, radius)))
    return float(np.sqrt(d[0] / d[3]))


def condition_number_ratio(design: str, radius: float) -> ArrayLike:
    """CDN_CL with that length over CDN_OE with that sphere."""
    posture = common.posture(design)
    length = characteristic_length(radius)
    return condition_number(posture, length) / condition_number_ellipsoid(
        posture, Ellipsoid(radius)
    )


def shell_inertia(a: float, b: float, c: float) -> Array:
    """Moments of inertia of a shell of mass 1 between similar ellipsoids, by quadrature."""
    z, weights = np.polynomial.legendre.leggauss(8)
    angle = 2.0 * np.pi * np.arange(16) / 16
    ring = np.sqrt(1.0 - z**2)[:, None]
    x2, y2 = (a * ring * np.cos(angle)) ** 2, (b * ring * np.sin(angle)) ** 2
    z2 = np.broadcast_to((c * z[:, None]) ** 2, x2.shape)
    mass = np.broadcast_to(weights[:, None] / 32.0, x2.shape)
    return np.array([(mass * s).sum() for s in (y2 + z2, x2 + z2, x2 + y2)])


def cdn_oe_over_root_of_energies(
    design: str, a: float, b: float, c: float, energies: str
) -> ArrayLike:
    """CDN_OE over the root of a ratio of the kinetic energies of the shell, greatest and least."""
    posture = common.posture(design)
    inertia = np.diag([*shell_inertia(a, b, c), 1.0, 1.0, 1.0])
    r = posture.pose.rotation
    turn = np.kron(np.eye(2), r)
    rows = posture.jacobian[:, [3, 4, 5, 0, 1, 2]]
    inertia = turn @ inertia @ turn.T
    root = source_matrices.root_of_eigenvalue_ratio(inertia, rows.T @ rows)
    ratios = {"maximal/minimal": root, "minimal/maximal": 1.0 / root}
    if energies not in ratios:
        raise InvalidInput(expected("energies", "one of " + ", ".join(ratios), energies))
    ratio = ratios[energies]
    return condition_number_ellipsoid(posture, Ellipsoid([a, b, c])) / ratio


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        "k_plus": k_plus,
        "ctn_of_example": ctn_of_example,
        "best_of_example_set": best_of_example_set,
        "eigenvalue_multiplicities": eigenvalue_multiplicities,
        "eigenvalue_multiplicities_of": eigenvalue_multiplicities_of,
        "spread_over_exchanges": spread_over_exchanges,
        "isotropic_exchanges": isotropic_exchanges,
        "anchors_in_ellipsoid_equation": anchors_in_ellipsoid_equation,
        "isotropic_indices": isotropic_indices,
        "planar_indices": planar_indices,
        "ellipsoid_matrix": ellipsoid_matrix,
        "ellipsoid_diagonal": ellipsoid_diagonal,
        "normal_diagonal": normal_diagonal,
        "off_diagonal": off_diagonal,
        "isotropic_lines": source_matrices.isotropic_lines,
        "best_anchors": source_matrices.best_anchors,
        "angular_differences": angular_differences,
        "characteristic_length": characteristic_length,
        "condition_number_ratio": condition_number_ratio,
        "shell_inertia": shell_inertia,
        "cdn_oe_over_root_of_energies": cdn_oe_over_root_of_energies,
    }
)
