"""Legs of fixed length that are driven at the base: the records of their drives."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from gsp import arguments
from gsp.checks import check_integer
from gsp.errors import InvalidDesign, InvalidInput, brief, expected
from gsp.geometry.vectors import EPS, Array, cross, norm, perpendicular

# An arm is along an axis if its part across it is rounding.
ALONG_AXIS = 8 * EPS


@dataclass(frozen=True, kw_only=True)
class Slider:
    """A carriage on a rail, with a rod of fixed length from it to the platform: a PSS leg.

    The rail is the base line of the leg: it passes through the base point, where the travel is
    zero, in the base direction. Hexaglides have such legs.

    Parameters
    ----------
    rod : float [unit of the design]
        Length of the rod, > 0.
    branch : 1 or −1
        Which of the two travels at a pose: 1 where the rod points along the rail to the positive
        side, so that the carriage pushes when it moves in the base direction.

    Raises
    ------
    InvalidInput
        On a length that is not a positive number, or another branch.

    *Source: the condition that the rod keeps its length; see docs/drives.md*

    Examples
    --------
    >>> import gsp
    >>> gsp.Slider(rod=0.6, branch=-1)
    Slider(rod=0.6, branch=-1)
    """

    kind: ClassVar[str] = "slider"

    rod: float
    branch: int = 1

    def __post_init__(self) -> None:
        _check_rod_and_branch(self)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Length of the rod [length] and branch [1], shape (2,), as the formulas read them.

        *Source: docs/drives.md*
        """
        return self.rod, float(self.branch)


@dataclass(frozen=True, kw_only=True)
class Crank:
    """A crank, with a rod of fixed length from its end to the platform: an RSS leg.

    The axis is the base line of the leg, through the base point in the base direction; positive
    angles turn right-handed about it. Platforms with rotary servomotors have such legs.

    Parameters
    ----------
    arm : (3,) array_like [unit of the design]
        From the base point to the tip of the crank at the angle zero, in base axes; not along the
        axis. As the angle is in (−π, π], choose the zero near the middle of its range.
    rod : float [unit of the design]
        Length of the rod, > 0.
    branch : 1 or −1
        Which of the two angles at a pose: 1 where the crank pushes the rod when its angle
        increases.

    Raises
    ------
    InvalidInput
        On an arm that is not three finite numbers, a length that is not a positive number, or
        another branch.

    *Source: the condition that the rod keeps its length; see docs/drives.md*

    Examples
    --------
    >>> import gsp
    >>> gsp.Crank(arm=[0.05, 0, 0], rod=0.2)
    Crank(arm=(0.05, 0.0, 0.0), rod=0.2, branch=1)
    """

    kind: ClassVar[str] = "crank"

    arm: tuple[float, float, float]
    rod: float
    branch: int = 1

    def __post_init__(self) -> None:
        arm = arguments.bounded_array("arm", self.arm, (3,))
        if arm.ndim != 1:
            raise InvalidInput(expected("arm", "three numbers", brief(self.arm)))
        object.__setattr__(self, "arm", tuple(arm.tolist()))
        _check_rod_and_branch(self)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Length of the rod [length], branch [1], arm [length], shape (5,), for the formulas.

        *Source: docs/drives.md*
        """
        return self.rod, float(self.branch), *self.arm


Drive = Slider | Crank
DRIVES: MappingProxyType[str, type[Drive]] = MappingProxyType(
    {kind.kind: kind for kind in (Slider, Crank)}
)


def scaled(drive: Drive, factor: float) -> Drive:
    """Return a drive with its lengths multiplied by a factor > 0 [1]."""
    lengths = {part.name: getattr(drive, part.name) for part in fields(drive)}
    del lengths["branch"]
    multiples = {name: (factor * np.asarray(value)).tolist() for name, value in lengths.items()}
    return replace(drive, **multiples)


def check_line(what: str, drive: Drive, line: Array) -> None:
    """Raise InvalidDesign if the arm of a crank is along its axis, up to rounding.

    Parameters
    ----------
    what : str
        The leg, for the message.
    drive : Slider or Crank
    line : (3,) array
        Unit direction of its rail or axis.
    """
    arm = np.array(getattr(drive, "arm", perpendicular(line)))
    if not norm(cross(line, arm)) > ALONG_AXIS * norm(arm):
        wanted = "a crank whose arm is not along its axis"
        raise InvalidDesign(expected(what, wanted, brief(arm.tolist())))


def _check_rod_and_branch(drive: Drive) -> None:
    object.__setattr__(drive, "rod", arguments.size("rod", drive.rod))
    if check_integer("branch", drive.branch, -1) not in (-1, 1):
        raise InvalidInput(expected("branch", "1 or -1", brief(drive.branch)))
    object.__setattr__(drive, "branch", int(drive.branch))


def drives_text(drives: Iterable[Drive | None]) -> str:
    """Return how many drives of each kind legs have, in words; "" if they have none.

    >>> drives_text([Slider(rod=2.0)] * 2 + [None, Crank(arm=[1.0, 0.0, 0.0], rod=2.0)])
    '2 sliders, 1 crank'
    """
    counts = Counter(drive.kind for drive in drives if drive is not None)
    return ", ".join(f"{n} {kind}{'s' * (n > 1)}" for kind, n in counts.items())
