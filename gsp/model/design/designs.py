"""Design: a mechanism with dimensions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib import import_module
from os import PathLike
from typing import TYPE_CHECKING, Any, ClassVar, Self

from gsp import arguments
from gsp.checks import check_type, plain_text
from gsp.errors import InvalidDesign, InvalidInput, MalformedFile, brief, expected
from gsp.files.writing import read_text
from gsp.geometry.copies import kept_property
from gsp.geometry.pose import Pose
from gsp.model.design.anchored import AnchoredDesign
from gsp.model.design.checks import check_legs
from gsp.model.design.forms import SPATIAL, Form
from gsp.model.design.frame import check_columns, columns_from_design, parameters_from_columns
from gsp.model.design.toml import parameters_from_toml
from gsp.model.drives import Drive, check_line, scaled
from gsp.model.legs import DRIVEN_LEGS, LEGS, Leg, check_leg
from gsp.model.mechanism import Mechanism
from gsp.model.posture.postures import Posture

if TYPE_CHECKING:
    import pandas as pd

    from gsp.app.scene.figure import SceneFigure
    from gsp.geometry.ellipsoid import Ellipsoid

# Bytes of the longest design file that is read; those of the library have a few thousand.
BYTES_PER_DESIGN = 64 * 2**20


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Design(AnchoredDesign[Pose]):
    """A mechanism with dimensions: legs, and where they are anchored.

    Parameters
    ----------
    legs : sequence of str, Slider, Crank or Leg
        Per leg its constraint(s): "D1", "D2", "D3", "D4", "A1" or "D4 A1"; or what drives a leg of
        fixed length at the base, a `gsp.Slider` or a `gsp.Crank`; or its record, such as those of
        another design. Together at least six constraints; more make a redundant design.
    base_points, platform_points : (n_legs, 3) array_like [unit]
        a_i in base axes, b_i in platform axes.
    base_directions, platform_directions : (n_legs, 3) array_like or None [1]
        s_i and t_i, normalised here. A row is ignored (NaN allowed) where the leg has no line. The
        base line of a driven leg is the rail of its slider or the axis of its crank.
    unit : str
        The unit of length of all the numbers, for the record: "mm", "m" … Any name without spaces
        around it; "" for none. See docs/conventions.md.
    name, source : str
    strokes : (n, 2) array_like or None [unit, rad]
        Least and greatest value per actuator, in the order of `joint_names`; NaN for no limit.
        Those of distances are ≥ 0, but for the travels of sliders.
    characteristic_length : float or None [unit]
        The length with which the source makes the Jacobian homogeneous.
    ellipsoid : Ellipsoid or None
        The operation ellipsoid.
    home : Pose of batch shape (), or None
        The pose at which the source studies the design.

    Raises
    ------
    InvalidDesign
        On an unknown leg, fewer than six constraints, a missing or zero direction, or the arm of a
        crank along its axis.
    InvalidInput
        On wrong shapes or numbers that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from gsp import Design, Pose
    >>> angle = np.arange(6) * np.pi / 3
    >>> ring = np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)
    >>> hexapod = Design(["D1"] * 6, base_points=2 * ring, platform_points=np.roll(ring, 1, axis=0))
    >>> hexapod.at(Pose([0, 0, 1])).joints.round(3)
    array([2., 2., 2., 2., 2., 2.])
    """

    dimension: ClassVar[int] = 3
    form: ClassVar[Form] = SPATIAL
    kinds: ClassVar[tuple[Any, ...]] = (*LEGS, *DRIVEN_LEGS)
    pose_type: ClassVar[type] = Pose

    legs: tuple[Leg, ...]

    @classmethod
    def _check_legs(cls, legs: Iterable[str | Leg | Drive | Iterable[str]]) -> tuple[Leg, ...]:
        given = check_legs(legs)
        kinds = tuple(check_leg(leg, f"legs[{i}]") for i, leg in enumerate(given))
        number = sum(len(leg.constraints) for leg in kinds)
        if number < 6:
            raise InvalidDesign(expected("legs", "at least six constraints", number))
        return kinds

    def _check_drives(self) -> None:
        for i, drive in enumerate(self.drives):
            if drive is not None:
                check_line(f"legs[{i}]", drive, self.base_directions[i])

    def _scaled_legs(self, factor: float) -> tuple[Leg, ...]:
        return tuple(
            leg if leg.drive is None else replace(leg, drive=scaled(leg.drive, factor))
            for leg in self.legs
        )

    @property
    def drives(self) -> tuple[Drive | None, ...]:
        """What drives each leg at the base: a Slider, a Crank, or None for other legs.

        *Source: docs/drives.md*
        """
        return tuple(leg.drive for leg in self.legs)

    @classmethod
    def from_frame(
        cls,
        frame: pd.DataFrame,
        *,
        unit: str = "",
        name: str = "",
        source: str = "",
        characteristic_length: float | None = None,
        ellipsoid: Ellipsoid | None = None,
        home: Pose | None = None,
    ) -> Self:
        """Return the design of a data frame with one row per leg.

        Parameters
        ----------
        frame : pandas.DataFrame
            Columns base_x, base_y, base_z, platform_x, platform_y, platform_z [unit], and where
            they are needed: constraints ("D1", "D4 A1" …; D1 without it), base_dx … base_dz and
            platform_dx … platform_dz (directions of lines), stroke_low and stroke_high [unit, rad]
            (empty for no limit), stroke_low_2 and stroke_high_2 (of the angle of legs D4 A1); for
            legs driven at the base drive ("slider", "crank"), rod, branch, arm_x, arm_y, arm_z.
        unit, name, source : str
        characteristic_length : float or None [unit]
        ellipsoid : Ellipsoid or None
        home : Pose of batch shape (), or None
            These as for `Design`.

        Returns
        -------
        Design

        Raises
        ------
        InvalidInput
            With the column and the row, counted from 0, of the first mistake.
        UnknownName
            On a column that is none of these.

        Examples
        --------
        >>> import gsp
        >>> lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
        >>> again = gsp.Design.from_frame(lift.to_frame(), home=lift.home)
        >>> bool((again.base_points == lift.base_points).all())
        True
        """
        names = list(arguments.frame("frame", frame).columns)
        check_columns(names, "frame")
        parameters = parameters_from_columns(
            {column: frame[column].tolist() for column in names},
            lambda row, column: f"frame, row {row}, column {brief(column)}",
        )
        return cls(
            **parameters,
            unit=unit,
            name=name,
            source=source,
            characteristic_length=characteristic_length,
            ellipsoid=ellipsoid,
            home=home,
        )

    def to_frame(self) -> pd.DataFrame:
        """Return the legs as a data frame, one row per leg, in the columns of `from_frame`.

        `Design.from_frame` returns the same numbers, bit by bit. Columns that no leg needs are
        left out, and so are unit, name, home and whatever else is not of a leg.

        Returns
        -------
        pandas.DataFrame
            (n_legs) rows; NaN where a leg has no line or limit.
        """
        import pandas as pd

        return pd.DataFrame(columns_from_design(self))

    @kept_property
    def mechanism(self) -> Mechanism:
        """Its constraints, as a mechanism (one of the 195 if there are six, ≤ 3 angular).

        A leg of fixed length that is driven at the base has the constraint D1.
        """
        return _mechanism_of(tuple([c.name for leg in self.legs for c in leg.constraints]))

    @property
    def determinant_power(self) -> int:
        """Power of the unit of length in det J of six rows: 3 − n_A1, n_A1 rows of angles.

        The Jacobian has three columns of moments, and their entries are lengths but for those of
        angular rows. It has no meaning where the determinant has no unit (`determinant_has_unit`).

        *Source: the units of the rows, TozKucuk2016, eqs. (12)–(16).*
        """
        return 3 - int(self.angular.sum())

    @property
    def determinant_has_unit(self) -> bool:
        """Whether |det J|, or sqrt(det JᵀJ) of more than six rows, has one unit.

        det JᵀJ of a redundant design with angular rows adds values of unlike units.

        *Source: the units of the rows, TozKucuk2016, eqs. (12)–(16).*
        """
        return len(self.joint_names) == 6 or not bool(self.angular.any())

    def show(self, pose: Pose | None = None) -> SceneFigure:
        """Return the design in space as a figure that can be turned, for notebooks.

        Parameters
        ----------
        pose : Pose of batch shape (), or None [unit]
            Default: the home pose; without one, above the base by the size of the design.

        Returns
        -------
        SceneFigure
            An HTML page that needs no other file and no network; `write` saves it.

        Raises
        ------
        InvalidInput
            On another type, or several poses.
        MissingSoftware
            Without the extra `app`.

        Examples
        --------
        >>> import gsp
        >>> gsp.catalogue.design("lee-2000-3-3").show()
        SceneFigure('lee-2000-3-3: platform at 0, 0, 1')
        """
        # The one function of a higher layer that is a method here; it is imported when it is used.
        shown: SceneFigure = import_module("gsp.app.scene.figure").figure(self, pose)
        return shown

    def at(self, pose: Pose) -> Posture:
        """Return the posture: the design evaluated at a pose or a batch of poses.

        Parameters
        ----------
        pose : Pose, batch shape (...)
            Platform axes in base axes, in the unit of the design.

        Returns
        -------
        Posture, batch shape (...)

        Raises
        ------
        InvalidInput
            If `pose` is not a Pose.
        """
        check_type("pose", pose, Pose)
        return Posture(self, pose)


@lru_cache(maxsize=1024)
def _mechanism_of(constraints: tuple[str, ...]) -> Mechanism:
    return Mechanism.of(constraints)


def check_undriven(what: str, design: Any) -> Design:
    """Return a design if no leg is driven at the base, or raise an error.

    It is called wherever the formulas are those of legs that change their own length.

    Parameters
    ----------
    what : str
        The argument, for the message.
    design : any

    Raises
    ------
    InvalidInput
        If it is not a Design.
    InvalidDesign
        If a leg is driven at the base.
    """
    check_type(what, design, Design)
    chosen: Design = design
    driven = [f"leg {i + 1} ({leg.name})" for i, leg in enumerate(chosen.legs) if leg.drive]
    if driven:
        wanted = "a design without legs that are driven at the base (see docs/drives.md)"
        others = f" and {len(driven) - 1} others" if len(driven) > 1 else ""
        raise InvalidDesign(expected(what, wanted, driven[0] + others))
    return chosen


def read_design(path: str | PathLike[str]) -> Design:
    """Return the design of a TOML file.

    Parameters
    ----------
    path : path of a file

    Returns
    -------
    Design

    Raises
    ------
    MalformedFile
        If the file cannot be read, is not TOML, or has a wrong key or value; the message gives
        the path, the line and the key.
    """
    path = plain_text(path)
    return design_from_toml(read_text(path, most=BYTES_PER_DESIGN), str(path))


def design_from_toml(text: str, origin: str) -> Design:
    """Return the design of the text of a TOML file.

    Parameters
    ----------
    text : str
    origin : str
        Names the file in errors.

    Returns
    -------
    Design

    Raises
    ------
    MalformedFile
        If the text is not TOML, or has a wrong key or value.
    """
    parameters = parameters_from_toml(text, origin)
    try:
        return Design(**parameters)
    except InvalidInput as error:
        raise MalformedFile(f"{origin}: {error}") from error
