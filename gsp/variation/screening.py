"""Stages that bound σ_min and the condition number without singular values.

With the preconditioner T, J(x) T = Q + D. As QᵀQ is I to rounding, ‖T‖₂ is near to 1/σ_min. It is
at most (tr (T Tᵀ)⁴)^(1/8), the eighth root of the sum of the eighth powers of its singular values,
and at least that over 6^(1/8); the same for ‖J‖₂ = σ_max. So the bounds are wider than those of
`matrices` by some percent, and need no iteration. The second stage adds Weyl's inequality for
σ_max, which needs the products of the derivatives of the rows. See `docs/proofs.md`, singular
values.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot, root
from gsp.kernels.stages import UPPER_SCALARS, Stage, store
from gsp.kernels.trace import Graph
from gsp.variation.jets import least
from gsp.variation.layout import HIGH, LOW, QUANTITY_SCALARS
from gsp.variation.legs import PATCH_SCALARS, Patch
from gsp.variation.matrices import (
    GRAM_NEAR,
    GRAM_REST,
    GRAM_SCALARS,
    INVERSE_SCALARS,
    INWARD,
    PLACE,
    SPECTRAL_ROUNDING,
    variation,
)
from gsp.variation.quantities import (
    INFINITE,
    OUTWARD,
    guarded,
    positive,
    shares_of,
)

# What the norm by eighth powers of six equal singular values exceeds them by.
EIGHTH_POWER_EXCESS = 6.0**0.125


def _power_norm(t: list[Any], squarings: int) -> Any:
    """Return (tr (T Tᵀ)ⁿ)^(1/2n), n = 2^(1 + squarings), of an upper triangle, at least ‖T‖₂."""

    def product(x: dict[tuple[int, int], Any], i: int, j: int, first: int) -> Any:
        return dot([x[i, k] for k in range(first, 6)], [x[j, k] for k in range(first, 6)])

    upper = {pair: t[k] for pair, k in PLACE.items()}
    square = {(i, j): product(upper, i, j, j) for i, j in PLACE}
    for _ in range(squarings):
        square |= {(j, i): x for (i, j), x in square.items()}
        square = {(i, j): product(square, i, j, 0) for i, j in PLACE}
    total: Any = 0.0
    for i, j in PLACE:
        entry = square[i, j]
        total = total + (entry * entry if i == j else 2.0 * (entry * entry))
    for _ in range(squarings + 2):
        total = root(total)
    return total


def _margin(upper: list[Any]) -> Any:
    """Bound of the rounding of singular values of a triangle."""
    return SPECTRAL_ROUNDING * root(dot(upper[:INVERSE_SCALARS], upper[:INVERSE_SCALARS])) * OUTWARD


def _screen() -> Stage:
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    upper, sums = graph.lanes("upper", UPPER_SCALARS), graph.lanes("sums", GRAM_SCALARS)
    inverse = graph.lanes("inverse", INVERSE_SCALARS)
    shares = shares_of(patch, graph.scalar("length"))
    linear, straight = variation(sums)
    rest, near = root(sums[GRAM_REST]) * OUTWARD, root(sums[GRAM_NEAR]) * OUTWARD
    margin = _margin(upper)
    stretch = _power_norm(inverse, 1) * OUTWARD
    size = _power_norm(upper[:INVERSE_SCALARS], 1) * OUTWARD
    # The singular values of Q are 1 to rounding, of the triangle and of its inverse.
    rounding = 2.0 * (margin * stretch)
    q_low, q_high = positive(1.0 - rounding), 1.0 + rounding * OUTWARD
    # σ_min and σ_max at the centre.
    small = q_low / stretch * INWARD, q_high / stretch * (EIGHTH_POWER_EXCESS * OUTWARD)
    large = positive(size / EIGHTH_POWER_EXCESS - margin) * INWARD, size + margin

    def bounds(reach: Any) -> tuple[list[Any], list[Any]]:
        share = reach * OUTWARD / q_low
        fewer, more = positive(1.0 - share) * INWARD, (1.0 + share) * OUTWARD
        low, high = guarded(small[0] * fewer, reach), small[1] * more
        ratio = choose(low > 0.0, large[1] * more / low * OUTWARD, INFINITE)
        least = large[0] * fewer / high * INWARD
        return [low, high], [choose(least < 1.0, 1.0, least), ratio]

    reach, error = linear + (rest + margin) * stretch, (near + margin) * stretch
    (value, ratio), (value_near, ratio_near) = bounds(reach), bounds(error)
    parts = [x + rest * stretch * share for x, share in zip(straight, shares, strict=True)]
    outputs = store("quantity", [*value, *value_near, *parts, *ratio, *ratio_near, *parts])
    arrays = ("patch", "upper", "sums", "inverse", "quantity")
    return Stage("proof screen", arrays, ("length",), outputs)


def _second_screen() -> Stage:
    """Lower the bound of the condition number by Weyl's inequality for σ_max."""
    graph = Graph()
    upper, gram = graph.lanes("upper", UPPER_SCALARS), graph.lanes("gram", GRAM_SCALARS)
    quantity = graph.lanes("quantity", 2 * QUANTITY_SCALARS)
    linear, _ = variation(gram)
    size, margin = _power_norm(upper[:INVERSE_SCALARS], 2) * OUTWARD, _margin(upper)
    largest = (size + 2.0 * margin + linear + root(gram[GRAM_REST])) * OUTWARD
    low, ratio = quantity[LOW], quantity[QUANTITY_SCALARS + HIGH]
    ratio = least(choose(low > 0.0, largest / low * OUTWARD, INFINITE), ratio)
    outputs = store("quantity", [ratio], QUANTITY_SCALARS + HIGH)
    return Stage("proof second screen", ("upper", "gram", "quantity"), (), outputs)


SCREEN, SECOND_SCREEN = _screen(), _second_screen()
ALL = SCREEN, SECOND_SCREEN
