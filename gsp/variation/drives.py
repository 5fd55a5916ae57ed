"""Legs that are driven at the base, on patches: the rods of `gsp.model.rods` as jets.

The bounds are infinite where a drive may be singular on the patch. They are for paths along which
the joint value changes continuously.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from gsp.geometry.scalars import norm
from gsp.model.drives import Crank, Slider
from gsp.model.rods import arm_axes
from gsp.variation.jets import (
    JET_ROUNDING,
    Jet,
    Vector,
    constant,
    image,
    inner,
    inverse,
    magnitude,
    multiple,
    outer,
    row_of,
    scaled,
    sharpened,
    square_root,
    total,
)
from gsp.variation.legs import Patch, across, lines_of


@dataclass(frozen=True)
class RodOnPatch:
    """The rod of a driven leg on a patch.

    Attributes
    ----------
    direction, moment : Jet
        u, from the tip to the platform anchor at r from the platform origin, and r × u.
    joint : Jet
        Travel q of a slider; of a crank (cos q, sin q), whose |X″| is at least |q″|.
    """

    direction: Jet
    moment: Jet
    joint: Jet

    @property
    def row(self) -> Jet:
        """[u, r × u]: the row of the drive times its scale, lengths in units of the design."""
        return row_of(self.direction, self.moment)


def slider_rod(patch: Patch, geometry: Vector, drive: Slider) -> RodOnPatch:
    """Return the rod of a slider: the tip is at q = s·d − b sqrt(ℓ² − c²) on the rail."""
    d, arm, s, _ = lines_of(patch, geometry)
    rod, branch = drive.numbers
    c = across(d, s, geometry[16] + JET_ROUNDING, 0.0)
    gap = square_root(sharpened(_less_square(rod, c)))
    u = scaled(1.0 / rod, total(c, multiple(gap, s), branch))
    return RodOnPatch(u, outer(arm, u, close=False), total(inner(d, s), gap, -branch))


def crank_rod(patch: Patch, geometry: Vector, drive: Crank) -> RodOnPatch:
    """Return the rod of a crank: (cos q, sin q) h² = C (X, Y) + b sqrt(h² − C²) (Y, −X)."""
    d, arm, s, _ = lines_of(patch, geometry)
    rod, branch, *crank = drive.numbers
    axial, x, y = arm_axes(list(crank), s.value)
    size = norm(x)
    d = total(d, constant(axial, norm(axial)), -1.0)
    # X = d · x and Y = d · y are the components along two orthogonal vectors of one length.
    plane = image(d, [x, y], size)
    aside = image(d, [y, [-a for a in x]], size)
    half = scaled(0.5, total(_less_square(rod, d), _number(size * size), 1.0))
    level = sharpened(total(_number(size * size), half, -1.0))
    square = inner(plane, plane)
    gap = square_root(sharpened(total(square, inner(level, level), -1.0)))
    sides = total(multiple(level, plane), multiple(gap, aside), branch)
    joint = multiple(inverse(square), sides)
    tip = image(joint, [list(pair) for pair in zip(x, y, strict=True)], size)
    u = scaled(1.0 / rod, total(d, tip, -1.0))
    return RodOnPatch(u, outer(arm, u, close=False), joint)


def _number(value: Any) -> Jet:
    return constant([value], magnitude(value))


def _less_square(rod: float, x: Jet) -> Jet:
    """Return ℓ² − x²."""
    return total(_number(rod * rod), inner(x, x), -1.0)


RODS: MappingProxyType[type[Any], Callable[..., RodOnPatch]] = MappingProxyType(
    {Slider: slider_rod, Crank: crank_rod}
)
