"""The canonical form of a design: the same for all designs that have the same maximum of |det J|.

Two designs share it if they differ by the unit of length (a similarity), by rigid motions of base
and platform axes, by a mirror, by the order of the legs (up to seven), or by which body is called
the base. Its frames lie at the centroids of the anchors, so that a search in it does not depend on
the frames of the original. (Redundant designs with A1 rows, whose |det J| has no power of the
unit, keep theirs, and differ by their size. Over a `PoseBox` the axes matter, and only unit and
order of the legs are free.)

Ties are decided once: the key is that of coordinates rounded to SAME_DESIGN of the size, and of
all orders of the legs, mirror images and exchanges the one with the least rounded coordinates is
taken. So symmetric designs, which have several equal forms, have one key.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations, product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.determinant.body_frames import framed, together
from gsp.determinant.domain import Neighbourhood, SearchRegion
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import nearest_rotations
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design, check_undriven

# Designs whose coordinates differ by less than this share of their size are the same. A maximum
# where the slope vanishes differs by the square of it.
SAME_DESIGN = 1e-8
# Legs of which all orders are tried; 7! is 5040.
MOST_ORDERED_LEGS = 7


@dataclass(frozen=True, eq=False)
class Canonical:
    """A design in canonical form, and the transformation of poses to it and back.

    Attributes
    ----------
    legs : list of str
    rows : list of lists of 12 floats
        Per leg its base anchor, base line, platform anchor and platform line; zeros where there is
        no line. The size of the design is 1, but for designs that keep their unit.
    domain : list or None
        ["box", [low, high], order] or ["near home", displacement, angle]; None for all poses.
    exchanged : bool
        Whether base and platform are exchanged.
    length : float [unit]
        Unit of the rows and the domain: the size of the original design; 1 if it keeps its unit.
    base, platform : (3, 4) arrays
        [axes as columns | origin] of the canonical frames in the original axes, before exchange.
        Both are left-handed if the form is the mirror image of the design.
    """

    legs: list[str]
    rows: list[list[float]]
    domain: list[Any] | None
    exchanged: bool
    length: float
    base: Array
    platform: Array

    @property
    def key(self) -> str:
        """SHA-256 of legs, rounded rows and domain, in hexadecimal; of the size if it matters."""
        return key_of(self.legs, self.rows, self.domain)

    @property
    def design(self) -> Design:
        """The canonical design."""
        return design_of(self.legs, self.rows)

    @property
    def region(self) -> SearchRegion:
        """The poses of the canonical design that are searched."""
        return region_of(self.domain)

    def inward(self, pose: Pose) -> Pose:
        """Return a pose of the original design as one of the canonical design."""
        (e, c), (f, k) = _parts(self.base), _parts(self.platform)
        moved = (pose.position + pose.rotation @ k - c) @ e / self.length
        inner = Pose(moved, nearest_rotations(e.T @ pose.rotation @ f))
        return inner.inverse() if self.exchanged else inner

    def outward(self, pose: Pose) -> Pose:
        """Return a pose of the canonical design as one of the original design."""
        inner = pose.inverse() if self.exchanged else pose
        (e, c), (f, k) = _parts(self.base), _parts(self.platform)
        rotation = nearest_rotations(e @ inner.rotation @ f.T)
        return Pose(e @ inner.position * self.length + c - rotation @ k, rotation)

    def scale(self, design: Design) -> float:
        """Return what |det J| of the canonical design is multiplied with for the original one."""
        return float(self.length**design.determinant_power)


def canonical(design: Design, region: SearchRegion = None) -> Canonical:
    """Return the canonical form of a design.

    Parameters
    ----------
    design : Design
    region : PoseBox, Neighbourhood or None
        The poses that the maximum is taken over; None for all.

    Returns
    -------
    Canonical

    Raises
    ------
    InvalidDesign
        For legs that are driven at the base, whose |det J| has no bound near a singular drive.
    """
    size = check_undriven("design", design).rms_radius
    # A determinant without a unit is multiplied by no power of the length.
    length = size if design.determinant_has_unit else 1.0
    if isinstance(region, PoseBox):
        return _over_box(design, region, size, length)
    forms = list(_forms(design, region, size))
    best = min(forms, key=lambda form: (form.preference, form.multiples.ravel().tolist()))
    domain = None
    if region is not None:
        domain = ["near home", region.displacement / length, region.angle]
    low, high = (best.platform, best.base) if best.exchanged else (best.base, best.platform)
    rows = _multiplied(best.rows, size / length).tolist()
    return Canonical(best.legs, rows, domain, best.exchanged, length, low, high)


class _Form(NamedTuple):
    """The least form of size 1 of a design, as given or exchanged, of one handedness."""

    preference: tuple[int, list[str]]
    legs: list[str]
    rows: Array
    multiples: Array
    exchanged: bool
    base: Array
    platform: Array


def _forms(design: Design, region: Neighbourhood | None, size: float) -> Iterator[_Form]:
    for exchanged, side in ((False, design), (True, design.exchanged())):
        orders = _orders(side)
        legs = [side.legs[i].name for i in orders[0]]
        # The side with fewer D2 rows: the moments of D2 rows grow with the displacement.
        preference = (side.mechanism.counts[1], legs)
        if region is None:
            base = framed(side.base_points, side.base_directions, orders, size)
            top = framed(side.platform_points, side.platform_directions, orders, size)
        else:
            base, top = together(side, region, exchanged, orders, size)
        for hand in (1.0, -1.0):
            flip = np.array([1.0, 1.0, hand])
            rows = np.concatenate((base.rows, top.rows), axis=-1) * np.tile(flip, 4)
            multiples = _multiples(rows)
            flat = multiples.reshape(len(rows), -1)
            first = int(np.lexsort(flat.T[::-1])[0])
            frames = (f.frames[first] * np.append(flip, 1.0) for f in (base, top))
            yield _Form(preference, legs, rows[first], multiples[first], exchanged, *frames)


def _over_box(design: Design, box: PoseBox, size: float, length: float) -> Canonical:
    """Canonical form over a box: the axes stay, legs are sorted by their coordinates."""
    columns = [
        design.base_points / size,
        design.base_directions,
        design.platform_points / size,
        design.platform_directions,
    ]
    rows = np.nan_to_num(np.concatenate(columns, axis=1))
    whole = _multiples(rows).tolist()
    order = sorted(range(len(rows)), key=lambda i: (design.legs[i].name, whole[i]))
    legs = [design.legs[i].name for i in order]
    numbers = _multiplied(rows[order], size / length).tolist()
    scaled = np.stack((box.low, box.high)) / np.repeat([length, 1.0], 3)
    still = np.eye(3, 4)
    return Canonical(
        legs, numbers, ["box", scaled.tolist(), box.order], False, length, still, still
    )


def _orders(design: Design) -> Array:
    """Return all orders of the legs with their kinds sorted: (m, n) integers."""
    names = [leg.name for leg in design.legs]
    groups = [[i for i, name in enumerate(names) if name == kind] for kind in sorted(set(names))]
    ways = [permutations(g) if len(names) <= MOST_ORDERED_LEGS else [tuple(g)] for g in groups]
    return np.array([sum(way, ()) for way in product(*ways)])


def key_of(legs: list[str], rows: list[list[float]], domain: list[Any] | None) -> str:
    """Return the key of a canonical form, exactly: of whole multiples of SAME_DESIGN.

    A design that keeps its unit has the key of its form of size 1, with the logarithm of its size.
    """
    design = design_of(legs, rows)
    kept = not design.determinant_has_unit
    size = design.rms_radius if kept else 1.0
    whole: list[Any] = [list(legs), _multiples(_multiplied(np.array(rows), 1.0 / size)).tolist()]
    if domain is not None:
        whole.append(_domain_multiples(domain, size))
    if kept:
        whole.append(_multiples(np.log(size)).tolist())
    return hashlib.sha256(json.dumps(whole).encode()).hexdigest()


def _domain_multiples(domain: list[Any], size: float) -> list[Any]:
    """Return a domain with whole multiples of SAME_DESIGN, of lengths in sizes."""
    if domain[0] == "box":
        kind, corners, order = domain
        return [kind, _multiples(corners / np.repeat([size, 1.0], 3)).tolist(), order]
    kind, displacement, angle = domain
    return [kind, *_multiples([displacement / size, angle]).tolist()]


def design_of(legs: list[str], rows: list[list[float]]) -> Design:
    """Return the design of a canonical form."""
    a, s, b, t = np.split(np.array(rows, dtype=np.float64), 4, axis=1)
    return Design(legs, a, b, _lines(s), _lines(t), name="canonical")


def region_of(domain: list[Any] | None) -> SearchRegion:
    """Return the poses that the domain of a canonical form stands for."""
    if domain is None:
        return None
    if domain[0] == "box":
        (low, high), order = domain[1:]
        pairs = np.stack((low, high), axis=-1).tolist()
        return PoseBox(pairs[:3], pairs[3:], order=order)
    still = Pose(np.zeros(3))
    return Neighbourhood(home=still, centre=np.zeros(3), displacement=domain[1], angle=domain[2])


def _multiples(values: Any) -> NDArray[np.int64]:
    return np.rint(np.array(values, dtype=np.float64) / SAME_DESIGN).astype(np.int64)


def _multiplied(rows: Array, factor: float) -> Array:
    """Rows of a canonical form with their anchors in another unit."""
    return np.asarray(rows * np.repeat([factor, 1.0, factor, 1.0], 3))


def _lines(directions: Array) -> Array:
    """Directions with NaN where there is none."""
    return np.where(np.asarray(norm(directions) > 0.5)[:, None], directions, np.nan)


def _parts(frame: Array) -> tuple[Array, Array]:
    return frame[:, :3], frame[:, 3]
