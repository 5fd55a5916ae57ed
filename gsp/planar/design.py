"""PlanarDesign: a planar platform with dimensions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_positive
from gsp.errors import InvalidDesign, InvalidInput, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array, frozen, norm, unit
from gsp.planar.constraints import PLANAR_CONSTRAINT, PlanarConstraint
from gsp.planar.pose import PlanarPose
from gsp.planar.posture import PlanarPosture


@dataclass(frozen=True, eq=False, init=False)
class PlanarDesign:
    """A planar platform with dimensions: legs, and where they are anchored.

    Parameters
    ----------
    legs : sequence of str
        Per leg its constraint: "D1" (an RPR leg), "D2", "D3" or "A1". At least three; more make
        a redundant design.
    base_points, platform_points : (n, 2) array_like [unit]
        a_i in base axes, b_i in platform axes.
    base_directions, platform_directions : (n, 2) array_like or None
        s_i and t_i, normalised here. A row is ignored (NaN allowed) where the leg has no line.
    unit : str
        The unit of length of all the numbers, for the record.
    name, source : str
    strokes : (n, 2) array_like or None [unit, rad]
        Least and greatest value per actuator; NaN for no limit.
    characteristic_length : float or None [unit]
    ellipsoid : Ellipsoid or None
        The operation ellipsoid, in platform axes (its z-axis is normal to the plane).
    home : PlanarPose or None

    Raises
    ------
    InvalidDesign
        On an unknown leg, fewer than three legs, or a missing or zero direction.
    InvalidInput
        On wrong shapes or numbers that are not finite.

    Examples
    --------
    >>> angle = np.arange(3) * 2 * np.pi / 3
    >>> triangle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    >>> design = PlanarDesign(["D1"] * 3, base_points=2 * triangle, platform_points=triangle)
    >>> design.at(PlanarPose([0.0, 0.0], 0.0)).joints.round(3)
    array([1., 1., 1.])
    """

    legs: tuple[PlanarConstraint, ...]
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
    home: PlanarPose | None

    def __init__(
        self,
        legs: Iterable[str],
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
        home: PlanarPose | None = None,
    ) -> None:
        kinds = _check_legs(legs)
        n, length = len(kinds), characteristic_length
        if ellipsoid is not None and not isinstance(ellipsoid, Ellipsoid):
            raise InvalidDesign(expected("ellipsoid", "an Ellipsoid or None", ellipsoid))
        if home is not None and (not isinstance(home, PlanarPose) or home.shape):
            raise InvalidDesign(expected("home", "a single PlanarPose or None", repr(home)))
        values = {
            "legs": kinds,
            "base_points": _rows("base_points", base_points, n),
            "platform_points": _rows("platform_points", platform_points, n),
            "base_directions": _directions("base", base_directions, [k.base for k in kinds]),
            "platform_directions": _directions(
                "platform", platform_directions, [k.platform for k in kinds]
            ),
            "unit": str(unit),
            "name": str(name),
            "source": str(source),
            "strokes": _strokes(strokes, n),
            "characteristic_length": None
            if length is None
            else check_positive("characteristic_length", length),
            "ellipsoid": ellipsoid,
            "home": home,
        }
        for key, value in values.items():
            object.__setattr__(self, key, value)

    @property
    def n_legs(self) -> int:
        """Number of legs."""
        return len(self.legs)

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the actuated joints: d1, d2, …, and theta1 … for angles."""
        return tuple(f"{c.symbol}{i}" for i, c in enumerate(self.legs, 1))

    @property
    def size(self) -> float:
        """Root-mean-square distance of base and platform anchors from their origins [unit]."""
        squares = np.concatenate((self.base_points, self.platform_points)) ** 2
        return float(np.sqrt(squares.sum(axis=1).mean()))

    def at(self, pose: PlanarPose) -> PlanarPosture:
        """Evaluate the design at a planar pose or a batch of them.

        Raises
        ------
        InvalidInput
            If `pose` is not a PlanarPose.
        """
        if not isinstance(pose, PlanarPose):
            raise InvalidInput(expected("pose", "a gsp.PlanarPose", type(pose).__name__))
        return PlanarPosture(self, pose)

    def replace(self, **changes: Any) -> PlanarDesign:
        """Return a design with some of its parameters changed."""
        fields = PlanarDesign.__dataclass_fields__
        unknown = set(changes) - set(fields)
        if unknown:
            raise InvalidInput(expected("design parameter", ", ".join(fields), unknown.pop()))
        kept = {key: getattr(self, key) for key in fields} | {"legs": [c.name for c in self.legs]}
        return PlanarDesign(**{**kept, **changes})

    def scaled(self, factor: float) -> PlanarDesign:
        """Return the design with every length multiplied by `factor` > 0 (a change of unit)."""
        k = check_positive("factor", factor)
        e, length, home, strokes = (
            self.ellipsoid, self.characteristic_length, self.home, self.strokes,
        )  # fmt: skip
        lengths = np.array([c.quantity == "distance" for c in self.legs])
        return self.replace(
            base_points=self.base_points * k,
            platform_points=self.platform_points * k,
            strokes=None if strokes is None else strokes * np.where(lengths, k, 1.0)[:, None],
            characteristic_length=None if length is None else length * k,
            ellipsoid=None if e is None else Ellipsoid(e.semi_axes * k, e.center * k, e.rotation),
            home=None if home is None else PlanarPose(home.position * k, home.angle),
        )

    def exchanged(self) -> PlanarDesign:
        """Return the design seen from its platform: base and platform change places.

        Its distances at the inverse pose are those of this design at the pose; the oriented
        angles of A1 legs change their sign.
        """
        swap = {"D2": "D3", "D3": "D2"}
        return self.replace(
            legs=[swap.get(c.name, c.name) for c in self.legs],
            base_points=self.platform_points,
            platform_points=self.base_points,
            base_directions=self.platform_directions,
            platform_directions=self.base_directions,
            ellipsoid=None,
            home=None if self.home is None else self.home.inverse(),
        )

    def __repr__(self) -> str:
        legs = ", ".join(c.name for c in self.legs)
        return f"PlanarDesign({self.name or 'unnamed'!r}, legs=[{legs}], unit={self.unit!r})"


