"""The planar designs of the set P, and the isotropic ones among them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gsp import arguments
from gsp.checks import check_items
from gsp.errors import InvalidInput, expected
from gsp.families.nawratil import isotropic_parameters, set_n
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.model.design import SETTINGS, check_keywords
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose

__all__ = [
    "isotropic",
    "set_p",
]


@arguments.validated(
    g=arguments.integer(3), r=arguments.number, a=arguments.number, b=arguments.number
)
def set_p(
    g: int, r: float, a: float, b: float, *, swap: Iterable[bool] | None = None, **settings: Any
) -> PlanarDesign:
    """Return a design of the set P: g RPR legs on lines at the distance r from the origin.

    The lines touch a circle of radius r; the anchors are at a and b from the points of contact.

    Parameters
    ----------
    g : int
        ≥ 3
    r, a, b : float [length]
        r > 0, a ≠ b. The base anchor is at a, where not swapped.
    swap : g booleans or None
        The legs whose base anchor is at b and platform anchor at a.
    settings : other parameters of `PlanarDesign`

    Raises
    ------
    InvalidInput
        If `g` is not an integer ≥ 3, r, a or b is not a number, `swap` does not have g
        elements, or a keyword is not a parameter of a design.

    *Source: Nawratil, Definition 6; the lines are those of (26) seen along z*
    """
    check_keywords("set_p", settings, SETTINGS)
    chosen = (False,) * g if swap is None else check_items("swap", swap, f"{g} booleans")
    if len(chosen) != g:
        raise InvalidInput(expected("swap", f"{g} booleans", len(chosen)))
    upper = set_n(g, r, 1.0, 0.0, a, b, swap=(*chosen, *chosen))
    defaults: dict[str, Any] = {
        "name": f"nawratil-p-g{g}",
        "source": "Nawratil, Definition 6",
        "home": PlanarPose([0.0, 0.0]),
    }
    return PlanarDesign(
        ["D1"] * g,
        upper.base_points[:g, :2],
        upper.platform_points[:g, :2],
        **{**defaults, **settings},
    )


@arguments.validated(g=arguments.integer(3), p=arguments.number)
def isotropic(g: int = 3, p: float = 1.0, swap: Iterable[bool] | None = None) -> PlanarDesign:
    """Return a planar design with CDN_OE = 1 and CTN = 1 at its home.

    Parameters
    ----------
    g, swap : see `set_p`
    p : float [1]
        The parameter of the one-parametric set of solutions; |p| from 1e-6 to 1e6. The operation
        ellipsoid has semi-axes 1, 1 in the plane, and p along z, which does not matter.

    Raises
    ------
    InvalidInput
        On numbers outside of their range, or `swap` that is not g booleans.

    Examples
    --------
    >>> from gsp.planar.indices import control_number
    >>> design = isotropic(4, 0.7)
    >>> round(float(control_number(design.at(design.home))), 9)
    1.0

    *Source: Nawratil, §4.2: the isotropic designs of the set N seen along z*
    """
    x = isotropic_parameters(p)
    return set_p(
        g,
        x["r"],
        x["a"],
        x["b"],
        swap=swap,
        ellipsoid=Ellipsoid((1.0, 1.0, abs(p))),
        name=f"nawratil-planar-isotropic-g{g}-p{p:.4g}",
        source="Nawratil, §4.2",
    )
