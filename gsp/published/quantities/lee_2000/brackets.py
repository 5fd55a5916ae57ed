"""det J as brackets of the vertices of the octahedron, and shears: chapter 3 of `Lee2000`."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import ConvexHull

from gsp.errors import InvalidInput, expected
from gsp.families import lee
from gsp.geometry.vectors import Array
from gsp.published.quantities.common import numbered
from gsp.published.quantities.lee_2000.platforms import pose

# Pairs of rows of (1, x, y, z) whose second-order determinants are L, M, N; P, Q, R: eq. (4).
PAIRS = ((0, 1), (0, 2), (0, 3), (2, 3), (3, 1), (1, 2))
PRODUCTS = (
    ("eb ea pa pc", "ea ec pc pb", "ec eb pb pa"),
    ("eb ea pa pb", "ea ec pc pa", "ec eb pb pc"),
)
# Base point and platform point of each leg.
LEG_ENDS = ((0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (0, 2))
NAMES = ("ea", "eb", "ec", "pa", "pb", "pc")
# Brackets and singular values below it are zero: those of the points here are 0.01 to 10.
ZERO_BRACKET = 1e-9


def _corners(a: float, b: float, h: float, theta: float, heights: str) -> dict[str, Array]:
    """E_A, E_B, E_C and A, B, C at the heights of eq. (2) or of eq. (27)."""
    known = {"(2)": (-h, 0.0), "(27)": (0.0, -h)}
    if heights not in known:
        raise InvalidInput(expected("heights", '"(2)" or "(27)"', repr(heights)))
    low, high = known[heights]
    design = lee.octahedral_3_3(a, b)
    base = design.base_points[[0, 2, 4]] + [0.0, 0.0, low]
    top = design.platform_points[[0, 2, 4]] @ pose(0.0, theta).rotation.T + [0.0, 0.0, high]
    return dict(zip(NAMES, (*base, *top), strict=True))


def _lines(base: Array, top: Array) -> Array:
    """Lines of the six legs between three base points and three platform points."""
    return np.stack(
        [lee.line_coordinates(base[..., i, :], top[..., j, :]) for i, j in LEG_ENDS], axis=-2
    )


def bracket_form_error() -> float:
    """Largest difference of eq. (25) from the determinant of the lines of random octahedra."""
    base, top = np.random.default_rng(0).normal(size=(2, 100, 3, 3))
    both = np.abs(np.linalg.det(_lines(base, top))), np.abs(lee.bracket_determinant(base, top))
    return float(np.abs(both[0] / both[1] - 1.0).max())


def brackets(
    product: int, a: float, b: float, h: float, theta: float = 0.0, heights: str = "(2)"
) -> Array:
    """Return the three brackets of the first or of the second product of eq. (25)."""
    at = _corners(a, b, h, theta, heights)
    (which,) = numbered("product", [product], len(PRODUCTS))
    return np.array(
        [_bracket(np.array([at[name] for name in four.split()])) for four in PRODUCTS[which]]
    )


def _bracket(points: Array) -> float:
    """Return the determinant of four points (1, x, y, z)."""
    return float(np.linalg.det(np.column_stack((np.ones(4), points)).T))


def brackets_over_volumes(product: int, a: float, b: float, h: float, theta: float) -> Array:
    """Absolute values of the three brackets of a product over the volumes of the tetrahedra."""
    at = _corners(a, b, h, theta, "(2)")
    (which,) = numbered("product", [product], len(PRODUCTS))
    volumes = [ConvexHull([at[name] for name in four.split()]).volume for four in PRODUCTS[which]]
    return np.asarray(np.abs(brackets(product, a, b, h, theta)) / volumes)


def product_ratio(theta_deg: float) -> float:
    """First product of eq. (25) over the second, turned about the vertical by an angle."""
    first, second = (brackets(k, 1.0, 2.0, 1.0, np.deg2rad(theta_deg)).prod() for k in (1, 2))
    return float(first / second)


def coplanar_fours(first: int, second: int, share: float) -> Array:
    """[rank of the lines, zero brackets of the first product, of the second] of an octahedron.

    Its six random vertices are moved by a share of the way to where a bracket of the first product
    and one of the second are zero, found by Newton's method with the least changes.
    """
    chosen = [PRODUCTS[0][numbered("first", [first], 3)[0]].split()]
    chosen.append(PRODUCTS[1][numbered("second", [second], 3)[0]].split())
    start = np.random.default_rng(0).normal(size=(6, 3))

    def values(flat: Array) -> Array:
        at = dict(zip(NAMES, flat.reshape(6, 3), strict=True))
        return np.array([_bracket(np.array([at[name] for name in four])) for four in chosen])

    end = start.ravel()
    for _ in range(50):
        # A bracket is linear in each coordinate, so central differences are exact.
        slopes = np.array([0.5 * (values(end + d) - values(end - d)) for d in np.eye(18)]).T
        end = end - np.linalg.pinv(slopes) @ values(end)
    points = start + share * (end.reshape(6, 3) - start)
    at = dict(zip(NAMES, points, strict=True))
    zero = [
        sum(
            abs(_bracket(np.array([at[name] for name in four.split()]))) < ZERO_BRACKET
            for four in product
        )
        for product in PRODUCTS
    ]
    sizes = np.linalg.svd(_lines(points[:3], points[3:]), compute_uv=False)
    return np.array([int((sizes > ZERO_BRACKET).sum()), *zero])


def sheared_brackets(a: float, b: float, h: float, x: float, y: float) -> Array:
    """All six brackets at the heights of eq. (27), with the platform moved by (x, y)."""
    at = _corners(a, b, h, 0.0, "(27)")
    moved = {k: v + [x, y, 0.0] if k.startswith("p") else v for k, v in at.items()}
    fours = (four.split() for product in PRODUCTS for four in product)
    return np.array([_bracket(np.array([moved[name] for name in four])) for four in fours])


def bracket_vanishes_at(product: int) -> float:
    """Turn about the vertical [deg] at which the brackets of a product vanish."""
    return float(
        brentq(lambda t: float(brackets(product, 1.0, 2.0, 1.0, np.deg2rad(t))[0]), -85.0, 85.0)
    )


def sheared(
    x: float,
    y: float,
    h: float,
    x1: float,
    x2: float,
    x3: float,
    x4: float,
    y1: float,
    y2: float,
    y3: float,
    y4: float,
) -> Array:
    """T M: the matrix M of eq. (27), sheared by eq. (31), as in eq. (30)."""
    m = np.array([np.ones(4), [x1, x2, x3, x4], [y1, y2, y3, y4], [0.0, 0.0, -h, -h]])
    return np.asarray(lee.shear(x, y, h) @ m)


def sheared_determinant(
    x: float,
    y: float,
    h: float,
    x1: float,
    x2: float,
    x3: float,
    x4: float,
    y1: float,
    y2: float,
    y3: float,
    y4: float,
) -> float:
    """Return the determinant of the matrix of eq. (28), built from moved points."""
    m = np.array([np.ones(4), [x1, x2, x3 + x, x4 + x], [y1, y2, y3 + y, y4 + y], [0, 0, -h, -h]])
    return float(np.linalg.det(m))


def shear(x: float, y: float, h: float) -> Array:
    """Return the linear map that leaves the base at z = 0 and moves the platform at z = −h."""
    p = np.random.default_rng(0).normal(size=(2, 4))
    m = np.array([np.ones(4), *p, [0.0, 0.0, -h, -h]])
    moved = m + np.outer([0.0, x, y, 0.0], [0.0, 0.0, 1.0, 1.0])
    return np.asarray(np.linalg.solve(m.T, moved.T).T)


def shear_of_lines(x: float, y: float, h: float) -> Array:
    """Second-order determinants of that map: what it does to (L, M, N; P, Q, R)."""
    t = shear(x, y, h)
    return np.array([[np.linalg.det(t[np.ix_(i, j)]) for j in PAIRS] for i in PAIRS])


def shear_determinants(x: float, y: float, h: float) -> Array:
    """Return the determinants of the map of points and of that of lines."""
    return np.array([np.linalg.det(shear(x, y, h)), np.linalg.det(shear_of_lines(x, y, h))])


def height_that_moves(share: float, h: float) -> float:
    """Height of the points that the printed matrix (31) moves by a share of (x, y)."""
    t = lee.shear(1.0, 1.0, h)
    return float(share / t[1, 3])


QUANTITIES = (
    bracket_form_error,
    brackets,
    brackets_over_volumes,
    product_ratio,
    coplanar_fours,
    sheared_brackets,
    bracket_vanishes_at,
    sheared,
    sheared_determinant,
    shear,
    shear_of_lines,
    shear_determinants,
    height_that_moves,
)
