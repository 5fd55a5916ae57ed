"""Rays across the boundary of a region, one or two in each of some cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.errors import EmptyWorkspace
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.quantities import BoundedQuantities
from gsp.workspace.boundary.orientations import START_SLACK
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes
from gsp.workspace.sets.inside.poses import drawn_rotations
from gsp.workspace.sets.region.regions import Region
from gsp.workspace.sets.tree.cells import Cells, first_cells
from gsp.workspace.sets.tree.cuts import sides
from gsp.workspace.sets.tree.deciding import reach

# Rays of one cell: a second one from another pose, if the end of the first is not a maximum.
RAYS_PER_CELL = 2
# Codes of corners, beside those of cells: not tried yet, and no proof that it is outside.
UNKNOWN, UNPROVEN = 2, 3
# For limits other than strokes of SPS legs: poses that are drawn in the region, and orientations
# that are tried at each point, those of the nearest poses.
POSES_DRAWN, ORIENTATIONS_PER_POINT = 400, 12


class Rays(NamedTuple):
    """Feasible poses (N, 3), (N, 3, 3), unit directions (N, 3), and cells (N,) they leave in."""

    position: Array
    rotation: Array
    direction: Array
    cell: NDArray[np.intp]


@dataclass(eq=False)
class Seeds:
    """Finds feasible poses at the corners of cells of a region in a plane.

    Attributes
    ----------
    region : Region
    bounds : BoundedQuantities
    position, rotation : (M, 3) and (M, 3, 3) arrays
        Poses whose orientations are tried elsewhere; one for a fixed orientation, none where
        orientations are found by climbing.
    """

    region: Region
    bounds: BoundedQuantities
    position: Array
    rotation: Array

    def __post_init__(self) -> None:
        region = self.region
        faces = np.stack((region.low, region.high), axis=1)
        corners = np.stack([faces[:, (i, j), (0, 1)] for i in (0, 1) for j in (0, 1)], axis=1)
        flat, corner = np.unique(corners.reshape(-1, 2), axis=0, return_inverse=True)
        self.points = np.pad(flat, ((0, 0), (0, 1)))
        self.corner = corner.reshape(-1, 4)
        self.code = np.full(len(flat), UNKNOWN, dtype=np.int8)
        # Corners in the outside parts of cells need no other proof.
        four = (np.repeat(x, 4, axis=0) for x in (region.low, region.high, region.cuts))
        beyond = sides(corners.reshape(-1, 2), *four) == OUTSIDE
        self.code[self.corner.ravel()[beyond]] = OUTSIDE
        self.turns = np.broadcast_to(np.eye(3), (len(flat), 3, 3)).copy()

    @classmethod
    def of(cls, region: Region, bounds: BoundedQuantities, rng: np.random.Generator) -> Seeds:
        """Return the seeds of a region, after poses are drawn where that is needed."""
        problem = region.problem
        if problem.single_rotation:
            return cls(region, bounds, np.zeros((1, 3)), drawn_rotations(problem, 1, rng))
        if problem.only_spheres:
            return cls(region, bounds, np.zeros((0, 3)), np.zeros((0, 3, 3)))
        try:
            drawn = region.poses(POSES_DRAWN, rng=rng)
        except EmptyWorkspace:  # so small a share of the poses is feasible
            turns = drawn_rotations(problem, POSES_DRAWN, rng)
            return cls(region, bounds, np.zeros((POSES_DRAWN, 3)), turns)
        return cls(region, bounds, drawn.position, drawn.rotation)

    def across(self, cells: NDArray[np.intp]) -> Rays:
        """Return rays that leave the region in cells.

        A ray goes from a corner of the cell with a feasible orientation toward one for which none
        is found.
        """
        number = self.corner[cells]
        new = np.unique(number[self.code[number] == UNKNOWN])
        found, self.turns[new] = self._feasible(self.points[new])
        self.code[new] = np.where(found, INSIDE, UNDECIDED)
        pairs = [
            (cell, corners[one], corners[two])
            for cell, corners in zip(cells, number, strict=True)
            for one, two in _pairs(self.code[corners] == INSIDE, self.points[corners])
        ]
        cell, one, two = np.array(pairs, dtype=np.intp).reshape(-1, 3).T
        points = self.region.problem.outward(self.points)
        way = points[two] - points[one]
        return Rays(points[one], self.turns[one], way / norm(way)[:, None], cell)

    def crossed(self, cells: NDArray[np.intp]) -> Mask:
        """Return which cells, of those that had rays, the boundary is proven to pass."""
        number = self.corner[cells]
        inside = (self.code[number] == INSIDE).any(axis=1)
        some = number[inside]
        new = np.unique(some[self.code[some] == UNDECIDED])
        self.code[new] = np.where(
            self.region._decide(self.points[new]) == OUTSIDE, OUTSIDE, UNPROVEN
        )
        return np.asarray(inside & (self.code[number] == OUTSIDE).any(axis=1))

    def decided(self, position: Array) -> Codes:
        """Return the codes of points (m, 3) in base axes."""
        points = self.region.problem.inward(position)
        found, _ = self._feasible(points)
        codes = np.where(found, INSIDE, UNDECIDED).astype(np.int8)
        codes[~found] = self.region._decide(points[~found])
        low, high = self.region.domain
        flat = points[:, :2]
        codes[((flat < low) | (flat > high)).any(axis=1)] = OUTSIDE
        return codes

    def _feasible(self, points: Array) -> tuple[Mask, Array]:
        """Where an orientation is found that is feasible at points (m, 3) in the frame; and it."""
        climbed = not len(self.position)
        position = self.region.problem.outward(points)
        rotation = self._climbed(points) if climbed else self._tried(position)
        found = self.bounds.allowed(position, rotation, -START_SLACK)
        side = self.region.problem.side
        return found & (points @ side[:, :3].T >= side[:, 3]).all(axis=1), rotation

    def _climbed(self, points: Array) -> Array:
        """Return orientations of large least margin, as the search for regions finds them."""
        problem = self.region.problem
        cells = reach(problem, Cells.begun(points, points, first_cells(problem)), sums=1)
        last = np.maximum(cells.met - 1, 0)
        rotation = cells.families[np.arange(len(points)), last, :9].reshape(-1, 3, 3)
        rotation[cells.met == 0] = np.eye(3)
        return np.asarray(problem.frame.T @ rotation)

    def _tried(self, position: Array) -> Array:
        """Return the first feasible orientation of those of the nearest poses, else the last."""
        rotation = np.broadcast_to(np.eye(3), (len(position), 3, 3)).copy()
        left = np.arange(len(position))
        away = norm(position[:, None] - self.position)
        nearest = np.argsort(away, axis=1, kind="stable")[:, :ORIENTATIONS_PER_POINT]
        for choice in nearest.T:
            rotation[left] = self.rotation[choice[left]]
            ok = self.bounds.allowed(position[left], rotation[left], -START_SLACK)
            left = left[~ok]
        return rotation


def _pairs(found: Mask, points: Array) -> list[tuple[int, int]]:
    """Numbers of feasible points and of the nearest other ones, the nearest pairs first."""
    ones, twos = np.flatnonzero(found), np.flatnonzero(~found)
    if not len(ones) or not len(twos):
        return []
    away = norm(points[ones, None] - points[twos])
    order = np.argsort(away.min(axis=1), kind="stable")[:RAYS_PER_CELL]
    return [(int(ones[i]), int(twos[np.argmin(away[i])])) for i in order]
