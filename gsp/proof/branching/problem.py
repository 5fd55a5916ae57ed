"""The requirements over a box, as flat arrays for the compiled search."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.checks import check_type
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import moving_axes, moving_places
from gsp.geometry.vectors import EPS, Array, norm
from gsp.limits import Limits
from gsp.limits.kinds import (
    Quantity,
    clearance_quantities,
    cone_quantities,
    index_quantities,
    joint_quantities,
    position_quantities,
)
from gsp.limits.legs import cone_axes, leg_pairs
from gsp.model.design import Design
from gsp.model.legs import LEGS
from gsp.proof.branching.requirements import is_empty, write_bounds
from gsp.proof.tolerances import Tolerances
from gsp.variation.designs import NORM_OUTWARD, geometry_of
from gsp.variation.layout import (
    CLEARANCE,
    CONES,
    CONTROL,
    ELLIPSOID,
    INDEX_ORDER,
    JOINTS,
    POSITION,
    SCREEN,
    SPECTRA,
)
from gsp.variation.passive import WEIGHTS_SCALARS

# Least positive number: "above zero" as a bound that is reached.
ABOVE_ZERO = float(np.nextafter(0.0, 1.0))
# Lengths whose sixth powers neither vanish nor overflow.
LENGTH_BOUNDS = 1e-40, 1e40


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
        angles = [3 + place for place in moving_places(order)]
        return cls(moving_axes(order), np.array([0, 1, 2, *angles], dtype=np.int64))


@dataclass(frozen=True, eq=False)
class Problem:
    """A design, and the bounds of its quantities.

    Attributes
    ----------
    design : Design
    named : tuple of Quantity
        The quantities: joints, x, y, z, cones, indices, clearances.
    bounds : (4, m) array
        Least and greatest values to prove, and those that refute: they differ by the tolerances
        of the joints. Of angles, bounds of their cosine.
    claims : dict
        What is required, by the names of the quantities, angles as angles: for certificates.
    chosen : int array
        Numbers of the quantities that are bounded.
    signed : int
        Number of the quantity whose change of sign refutes regularity, or −1.
    arguments : tuple
        Kinds, geometry, axes of cones, weights of the ellipsoid, pairs of legs and the length, for
        the compiled code: see `gsp.variation.kernel`.
    wanted : int
        Which quantities are computed: see `gsp.variation.layout`.
    ellipsoid : Ellipsoid or None
    """

    design: Design
    named: tuple[Quantity, ...]
    bounds: Array
    claims: dict[str, list[float | None]]
    chosen: NDArray[np.int64]
    signed: int
    arguments: tuple[Any, ...]
    wanted: int
    ellipsoid: Ellipsoid | None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the quantities."""
        return tuple(quantity.name for quantity in self.named)

    @property
    def low(self) -> Array:
        """Least values to prove."""
        return np.asarray(self.bounds[0])

    @property
    def high(self) -> Array:
        """Greatest values to prove."""
        return np.asarray(self.bounds[1])

    @property
    def axes(self) -> Array:
        """Unit axes of the cones of each leg on base and platform, (n_legs, 2, 3)."""
        return np.asarray(self.arguments[2]).reshape(-1, 2, 3)

    @property
    def length(self) -> float:
        """Characteristic length."""
        return float(self.arguments[5])

    def nominal(self) -> Problem:
        """Return the problem of the design itself, without tolerances of anchors and lines."""
        kinds, _, *others = self.arguments
        return replace(self, arguments=(kinds, geometry_of(self.design).ravel(), *others))

    def is_cosine(self, quantity: int) -> bool:
        """Whether a quantity is the cosine of an angle: of an actuator, or of a cone."""
        return self.named[quantity].angular

    def frame(self, angles: Angles, rotation: Array | None = None) -> Array:
        """Return the frame of angles, and the rotation that comes before them, as 18 numbers."""
        first = np.eye(3) if rotation is None else rotation
        return np.concatenate((angles.axes.ravel(), first.ravel()))


