"""A stage that bounds σ_min and the condition number without singular values.

With the preconditioner T, J(x) T = Q + D. As QᵀQ is I to rounding, ‖T‖₂ is near to 1/σ_min. It is
at most (tr (T Tᵀ)⁴)^(1/8), the eighth root of the sum of the eighth powers of its singular values,
and at least that over 6^(1/8); the same for ‖J‖₂ = σ_max. So the bounds are wider than those of
`matrices` by some percent, and need no iteration. See `docs/proofs.md`, singular values.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot, root
from gsp.kernels.stages import UPPER, Stage
from gsp.kernels.trace import Graph
from gsp.variation.legs import PATCH, Patch
from gsp.variation.matrices import (
    GRAM,
    GRAM_NEAR,
    GRAM_REST,
    INVERSE,
    INWARD,
    PLACE,
    SPECTRAL,
    variation,
)
from gsp.variation.quantities import (
    INFINITE,
    OUTWARD,
    guarded,
    positive,
    shares_of,
    store,
)

# What the norm by eighth powers of six equal singular values exceeds them by.
EXCESS = 6.0**0.125


def _eighth_power_norm(t: list[Any]) -> Any:
    """Return (tr (T Tᵀ)⁴)^(1/8) of an upper triangle, at least ‖T‖₂."""

    def product(x: dict[tuple[int, int], Any], i: int, j: int, first: int) -> Any:
        return dot([x[i, k] for k in range(first, 6)], [x[j, k] for k in range(first, 6)])

    upper = {pair: t[k] for pair, k in PLACE.items()}
    square = {(i, j): product(upper, i, j, j) for i, j in PLACE}
    square |= {(j, i): x for (i, j), x in square.items()}
    total: Any = 0.0
    for i, j in PLACE:
        entry = product(square, i, j, 0)
        total = total + (entry * entry if i == j else 2.0 * (entry * entry))
    return root(root(root(total)))


def _screen() -> Stage:
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH))
    upper, sums = graph.lanes("upper", UPPER), graph.lanes("sums", GRAM)
    inverse = graph.lanes("inverse", INVERSE)
    shares = shares_of(patch, graph.scalar("length"))
    linear, straight = variation(sums)
    rest, near = root(sums[GRAM_REST]) * OUTWARD, root(sums[GRAM_NEAR]) * OUTWARD
    margin = SPECTRAL * root(dot(upper[:INVERSE], upper[:INVERSE])) * OUTWARD
    stretch = _eighth_power_norm(inverse) * OUTWARD
    size = _eighth_power_norm(upper[:INVERSE]) * OUTWARD
    # The singular values of Q are 1 to rounding, of the triangle and of its inverse.
    rounding = 2.0 * (margin * stretch)
    q_low, q_high = positive(1.0 - rounding), 1.0 + rounding * OUTWARD
    # σ_min and σ_max at the centre.
    small = q_low / stretch * INWARD, q_high / stretch * (EXCESS * OUTWARD)
    large = positive(size / EXCESS - margin) * INWARD, size + margin

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


SCREEN = _screen()
