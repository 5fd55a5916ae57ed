"""Workspaces in space: ray ends in all directions, their surface and its volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp import arguments
from gsp.checks import check_integer, check_items, check_memory, reading
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array, Mask, frozen
from gsp.limits.bounds import bounded_quantities
from gsp.limits.limits import Limits
from gsp.limits.quantities import BoundedQuantities
from gsp.model.design import Design, check_undriven
from gsp.progress import Progress, meter
from gsp.workspace.boundary.mapping import RAY_BYTES
from gsp.workspace.boundary.orientations import feasible_orientations
from gsp.workspace.boundary.rays import ray_ends
from gsp.workspace.volumes import Volume

# Rays climbed at once, and between two reports of progress.
RAYS_PER_BLOCK = 2000
# Highest order of symmetry that is tried.
MOST_FOLDS = 12
# Anchors that a turn maps nearer than this [share of the design's size] repeat each other.
REPEAT_TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class Surface(ReadOnly):
    """The ends of rays from one point over a grid of directions.

    Attributes
    ----------
    origin : (3,) array [length]
    theta : (a,) array [rad]
        Angles of the vertical half-planes.
    height : (b,) array [1]
        Cosines of the rays with the z-axis.
    distance : (a, b) array [length]
        To the farthest end that is a local maximum; NaN where none is.
    labels : (a, b) array of str
        The limits at which the ray ends, "" where none is a local maximum.
    coarse : array of shape (a // 2 + 1, b // 2 + 1) [length]
        Distances on a coarser grid, for the estimate of errors.
    folds : int
        The symmetry about the vertical through the origin that was used: the half-planes cover
        2π / folds.
    """

    origin: Array
    theta: Array
    height: Array
    distance: Array
    labels: NDArray[np.str_]
    coarse: Array
    folds: int

    @property
    def maximal(self) -> Mask:
        """Where an end is a local maximum of the distance, shape (a, b).

        *Source: ours*
        """
        return np.asarray(~np.isnan(self.distance))

    @property
    def points(self) -> Array:
        """The ends, in base axes, over the full turn: shape (a · folds, b, 3) [length].

        *Source: Workspace-3, eqs. (3.10)–(3.16): rays in a fan of vertical planes*
        """
        theta = np.concatenate(
            [self.theta + 2.0 * np.pi * k / self.folds for k in range(self.folds)]
        )
        distance = np.tile(self.distance, (self.folds, 1))
        return self.origin + distance[..., None] * _directions(theta, self.height)

    def volume(self) -> Volume:
        """Volume between the origin and the surface, ∫ r³ / 3 dΩ, and an estimate of its error.

        It is that of the set if the set is star-shaped about the origin. The rule is
        Gauss–Legendre in the cosine, and the mean over the half-planes; the error is estimated from
        a grid of about half as many of both. A ray whose end is no local maximum counts with
        the mean of r³ of the others, and all of its share is added to the error.

        Raises
        ------
        EmptyWorkspace
            If no end is a local maximum.

        *Source: ours*
        """
        value, unknown = _volume(self.distance)
        coarse, _ = _volume(self.coarse)
        return Volume(value, abs(value - coarse) + unknown)


def _volume(distance: Array) -> tuple[float, float]:
    """Return a volume, and the part of it that rays without a solved end are taken to have."""
    known = np.isfinite(distance)
    if not known.any():
        raise EmptyWorkspace(expected("surface", "a ray whose end is a local maximum", "none"))
    _, weight = np.polynomial.legendre.leggauss(distance.shape[1])
    cubes = np.where(known, np.nan_to_num(distance) ** 3, (distance[known] ** 3).mean())
    shares = 2.0 * np.pi / 3.0 * cubes * weight / len(distance)
    return float(shares.sum()), float(shares[~known].sum())


def surface(
    design: Design,
    origin: ArrayLike | None = None,
    *,
    rotation: ArrayLike | None = None,
    limits: Limits | None = None,
    counts: tuple[int, int] = (24, 24),
    starts: int = 4,
    rng: np.random.Generator | int = 0,
    progress: Progress = None,
) -> Surface:
    """Return a workspace in space, mapped by rays in all directions as `section` does in a plane.

    Parameters
    ----------
    design : Design
    origin : (3,) array_like or None [length]
        The radiating point; default the position of the design's home pose.
    rotation : (3, 3) array_like or None [1]
        A fixed orientation; default none, any orientation is allowed.
    limits : Limits or None
        Default: the strokes of the design.
    counts : (int, int)
        Half-planes and rays in each. If the design is the same after a turn by 2π/m about the
        z-axis, and the origin lies on that axis, the half-planes cover 2π/m alone.
    starts : int
        Orientations per ray, as of `gsp.workspace.section`.
    rng : numpy.random.Generator or int
        Generator or seed of the orientations.
    progress : function (done, total), bool or None
        Called after each block of rays; False: no output; None or True: a progress bar.

    Returns
    -------
    Surface

    Raises
    ------
    EmptyWorkspace
        As `gsp.workspace.section`, for the orientations at the radiating point.
    MissingParameter
        Without limits.
    InvalidInput
        Without a radiating point; on limits that cross, strokes of zero, or wrong arguments.

    *Source: Workspace-3, eqs. (3.10)–(3.16): a fan of vertical planes over one period*
    """
    bounds = bounded_quantities(design, limits)
    if origin is None and design.home is None:
        raise InvalidInput(expected("origin", "a point, as the design has no home pose", None))
    place = design.home.position if origin is None else origin  # type: ignore[union-attr]
    start = arguments.bounded_array("origin", place, (3,))
    if start.ndim != 1:
        raise InvalidInput(expected("origin", "a single point", f"shape {start.shape}"))
    a, b = _counts(counts)
    turns = np.eye(3) if rotation is None else np.zeros((0, 3))
    alone = limits is None and rotation is None and not start[:2].any()
    folds = symmetry(design) if alone else 1
    few, all_rays = (a // 2 + 1) * (b // 2 + 1), a * b
    with meter(progress, "rays") as report:
        orientations = feasible_orientations(design, bounds, start, rotation, starts, rng)

        def ends(a: int, b: int, before: int) -> tuple[Array, Array, Array, NDArray[np.str_]]:
            theta = (np.arange(a) + 0.5) * 2.0 * np.pi / (a * folds)
            height, _ = np.polynomial.legendre.leggauss(b)
            heading = _directions(theta, height).reshape(-1, 3)

            def done(rays: int) -> None:
                report(before + rays, few + all_rays)

            far, labels = _farthest(bounds, turns, start, orientations, heading, done)
            return theta, height, far.reshape(a, b), labels.reshape(a, b)

        _, _, coarse, _ = ends(a // 2 + 1, b // 2 + 1, 0)
        theta, height, distance, labels = ends(a, b, few)
    return Surface(
        frozen(start),
        frozen(theta),
        frozen(height),
        frozen(distance),
        labels,
        frozen(coarse),
        folds,
    )


def _counts(given: Any) -> tuple[int, int]:
    with reading("counts", "two integers ≥ 1", given):
        a, b = check_items("counts", given, "two integers ≥ 1")
    # The heights are the eigenvalues of a matrix of b rows.
    check_memory("counts", check_integer("counts", b) ** 2, 16, "pairs of heights")
    check_memory("counts", check_integer("counts", a) * b, RAY_BYTES, "rays")
    return a, b


def _farthest(
    bounds: BoundedQuantities,
    turns: Array,
    start: Array,
    orientations: Array,
    heading: Array,
    done: Callable[[int], None],
) -> tuple[Array, NDArray[np.str_]]:
    """Distance and label of the farthest maximum in each direction; NaN, "" for none."""
    number = len(orientations)
    directions = np.repeat(heading, number, axis=0)
    distance = np.full(len(directions), -np.inf)
    labels: list[str] = []
    for low in range(0, len(directions), RAYS_PER_BLOCK):
        part = np.arange(low, min(low + RAYS_PER_BLOCK, len(directions)))
        where = np.broadcast_to(start, (len(part), 3))
        ends = ray_ends(bounds, turns, where, orientations[part % number], directions[part])
        distance[part] = np.where(ends.maximal, ends.distance, -np.inf)
        labels += ends.labels
        done((int(part[-1]) + 1) // number)
    rows = distance.reshape(-1, number)
    best = rows.argmax(axis=1)
    far = rows[np.arange(len(rows)), best]
    chosen = np.array(labels).reshape(-1, number)[np.arange(len(rows)), best]
    known = np.isfinite(far)
    return np.where(known, far, np.nan), np.where(known, chosen, "")


def _directions(theta: Array, height: Array) -> Array:
    """Return unit vectors, shape (a, b, 3)."""
    reach = np.sqrt(1.0 - height**2)
    x, y = np.outer(np.cos(theta), reach), np.outer(np.sin(theta), reach)
    return np.stack((x, y, np.broadcast_to(height, x.shape)), axis=-1)


def symmetry(design: Design) -> int:
    """Return the largest m ≤ 12 for which a turn by 2π/m about the z-axis repeats the design.

    Base and platform are turned alike; legs of equal constraints and strokes may be permuted.

    Parameters
    ----------
    design : Design

    Returns
    -------
    int

    Raises
    ------
    InvalidInput
        If `design` is not a Design.

    Examples
    --------
    >>> import gsp
    >>> symmetry(gsp.catalogue.design("workspace-6-3"))
    3
    """
    check_undriven("design", design)
    return next((m for m in range(MOST_FOLDS, 1, -1) if _repeats(design, m)), 1)


def _repeats(design: Design, m: int) -> bool:
    turn = rotation_from_angles([0.0, 0.0, 2.0 * np.pi / m])
    legs = _descriptions(design, np.eye(3))
    turned = _descriptions(design, turn)
    gap = np.abs(legs[:, None] - turned[None]).max(axis=2)
    near = gap < REPEAT_TOLERANCE * max(design.rms_radius, 1e-300)
    return bool((near.sum(axis=0) == 1).all() and (near.sum(axis=1) == 1).all())


def _descriptions(design: Design, turn: Array) -> Array:
    """Numbers of each leg that a symmetry keeps: anchors, lines, kind and strokes."""
    size = design.rms_radius
    kinds = sorted({leg.name for leg in design.legs})
    kind = np.array([[size * kinds.index(leg.name)] for leg in design.legs])
    places = [p @ turn.T for p in (design.base_points, design.platform_points)]
    lines = [
        size * np.nan_to_num(p @ turn.T)
        for p in (design.base_directions, design.platform_directions)
    ]
    strokes = np.zeros((design.n_legs, 4))
    if design.strokes is not None:
        owners = np.array([row.leg for row in design.rows])
        for i in range(design.n_legs):
            rows = design.strokes[owners == i]
            strokes[i, : rows.size] = np.nan_to_num(rows, nan=-size).ravel()
    return np.concatenate((*places, *lines, kind, strokes), axis=1)
