"""What bounds a pose, as flat arrays in the axes of a plane or of the base."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import PoseBox
from gsp.geometry.rotations import moving_axes, moving_places
from gsp.geometry.vectors import Array, norm
from gsp.limits import Limits
from gsp.limits.bounds import bounded_quantities
from gsp.limits.legs import cone_axes, leg_pairs
from gsp.limits.quantities import BoundedQuantities
from gsp.model.design import Design
from gsp.proof.branching.problem import Problem, problem_of
from gsp.proof.branching.requirements import has_bounds
from gsp.workspace.planes import plane_of
from gsp.workspace.sets.domain import (
    ALIGNED,
    cut_faces,
    half_spaces_of,
    one_half_space,
    position_box,
)
from gsp.workspace.sets.faces import faces_of, within_range


@dataclass(frozen=True, eq=False)
class Bounded(ReadOnly):
    """A design and its limits, in the axes of a frame.

    Attributes
    ----------
    design, limits : Design, Limits
        As they were given.
    origin, frame : (3,) and (3, 3) arrays
        Origin and axes (rows) of the frame, in base axes.
    legs : (n, 9) array
        Per SPS leg a, b, |b|, least and greatest length.
    turns : (6, 3) array
        The moving axes of the three angles in the frame, and the rotation before them.
    half_spaces : (m, 4) array
        Half-spaces n · p ≥ c that hold the positions, and are not faces of the domain.
    side : (1 or 0, 4) array
        The half-space that was given besides the limits, in the axes of the frame.
    proof : Problem or None
        What else has bounds over boxes, as `gsp.proof` takes it.
    pairs : (k, 2) int array
        Pairs of SPS legs that have to keep clear of each other.
    clearance : float [length]
        How far apart their axes stay.
    unbounded_limits : bool
        Whether there is a limit that has no bound over boxes: nothing is proven inside then.
    low, high : (3,) arrays [length]
        A box that holds all positions, in the axes of the frame.
    least, most : (3,) arrays [rad]
        The range of the angles, in the order of moving axes.
    order : str
        Their angle set.
    """

    design: Design
    limits: Limits | None
    origin: Array
    frame: Array
    legs: Array
    turns: Array
    half_spaces: Array
    side: Array
    proof: Problem | None
    pairs: Any
    clearance: float
    unbounded_limits: bool
    low: Array
    high: Array
    least: Array
    most: Array
    order: str

    @property
    def only_spheres(self) -> bool:
        """Whether lengths of SPS legs and positions are all that is bounded."""
        return self.proof is None and not len(self.pairs) and not self.unbounded_limits

    @property
    def with_bounds(self) -> Bounded:
        """The problem without the limits that have no bound over boxes."""
        return replace(self, unbounded_limits=False)

    @property
    def free(self) -> bool:
        """Whether all rotations count."""
        width = self.most - self.least
        return bool(width[0] >= 2.0 * np.pi and width[1] >= np.pi and width[2] >= 2.0 * np.pi)

    @property
    def single_rotation(self) -> bool:
        """Whether one rotation counts only."""
        return np.array_equal(self.least, self.most)

    @property
    def within(self) -> Array:
        """Range of the angles that turns do not leave, (2, 3), or (0, 3) for all rotations."""
        return np.zeros((0, 3)) if self.free else within_range(self.least, self.most)

    @property
    def faces(self) -> Array:
        """Half-spaces of rotations that hold the range: (f, 7), as `faces_of` returns."""
        if self.free:
            return np.zeros((0, 7))
        return faces_of(self.turns, self.least, self.most, self.arm)

    @property
    def design_in_frame(self) -> Design:
        """The design, with base anchors and lines in the axes of the frame."""
        return _moved(self.design, self.origin, self.frame)

    @property
    def arm(self) -> float:
        """Greatest distance of a platform anchor from the platform origin [length]."""
        return max(float(norm(self.design.platform_points).max()), 1e-300)

    @cached_property
    def quantities(self) -> BoundedQuantities:
        """What is bounded, but for indices that have no bound over boxes."""
        limits = Limits() if self.limits is None else self.limits
        limits = replace(limits, indices=_with_bounds(self.design, limits))
        return bounded_quantities(self.design, limits)

    def inward(self, points: Array) -> Array:
        """Coordinates in the frame of points (..., 3) in base axes."""
        return (points - self.origin) @ self.frame.T

    def outward(self, points: Array) -> Array:
        """Points (..., 3) in base axes from coordinates in the frame."""
        return self.origin + points @ self.frame


def bounded(
    design: Design,
    limits: Limits | None,
    plane: Any = None,
    rotations: PoseBox | None = None,
    *,
    half_space: Any = None,
    domain: bool = True,
) -> Bounded:
    """Return a design and its limits in the axes of a plane, or of the base.

    Raises
    ------
    MissingParameter
        If nothing bounds the design.
    InvalidInput
        If the positions are not bounded, or on arguments of other types or shapes.
    """
    quantities = bounded_quantities(design, limits, crossed=True)
    origin, frame = _frame(plane)
    given = Limits() if limits is None else limits
    strokes = np.stack((quantities.low, quantities.high), axis=1)[: quantities.joints]
    in_frame = _moved(design, origin, frame)
    legs = _spheres(in_frame, strokes)
    order, least, most = _range(rotations)
    axes = moving_axes(order)
    of_limits, side = (
        half_spaces_of(given, origin, frame),
        one_half_space(half_space, origin, frame),
    )
    half_spaces = np.concatenate((of_limits, side))
    low, high = (
        cut_faces(*position_box(in_frame, strokes, of_limits), side)
        if domain
        else (np.zeros(3), np.zeros(3))
    )
    if plane is not None and low[2] <= 0.0 <= high[2]:
        low[2] = high[2] = 0.0
    elif plane is not None:
        low[2], high[2] = 1.0, 0.0  # nothing is in the plane
    # A half-space whose boundary is a face of the domain needs no further test.
    aligned = domain & (
        np.abs(np.abs(half_spaces[:, :3]).max(axis=1, initial=0.0) - 1.0) <= ALIGNED
    )
    clear = given.leg_radius is not None and design.between_points
    pairs = np.array(leg_pairs(design) if clear else [], dtype=np.int64).reshape(-1, 2)
    proof, unbounded_limits = _proof(in_frame, with_axes(design, given, frame), strokes)
    return Bounded(
        design=design,
        limits=limits,
        origin=origin,
        frame=frame,
        legs=legs,
        turns=np.concatenate((axes @ frame.T, frame)),
        half_spaces=half_spaces[~aligned],
        side=side,
        proof=proof,
        pairs=pairs,
        clearance=2.0 * (given.leg_radius or 0.0),
        unbounded_limits=unbounded_limits,
        low=low,
        high=high,
        least=least,
        most=most,
        order=order,
    )


def _frame(plane: Any) -> tuple[Array, Array]:
    if plane is None:
        return np.zeros(3), np.eye(3)
    start, frame = plane_of(plane)
    return start, np.where(np.abs(frame) <= ALIGNED, 0.0, frame)


def _moved(design: Design, origin: Array, frame: Array) -> Design:
    """Return a design with base anchors and lines in the axes of the frame."""
    if np.array_equal(frame, np.eye(3)) and not origin.any():
        return design
    return Design(
        [leg.name for leg in design.legs],
        (design.base_points - origin) @ frame.T,
        design.platform_points,
        design.base_directions @ frame.T,
        design.platform_directions,
        characteristic_length=design.characteristic_length,
        ellipsoid=design.ellipsoid,
    )


def _spheres(design: Design, strokes: Array) -> Array:
    rows = [(i, row) for i, row in enumerate(design.rows) if not design.legs[row.leg].cylindrical]
    number = np.array([i for i, _ in rows], dtype=np.int64)
    leg = np.array([row.leg for _, row in rows], dtype=np.int64)
    b = design.platform_points[leg]
    low, high = np.maximum(strokes[number, :1], 0.0), strokes[number, 1:]
    return np.concatenate((design.base_points[leg], b, norm(b)[:, None], low, high), axis=1)


def _range(rotations: PoseBox | None) -> tuple[str, Array, Array]:
    if rotations is None:
        quarter = 0.5 * np.pi
        return (
            "rpy",
            np.array([-2 * quarter, -quarter, -2 * quarter]),
            np.array([2 * quarter, quarter, 2 * quarter]),
        )
    places = moving_places(rotations.order)
    return rotations.order, rotations.low[3:][places], rotations.high[3:][places]


def _with_bounds(design: Design, limits: Limits) -> tuple[str, ...]:
    """Return the limits of indices that have bounds over boxes."""
    return tuple(
        text
        for text, (index, _, _) in zip(limits.indices, limits.thresholds, strict=True)
        if has_bounds(design, index.name)
    )


def _proof(design: Design, limits: Limits, strokes: Array) -> tuple[Problem | None, bool]:
    """Return what `gsp.proof` bounds, and whether a limit has no bound."""
    known = _with_bounds(design, limits)
    unbounded_limits = len(known) < len(limits.thresholds)
    spheres = design.between_points
    if spheres and limits.base_cone is None and limits.platform_cone is None and not known:
        return None, unbounded_limits
    clear = None if spheres else limits.leg_radius
    changes: dict[str, Any] = {
        "strokes": strokes,
        "indices": known,
        "position": None,
        "leg_radius": clear,
    }
    return problem_of(design, replace(limits, **changes), regular=False), unbounded_limits


def with_axes(design: Design, limits: Limits, frame: Array) -> Limits:
    """Return limits with the axes of their cones, those on the base in the axes of a frame."""
    changes: dict[str, Any] = {}
    for side in ("base", "platform"):
        if getattr(limits, f"{side}_cone") is not None:
            axes = cone_axes(design, side, getattr(limits, f"{side}_axes"))
            changes[f"{side}_axes"] = axes @ frame.T if side == "base" else axes
    return replace(limits, **changes)


def inside_half_spaces(half_spaces: Array, low: Array, high: Array) -> NDArray[np.int8]:
    """Where boxes (..., 3) lie: 1 within all half-spaces, −1 beyond one, else 0."""
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    code = np.ones(low.shape[:-1], dtype=np.int8)
    for *normal, least in half_spaces:
        n = np.array(normal)
        value, reach = middle @ n - least, half @ np.abs(n)
        slack = 1e-12 * (np.abs(middle) @ np.abs(n) + reach + abs(least))
        code = np.where(
            value + reach < -slack, -1, np.where(value - reach < slack, np.minimum(code, 0), code)
        )
    return np.asarray(code, dtype=np.int8)
