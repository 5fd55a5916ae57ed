"""PlanarDesign: a planar platform with dimensions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from typing import Any, ClassVar

from gsp.checks import is_a, plain_text
from gsp.errors import InvalidDesign, InvalidInput, MalformedFile, expected
from gsp.files.writing import read_text
from gsp.model.design import AnchoredDesign
from gsp.model.design.checks import check_legs
from gsp.model.design.designs import BYTES_PER_DESIGN
from gsp.model.design.forms import Form
from gsp.model.design.toml import parameters_from_toml
from gsp.planar.constraints import PLANAR_CONSTRAINTS, PlanarConstraint
from gsp.planar.pose import PlanarPose
from gsp.planar.posture import PlanarPosture
from gsp.planar.toml import PLANAR, check_planar_leg


@dataclass(frozen=True, eq=False, init=False, repr=False)
class PlanarDesign(AnchoredDesign[PlanarPose]):
    """A planar platform with dimensions: legs, and where they are anchored.

    Parameters
    ----------
    legs : sequence of str or PlanarConstraint
        Per leg its constraint: "D1" (an RPR leg), "D2", "D3" or "A1". At least three; more make
        a redundant design.
    base_points, platform_points : (n, 2) array_like [unit]
        a_i in base axes, b_i in platform axes.
    base_directions, platform_directions : (n, 2) array_like or None [1]
        s_i and t_i, normalised here. A row is ignored (NaN allowed) where the leg has no line.
    unit : str
        The unit of length of all the numbers, for the record.
    name, source : str
    strokes : (n, 2) array_like or None [unit, rad]
        Least and greatest value per actuator, those of distances ≥ 0; NaN for no limit.
    characteristic_length : float or None [unit]
    ellipsoid : Ellipsoid or None
        The operation ellipsoid, in platform axes (its z-axis is normal to the plane).
    home : PlanarPose of batch shape (), or None
        The pose that the source studies.

    Raises
    ------
    InvalidDesign
        On an unknown leg, fewer than three legs, or a missing or zero direction.
    InvalidInput
        On wrong shapes or numbers that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.planar import PlanarDesign, PlanarPose
    >>> angle = np.arange(3) * 2 * np.pi / 3
    >>> triangle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    >>> design = PlanarDesign(["D1"] * 3, base_points=2 * triangle, platform_points=triangle)
    >>> design.at(PlanarPose([0.0, 0.0], 0.0)).joints.round(3)
    array([1., 1., 1.])
    """

    dimension: ClassVar[int] = 2
    form: ClassVar[Form] = PLANAR
    kinds: ClassVar[tuple[Any, ...]] = PLANAR_CONSTRAINTS
    pose_type: ClassVar[type] = PlanarPose

    legs: tuple[PlanarConstraint, ...]

    @classmethod
    def _check_legs(cls, legs: Iterable[str | PlanarConstraint]) -> tuple[PlanarConstraint, ...]:
        names = check_legs(legs)
        found = tuple(check_planar_leg(name, f"legs[{i}]") for i, name in enumerate(names))
        if len(names) < 3:
            raise InvalidDesign(expected("legs", "at least three", len(names)))
        return found

    def at(self, pose: PlanarPose) -> PlanarPosture:
        """Return the posture: the design evaluated at a planar pose or a batch of them.

        Parameters
        ----------
        pose : PlanarPose, batch shape (...)
            Platform axes in base axes, in the unit of the design.

        Returns
        -------
        PlanarPosture, batch shape (...)

        Raises
        ------
        InvalidInput
            If `pose` is not a PlanarPose.
        """
        if not is_a(pose, PlanarPose):
            raise InvalidInput(expected("pose", "a gsp.planar.PlanarPose", type(pose).__name__))
        return PlanarPosture(self, pose)


def read_planar_design(path: str | PathLike[str]) -> PlanarDesign:
    """Return the planar design of a TOML file.

    Parameters
    ----------
    path : path of a file
        With the keys of a design in space; points and directions have two numbers, and the table
        [home] has `position` and `angle` [rad] or `angle_deg`.

    Returns
    -------
    PlanarDesign

    Raises
    ------
    MalformedFile
        If the file cannot be read, is not TOML, or has a wrong key or value; the message gives
        the path, the line and the key.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import gsp
    >>> path = Path(tempfile.mkdtemp(), "mine.toml")
    >>> gsp.planar.families.isotropic(4).write(path)
    >>> gsp.planar.read_planar_design(path).n_legs
    4
    """
    path = plain_text(path)
    text = read_text(path, most=BYTES_PER_DESIGN)
    parameters = parameters_from_toml(text, str(path), PLANAR)
    try:
        return PlanarDesign(**parameters)
    except InvalidInput as error:
        raise MalformedFile(f"{path}: {error}") from error
