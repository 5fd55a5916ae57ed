"""The largest ball, cylinder or box that fits into a region of positions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_positive
from gsp.errors import EmptyWorkspace, InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE
from gsp.workspace.sets.shapes.meshes import free_faces

Body = Literal["ball", "cylinder", "box"]
# Centres that are tried at once, and at most; obstacles near a centre that are looked at.
CENTRES_PER_BATCH, MOST_CENTRES, NEAREST_OBSTACLES = 256, 100_000, 64
# Sizes are made smaller or larger by this share, for rounding.
SIZE_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False, kw_only=True)
class Inscribed(ReadOnly):
    """The largest body of given proportions in a region; made by `gsp.workspace.Region.largest`.

    Attributes
    ----------
    centre : (3,) array [length]
        In base axes.
    half_widths : (3,) or (2,) array [length]
        Of the body, along the axes of the base or the directions of the plane: its radii where it
        is round.
    factor : float [1]
        The multiple of the proportions that fits, proven.
    above : float [1]
        No greater multiple fits, proven.
    """

    centre: Array
    half_widths: Array
    factor: float
    above: float


@dataclass(frozen=True)
class _Gauge:
    """How large a body of proportions 1 is that reaches a distance along the axes.

    `dual` of the normal of a plane is how far the body of size 1 reaches along it. The gauge is
    at least the norm of `order`.
    """

    size: Callable[[Array], Array]
    dual: Callable[[Array], Array]
    order: float


GAUGES: Mapping[str, _Gauge] = MappingProxyType(
    {
        "ball": _Gauge(
            lambda gap: np.sqrt((gap * gap).sum(axis=-1)),
            lambda n: np.sqrt((n * n).sum(axis=-1)),
            2.0,
        ),
        "cylinder": _Gauge(
            lambda gap: np.maximum(np.hypot(gap[..., 0], gap[..., 1]), gap[..., 2]),
            lambda n: np.hypot(n[..., 0], n[..., 1]) + n[..., 2],
            np.inf,
        ),
        "box": _Gauge(lambda gap: gap.max(axis=-1), lambda n: n.sum(axis=-1), np.inf),
    }
)


def largest(region: Any, body: Body, proportions: ArrayLike | None, tolerance: float) -> Inscribed:
    """Return the largest body in a region: see `gsp.workspace.Region.largest`."""
    body = arguments.one_of(*get_args(Body))("body", body)
    shape, share = _proportions(region, body, proportions), check_positive("tolerance", tolerance)
    d, gauge = len(shape), GAUGES[body]
    low, high, cuts = region.low / shape, region.high / shape, region.cuts.copy()
    cuts[:, :d] *= shape
    cuts[:, 4 : 4 + d] *= shape
    open_ = region.codes != INSIDE
    near, far = _outer_faces(low, high)
    obstacles = _obstacles(
        np.concatenate((low[open_], near)),
        np.concatenate((high[open_], far)),
        np.concatenate((cuts[open_, 4:], np.tile([0.0] * 3 + [np.inf], (len(near), 1)))),
    )
    points = np.concatenate(
        (_outside(low[open_], high[open_], cuts[open_, :4]), 0.5 * (near + far))
    )
    # The body may be centred in the inside part of an undecided cell.
    some = ~open_ | (cuts[:, 7] < np.inf)
    if not some.any():
        raise EmptyWorkspace(expected("region", "a cell that is proven inside", "none"))
    centre, factor, _ = _deepest(
        low[some], high[some], gauge, lambda p: _to_obstacles(p, obstacles, gauge), share
    )
    _, _, above = _deepest(low, high, gauge, lambda p: _to_points(p, points, gauge), share)
    return Inscribed(
        centre=region.problem.outward(np.pad(centre * shape, (0, 3 - d))),
        half_widths=factor * (1.0 - SIZE_ROUNDING) * shape,
        factor=factor * (1.0 - SIZE_ROUNDING),
        above=max(above, factor) * (1.0 + SIZE_ROUNDING),
    )


def _proportions(region: Any, body: Any, given: ArrayLike | None) -> Array:
    """Return the half-widths of the body of size 1, (d,), if they suit the body and the region."""
    if region.kind == "orientations":
        raise InvalidInput(expected("region", "a region of positions", region.kind))
    d = region.low.shape[1]
    if body == "cylinder" and d == 2:
        raise InvalidInput(expected("body", '"ball" or "box" in a plane', brief(body)))
    shape = np.ones(d) if given is None else arguments.bounded_array("proportions", given, (d,))
    if shape.ndim != 1 or not (shape > 0.0).all():
        raise InvalidInput(expected("proportions", f"{d} positive numbers", brief(given)))
    radii = {"ball": shape, "cylinder": shape[:2], "box": shape[:1]}[body]
    if (radii != radii[0]).any():
        raise InvalidInput(expected("proportions", f"equal radii of a {body}", brief(given)))
    return shape


def _outer_faces(low: Array, high: Array) -> tuple[Array, Array]:
    """Return the faces between boxes (n, d) and what is in none, as boxes of no width."""
    lows, highs = [np.zeros((0, low.shape[1]))], [np.zeros((0, low.shape[1]))]
    for k, side, a, b in free_faces(low, high):
        near, far = a.copy(), b.copy()
        near[:, k] = far[:, k] = (b if side else a)[:, k]
        lows.append(near)
        highs.append(far)
    return np.concatenate(lows), np.concatenate(highs)


def _outside(low: Array, high: Array, cuts: Array) -> Array:
    """Return corners of cells (n, d), and points of their cuts, that are proven outside."""
    d = low.shape[1]
    n, c = cuts[:, :d], cuts[:, 3]
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    signs = np.array(np.meshgrid(*[(-1.0, 1.0)] * d)).reshape(d, -1).T
    # From each corner along the normal to the plane, if that is in the cell.
    delta = (half[:, None] * signs).reshape(-1, d)
    n, c, half, middle = (np.repeat(x, 2**d, axis=0) for x in (n, c, half, middle))
    beyond = (n * delta).sum(axis=1) - c
    square = (n * n).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        step = np.where(beyond > 0.0, beyond / square, 0.0)
        moved = delta - np.where(step > 0.0, step, 0.0)[:, None] * n
    inside = (np.abs(moved) <= half).all(axis=1) & np.isfinite(beyond)
    return np.asarray((middle + moved)[inside])


def _obstacles(low: Array, high: Array, cuts: Array) -> list[tuple[Any, Array, Array, Array]]:
    """Return what is not proven inside: boxes, and the side n · δ ≤ c of a plane, of each size."""
    from scipy.spatial import cKDTree

    half = 0.5 * (high - low)
    unit = max(float(half.max(initial=0.0)), 1e-300)
    sizes = np.round(half / unit, 9)
    groups = []
    for size in np.unique(sizes, axis=0):
        chosen = (sizes == size).all(axis=1)
        middle = 0.5 * (low + high)[chosen]
        groups.append((cKDTree(middle), middle, half[chosen], cuts[chosen]))
    return groups


def _to_obstacles(p: Array, groups: list[tuple[Any, Array, Array, Array]], gauge: _Gauge) -> Array:
    """Return the size of the largest body about points (m, d) that meets no obstacle, or less."""
    size = np.full(len(p), np.inf)
    for tree, middle, half, cuts in groups:
        k = min(NEAREST_OBSTACLES, len(middle))
        far, near = tree.query(p, k=[*range(1, k + 1)], p=gauge.order)
        delta = p[:, None] - middle[near]
        gap = gauge.size(np.maximum(np.abs(delta) - half[near], 0.0))
        n, c = cuts[near, : p.shape[1]], cuts[near, 3]
        with np.errstate(invalid="ignore", divide="ignore"):
            beyond = ((n * delta).sum(axis=-1) - c) / gauge.dual(np.abs(n))
        size = np.minimum(size, np.fmax(gap, beyond).min(axis=1))
        if k < len(middle):
            # The others are farther away.
            reach = float(np.linalg.norm(half[0], ord=gauge.order)) * (1.0 + 1e-6)
            size = np.minimum(size, np.maximum(far[:, -1] - reach, 0.0))
    return size


def _to_points(p: Array, points: Array, gauge: _Gauge) -> Array:
    """Return the size of the largest body about points (m, d) without others inside, or more."""
    from scipy.spatial import cKDTree

    k = min(NEAREST_OBSTACLES, len(points))
    _, near = cKDTree(points).query(p, k=[*range(1, k + 1)], p=gauge.order)
    return np.asarray(gauge.size(np.abs(p[:, None] - points[near])).min(axis=1))


def _deepest(
    low: Array, high: Array, gauge: _Gauge, size: Callable[[Array], Array], share: float
) -> tuple[Array, float, float]:
    """Return the centre in boxes (n, d) whose body is largest, its size, and an upper bound.

    The size changes by no more than the gauge of a displacement, so boxes of centres are bounded
    from their middles; that with the greatest bound is halved.
    """
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    value = size(middle)
    bound = value + gauge.size(half)
    # Products of floats overflow to infinity without a warning, as those with great tolerances do.
    best, centre, tried = float(value.max()), middle[value.argmax()], len(value)
    while tried < MOST_CENTRES and bound.max(initial=0.0) > best * (1.0 + share):
        some = np.argsort(-bound, kind="stable")[:CENTRES_PER_BATCH]
        rest = np.ones(len(bound), dtype=np.bool_)
        rest[some] = False
        k, i = half[some].argmax(axis=1), np.arange(len(some))
        step = np.zeros((len(some), half.shape[1]))
        step[i, k] = 0.5 * half[some, k]
        points = np.concatenate((middle[some] - step, middle[some] + step))
        sides = np.tile(half[some] - step, (2, 1))
        found = size(points)
        tried += len(points)
        if found.max() > best:
            best, centre = float(found.max()), points[found.argmax()]
        ends = np.minimum(found + gauge.size(sides), np.tile(bound[some], 2))
        middle = np.concatenate((middle[rest], points))
        half = np.concatenate((half[rest], sides))
        bound = np.concatenate((bound[rest], ends))
        above = bound > best
        middle, half, bound = middle[above], half[above], bound[above]
    return centre, best, float(max(best, bound.max(initial=0.0)))
