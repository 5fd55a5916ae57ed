"""Dextrous workspaces of SPS legs: points reached with all orientations of a box of angles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_integer
from gsp.errors import EmptyWorkspace, InvalidInput, brief, expected
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array, Mask, frozen, norm, unit
from gsp.limits.labels import label
from gsp.limits.limits import Limits
from gsp.model.design import Design
from gsp.workspace.exact.fixed_orientation import stroke_bounds
from gsp.workspace.leg_lengths import LegLengths
from gsp.workspace.planes import plane_frame
from gsp.workspace.volumes import Volume, check_heights

# Steps along a ray, each as long as the margin; a ray that needs more is not certified.
STEPS_PER_RAY = 2000
# Margin at which a ray has reached the boundary [share of the greatest length].
MARGIN_TOLERANCE = 1e-12
# Cells of the octree evaluated at once.
CELLS_PER_BLOCK = 20_000


@dataclass(frozen=True, eq=False)
class DextrousEnds:
    """Ends of rays in a dextrous workspace.

    Attributes
    ----------
    position : (N, 3) array [unit of the design]
    distance : (N,) array [length]
        The first exit from the radiating point.
    labels : tuple of str
        The leg at whose least (0) or greatest (1) length the ray ends.
    angles : (N, 3) array [rad]
        The orientation of the box at which this is so.
    certified : (N,) bool array
        Whether the exit was met within the tolerance; no point before it was skipped, as the
        steps are never longer than the margin.
    """

    position: Array
    distance: Array
    labels: tuple[str, ...]
    angles: Array
    certified: Mask


@dataclass(frozen=True, eq=False, kw_only=True)
class DextrousWorkspace:
    """The dextrous workspace of a design for a box of angles; made by `dextrous`.

    Attributes
    ----------
    base_points, platform_points : (n, 3) arrays [length]
    low, high : (n,) arrays [length]
    least, greatest : (3,) arrays [rad]
        The box of angles.
    order : str
        The angle set.
    """

    base_points: Array
    platform_points: Array
    low: Array
    high: Array
    least: Array
    greatest: Array
    order: str

    @cached_property
    def _lengths(self) -> LegLengths:
        return LegLengths(
            base_points=self.base_points,
            platform_points=self.platform_points,
            least=self.least,
            greatest=self.greatest,
            order=self.order,
        )

    @property
    def free(self) -> tuple[int, ...]:
        """The angles that have a range."""
        return self._lengths.free

    def extremes(self, position: ArrayLike) -> tuple[Array, Array]:
        """Return the shortest and longest lengths over the box of angles, and where.

        Along one angle the square of a length is A + B cos + C sin, so its extremes over an
        interval are known in closed form. With several angles they are improved in turn, from
        the best node of a grid over the box.

        Parameters
        ----------
        position : (N, 3) array_like [length]

        Returns
        -------
        lengths : (N, n, 2) array [length]
        angles : (N, n, 2, 3) array [rad]

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.
        """
        p = check_array("position", position, (3,)).reshape(-1, 3)
        return self._lengths.extremes(p)

    def margins(self, position: ArrayLike) -> Array:
        """Return the margins of lengths to the ends of their strokes; ≥ 0 in the workspace.

        Each is 1-Lipschitz in the position.

        Parameters
        ----------
        position : (N, 3) array_like [length]

        Returns
        -------
        (N, n, 2) array [length]
            Above the least and below the greatest length.

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.
        """
        lengths, _ = self.extremes(position)
        return np.stack((lengths[..., 0] - self.low, self.high - lengths[..., 1]), axis=-1)

    def contains(self, position: ArrayLike) -> Mask:
        """Return whether positions are reached with all orientations of the box.

        Parameters
        ----------
        position : (..., 3) array_like [length]

        Returns
        -------
        (...) bool array

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.
        """
        p = check_array("position", position, (3,))
        inside = (self.margins(p) >= 0.0).all(axis=(-2, -1))
        return np.asarray(inside.reshape(p.shape[:-1]))

    def ray_ends(self, origin: ArrayLike, directions: ArrayLike) -> DextrousEnds:
        """Return the first exits of rays from a point of the workspace.

        Parameters
        ----------
        origin : (3,) array_like [length]
        directions : (N, 3) array_like [any length]

        Returns
        -------
        DextrousEnds

        Raises
        ------
        EmptyWorkspace
            If the origin is not inside.
        InvalidInput
            On wrong shapes, or a direction of zero.
        """
        start = check_array("origin", origin, (3,))
        given = check_array("directions", directions, (3,)).reshape(-1, 3)
        if start.ndim != 1 or not (norm(given) > 0.0).all():
            wanted = "one point, and directions other than zero"
            raise InvalidInput(expected("origin, directions", wanted, brief(given.tolist())))
        heading = unit(given)
        at_start = self.margins(start)[0]
        if not at_start.min() > 0.0:
            i, side = np.unravel_index(int(np.argmin(at_start)), at_start.shape)
            raise EmptyWorkspace(
                expected(
                    "origin",
                    "a point inside the dextrous workspace",
                    f"leg {i + 1} beyond its {('least', 'greatest')[int(side)]} length by "
                    f"{-at_start.min():.6g}",
                )
            )
        distance = np.zeros(len(heading))
        tolerance = MARGIN_TOLERANCE * float(self.high.max())
        going = np.arange(len(heading))
        for _ in range(STEPS_PER_RAY):
            margin = self.margins(start + distance[going, None] * heading[going]).min(axis=(1, 2))
            distance[going] += np.maximum(margin, 0.0)
            going = going[margin > tolerance]
            if not going.size:
                break
        certified = np.ones(len(heading), dtype=bool)
        certified[going] = False
        return self._ends(start, heading, distance, certified)

    def section(
        self, origin: ArrayLike, axes: ArrayLike = ((1, 0, 0), (0, 0, 1)), rays: int = 360
    ) -> DextrousEnds:
        """Return the ends of equally spaced rays in a plane.

        A ray of angle φ goes along cos φ axes[0] + sin φ axes[1], after the axes are made
        orthonormal.

        Parameters
        ----------
        origin : (3,) array_like [length]
            A point of the workspace.
        axes : (2, 3) array_like [any length]
            Two directions that span the plane.
        rays : int
            Number of rays, ≥ 1.

        Returns
        -------
        DextrousEnds

        Raises
        ------
        EmptyWorkspace
            If the origin is not inside.
        InvalidInput
            On wrong shapes, dependent directions, or no ray.
        """
        rays = check_integer("rays", rays)
        start, (first, second, _) = plane_frame(origin, axes)
        phi = np.arange(rays) * (2.0 * np.pi / rays)
        return self.ray_ends(start, np.outer(np.cos(phi), first) + np.outer(np.sin(phi), second))

    def volume(self, depth: int = 6, heights: tuple[float, float] = (-np.inf, np.inf)) -> Volume:
        """Return the volume by an octree, and an estimate of its error.

        Cells whose center is farther inside or outside than their corners are settled, as the
        margins are 1-Lipschitz. A cell that the boundary cuts at last counts by the share of a ball
        of its volume that a plane at the same distance cuts off. The error is estimated from the
        level before.

        Parameters
        ----------
        depth : int
            How often cells are halved; each level costs about four times as much.
        heights : (float, float) [length]
            Least and greatest z.

        Returns
        -------
        Volume [length³]

        Raises
        ------
        InvalidInput
            If `depth` is no integer ≥ 0, or `heights` are not two numbers.
        """
        depth, heights = check_integer("depth", depth, least=0), check_heights(heights)
        center, half = self._enclosing_box(heights)
        if not half.all():
            return Volume(0.0, 0.0)
        cells = center[None]
        settled, values = 0.0, []
        for level in range(depth + 1):
            margin = self._margin_in_blocks(cells)
            reach, size = float(norm(half)), float(np.prod(2.0 * half))
            settled += float((margin >= reach).sum()) * size
            cut = np.abs(margin) < reach
            radius = (size * 3.0 / (4.0 * np.pi)) ** (1.0 / 3.0)
            t = np.clip(margin[cut] / radius, -1.0, 1.0)
            values.append(settled + float(((1.0 + t) ** 2 * (2.0 - t)).sum()) / 4.0 * size)
            if level < depth:
                half = 0.5 * half
                corners = np.array(list(product((-1.0, 1.0), repeat=3))) * half
                cells = (cells[cut][:, None] + corners).reshape(-1, 3)
        return Volume(values[-1], abs(values[-1] - values[-2]) if depth else values[-1])

    def _margin_in_blocks(self, cells: Array) -> Array:
        parts = np.array_split(cells, len(cells) // CELLS_PER_BLOCK + 1)
        return np.concatenate([self.margins(part).min(axis=(1, 2)) for part in parts])

    def _enclosing_box(self, heights: tuple[float, float]) -> tuple[Array, Array]:
        reach = (norm(self.platform_points) + self.high)[:, None]
        low = (self.base_points - reach).max(axis=0)
        high = (self.base_points + reach).min(axis=0)
        low[2], high[2] = max(low[2], heights[0]), min(high[2], heights[1])
        return 0.5 * (low + high), np.maximum(0.5 * (high - low), 0.0)

    def _ends(self, start: Array, heading: Array, distance: Array, certified: Mask) -> DextrousEnds:
        position = start + distance[:, None] * heading
        margin = self.margins(position)
        _, angles = self.extremes(position)
        n = len(self.low)
        worst = margin.reshape(len(position), 2 * n).argmin(axis=1)
        leg, side = worst // 2, worst % 2
        active = [((int(i), int(s)),) for i, s in zip(leg, side, strict=True)]
        texts = tuple(label(a, (), n) for a in active)
        turned = angles[np.arange(len(position)), leg, side]
        return DextrousEnds(position, distance, texts, turned, certified)


@arguments.validated(degrees=arguments.flag)
def dextrous(
    design: Design,
    angles: ArrayLike,
    *,
    degrees: bool = False,
    order: str = "approach-roll",
    limits: Limits | None = None,
) -> DextrousWorkspace:
    """Return the dextrous workspace A[α, β, γmin–γmax], for any box of angles.

    Parameters
    ----------
    design : Design
        All legs D1, with strokes.
    angles : (3, 2) array_like, or three numbers or pairs [rad, or degrees]
        Least and greatest value of each angle; a single number stands for both.
    degrees : bool
        Whether the angles are in degrees.
    order : str
        The angle set, by default that of the source: R = Ry(β) Rx(α) Rz(γ).
    limits : Limits or None
        Other strokes; no other kind of limit is accepted.

    Returns
    -------
    DextrousWorkspace

    Raises
    ------
    InvalidDesign
        If a leg is not SPS.
    MissingParameter
        If the legs have no strokes.
    InvalidInput
        On angles that cross, ranges of more than a full turn, an unknown order, other limits, or
        arguments of other types.

    Examples
    --------
    >>> import gsp
    >>> ring = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6)])
    >>> d = gsp.Design(["D1"] * 6, 2 * ring, ring, strokes=[[1.0, 3.0]] * 6)
    >>> bool(dextrous(d, [0, 0, (-20, 20)], degrees=True).contains([0.0, 0.0, 1.5]))
    True

    *Source: Workspace-3, §3.1 (iii); closed-form extremes and certificates are ours*
    """
    bounds = stroke_bounds(design, limits)
    box = _box(angles, degrees)
    rotation_from_angles(box[:, 0], order)
    low = np.maximum(bounds.low, 0.0)
    return DextrousWorkspace(
        base_points=design.base_points,
        platform_points=design.platform_points,
        low=frozen(low),
        high=frozen(bounds.high),
        least=frozen(box[:, 0]),
        greatest=frozen(box[:, 1]),
        order=order,
    )


def _box(angles: ArrayLike, degrees: bool) -> Array:
    try:
        pairs = [np.broadcast_to(check_array("angles", a, ()), (2,)) for a in angles]  # type: ignore[union-attr]
    except (TypeError, ValueError) as error:
        raise InvalidInput(
            expected("angles", "three numbers or pairs (least, greatest)", brief(angles))
        ) from error
    box = check_array("angles", np.array(pairs), (None, 2))
    box = np.deg2rad(box) if degrees else box
    if box.shape != (3, 2) or (box[:, 0] > box[:, 1]).any():
        raise InvalidInput(
            expected("angles", "three numbers or pairs (least ≤ greatest)", brief(angles))
        )
    if (box[:, 1] - box[:, 0] > 2.0 * np.pi + 1e-12).any():
        raise InvalidInput(expected("angles", "ranges of a full turn at most", brief(angles)))
    return box
