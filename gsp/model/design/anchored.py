"""Legs anchored on base and platform: the common part of designs in space and in the plane."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import update_wrapper
from os import PathLike
from types import FunctionType
from typing import Any, ClassVar, Generic, NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_line, check_text, check_type, is_a
from gsp.errors import InvalidDesign, InvalidInput, brief, expected
from gsp.files.writing import write_text
from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Batched
from gsp.geometry.vectors import EPS, Array, Mask
from gsp.model.design.checks import (
    check_directions,
    check_points,
    check_sizes,
    check_strokes,
)
from gsp.model.design.forms import Form
from gsp.model.design.toml import toml_from_design
from gsp.model.posture.assembly import Group, groups
from gsp.model.units import check_unit

P = TypeVar("P", bound=Batched)

# Anchors closer to their centre than this share of their coordinates are in one point.
ONE_POINT = 8 * EPS


class Row(NamedTuple):
    """A row of the Jacobian: the leg that it belongs to, and its constraint.

    Attributes
    ----------
    leg : int
        Counted from 0.
    constraint : Constraint or PlanarConstraint
        Its record.
    """

    leg: int
    constraint: Any


@dataclass(frozen=True, eq=False, init=False, repr=False)
class AnchoredDesign(ReadOnly, Generic[P]):
    """A design in `dimension` dimensions, whose legs join anchor points or lines.

    Its arguments are described at `Design` and `PlanarDesign`, which state what kinds of legs there
    are, what a pose is, and how the names of legs are read.

    Parameters
    ----------
    legs : sequence of names or records
        As attributes, a tuple of records with `name`, `constraints` (records with `name`, `symbol`,
        `quantity`, `undefined`), `base_line`, `platform_line`, `cylindrical` and `exchanged`.
    base_points, platform_points : (n_legs, dimension) array_like [unit]
    base_directions, platform_directions : (n_legs, dimension) array_like or None [1]
    unit, name, source : str
    strokes : (n, 2) array_like or None [unit, rad]
    characteristic_length : float or None [unit]
    ellipsoid : Ellipsoid or None
    home : pose or None

    Raises
    ------
    InvalidDesign
        If legs and anchors do not make a design: too few constraints, unknown legs, or lines
        that are not given.
    InvalidInput
        On wrong shapes or types, or numbers that are not finite or out of range.
    """

    dimension: ClassVar[int]
    form: ClassVar[Form]
    kinds: ClassVar[tuple[Any, ...]]
    pose_type: ClassVar[type]

    legs: tuple[Any, ...]
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
    home: P | None

    def __init_subclass__(cls) -> None:
        """Give each class a constructor of its own name, which Python's errors state."""
        of = AnchoredDesign.__init__
        own = FunctionType(of.__code__, of.__globals__, "__init__", of.__defaults__, of.__closure__)
        update_wrapper(own, of)
        own.__kwdefaults__, own.__qualname__ = of.__kwdefaults__, f"{cls.__qualname__}.__init__"
        type.__setattr__(cls, "__init__", own)

    def __init__(
        self,
        legs: Iterable[Any],
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
        home: P | None = None,
    ) -> None:
        # The attributes have other types than the arguments, so the record checks and sets here.
        kinds, n = self._check_legs(legs), self.dimension
        object.__setattr__(self, "legs", kinds)  # `rows` reads them
        base_lines = [leg.base_line for leg in kinds]
        platform_lines = [leg.platform_line for leg in kinds]
        if ellipsoid is not None:
            check_type("ellipsoid", ellipsoid, Ellipsoid, "a gsp.Ellipsoid or None")
        if home is not None and (not is_a(home, self.pose_type) or home.shape):
            wanted = f"a single {self.pose_type.__name__} or None"
            raise InvalidDesign(expected("home", wanted, brief(home)))
        length = characteristic_length
        if length is not None:
            length = arguments.size("characteristic_length", length)
        given = {"base_points": base_points, "platform_points": platform_points}
        points = {key: check_points(key, value, len(kinds), n) for key, value in given.items()}
        check_sizes(points)
        checked = {
            **points,
            "base_directions": check_directions("base_directions", base_directions, base_lines, n),
            "platform_directions": check_directions(
                "platform_directions", platform_directions, platform_lines, n
            ),
            "unit": check_unit("unit", unit),
            "name": check_line("name", name),
            "source": check_text("source", source),
            "strokes": None if strokes is None else check_strokes(strokes, self.signed),
            "characteristic_length": length,
            "ellipsoid": ellipsoid,
            "home": home,
        }
        for key, value in checked.items():
            object.__setattr__(self, key, value)
        self._check_drives()

    @classmethod
    def _check_legs(cls, legs: Any) -> tuple[Any, ...]:
        """Return the kinds of the legs that are named, or raise InvalidDesign."""
        raise NotImplementedError

    def _check_drives(self) -> None:
        """Raise InvalidDesign for drives that do not fit their lines; the plane has none."""

    def _scaled_legs(self, factor: float) -> tuple[Any, ...]:
        """Return the legs with the lengths of their drives multiplied by a factor."""
        return self.legs

    @kept_property
    def groups(self) -> tuple[Group, ...]:
        """Its legs by kind, prepared for the formulas."""
        return groups(
            self.legs,
            self.kinds,
            (self.base_points, self.platform_points),
            (self.base_directions, self.platform_directions),
        )

    @property
    def n_legs(self) -> int:
        """Number of legs."""
        return len(self.legs)

    @kept_property
    def rows(self) -> tuple[Row, ...]:
        """Rows of the Jacobian in order: the leg of each, counted from 0, and its constraint."""
        return tuple(Row(i, c) for i, leg in enumerate(self.legs) for c in leg.constraints)

    @kept_property
    def angular(self) -> Mask:
        """Which rows, and so which actuators, are angles (A1 constraints), shape (n,).

        *Source: TozKucuk2016, §2, for A1*
        """
        mask = np.array([row.constraint.quantity == "angle" for row in self.rows], dtype=bool)
        mask.flags.writeable = False
        return mask

    @kept_property
    def signed(self) -> Mask:
        """Which actuators may have values below zero, shape (n,): angles, and drives at the base.

        *Source: ours; docs/drives.md*
        """
        mask = np.array([row.constraint.signed for row in self.rows], dtype=bool)
        mask.flags.writeable = False
        return mask

    @kept_property
    def driven(self) -> bool:
        """Whether some leg is driven at the base, by a slider or a crank.

        *Source: docs/drives.md*
        """
        return any(getattr(leg, "drive", None) is not None for leg in self.legs)

    @property
    def cylindrical(self) -> bool:
        """Whether a passive joint of some leg slides."""
        return any(leg.cylindrical for leg in self.legs)

    @property
    def between_points(self) -> bool:
        """Whether all legs are between points: SPS legs in space, RPR legs in the plane."""
        return not any(leg.base_line or leg.platform_line for leg in self.legs)

    @kept_property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the actuated joints in row order: d1, d2, …, and theta1 … for angles."""
        return tuple(f"{row.constraint.symbol}{row.leg + 1}" for row in self.rows)

    @kept_property
    def joint_units(self) -> tuple[str, ...]:
        """Units of the actuated joints in row order: the unit of the design, or rad."""
        return tuple("rad" if angle else self.unit for angle in self.angular)

    @kept_property
    def rms_radius(self) -> float:
        """Root-mean-square distance of the anchors from the centre of those of their body [unit].

        It does not depend on where the frames have their origins. It is 1 where the anchors of
        either body are in one point, as lines through one point may have them.

        *Source: ours*
        """
        sides = (self.base_points, self.platform_points)
        squares = np.concatenate([points - points.mean(axis=0) for points in sides]) ** 2
        radius = float(np.sqrt(squares.sum(axis=1).mean()))
        largest = max(float(np.abs(points).max()) for points in sides)
        return radius if radius > ONE_POINT * largest else 1.0

    def replace(self, **changes: Any) -> Self:
        """Return a design with some of its parameters changed.

        Parameters
        ----------
        **changes : new values by the names of the parameters

        Raises
        ------
        InvalidInput
            On a name that is not a parameter.
        """
        check_keywords(f"{type(self).__name__}.replace", changes, PARAMETERS)
        if changes.keys() == {"name"}:  # what is computed and kept does not depend on it
            return self._named(check_line("name", changes["name"]))
        kept = {key: getattr(self, key) for key in PARAMETERS}
        return type(self)(**{**kept, **changes})

    def _named(self, name: str) -> Self:
        """Return the design with another name; all else is shared, as nothing of it can change."""
        other = object.__new__(type(self))
        vars(other).update(vars(self), name=name)
        return other

    def scaled(self, factor: float) -> Self:
        """Return the design with every length multiplied by a factor (a change of unit).

        Parameters
        ----------
        factor : float [1]
            > 0

        Returns
        -------
        A design of the same kind, with strokes, length, ellipsoid and home in the new unit.

        Raises
        ------
        InvalidInput
            On another factor.

        *Source: docs/conventions.md, "Units"*
        """
        k = arguments.size("factor", factor)
        length, ellipsoid, home, strokes = (
            self.characteristic_length,
            self.ellipsoid,
            self.home,
            self.strokes,
        )
        units = np.where(self.angular, 1.0, k)[:, None]
        return self.replace(
            legs=self._scaled_legs(k),
            base_points=self.base_points * k,
            platform_points=self.platform_points * k,
            strokes=None if strokes is None else strokes * units,
            characteristic_length=None if length is None else length * k,
            ellipsoid=None if ellipsoid is None else ellipsoid.scaled(k),
            home=None if home is None else home.scaled(k),
        )

    def with_origin(self, point: ArrayLike) -> Self:
        """Return the design with the platform origin at another point: a tool centre or a pivot.

        The joint values at a pose of the new origin are those at the same place of the platform.
        Twists then have the velocity of that point. The ellipsoid and home stay where they are.

        Parameters
        ----------
        point : (dimension,) array_like [unit]
            In platform axes, from the present origin.

        Returns
        -------
        A design of the same kind.

        Raises
        ------
        InvalidInput
            On another shape, or numbers that are not finite.

        *Source: docs/conventions.md, "What another description changes"*
        """
        shift = check_array("point", point, (self.dimension,))
        if shift.ndim != 1:
            raise InvalidInput(expected("point", "a single point", f"shape {shift.shape}"))
        ellipsoid = self.ellipsoid
        home: Any = self.home
        if ellipsoid is not None:
            centre = ellipsoid.center - np.append(shift, np.zeros(3 - self.dimension))
            ellipsoid = Ellipsoid(ellipsoid.semi_axes, centre, ellipsoid.rotation)
        if home is not None:
            home = home.compose(self.pose_type(shift))
        return self.replace(
            platform_points=self.platform_points - shift, ellipsoid=ellipsoid, home=home
        )

    def exchanged(self) -> Self:
        """Return the design with base and platform exchanged, of legs not driven at the base.

        Its distances at the inverse pose are those of this design at the pose, and so are the
        angles in space; the oriented angles in the plane change their sign.

        Returns
        -------
        A design of the same kind. It has no operation ellipsoid, which is fixed to the platform.

        Raises
        ------
        InvalidDesign
            For legs that are driven at the base.

        *Source: docs/conventions.md, "What another description changes"*
        """
        if any(not constraint.exchanged for _, constraint in self.rows):
            raise InvalidDesign(
                expected("exchanged", "legs that are not driven at the base", repr(self))
            )
        return self.replace(
            legs=[leg.exchanged for leg in self.legs],
            base_points=self.platform_points,
            platform_points=self.base_points,
            base_directions=self.platform_directions,
            platform_directions=self.base_directions,
            ellipsoid=None,
            home=None if self.home is None else self.home.inverse(),
        )

    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the design as TOML; reading the file gives the same numbers, bit by bit.

        It is read by `gsp.read_design`, of a planar design by `gsp.planar.read_planar_design`.

        Parameters
        ----------
        path : path of a file
        overwrite : bool
            Whether a file that exists is replaced.

        Raises
        ------
        UnwritableOutput
            If the file exists and `overwrite` is not set, or the folder cannot be written.
        """
        allowed = arguments.flag("overwrite", overwrite)
        write_text(arguments.path("path", path), toml_from_design(self), overwrite=allowed)

    def __repr__(self) -> str:
        legs = ", ".join(leg.name for leg in self.legs)
        return (
            f"{type(self).__name__}({self.name or 'unnamed'!r}, legs=[{legs}], unit={self.unit!r})"
        )


PARAMETERS = tuple(field.name for field in fields(AnchoredDesign))
# What a function that makes the legs and their anchors passes on to the design.
SETTINGS = tuple(
    name for name in PARAMETERS if name not in ("legs", "base_points", "platform_points")
)


def check_keywords(function: str, given: Iterable[str], known: Iterable[str]) -> None:
    """Raise InvalidInput for keywords that a function does not pass on to a design.

    The message names the function that was called, which Python's own would not.

    Parameters
    ----------
    function : str
        Its name.
    given, known : iterables of str
        Names of keywords.

    Raises
    ------
    InvalidInput
        If one of those given is not known.
    """
    names = tuple(known)
    unknown = sorted(set(given) - set(names))
    if unknown:
        what = f"{function}, keyword argument"
        raise InvalidInput(expected(what, "one of " + ", ".join(names), unknown[0]))
