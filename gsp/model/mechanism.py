"""Mechanism: six constraints on legs, its name, and the reading of names."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol, Self

from gsp.checks import check_integer, check_items, is_a, plain_text
from gsp.errors import InvalidInput, brief, expected
from gsp.model.constraints import CONSTRAINTS
from gsp.model.legs import LEG, Leg

NAMES = tuple(constraint.name for constraint in CONSTRAINTS)
_SCRIPTS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_SUPER = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹]+")
_SUPER_DIGITS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_FACTOR = re.compile(r"([DA])_?(\d)(?:\^(\d{1,9}))?", re.ASCII)


class Kind(Protocol):
    """What a mechanism reads from the record of a constraint, in space or in the plane."""

    @property
    def name(self) -> str:
        """Name of the constraint."""

    @property
    def quantity(self) -> Literal["distance", "angle"]:
        """The actuated quantity."""

    @property
    def exchanged(self) -> str:
        """Name of the constraint that it becomes where base and platform are exchanged."""


@dataclass(frozen=True)
class Counted:
    """How often each constraint of a table occurs: what mechanisms in space and the plane share.

    Parameters
    ----------
    counts : integers ≥ 0, one per constraint of the table

    Raises
    ------
    InvalidInput
        If `counts` are not as many integers ≥ 0.
    """

    counts: tuple[int, ...]

    _what: ClassVar[str]
    _table: ClassVar[tuple[Kind, ...]]

    def __post_init__(self) -> None:
        names = ", ".join(kind.name for kind in self._table)
        wanted = f"{len(self._table)} counts ≥ 0, of {names}"
        given = check_items(self._what, self.counts, wanted)
        counts = tuple(check_integer(f"{self._what} count", n, 0) for n in given)
        if len(counts) != len(self._table):
            raise InvalidInput(expected(self._what, wanted, brief(self.counts)))
        object.__setattr__(self, "counts", counts)

    @property
    def constraints(self) -> tuple[str, ...]:
        """Names of the constraints, one by one."""
        return tuple(name for name, count in self._factors for _ in range(count))

    @property
    def name(self) -> str:
        """Canonical name, such as "D1^2 D2 D4 A1^2", or "D1^2 A1" in the plane."""
        return " ".join(n + (f"^{k}" if k > 1 else "") for n, k in self._factors)

    @property
    def _factors(self) -> list[tuple[str, int]]:
        return [(kind.name, k) for kind, k in zip(self._table, self.counts, strict=True) if k]

    @property
    def n_angles(self) -> int:
        """Number of angular constraints."""
        angular = (kind.quantity == "angle" for kind in self._table)
        return sum(k for k, angle in zip(self.counts, angular, strict=True) if angle)

    @property
    def group(self) -> str:
        """Class by numbers of distances and angles: such as "6D", "4D2A", "2D1A".

        *Source: TozKucuk2016, §1, for the four classes of the 195*
        """
        angles = self.n_angles
        return f"{sum(self.counts) - angles}D" + (f"{angles}A" if angles else "")

    def exchanged(self) -> Self:
        """Return the mechanism with base and platform exchanged: D2 becomes D3, and D3 D2.

        *Source: ours; docs/conventions.md, "What another description changes"*
        """
        pairs = zip(self._table, self.counts, strict=True)
        names = [kind.exchanged for kind, count in pairs for _ in range(count)]
        return type(self)(tuple(names.count(kind.name) for kind in self._table))

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, order=False)
class Mechanism(Counted):
    """A kind of mechanism: how often each constraint occurs.

    Parameters
    ----------
    counts : five integers ≥ 0
        Numbers of D1, D2, D3, D4 and A1.

    Raises
    ------
    InvalidInput
        If `counts` are not five integers ≥ 0.

    Examples
    --------
    >>> m = Mechanism((1, 1, 1, 1, 2))
    >>> m.name, m.group, [leg.name for leg in m.legs]
    ('D1 D2 D3 D4 A1^2', '4D2A', ['D1', 'D2', 'D3', 'D4 A1', 'A1'])
    """

    _what = "mechanism"
    _table = CONSTRAINTS

    @classmethod
    def of(cls, constraints: Iterable[str]) -> Mechanism:
        """Return the mechanism of constraints named one by one, in any order.

        Parameters
        ----------
        constraints : iterable of str
            "D1", "D2", "D3", "D4" or "A1" each.

        Raises
        ------
        InvalidInput
            On another name, or if it is not a sequence of names.
        """
        given = check_items("constraints", constraints, "a sequence of names of constraints")
        names = [name if is_a(name, str) else brief(name) for name in given]
        unknown = [name for name in names if name not in NAMES]
        if unknown:
            raise InvalidInput(expected("constraint", "one of " + ", ".join(NAMES), unknown[0]))
        return cls(tuple(map(names.count, NAMES)))

    @property
    def latex(self) -> str:
        """Name as the papers print it, such as "D_1^2 D_2 D_4 A_1^2".

        *Source: TozKucuk2016, §4.2*
        """
        return " ".join(f"{n[0]}_{n[1]}" + (f"^{k}" if k > 1 else "") for n, k in self._factors)

    @property
    def legs(self) -> tuple[Leg, ...]:
        """The legs; D4 and A1 are paired on CCC legs as often as there are both."""
        d1, d2, d3, d4, a1 = self.counts
        both = min(d4, a1)
        numbers = (d1, d2, d3, d4 - both, a1 - both, both)
        kinds = zip(("D1", "D2", "D3", "D4", "A1", "D4 A1"), numbers, strict=True)
        repeated = {name: (LEG[name],) * number for name, number in kinds}
        order = ("D1", "D2", "D3", "D4", "D4 A1", "A1")
        return tuple(leg for name in order for leg in repeated[name])

    @property
    def symmetric(self) -> bool:
        """Whether it is one of the four whose six constraints are the same.

        *Source: TozKucuk2016 §1 counts 4 symmetrical mechanisms among the 195, and §4.2 calls
        D_3^6 one; that they are D1^6, D2^6, D3^6 and D4^6 is our reading.*
        """
        return max(self.counts) == sum(self.counts)


def read_mechanism(text: str) -> Mechanism:
    r"""Read a mechanism from its name, in any order and in any of the usual spellings.

    Raises
    ------
    InvalidInput
        If the text is not a product of D1 … D4 and A1 with powers.

    Examples
    --------
    >>> {read_mechanism(s).name for s in ("D1D1D2D4A1A1", "D₁²D₂D₄A₁²", r"$D_1^{2} D_2 D_4 A_1^2$")}
    {'D1^2 D2 D4 A1^2'}
    """
    if not is_a(text, str):
        raise InvalidInput(expected("mechanism name", "a text", brief(text)))
    text = plain_text(text)
    plain = _SUPER.sub(lambda m: "^" + m.group().translate(_SUPER_DIGITS), text)
    plain = re.sub(r"\\[a-zA-Z]+|[\s{}$*·\\,]", "", plain.translate(_SCRIPTS)).upper()
    factors = _FACTOR.findall(plain)
    rebuilt = "".join(m.group() for m in _FACTOR.finditer(plain))
    if not factors or rebuilt != plain:
        raise InvalidInput(expected("mechanism name", 'such as "D1^2 D2 D4 A1^2"', brief(text)))
    counts = dict.fromkeys(NAMES, 0)
    for letter, digit, power in factors:
        if letter + digit not in counts:
            raise InvalidInput(expected("constraint", "one of " + ", ".join(NAMES), letter + digit))
        counts[letter + digit] += int(power or 1)
    return Mechanism(tuple(counts.values()))
