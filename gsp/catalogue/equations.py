"""The equations of the five constraints as text, for pages and terminals."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

SYMBOLS = (
    "d = p + R b − a; a, b anchor points; s, t unit directions of the base line and of the "
    "platform line, t and R b in base axes; n = t × s"
)


@dataclass(frozen=True)
class Equation:
    """What a constraint measures, and its row of the inverse Jacobian, as text.

    Attributes
    ----------
    constraint : str
        "D1" … "D4", "A1".
    value : str
        The distance or angle.
    row : str
        (moved part, turned part): actuator rate = row · (v, ω).
    direction, arm : str
        u and r in the row; "" where they do not occur.
    """

    constraint: str
    value: str
    row: str
    direction: str = ""
    arm: str = ""

    @property
    def text(self) -> str:
        """Row with what its letters stand for."""
        parts = [f"u = {self.direction}"] * bool(self.direction)
        parts += [f"r = {self.arm}"] * bool(self.arm)
        return ", ".join([self.row, *parts])


# Derived from the printed equations; the tests evaluate these texts against the rows of postures.
_EQUATIONS = (
    Equation("D1", "|d|", "(u, r × u)", "d / |d|", "R b"),
    Equation("D2", "|d × t|", "(u, r × u)", "t × (d × t) / |d × t|", "R b − (d · t) t"),
    Equation("D3", "|d × s|", "(u, r × u)", "s × (d × s) / |d × s|", "R b"),
    Equation(
        "D4",
        "|d · n| / |n|",
        "(u, r × u)",
        "± n / |n|, + where d · n ≥ 0",
        "R b − ((d × s) · n / |n|²) t",
    ),
    Equation("A1", "atan2(|n|, t · s)", "(0, −n / |n|)"),
)

EQUATIONS = MappingProxyType({equation.constraint: equation for equation in _EQUATIONS})
