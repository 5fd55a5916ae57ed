"""The largest ball, cylinder or box that fits into a region of positions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_positive
from gsp.errors import EmptyWorkspace, InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE
from gsp.workspace.sets.shapes.clipped import corners_beyond
from gsp.workspace.sets.shapes.free import outer_faces
from gsp.workspace.sets.tree.cuts import boxes_beyond

Body = Literal["ball", "cylinder", "box"]
Size = Callable[[Array], Array]
# Obstacles: the tree of their middles, these, their half-widths, and planes.
Group = tuple[Any, Array, Array, Array]


class Obstacles(NamedTuple):
    """What a body may not reach: all of it, and divided into boxes of one size."""

    all: Group
    groups: list[Group]


# Centres that are tried at once, and at most.
CENTRES_PER_BATCH, MOST_CENTRES = 256, 100_000
# Obstacles of one size near a centre that are looked at; more where these do not suffice.
NEAREST_OBSTACLES = (1, 8, 64)
NO_PLANE = (0.0, 0.0, 0.0, np.inf)
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
    reached : bool
        Whether the searches ended by the tolerance, and not at the greatest number of centres: the
        rest of `gap` is that of the undecided cells then.
    """

    centre: Array
    half_widths: Array
    factor: float
    above: float
    reached: bool

    @property
    def gap(self) -> float:
        """How much more than `factor` is not excluded, as a share of it: above / factor − 1 [1].

        *Source: ours; see docs/sets.md*
        """
        return self.above / self.factor - 1.0 if self.factor > 0.0 else float("inf")


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
    # The body may be centred in the inside part of an undecided cell.
    some = ~open_ | (cuts[:, 7] < np.inf)
    if not some.any():
        raise EmptyWorkspace(expected("region", "a cell that is proven inside", "none"))
    near, far = outer_faces(low, high)
    obstacles = _obstacles(
        np.concatenate((low[open_], near)),
        np.concatenate((high[open_], far)),
        np.concatenate((cuts[open_, 4:], np.tile(NO_PLANE, (len(near), 1)))),
    )
    flat = [(0, 0), (0, 3 - d)]
    outside = corners_beyond(np.pad(low[open_], flat), np.pad(high[open_], flat), -cuts[open_, :4])
    points = np.concatenate((outside[:, :d], 0.5 * (near + far)))
    centre, factor, bound = _deepest(
        low[some],
        high[some],
        gauge,
        lambda p: _sizes(p, obstacles, gauge)[0],
        lambda p: _most(p, obstacles, gauge),
        share,
    )
    # A body beyond `above` has one of these points inside, wherever its centre is.
    out = _obstacles(points, points, np.tile(NO_PLANE, (len(points), 1)))
    # Nor is its centre in a part that is outside: most of a large cell often is.
    _, deepest, above = _deepest(
        *boxes_beyond(low, high, cuts[:, :4]),
        gauge,
        lambda p: _sizes(p, out, gauge)[1],
        lambda p: _most(p, out, gauge),
        share,
    )
    return Inscribed(
        centre=region.problem.outward(np.pad(centre * shape, (0, 3 - d))),
        half_widths=factor * (1.0 - SIZE_ROUNDING) * shape,
        factor=factor * (1.0 - SIZE_ROUNDING),
        above=max(above, factor) * (1.0 + SIZE_ROUNDING),
        reached=bound <= factor * (1.0 + share) and above <= deepest * (1.0 + share),
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


def _obstacles(low: Array, high: Array, cuts: Array) -> Obstacles:
    """Return what is not proven inside: boxes, and the side n · δ ≤ c of a plane."""
    half, middle = 0.5 * (high - low), 0.5 * (low + high)
    unit = max(float(half.max(initial=0.0)), 1e-300)
    number = np.zeros(len(half), dtype=np.int64)
    for column in np.round(half / unit, 9).T:
        of_size, here = np.unique(column, return_inverse=True)
        number = np.unique(number * len(of_size) + here, return_inverse=True)[1]
    chosen = [number == i for i in range(number.max(initial=-1) + 1)]
    groups = [_group(middle[some], half[some], cuts[some]) for some in chosen]
    return Obstacles(_group(middle, half, cuts) if len(groups) > 1 else groups[0], groups)


def _group(middle: Array, half: Array, cuts: Array) -> Group:
    from scipy.spatial import cKDTree

    return cKDTree(middle), middle, half, cuts


def _sizes(p: Array, obstacles: Obstacles, gauge: _Gauge) -> tuple[Array, Array]:
    """Return two bounds of the size of the largest body about points (m, d) without obstacles."""
    one_size = len(obstacles.groups) == 1
    most = np.full(len(p), np.inf) if one_size else _most(p, obstacles, gauge)
    least = np.full(len(p), np.inf)
    for group in obstacles.groups:
        tree, _, half, _ = group
        # Others than those that were looked at are farther away.
        reach = float(np.linalg.norm(half[0], ord=gauge.order)) * (1.0 + 1e-6)
        open_, far = np.arange(len(p)), np.zeros(len(p))
        for k in NEAREST_OBSTACLES:
            far, gap = _gaps(p[open_], group, min(k, tree.n), gauge)
            most[open_] = np.minimum(most[open_], gap)
            far = np.maximum(far - reach, 0.0) if k < tree.n else np.full(len(open_), np.inf)
            nearer = far < most[open_]
            open_, far = open_[nearer], far[nearer]
            if not open_.size:
                break
        least[open_] = np.minimum(least[open_], far)
    return np.minimum(least, most), most


def _most(p: Array, obstacles: Obstacles, gauge: _Gauge) -> Array:
    """Return the size of the body about points (m, d) that meets the obstacle with nearest middle.

    No larger one is without obstacles.
    """
    return _gaps(p, obstacles.all, 1, gauge)[1]


def _gaps(p: Array, group: Group, k: int, gauge: _Gauge) -> tuple[Array, Array]:
    """Return how far the last of the k nearest middles is, and the least gap to these obstacles."""
    tree, middle, half, cuts = group
    far, near = tree.query(p, k=[*range(1, k + 1)], p=gauge.order)
    delta = p[:, None] - middle[near]
    gap = gauge.size(np.maximum(np.abs(delta) - half[near], 0.0))
    n, c = cuts[near, : p.shape[1]], cuts[near, 3]
    with np.errstate(invalid="ignore", divide="ignore"):
        beyond = ((n * delta).sum(axis=-1) - c) / gauge.dual(np.abs(n))
    return far[:, -1], np.fmax(gap, beyond).min(axis=1)


def _deepest(
    low: Array, high: Array, gauge: _Gauge, size: Size, most: Size, share: float
) -> tuple[Array, float, float]:
    """Return the centre in boxes (n, d) whose body is largest, its size, and an upper bound.

    The size changes by no more than the gauge of a displacement, so boxes of centres are bounded
    from their middles; that with the greatest bound is halved. `most` is a bound of the size that
    takes less time: most boxes are left out by it.
    """
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    bound = most(middle) + gauge.size(half)
    some = np.argsort(-bound, kind="stable")[:CENTRES_PER_BATCH]
    value = size(middle[some])
    # Products of floats overflow to infinity without a warning, as those with great tolerances do.
    best, centre, tried = float(value.max()), middle[some[value.argmax()]], len(value)
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
