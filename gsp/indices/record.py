"""Records of indices: a function, and the facts from which tables, rankings and docs are made."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any, Literal, get_args

import numpy as np

from gsp import arguments
from gsp.checks import check_items, check_text, is_a, plain_text, reading
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.units import power_base


@dataclass(frozen=True, kw_only=True)
class Properties:
    """Which of the six properties an index has; each statement is tested, also the negative ones.

    They are about the merit of a posture: the value where higher is better, else its reciprocal.
    Parameters that an index needs (a length, an ellipsoid, a maximum) move and scale with the
    mechanism; optional parameters are not given.

    Attributes
    ----------
    non_negative : bool
    zero_iff_singular : bool
    motion_invariant : bool
        Base and platform moved together by a Euclidean motion.
    similarity_invariant : bool
        Base, platform and parameters scaled together.
    geometric : bool
        It has a geometric meaning: speeds of points, rotation rates of legs, an angle.
    real_time : bool
        One small matrix factorisation per posture, and no search.

    Raises
    ------
    InvalidInput
        If one of them is not True or False.

    *Source: Nawratil, §1; §§2–3 for which index has which, where it is stated*
    """

    non_negative: bool
    zero_iff_singular: bool
    motion_invariant: bool
    similarity_invariant: bool
    geometric: bool
    real_time: bool

    def __post_init__(self) -> None:
        for field in fields(self):
            arguments.flag(field.name, getattr(self, field.name))


ALL_SIX = Properties(
    non_negative=True,
    zero_iff_singular=True,
    motion_invariant=True,
    similarity_invariant=True,
    geometric=True,
    real_time=True,
)

Effect = Literal["unchanged", "changes"]


@dataclass(frozen=True, kw_only=True)
class Invariance:
    """Changes of the values of an index if the same mechanism is described differently.

    "changes" means that the values of some design differ; both words are tested. The effect of
    the unit of length is `Index.unit_power`. Length and maximum stay, and the ellipsoid stays
    in its place on the platform.

    Attributes
    ----------
    base_turn, base_shift : "unchanged" or "changes"
        Other axes, or another origin, of the base frame.
    platform_turn, platform_shift : "unchanged" or "changes"
        Other axes, or another origin, of the platform frame. A twist refers to the platform
        origin, so an index that gives all twists of unit size the same weight changes.
    order : "unchanged" or "changes"
        The legs in another order.
    exchange : "unchanged" or "changes"
        Base and platform change places (`Design.exchanged`, at inverse poses).
    mirror : "unchanged" or "changes"
        The mirror image of everything.
    slide : "unchanged" or "changes"
        Anchor points moved along the lines of their cylindrical joints.
    reversal : "unchanged" or "changes"
        Lines with the opposite sense, so that angles θ become π − θ.

    Raises
    ------
    InvalidInput
        If one of them is another word.

    *Source: the definitions of the indices; ours.*
    """

    base_turn: Effect = "unchanged"
    base_shift: Effect = "unchanged"
    platform_turn: Effect = "unchanged"
    platform_shift: Effect = "unchanged"
    order: Effect = "unchanged"
    exchange: Effect = "unchanged"
    mirror: Effect = "unchanged"
    slide: Effect = "unchanged"
    reversal: Effect = "unchanged"

    def __post_init__(self) -> None:
        for field in fields(self):
            arguments.one_of(*get_args(Effect))(field.name, getattr(self, field.name))


# The twist is measured at the platform origin; or on the platform, but not at its origin.
AT_PLATFORM_ORIGIN = Invariance(platform_shift="changes", exchange="changes")
ON_PLATFORM = Invariance(exchange="changes")


def _end_of_range(what: str, value: Any) -> float:
    wanted = "a number or inf"
    with reading(what, wanted, value):
        if is_a(value, bool) or not is_a(value, Real) or value != value:
            raise InvalidInput(expected(what, wanted, brief(value)))
        return float(value)


def _word(what: str, value: Any) -> str:
    text = check_text(what, value)
    if not text.strip():
        raise InvalidInput(expected(what, "a text", "an empty one"))
    return text


def _tuple_of_names(what: str, value: Any) -> tuple[str, ...]:
    wanted = "a tuple of names"
    names = check_items(what, value, wanted) if is_a(value, tuple) else (None,)
    if not all(is_a(name, str) for name in names):
        raise InvalidInput(expected(what, wanted, brief(value)))
    return names


PARAMETERS = ("length", "ellipsoid", "maximum")
CHECKS: Mapping[str, arguments.Check] = {
    "name": _word,
    "symbol": _word,
    "function": arguments.function,
    "better": arguments.one_of("higher", "lower"),
    "best": _end_of_range,
    "worst": _end_of_range,
    "parameters": _tuple_of_names,
    "needs": _tuple_of_names,
    "length_for": arguments.one_of("", "angular", "cylindrical"),
    "unit_power": arguments.one_of("1", "length", "length^(3 − n_A1)", "no power"),
    "source": _word,
    "properties": arguments.kind(Properties),
    "invariance": arguments.kind(Invariance, "an Invariance"),
    "actuators": arguments.optional(arguments.integer(1)),
    "routine": arguments.flag,
    "slow": arguments.flag,
    "of_determinant": arguments.flag,
    "share_of": arguments.text,
    "slope": arguments.optional(arguments.function),
    "of_actuators": arguments.optional(arguments.function),
}


@dataclass(frozen=True, kw_only=True)
class Index(ReadOnly):
    """A performance index.

    Attributes
    ----------
    name : str
        Name of its function in `gsp.indices`.
    symbol : str
        As the literature writes it.
    function : posture, … -> (...) array
    better : "higher" or "lower"
    best, worst : float [unit of the index]
        Range, inf where there is no bound. `worst` is the value at singular postures, if the
        index has the property `zero_iff_singular`.
    parameters : tuple of str
        Which of "length", "ellipsoid", "maximum" the function takes.
    needs : tuple of str
        Those of them that it needs for every mechanism.
    length_for : "" or "angular" or "cylindrical"
        The legs for which it needs a length as well: those with A1 actuators, or those with
        cylindrical joints.
    unit_power : str
        How a value changes with the unit of length when the parameters keep their meaning:
        "1" (not at all), a power of the length, or "no power" (by no fixed factor). |det J| and λ
        of redundant designs with A1 actuators change by no fixed factor: `unit` is then "mixed".
    source : str
    properties : Properties
        Which of Nawratil's six properties it has.
    invariance : Invariance
        Which other descriptions of the same mechanism change its values.
    actuators : int or None
        The number of actuators that it is defined for; None for any.
    routine : bool
        Whether it is computed where no indices are named. The others are not compiled and take
        some ten microseconds per posture, many times as long.
    slow : bool
        Whether it takes still longer, in batches some 30 µs per posture, and needs code that is
        compiled apart. It is evaluated in small blocks, and on demand only in the browser tool.
    of_determinant : bool
        Whether its values are those of |det J| or a share of it. The unit is then "mixed" for
        redundant designs with A1 actuators, where det JᵀJ adds values of unlike units.
    share_of : str
        Name of the index whose values it divides by `maximum=`: "manipulability" for λ; "" for
        those that are no share of a maximum.
    slope : (Slopes, …) -> (..., k) array, or None
        Derivatives of its values along k directions of the dimensions: see `gsp.indices.gradient`.
        None for those that have no formula, and for shares of a maximum.
    of_actuators : posture, … -> (..., n) array, or None
        The values of the n actuators of which it is the greatest; None for other indices.

    Raises
    ------
    InvalidInput
        If an attribute is not of its type or not one of its words, a needed parameter is not among
        the parameters, or the best value is not on the better side of the worst one.
    """

    name: str
    symbol: str
    function: Callable[..., Array]
    better: Literal["higher", "lower"]
    best: float
    worst: float
    parameters: tuple[str, ...]
    needs: tuple[str, ...]
    length_for: Literal["", "angular", "cylindrical"]
    unit_power: str
    source: str
    properties: Properties
    invariance: Invariance
    actuators: int | None = None
    routine: bool = True
    slow: bool = False
    of_determinant: bool = False
    share_of: str = ""
    slope: Callable[..., Array] | None = None
    of_actuators: Callable[..., Array] | None = None

    def __post_init__(self) -> None:
        what = f"index {plain_text(self.name) if is_a(self.name, str) else brief(self.name)}"
        for name, check in CHECKS.items():
            object.__setattr__(self, name, check(f"{what}: {name}", getattr(self, name)))
        for name, known in (("parameters", PARAMETERS), ("needs", self.parameters)):
            unknown = [one for one in getattr(self, name) if one not in known]
            if unknown:
                wanted = "names among " + (", ".join(known) or "none")
                raise InvalidInput(expected(f"{what}: {name}", wanted, brief(unknown[0])))
        good = self.best > self.worst if self.better == "higher" else self.best < self.worst
        if not good:
            wanted = "best above worst" if self.better == "higher" else "best below worst"
            raise InvalidInput(expected(what, wanted, f"{self.best}, {self.worst}"))

    @arguments.validated(design=arguments.kind(Design, "a gsp.Design"))
    def unit(self, design: Design) -> str:
        """Return the unit of the values for a design.

        Parameters
        ----------
        design : Design

        Returns
        -------
        str
            "1", or a power of the unit of the design such as "mm" or "mm^3". "mixed" where values
            of unlike units are added: in the plain Jacobian, and in det JᵀJ of a redundant design
            with angular actuators, so in its |det J| and λ.

        Raises
        ------
        InvalidInput
            If `design` is not a Design.

        *Source: the units of the rows, TozKucuk2016, eqs. (12)–(16).*
        """
        length = design.unit or "length"
        mixed = self.of_determinant and not design.determinant_has_unit
        if self.unit_power == "no power" or mixed:
            return "mixed"
        if self.unit_power == "1":
            return "1"
        if self.unit_power == "length":
            return length
        power = design.determinant_power
        return {0: "1", 1: length}.get(power, f"{power_base(length)}^{power}")

    @arguments.validated(
        design=arguments.kind(Design, "a gsp.Design"),
        given=arguments.names,
    )
    def missing(self, design: Design, given: Collection[str]) -> tuple[str, ...]:
        """Return what is missing for a design: parameters, or a number of actuators.

        Parameters
        ----------
        design : Design
        given : collection of str
            Names of the given parameters: "length", "ellipsoid", "maximum".

        Returns
        -------
        tuple of str
            Names of parameters, or a number of actuators in words; empty if nothing is missing.

        Raises
        ------
        InvalidInput
            If `design` is not a Design, or `given` is not a collection of names.
        """
        legs = {
            "": False,
            "angular": bool(design.angular.any()),
            "cylindrical": design.cylindrical or bool(design.angular.any()),
        }
        needs = (*self.needs, "length") if legs[self.length_for] else self.needs
        missing_names = tuple(name for name in dict.fromkeys(needs) if name not in given)
        if self.actuators not in (None, len(design.joint_names)):
            missing_names += (f"{self.actuators} actuators",)
        return missing_names

    @arguments.validated(need=arguments.text, design=arguments.kind(Design, "a gsp.Design"))
    def missing_message(self, need: str, design: Design) -> str:
        """Return the message of an error: something that `missing` names was expected for a design.

        Parameters
        ----------
        need : str
            One of the names that `missing` returns.
        design : Design

        Returns
        -------
        str

        Raises
        ------
        InvalidInput
            If `need` is not a text, or `design` is not a Design.
        """
        if need in self.parameters:
            return f"{self.name}: expected {need}=, received none"
        return f"{self.name}: expected {need}, received {len(design.joint_names)}"

    def merit(self, values: Array) -> Array:
        """Return values as a merit: higher is better, and 0 is the worst.

        The reciprocal where lower is better, so that a condition number becomes 1/CDN in [0, 1].

        Parameters
        ----------
        values : (...) array [unit of the index]

        Returns
        -------
        (...) array [unit of the index, or its reciprocal]

        *Source: ours*
        """
        if self.better == "higher":
            return values
        with np.errstate(divide="ignore"):
            return 1.0 / values
