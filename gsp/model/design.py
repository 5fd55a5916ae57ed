"""Design: a mechanism with dimensions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_positive, check_text, check_type
from gsp.errors import InvalidDesign, InvalidInput, MalformedFile, brief, expected
from gsp.files.writing import read_text, write_text
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask, frozen, unit
from gsp.model.assembly import Group, Row, groups
from gsp.model.design_toml import parameters_from_toml, toml_from_design
from gsp.model.legs import Leg, check_leg
from gsp.model.mechanism import Mechanism
from gsp.model.posture import Posture


@dataclass(frozen=True, eq=False, init=False)
class Design:
    """A mechanism with dimensions: legs, and where they are anchored.

    Parameters
    ----------
    legs : sequence of str
        Per leg its constraint(s): "D1", "D2", "D3", "D4", "A1" or "D4 A1". Together at least
        six constraints; more make a redundant design.
    base_points, platform_points : (n_legs, 3) array_like [unit]
        a_i in base axes, b_i in platform axes.
    base_directions, platform_directions : (n_legs, 3) array_like or None
        s_i and t_i, normalised here. A row is ignored (NaN allowed) where the leg has no line.
    unit : str
        The unit of length of all the numbers, for the record: "mm", "m" …
    name, source : str
    strokes : (n, 2) array_like or None [unit, rad]
        Least and greatest value per actuator, in the order of `joint_names`; NaN for no limit.
    characteristic_length : float or None [unit]
        The length that the source homogenises the Jacobian with.
    ellipsoid : Ellipsoid or None
        The operation ellipsoid.
    home : Pose or None
        The pose that the source studies.

    Raises
    ------
    InvalidDesign
        On an unknown leg, fewer than six constraints, or a missing or zero direction.
    InvalidInput
        On wrong shapes or numbers that are not finite.

    Examples
    --------
    >>> angle = np.arange(6) * np.pi / 3
    >>> ring = np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)
    >>> hexapod = Design(["D1"] * 6, base_points=2 * ring, platform_points=np.roll(ring, 1, axis=0))
    >>> hexapod.at(Pose([0, 0, 1])).joints.round(3)
    array([2., 2., 2., 2., 2., 2.])
    """

    legs: tuple[Leg, ...]
    base_points: Array
    platform_points: Array
    base_directions: Array
    platform_directions: Array
    unit: str
    name: str
    source: str
    strokes: Array | None
    characteristic_length: float | None
    ellipsoid: Ellipsoid | None
    home: Pose | None

    def __init__(
        self,
        legs: Iterable[str | Iterable[str]],
        base_points: ArrayLike,
        platform_points: ArrayLike,
        base_directions: ArrayLike | None = None,
        platform_directions: ArrayLike | None = None,
        *,
        unit: str = "",
        name: str = "",
        source: str = "",
        strokes: ArrayLike | None = None,
        characteristic_length: float | None = None,
        ellipsoid: Ellipsoid | None = None,
        home: Pose | None = None,
    ) -> None:
        kinds = _check_legs(legs)
        put = object.__setattr__
        put(self, "legs", kinds)
        put(self, "base_points", _points("base_points", base_points, len(kinds)))
        put(self, "platform_points", _points("platform_points", platform_points, len(kinds)))
        used = [leg.base_line for leg in kinds]
        put(self, "base_directions", _directions("base_directions", base_directions, used))
        used = [leg.platform_line for leg in kinds]
        put(
            self,
            "platform_directions",
            _directions("platform_directions", platform_directions, used),
        )
        put(self, "unit", check_text("unit", unit))
        put(self, "name", check_text("name", name))
        put(self, "source", check_text("source", source))
        put(self, "strokes", _strokes(strokes, len(self.joint_names)))
        length = characteristic_length
        put(
            self,
            "characteristic_length",
            length if length is None else check_positive("characteristic_length", length),
        )
        if ellipsoid is not None:
            check_type("ellipsoid", ellipsoid, Ellipsoid, "a gsp.Ellipsoid or None")
        put(self, "ellipsoid", ellipsoid)
        if home is not None and (not isinstance(home, Pose) or home.shape):
            raise InvalidDesign(expected("home", "a single gsp.Pose or None", brief(home)))
        put(self, "home", home)

    @property
    def n_legs(self) -> int:
        """Number of legs."""
        return len(self.legs)

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """Rows of the Jacobian in order: the leg of each, counted from 0, and its constraint."""
        return tuple(Row(i, c) for i, leg in enumerate(self.legs) for c in leg.constraints)

    @cached_property
    def angular(self) -> Mask:
        """Which rows, and so which actuators, are angles (A1 constraints), shape (n,)."""
        mask = np.array([row.constraint.quantity == "angle" for row in self.rows], dtype=bool)
        mask.flags.writeable = False
        return mask

    @cached_property
    def groups(self) -> tuple[Group, ...]:
        """Its legs by kind, prepared for the formulas."""
        return groups(
            self.legs,
            (self.base_points, self.platform_points),
            (self.base_directions, self.platform_directions),
        )

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the actuated joints in row order: d1, d2, …, and theta1 … for angles."""
        return tuple(f"{row.constraint.symbol}{row.leg + 1}" for row in self.rows)

    @cached_property
    def joint_units(self) -> tuple[str, ...]:
        """Units of the actuated joints in row order: the unit of the design, or rad."""
        return tuple("rad" if angle else self.unit for angle in self.angular)

    @cached_property
    def mechanism(self) -> Mechanism:
        """Its constraints, as a mechanism (one of the 195 if there are six, ≤ 3 angular)."""
        return Mechanism.of(row.constraint.name for row in self.rows)

    @property
    def size(self) -> float:
        """Root-mean-square distance of base and platform anchors from their origins [unit].

        It is 1 where all the anchors are at the origins, as lines through one point may have them.
        """
        squares = np.concatenate((self.base_points, self.platform_points)) ** 2
        return float(np.sqrt(squares.sum(axis=1).mean())) or 1.0

    def at(self, pose: Pose) -> Posture:
        """Evaluate the design at a pose or a batch of poses.

        Raises
        ------
        InvalidInput
            If `pose` is not a Pose.
        """
        check_type("pose", pose, Pose)
        return Posture(self, pose)

    def replace(self, **changes: Any) -> Design:
        """Return a design with some of its parameters changed."""
        kept = {
            "legs": [leg.name for leg in self.legs],
            **{
                k: v
                for k, v in vars(self).items()
                if k in Design.__dataclass_fields__ and k != "legs"
            },
        }
        unknown = set(changes) - set(kept)
        if unknown:
            wanted = "one of " + ", ".join(kept)
            raise InvalidInput(expected("design parameter", wanted, sorted(unknown)[0]))
        return Design(**{**kept, **changes})

    def scaled(self, factor: float) -> Design:
        """Return the design with every length multiplied by `factor` > 0 (a change of unit)."""
        k = check_positive("factor", factor)
        length, ellipsoid, home, strokes = (
            self.characteristic_length, self.ellipsoid, self.home, self.strokes,
        )  # fmt: skip
        if strokes is not None:
            strokes = strokes * np.where(self.angular, 1.0, k)[:, None]
        return self.replace(
            base_points=self.base_points * k,
            platform_points=self.platform_points * k,
            strokes=strokes,
            characteristic_length=None if length is None else length * k,
            ellipsoid=None
            if ellipsoid is None
            else Ellipsoid(ellipsoid.semi_axes * k, ellipsoid.center * k, ellipsoid.rotation),
            home=None if home is None else Pose(home.position * k, home.rotation),
        )

    def exchanged(self) -> Design:
        """Return the design seen from its platform: base and platform change places.

        Its joint values at the inverse pose are those of this design at the pose.
        """
        swap = {"D2": "D3", "D3": "D2"}
        return self.replace(
            legs=[swap.get(leg.name, leg.name) for leg in self.legs],
            base_points=self.platform_points,
            platform_points=self.base_points,
            base_directions=self.platform_directions,
            platform_directions=self.base_directions,
            ellipsoid=None,
            home=None if self.home is None else self.home.inverse(),
        )

    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the design as TOML; `gsp.read_design` gives the same numbers back, bit by bit.

        Raises
        ------
        UnwritableOutput
            If the file exists and `overwrite` is not set, or the folder cannot be written.
        """
        allowed = arguments.flag("overwrite", overwrite)
        write_text(path, toml_from_design(self), overwrite=allowed)

    def __repr__(self) -> str:
        legs = ", ".join(leg.name for leg in self.legs)
        return f"Design({self.name or 'unnamed'!r}, legs=[{legs}], unit={self.unit!r})"


def read_design(path: str | PathLike[str]) -> Design:
    """Read a design from a TOML file.

    Raises
    ------
    MalformedFile
        If the file cannot be read, is no TOML, or has a wrong key or value; the message gives
        the path, the line and the key.
    """
    return design_from_toml(read_text(path), str(path))


def design_from_toml(text: str, origin: str) -> Design:
    """Make a design from the text of a TOML file; `origin` names it in errors."""
    parameters = parameters_from_toml(text, origin)
    try:
        return Design(**parameters)
    except InvalidInput as error:
        raise MalformedFile(f"{origin}: {error}") from error


def _check_legs(legs: Iterable[str | Iterable[str]]) -> tuple[Leg, ...]:
    if isinstance(legs, str | bytes) or not isinstance(legs, Iterable):
        raise InvalidDesign(expected("legs", "a sequence with one entry a leg", brief(legs)))
    kinds = tuple(check_leg(leg, f"legs[{i}]") for i, leg in enumerate(legs))
    number = sum(len(leg.constraints) for leg in kinds)
    if number < 6:
        raise InvalidDesign(expected("legs", "at least six constraints", number))
    return kinds


def _points(what: str, value: ArrayLike, n: int) -> Array:
    points = check_array(what, value, (n, 3))
    if points.ndim != 2:
        raise InvalidInput(expected(what, f"shape ({n}, 3)", f"shape {points.shape}"))
    return frozen(points)


def _directions(what: str, value: ArrayLike | None, used: Sequence[bool]) -> Array:
    wanted = np.array(used, dtype=bool)
    if value is None:
        if wanted.any():
            leg = int(np.flatnonzero(wanted)[0])
            raise InvalidDesign(
                expected(f"{what}[{leg}]", "a direction, as the leg has a line there", None)
            )
        return frozen(np.full((len(used), 3), np.nan))
    rows = check_array(what, value, (len(used), 3), finite=False)
    if rows.ndim != 2:
        raise InvalidInput(expected(what, f"shape ({len(used)}, 3)", f"shape {rows.shape}"))
    size = np.abs(rows).max(axis=1, keepdims=True, initial=0.0)
    bad = wanted & ~((size[:, 0] > 0.0) & (size[:, 0] < np.inf))
    if bad.any():
        leg = int(np.flatnonzero(bad)[0])
        wish = "a finite direction other than zero, as the leg has a line there"
        raise InvalidDesign(expected(f"{what}[{leg}]", wish, rows[leg].tolist()))
    extreme = (size > 1e100) | (size < 1e-100)  # the squares of these would not be numbers
    chosen = np.where(wanted[:, None], rows, np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        return frozen(unit(np.where(extreme, chosen / size, chosen)))


def _strokes(value: ArrayLike | None, n: int) -> Array | None:
    if value is None:
        return None
    limits = check_array("strokes", value, (n, 2), finite=False)
    if limits.ndim != 2 or (limits[:, 0] > limits[:, 1]).any():
        wanted = f"shape ({n}, 2) with least ≤ greatest"
        raise InvalidDesign(expected("strokes", wanted, brief(limits.tolist())))
    return None if np.isnan(limits).all() else frozen(limits)
