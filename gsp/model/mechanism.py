"""Mechanism: six constraints on legs, its name, and the reading of names."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from gsp.checks import check_integer, is_iterable
from gsp.errors import InvalidInput, brief, expected
from gsp.model.constraints import CONSTRAINTS
from gsp.model.legs import LEG, Leg

NAMES = tuple(constraint.name for constraint in CONSTRAINTS)
_SCRIPTS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_SUPER = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹]+")
_SUPER_DIGITS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_FACTOR = re.compile(r"([DA])_?(\d)(?:\^(\d{1,9}))?", re.ASCII)


@dataclass(frozen=True, order=False)
class Mechanism:
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

    counts: tuple[int, int, int, int, int]

    def __post_init__(self) -> None:
        given = self.counts if is_iterable(self.counts) else ()
        counts = tuple(check_integer("mechanism count", n, 0) for n in given)
        if len(counts) != len(NAMES):
            raise InvalidInput(expected("mechanism", "five counts ≥ 0", brief(self.counts)))
        object.__setattr__(self, "counts", counts)

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
        if isinstance(constraints, str) or not is_iterable(constraints):
            wanted = "a sequence of names of constraints"
            raise InvalidInput(expected("constraints", wanted, brief(constraints)))
        names = [str(name) for name in constraints]
        unknown = [name for name in names if name not in NAMES]
        if unknown:
            raise InvalidInput(expected("constraint", "one of " + ", ".join(NAMES), unknown[0]))
        d1, d2, d3, d4, a1 = map(names.count, NAMES)
        return cls((d1, d2, d3, d4, a1))

    @property
    def constraints(self) -> tuple[str, ...]:
        """Names of the constraints, one by one."""
        return tuple(n for n, k in zip(NAMES, self.counts, strict=True) for _ in range(k))

    @property
    def name(self) -> str:
        """Canonical name, such as "D1^2 D2 D4 A1^2"."""
        return " ".join(n + (f"^{k}" if k > 1 else "") for n, k in self._factors)

    @property
    def latex(self) -> str:
        """Name as the papers print it, such as "D_1^2 D_2 D_4 A_1^2".

        *Source: TozKucuk2016, §4.2*
        """
        return " ".join(f"{n[0]}_{n[1]}" + (f"^{k}" if k > 1 else "") for n, k in self._factors)

    @property
    def _factors(self) -> list[tuple[str, int]]:
        return [(n, k) for n, k in zip(NAMES, self.counts, strict=True) if k]

    @property
    def n_angles(self) -> int:
        """Number of angular constraints."""
        return self.counts[NAMES.index("A1")]

    @property
    def group(self) -> str:
        """Class by numbers of distances and angles: "6D", "5D1A", "4D2A" or "3D3A".

        *Source: TozKucuk2016, §1, for the four classes of the 195*
        """
        angles = self.n_angles
        return f"{sum(self.counts) - angles}D" + (f"{angles}A" if angles else "")

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

    def exchanged(self) -> Mechanism:
        """Return the mechanism with base and platform exchanged: D2 becomes D3, and D3 D2.

        *Source: ours; docs/conventions.md, "What another description changes"*
        """
        d1, d2, d3, d4, a1 = (self.counts[NAMES.index(c.exchanged)] for c in CONSTRAINTS)
        return Mechanism((d1, d2, d3, d4, a1))

    def __str__(self) -> str:
        return self.name


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
    if not isinstance(text, str):
        raise InvalidInput(expected("mechanism name", "a text", brief(text)))
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
    d1, d2, d3, d4, a1 = counts.values()
    return Mechanism((d1, d2, d3, d4, a1))
