"""Symmetries of a template: motions and reflections that put its anchors in another order."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache

import numpy as np

from gsp import arguments
from gsp.catalogue.placement import lines_of
from gsp.errors import InvalidDesign, InvalidInput, expected
from gsp.geometry.congruence import Figure
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design, check_undriven
from gsp.model.design.symmetry import Symmetry, symmetries_between

# Papers print coordinates to four or five digits: their symmetries hold to 1e-5 of the size.
TEMPLATE_TOLERANCE = 1e-4
# Symmetries of anchors that differ by more than this share of the size have no meaning.
LARGEST_TOLERANCE = 0.1
# All 8! orders of as many legs in one point take some ten seconds.
MOST_POSITIONS = 8
# The image of each position, and whether base and platform are exchanged.
Order = tuple[tuple[int, ...], bool]


@arguments.validated(
    template=check_undriven,
    reflections=arguments.flag,
    exchange=arguments.flag,
    tolerance=arguments.one(arguments.within(1e-12, LARGEST_TOLERANCE)),
)
def symmetries(
    template: Design,
    *,
    reflections: bool = True,
    exchange: bool = False,
    tolerance: float = TEMPLATE_TOLERANCE,
) -> tuple[Symmetry, ...]:
    """Return the symmetry group of the positions of a template, one symmetry for each order.

    A symmetry is an isometry g of the base and k of the platform that move all anchor points, and
    the lines through them, onto each other in the same order. Mechanisms whose legs are in that
    order have the same joint values at the pose g T k⁻¹ as the others at T (angles θ between lines
    may become π − θ). Lines that the template does not have are those of `instantiate`. k leaves
    the platform origin and the ellipsoid of the template in place, so the values of all indices
    agree as well, but for the stiffness along axes of the base: g turns the axes.

    Both isometries are motions, or both are reflections. A reflection by Q makes Q v of the
    velocity v and −Q ω of the angular velocity ω: a row [u, r × u] of the Jacobian becomes
    [Q u, −Q (r × u)]. Its singular values stay, and det J changes its sign at most.

    Parameters
    ----------
    template : Design
        With at most eight legs. What kinds they are does not matter.
    reflections : bool
        Whether orders are included that need reflections.
    exchange : bool
        Whether symmetries are included that move the base onto the platform and the platform onto
        the base; they may move the platform origin.
    tolerance : float [1]
        Largest distance of a moved anchor from its image, over the rms radius of the template
        (`rms_radius`), and largest difference of the directions of lines [rad].

    Returns
    -------
    tuple of Symmetry
        The identity first; a motion where an order has both. `legs` is the order: position i is
        moved to position `legs[i]`.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type or range, or if the orders that fit within the tolerance are
        no group, as the template is symmetric to about this tolerance.
    InvalidDesign
        If the template has more than eight legs.

    *Source: ours; docs/exploration.md*

    Examples
    --------
    >>> from gsp.catalogue import design
    >>> group = symmetries(design("toz-kucuk-2016-d3-6"))
    >>> [(s.legs, s.reflected) for s in group][:3]
    [((0, 1, 2, 3, 4, 5), False), ((1, 0, 5, 4, 3, 2), True), ((2, 3, 4, 5, 0, 1), False)]
    """
    if template.n_legs > MOST_POSITIONS:
        wanted = f"at most {MOST_POSITIONS} legs, whose orders can be compared"
        raise InvalidDesign(expected("template", wanted, template.n_legs))
    return _group(template, reflections, exchange, tolerance)


# All 195 mechanisms are placed on one template.
@lru_cache(maxsize=16)
def _group(
    template: Design, reflections: bool, exchange: bool, tolerance: float
) -> tuple[Symmetry, ...]:
    still = np.eye(3, 4)
    found = [
        Symmetry(tuple(range(template.n_legs)), still, still),
        *_kept(template, tolerance),
        *(_exchanges(template, tolerance) if exchange else ()),
    ]
    best: dict[Order, Symmetry] = {}
    for symmetry in sorted(found, key=lambda s: (s.exchanged, s.legs, s.reflected)):
        if reflections or not symmetry.reflected:
            best.setdefault((symmetry.legs, symmetry.exchanged), symmetry)
    _check_group(best, tolerance)
    return tuple(best.values())


def _figures(template: Design, middle: Array | None) -> tuple[Figure, Figure]:
    """Return base and platform with lines; the platform from `middle`, None for its centre."""
    size = template.rms_radius
    base, platform = (_unit(lines) for lines in lines_of(template))
    return (
        Figure.of(template.base_points, size, lines=base),
        Figure.of(template.platform_points, size, lines=platform, centre=middle),
    )


def _unit(lines: Array) -> Array:
    """Return unit vectors, and 0 where there is no line."""
    lengths = norm(lines)[:, None]
    return np.divide(lines, lengths, out=np.zeros_like(lines), where=lengths > 0.0)


def _kept(template: Design, tolerance: float) -> Iterator[Symmetry]:
    """Symmetries that leave the bodies, the platform origin and the ellipsoid in place."""
    base, platform = _figures(template, np.zeros(3))
    for symmetry in symmetries_between((base, base), (platform, platform), tolerance):
        ellipsoid, k = template.ellipsoid, symmetry.platform[:, :3]
        if ellipsoid is None or _fits(ellipsoid, k, tolerance, template.rms_radius):
            yield symmetry


def _exchanges(template: Design, tolerance: float) -> Iterable[Symmetry]:
    base, platform = _figures(template, None)
    return symmetries_between((base, platform), (platform, base), tolerance, exchanged=True)


def _fits(ellipsoid: Ellipsoid, q: Array, tolerance: float, size: float) -> bool:
    """Whether an ellipsoid turned about the platform origin is in the same place."""
    root = ellipsoid.rotation * ellipsoid.semi_axes
    shape, centre = root @ root.T, ellipsoid.center
    # The squares of the semi-axes differ by twice the share of the lengths.
    same = np.abs(q @ shape @ q.T - shape).max() <= 2.0 * tolerance * np.abs(shape).max()
    return bool(same and norm(q @ centre - centre) <= tolerance * size)


def _check_group(found: Collection[Order], tolerance: float) -> None:
    """Raise InvalidInput if two of the orders one after the other make one that is not there."""
    first = next(iter(found))
    generators, group = list[Order](), {first}
    for order in found:
        if order in group:
            continue
        generators.append(order)
        new = group
        while new and len(group) <= len(found):
            new = {_after(a, b) for a in new for b in generators} - group
            group |= new
    if len(group) > len(found):
        wanted = "a tolerance at which the symmetries of the template are a group"
        raise InvalidInput(expected("tolerance", wanted, f"{tolerance:g}"))


def _after(first: Order, second: Order) -> Order:
    return tuple(second[0][i] for i in first[0]), first[1] != second[1]
