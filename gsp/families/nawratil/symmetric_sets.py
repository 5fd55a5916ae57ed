"""The sets M and N of `Nawratil`, of legs turned about the z-axis, and the isotropic designs.

Axes are those of the source; the postures are the designs at their home.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_items, is_a
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.model.design import SETTINGS, Design, check_keywords

# Legs on each of the two orbits. Designs of thousands of legs would fill the memory.
LEGS_OF_A_KIND = arguments.integer(3, 1000)


@arguments.validated(g=LEGS_OF_A_KIND)
def set_m(
    first: ArrayLike,
    second: ArrayLike,
    g: int,
    *,
    swap: Iterable[bool] | None = None,
    **settings: Any,
) -> Design:
    """Return a design of the set M: two legs, each turned g times about the z-axis.

    Parameters
    ----------
    first, second : (2, 3) array_like [unit]
        Base anchor and platform anchor of leg 1 and of leg g + 1, in the axes of the source.
    g : int
        From 3 to 1000; the design has 2g legs.
    swap : 2g booleans or None
        The legs whose base and platform anchor are exchanged.
    settings : other parameters of `Design`

    Returns
    -------
    Design
        With 2g UPS legs and its home at the origin.

    Raises
    ------
    InvalidInput
        If `g` is outside of its range, on a keyword that is not a parameter of a design, points of
        other shapes, or `swap` that is not 2g booleans.

    *Source: Nawratil, Definition 4*
    """
    check_keywords("set_m", settings, SETTINGS)
    pairs = np.stack((_pair("first", first), _pair("second", second)))
    turned = Pose.from_rpy([0.0, 0.0, 0.0], _turns(g)).rotation
    points = np.einsum("kij,spj->skpi", turned, pairs).reshape(2 * g, 2, 3)
    base, platform = _exchanged(points[:, 0], points[:, 1], swap)
    defaults: dict[str, Any] = {
        "name": f"nawratil-m-g{g}",
        "source": "Nawratil, Definition 4",
        "home": Pose([0.0, 0.0, 0.0]),
    }
    return Design(["D1"] * (2 * g), base, platform, **{**defaults, **settings})


@arguments.validated(
    g=LEGS_OF_A_KIND,
    r=arguments.size,
    h=arguments.size,
    t=arguments.number,
    mu=arguments.number,
)
def line_configuration(
    g: int, r: float, h: float, t: float, mu: float = 0.0
) -> tuple[Array, Array]:
    """Footpoints f_i and directions g_i of the leg lines of a design of the set N.

    Parameters
    ----------
    g : int
        From 3 to 1000; there are 2g lines.
    r, h : float [unit]
        > 0; distance of the lines from the z-axis, and height of the footpoints above and below
        the origin.
    t : float [1]
        Rise of the lines; the directions are not unit vectors but have the length sqrt(1 + t²).
    mu : float [rad]
        Turn of the lower lines against the upper ones.

    Returns
    -------
    two (2g, 3) arrays [unit], [1]

    Raises
    ------
    InvalidInput
        If g is not an integer from 3 to 1000, or a length is not positive.

    *Source: Nawratil, eq. (26)*
    """
    angle = _turns(g)[:, 2]
    upper_lower = np.concatenate((angle, angle + mu))
    sign = np.repeat([1.0, -1.0], g)
    cosine, sine = np.cos(upper_lower), np.sin(upper_lower)
    feet = np.stack((r * cosine, r * sine, h * sign), axis=1)
    directions = np.stack((-sine, cosine, t * sign), axis=1)
    return feet, directions


@arguments.validated(
    g=LEGS_OF_A_KIND,
    r=arguments.size,
    h=arguments.size,
    t=arguments.number,
    a=arguments.number,
    b=arguments.number,
    mu=arguments.number,
)
def set_n(
    g: int,
    r: float,
    h: float,
    t: float,
    a: float,
    b: float,
    *,
    mu: float = 0.0,
    swap: Iterable[bool] | None = None,
    **settings: Any,
) -> Design:
    """Return a design of the set N at the origin: anchors f_i + a g_i and f_i + b g_i.

    Parameters
    ----------
    g : int
    r, h, t, mu : float [unit, unit, 1, rad]
        See `line_configuration`.
    a, b : float [unit]
        Places of the anchors on the lines, a ≠ b. The base anchor is at a, where not swapped.
    swap : 2g booleans or None
        The legs whose base anchor is at b and platform anchor at a.
    settings : other parameters of `Design`

    Raises
    ------
    InvalidInput
        If a = b, `swap` does not have 2g entries, or a keyword is not a parameter of a design.

    *Source: Nawratil, Definition 5, eqs. (26), (32)*
    """
    check_keywords("set_n", settings, SETTINGS)
    feet, directions = line_configuration(g, r, h, t, mu)
    if a == b:
        raise InvalidInput(expected("a, b", "two different numbers", f"{a}, {b}"))
    at_a, at_b = feet + a * directions, feet + b * directions
    base, platform = _exchanged(at_a, at_b, swap)
    defaults: dict[str, Any] = {
        "name": f"nawratil-n-g{g}",
        "source": "Nawratil, Definition 5",
        "home": Pose([0.0, 0.0, 0.0]),
    }
    return Design(
        ["D1"] * (2 * g),
        base,
        platform,
        **{**defaults, **settings},
    )


# Of |p|: at its ends CTN and CDN_OE of the isotropic designs are 1 to ten digits.
RANGE = arguments.within(1e-6, 1e6)


@arguments.validated(p=arguments.number)
def isotropic_parameters(p: float) -> dict[str, float]:
    """Return r, h, t, a, b for which a design of the set N has CDN_OE = 1 and CTN = 1.

    Parameters
    ----------
    p : float [unit]
        Semi-axis along z of the operation ellipsoid, the other two being 1; |p| from 1e-6 to 1e6.
        Beyond, a and b agree but for their sign to so many digits that CTN loses those it has.

    Returns
    -------
    dict from name to float [unit; t: 1]

    Raises
    ------
    InvalidInput
        If |p| is not in this range.

    Examples
    --------
    >>> {k: round(v, 4) for k, v in isotropic_parameters(1.0).items()}
    {'r': 0.5774, 'h': 0.7071, 't': 0.7071, 'a': -0.8047, 'b': 0.1381}

    *Source: Nawratil, eqs. (31), (34)*
    """
    # Eq. (34) divided by its roots: no fourth power of p is left, which would overflow.
    axis = np.sqrt(2.0) * RANGE("|p|", abs(p))
    root = np.hypot(1.0, axis)
    return {
        "r": float(np.sqrt(3.0) / 3.0),
        "h": float(root / np.sqrt(6.0)),
        "t": float(np.sqrt(2.0) / 2.0),
        "a": float(-(1.0 + axis) / (np.sqrt(3.0) * root)),
        "b": float((axis - 1.0) / (np.sqrt(3.0) * root)),
    }


@arguments.validated(g=LEGS_OF_A_KIND, p=arguments.number, mu=arguments.number)
def isotropic(
    g: int = 3, p: float = np.sqrt(0.5), mu: float = 0.0, swap: Iterable[bool] | None = None
) -> Design:
    """Return a hexapod (2g legs) with CDN_OE = 1 and CTN = 1 at its home.

    Parameters
    ----------
    g : int
    mu : float [rad]
    swap : 2g booleans or None
        See `set_n`.
    p : float [unit]
        Semi-axis along z of the operation ellipsoid x² + y² + z²/p² = 1, on which all anchors
        lie; |p| from 1e-6 to 1e6.

    Raises
    ------
    InvalidInput
        On numbers outside of their range, or `swap` that is not 2g booleans.

    Examples
    --------
    >>> import gsp
    >>> design = isotropic(g=4, p=2.0, mu=0.3)
    >>> round(float(gsp.indices.control_number(design.at(design.home))), 9)
    1.0

    *Source: Nawratil, §4.1, eqs. (26)–(35)*
    """
    return set_n(
        g,
        **isotropic_parameters(p),
        mu=mu,
        swap=swap,
        ellipsoid=Ellipsoid((1.0, 1.0, abs(p))),
        name=f"nawratil-isotropic-g{g}-p{p:.4g}-mu{mu:.4g}",
        source="Nawratil, eqs. (26)–(34)",
    )


def _turns(g: int) -> Array:
    """Roll, pitch, yaw of the g turns about the z-axis: (g, 3)."""
    yaw = np.arange(g) * 2.0 * np.pi / g
    return np.stack((np.zeros(g), np.zeros(g), yaw), axis=1)


def _pair(what: str, value: ArrayLike) -> Array:
    points = check_array(what, value, (2, 3))
    if points.ndim != 2:
        raise InvalidInput(expected(what, "shape (2, 3)", f"shape {points.shape}"))
    return points


def _exchanged(base: Array, platform: Array, swap: Iterable[bool] | None) -> tuple[Array, Array]:
    """Return anchor points (n, 3), those of the legs that are marked in `swap` exchanged."""
    chosen = _swaps(swap, len(base))[:, None]
    return np.where(chosen, platform, base), np.where(chosen, base, platform)


def _swaps(swap: Iterable[bool] | None, n: int) -> Mask:
    given = (False,) * n if swap is None else check_items("swap", swap, f"{n} booleans")
    if not all(is_a(one, bool | np.bool_) for one in given):
        raise InvalidInput(expected("swap", f"{n} booleans", brief(given)))
    chosen = np.array(given, dtype=bool)
    if chosen.shape != (n,):
        raise InvalidInput(expected("swap", f"{n} booleans", f"{chosen.size}"))
    return chosen
