"""The requirements over a box, as flat arrays for the compiled search."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.checks import check_type
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import angle_set
from gsp.geometry.vectors import EPS, Array, norm
from gsp.limits import Limits
from gsp.limits.bounds import bounded_quantities, cone_axes
from gsp.model.design import Design
from gsp.model.legs import LEGS
from gsp.proof.tolerances import Tolerances
from gsp.proof.variation.layout import CONES, JOINTS, SPECTRA

# Least positive number: "above zero" as a bound that is reached.
ABOVE_ZERO = float(np.nextafter(0.0, 1.0))
# Roundings of cosines of bounds, and of norms.
COSINE = 4.0 * EPS
NORM = 1.0 + 4.0 * EPS
# The indices that have bounds, and their places after the cones.
INDEX_PLACES = {"minimum_singular_value": 0, "condition_number": 1}


@dataclass(frozen=True, eq=False)
class Angles:
    """A set of three angles as turns about moving axes, each a coordinate of a box.

    Attributes
    ----------
    axes : (3, 3) array
        The axes in the order of the turns: each turn also turns the axes after it.
    coordinates : (6,) int array
        Place in `PoseBox` of each coordinate of the search.
    """

    axes: Array
    coordinates: NDArray[np.int64]

    @classmethod
    def of(cls, order: str) -> Angles:
        """Return a named angle set."""
        sequence, places = angle_set(order)
        moving = (0, 1, 2) if sequence.isupper() else (2, 1, 0)
        axes = np.array([np.eye(3)["XYZ".index(sequence[i].upper())] for i in moving])
        coordinates = np.array([0, 1, 2, *(3 + places[i] for i in moving)], dtype=np.int64)
        return cls(axes, coordinates)


@dataclass(frozen=True, eq=False)
class Problem:
    """A design, and the bounds of its quantities.

    Attributes
    ----------
    design : Design
    names : tuple of str
        The quantities: joints, x, y, z, cones, indices.
    low, high : (m,) arrays
        Bounds; of angles those of their cosine.
    chosen : int array
        Numbers of the quantities that are bounded.
    signed : int
        Number of the quantity whose change of sign refutes regularity, or −1.
    kinds, geometry, axes, length, wanted
        Arguments of the compiled code: see `gsp.proof.variation.kernel`.
    """

    design: Design
    names: tuple[str, ...]
    low: Array
    high: Array
    chosen: NDArray[np.int64]
    signed: int
    kinds: NDArray[np.int64]
    geometry: Array
    axes: Array
    length: float
    wanted: int

    def frame(self, angles: Angles, rotation: Array | None = None) -> Array:
        """Return the frame of angles, and the rotation that comes before them, as 18 numbers."""
        first = np.eye(3) if rotation is None else rotation
        return np.concatenate((angles.axes.ravel(), first.ravel()))


def quantity_names(design: Design) -> tuple[str, ...]:
    """Return the names of all quantities that the search bounds, in its order."""
    cones = [
        f"{side} cone {i}" for i in range(1, design.n_legs + 1) for side in ("base", "platform")
    ]
    return (*design.joint_names, "x", "y", "z", *cones, *INDEX_PLACES)


def problem_of(
    design: Design,
    limits: Limits | None,
    *,
    regular: bool = True,
    tolerances: Tolerances | None = None,
    length: float | None = None,
) -> Problem:
    """Return the problem; `length` is the characteristic length if limits have none.

    Raises
    ------
    MissingParameter
        If nothing is to be proven, or an index needs a length that is not given.
    InvalidInput
        On limits that have no bounds over boxes.
    """
    arguments.flag("regular", regular)
    if tolerances is not None:
        check_type("tolerances", tolerances, Tolerances)
    names = quantity_names(design)
    low, high = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    allowed = Tolerances() if tolerances is None else tolerances
    scale = _length(design, limits) if length is None else length
    if limits is not None:
        _limit(design, limits, allowed, names, low, high)
    least = names.index("minimum_singular_value")
    if regular:
        low[least] = max(low[least], ABOVE_ZERO)
    chosen = np.flatnonzero((low > -np.inf) | (high < np.inf)).astype(np.int64)
    if not chosen.size:
        raise MissingParameter(
            f"requirements of {design.name!r}: expected regular=True or limits, received none"
        )
    # σ_min is the most expensive quantity, and the first that fails chooses what is halved.
    return Problem(
        design=design,
        names=names,
        low=low,
        high=high,
        chosen=chosen,
        signed=least if regular and len(design.joint_names) == 6 else -1,
        kinds=np.array([LEGS.index(leg) for leg in design.legs], dtype=np.int64),
        geometry=_geometry(design, allowed),
        axes=_axes(design, limits),
        length=scale,
        wanted=_wanted(design, names, chosen),
    )


def _wanted(design: Design, names: tuple[str, ...], chosen: NDArray[np.int64]) -> int:
    n = len(design.joint_names)
    spectra = np.isin(chosen, [names.index(name) for name in INDEX_PLACES]).any()
    cones = np.array(["cone" in names[i] for i in chosen]).any()
    return int(SPECTRA * spectra + CONES * cones + JOINTS * (chosen < n).any())


def _length(design: Design, limits: Limits | None) -> float:
    given = None if limits is None else limits.length
    if given is not None:
        return float(given)
    if design.characteristic_length is not None:
        return design.characteristic_length
    return design.rms_radius


def _geometry(design: Design, tolerances: Tolerances) -> Array:
    """Return a, b, s, t, |a|, |b| and tolerances of each leg; directions that are missing are z."""
    z = np.array([0.0, 0.0, 1.0])
    s = np.where(np.isfinite(design.base_directions), design.base_directions, z)
    t = np.where(np.isfinite(design.platform_directions), design.platform_directions, z)
    a, b = design.base_points, design.platform_points
    sizes = np.stack((norm(a), norm(b)), axis=1) * NORM
    return np.concatenate((a, b, s, t, sizes, tolerances.of_legs(design)), axis=1).ravel()


def _axes(design: Design, limits: Limits | None) -> Array:
    """Return the unit axes of the cones of each leg, on both sides; 0 where there is no cone."""
    axes = np.zeros((design.n_legs, 2, 3))
    if limits is not None:
        for side, name in enumerate(("base", "platform")):
            if getattr(limits, f"{name}_cone") is not None:
                given = cone_axes(design, name, getattr(limits, f"{name}_axes"))
                axes[:, side] = given / norm(given)[:, None]
    return axes.ravel()


def _limit(
    design: Design, limits: Limits, tolerances: Tolerances, names: tuple[str, ...],
    low: Array, high: Array,
) -> None:  # fmt: skip
    """Write the bounds of limits."""
    if _empty(design, limits):
        return
    bounds = bounded_quantities(design, limits, crossed=True)
    spare = tolerances.of_joints(design)
    for i, (name, least, most) in enumerate(
        zip(bounds.names, bounds.low, bounds.high, strict=True)
    ):
        if name not in names:
            known = "strokes, cones, position or an index of " + ", ".join(INDEX_PLACES)
            raise InvalidInput(expected("limits of a proof", known, name))
        place = names.index(name)
        if i < len(spare):
            least, most = least + spare[i], most - spare[i]
        if name.startswith("theta") or "cone" in name:
            least, most = _cosines(least, most)
        low[place], high[place] = max(low[place], least), min(high[place], most)


def _empty(design: Design, limits: Limits) -> bool:
    given = (
        design.strokes if limits.strokes is None else limits.strokes, limits.base_cone,
        limits.platform_cone, limits.position, limits.leg_radius,
    )  # fmt: skip
    return all(x is None for x in given) and not limits.thresholds


def _cosines(least: float, most: float) -> tuple[float, float]:
    """Bounds of the cosine of an angle within bounds, rounded inward."""
    low = np.cos(most) + COSINE if most < np.pi else -np.inf
    high = np.cos(least) - COSINE if least > 0.0 else np.inf
    return float(low), float(high)


def centre(box: PoseBox) -> Pose:
    """Return the pose in the middle of a box."""
    return box.pose(0.5 * (box.low + box.high))


def boxes_of(box: PoseBox, angles: Angles) -> Array:
    """Return a box as the search takes it, shape (1, 12)."""
    order: Any = angles.coordinates
    return np.concatenate((box.low[order], box.high[order]))[None]