def quantities_of(design: Design) -> tuple[Quantity, ...]:
    """Return all quantities that the search bounds, in its order."""
    cones = zip(cone_quantities(design, "base"), cone_quantities(design, "platform"), strict=True)
    return (
        *joint_quantities(design),
        *position_quantities(),
        *chain.from_iterable(cones),
        *index_quantities(INDEX_ORDER),
        *clearance_quantities(design),
    )


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
    if not regular and (limits is None or is_empty(design, limits)):
        raise MissingParameter(
            f"requirements of {design.name!r}: expected regular=True or limits, received none"
        )
    _check_size(design)
    if tolerances is not None:
        tolerances.of_joints(design)
    named = quantities_of(design)
    allowed = Tolerances() if tolerances is None else tolerances
    scale = _length(design, limits) if length is None else length
    bounds, claims = np.tile([[-np.inf], [np.inf]], (2, len(named))), {}
    if limits is not None and not is_empty(design, limits):
        claims = write_bounds(design, limits, allowed, named, bounds)
    least = [quantity.name for quantity in named].index("minimum_singular_value")
    if regular:
        bounds[::2, least] = np.maximum(bounds[::2, least], ABOVE_ZERO)
    chosen = np.flatnonzero((bounds[0] > -np.inf) | (bounds[1] < np.inf)).astype(np.int64)
    # Cones and indices are the most expensive; the first that fails chooses what is halved.
    return Problem(
        design=design,
        named=named,
        bounds=bounds,
        claims=claims,
        chosen=chosen,
        signed=least if regular and len(design.joint_names) == 6 else -1,
        arguments=(
            np.array([LEGS.index(leg) for leg in design.legs], dtype=np.int64),
            geometry_of(design, allowed.of_legs(design)).ravel(),
            _axes(design, limits),
            _weights(design, limits),
            np.array(leg_pairs(design), dtype=np.int64).reshape(-1, 2),
            scale,
        ),
        wanted=_wanted([named[i] for i in chosen]),
        ellipsoid=ellipsoid_of(design, limits),
    )


def _check_size(design: Design) -> None:
    most = float(max(np.abs(design.base_points).max(), np.abs(design.platform_points).max()))
    low, high = LENGTH_BOUNDS
    if not low < most < high:
        wanted = f"lengths between {low:g} and {high:g}, whose powers are numbers"
        raise InvalidInput(expected(f"design {design.name!r}", wanted, most))


def _wanted(bounded: list[Quantity]) -> int:
    kinds, names = {one.kind for one in bounded}, {one.name for one in bounded}
    flags = {
        SPECTRA: not names.isdisjoint(INDEX_ORDER[:3]),
        CONES: "cone" in kinds,
        JOINTS: "joint" in kinds,
        ELLIPSOID: "condition_number_ellipsoid" in names,
        CONTROL: "control_number" in names,
        CLEARANCE: "clearance" in kinds,
        POSITION: "position" in kinds,
    }
    # The others overwrite what singular values are computed from, if they turn out to be needed.
    others = ("manipulability", "condition_number_ellipsoid", "control_number")
    flags[SCREEN] = flags[SPECTRA] and names.isdisjoint(others)
    return sum(flag for flag, wanted in flags.items() if wanted)


def _length(design: Design, limits: Limits | None) -> float:
    """Return the length that twists are scaled by: a given one only if an index depends on it.

    Bounds of the others hold with any length, but are wide with one unlike the design's size.
    """
    if limits is not None and limits.length is not None:
        if any("length" in index.missing(design, ()) for index, _, _ in limits.thresholds):
            return float(limits.length)
    if design.characteristic_length is not None:
        return design.characteristic_length
    return design.rms_radius


def _axes(design: Design, limits: Limits | None) -> Array:
    """Return the unit axes of the cones of each leg, on both sides; 0 where there is no cone."""
    axes = np.zeros((design.n_legs, 2, 3))
    if limits is not None:
        for side, name in enumerate(("base", "platform")):
            if getattr(limits, f"{name}_cone") is not None:
                given = cone_axes(design, name, getattr(limits, f"{name}_axes"))
                axes[:, side] = given / norm(given)[:, None]
    return axes.ravel()


def ellipsoid_of(design: Design, limits: Limits | None) -> Ellipsoid | None:
    """Return the operation ellipsoid that is given, or that of the design."""
    given = None if limits is None else limits.ellipsoid
    return design.ellipsoid if given is None else given


def _weights(design: Design, limits: Limits | None) -> Array:
    """Return the scalars of the ellipsoid: see `gsp.variation.passive`; zeros without one."""
    ellipsoid = ellipsoid_of(design, limits)
    if ellipsoid is None:
        return np.zeros(WEIGHTS_SCALARS)
    centre, columns = ellipsoid.scalars[:3], ellipsoid.scalars[3:].reshape(3, 3)
    weights = norm(columns.T)
    middle, half = 0.5 * (weights.max() + weights.min()), 0.5 * np.ptp(weights)
    turn = ellipsoid.rotation
    matrix = (turn * (weights - middle)) @ turn.T
    # The matrix is rounded, and so are its eigenvalues.
    half = half * NORM_OUTWARD + 64.0 * EPS * middle
    return np.concatenate((centre, [norm(centre) * NORM_OUTWARD, middle, half], matrix.ravel()))


def centre(box: PoseBox) -> Pose:
    """Return the pose in the middle of a box."""
    return box.pose(0.5 * (box.low + box.high))


def boxes_of(box: PoseBox, angles: Angles) -> Array:
    """Return a box as the search takes it, shape (1, 12)."""
    order: Any = angles.coordinates
    return np.concatenate((box.low[order], box.high[order]))[None]