def _check_legs(legs: Iterable[str]) -> tuple[PlanarConstraint, ...]:
    if not isinstance(legs, Iterable):
        raise InvalidDesign(expected("legs", "a sequence with one name per leg", brief(legs)))
    names = (legs,) if isinstance(legs, str) else tuple(legs)
    for i, name in enumerate(names):
        if not isinstance(name, str) or name not in PLANAR_CONSTRAINT:
            wanted = "one of " + ", ".join(PLANAR_CONSTRAINT)
            raise InvalidDesign(expected(f"legs[{i}]", wanted, repr(name)))
    if len(names) < 3:
        raise InvalidDesign(expected("legs", "at least three", len(names)))
    return tuple(PLANAR_CONSTRAINT[name] for name in names)


def _rows(what: str, value: ArrayLike, n: int, *, finite: bool = True) -> Array:
    rows = check_array(what, value, (n, 2), finite=finite)
    if rows.ndim != 2:
        raise InvalidInput(expected(what, f"shape ({n}, 2)", f"shape {rows.shape}"))
    return frozen(rows)


def _directions(side: str, value: ArrayLike | None, primitives: Sequence[str]) -> Array:
    what, wanted = f"{side}_directions", np.array([p == "line" for p in primitives])
    given = np.full((len(wanted), 2), np.nan) if value is None else value
    rows = _rows(what, given, len(wanted), finite=False)
    missing = wanted & ~(np.isfinite(rows).all(axis=1) & (norm(np.nan_to_num(rows)) > 0.0))
    if missing.any():
        leg = int(np.flatnonzero(missing)[0])
        raise InvalidDesign(expected(f"{what}[{leg}]", "a non-zero direction", rows[leg].tolist()))
    return frozen(np.where(wanted[:, None], unit(rows), np.nan))


def _strokes(value: ArrayLike | None, n: int) -> Array | None:
    if value is None:
        return None
    limits = _rows("strokes", value, n, finite=False)
    if (limits[:, 0] > limits[:, 1]).any():
        raise InvalidDesign(expected("strokes", f"({n}, 2) with least ≤ greatest", limits.tolist()))
    return limits
