"""Axes with coordinates: names with the unit, one power of ten for all, and plain numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Axes whose greatest number is in this range have no power of ten.
PLAIN_NUMBERS = (1e-2, 1e5)
# An axis whose middle is more lengths of the axis away from zero counts from a number near it.
FAR_LENGTHS = 1e3
# Significant digits of the numbers on axes.
DIGITS = 6
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def name_lengths(ax: Axes, names: Mapping[str, str], unit: str) -> None:
    """Set the labels and the numbers of axes with coordinates, as the limits of the axes are.

    Parameters
    ----------
    ax : matplotlib Axes
        In a plane or in space, with its limits.
    names : mapping of "x", "y", "z" to str
        The coordinate along each axis that has one.
    unit : str
        Of the coordinates, or "".
    """
    from matplotlib.ticker import FuncFormatter

    limits = {axis: np.array(getattr(ax, f"get_{axis}lim")()) for axis in names}
    origins = {axis: _origin(ends) for axis, ends in limits.items()}
    largest = max(float(np.abs(ends - origins[axis]).max()) for axis, ends in limits.items())
    plain = largest == 0.0 or PLAIN_NUMBERS[0] < largest < PLAIN_NUMBERS[1]
    power = 0 if plain else 3 * int(np.floor(np.log10(largest) / 3.0))
    scale = "10" + str(power).translate(_SUPERSCRIPTS) if power else ""
    words = " ".join(word for word in (scale, unit.replace("$", r"\$")) if word)
    for axis, name in names.items():
        away = origins[axis]
        counted = f" {'−' if away > 0.0 else '+'} {abs(away):.15g}" if away else ""
        getattr(ax, f"set_{axis}label")(name + counted + (f" [{words}]" if words else ""))
        getattr(ax, f"{axis}axis").set_major_formatter(
            FuncFormatter(partial(_tick, origin=away, power=power, largest=largest))
        )


def name_coordinates(ax: Axes, names: Sequence[str], turning: Sequence[bool], unit: str) -> None:
    """Set the labels and the numbers of two axes with coordinates, lengths or angles.

    Parameters
    ----------
    ax : matplotlib Axes
        With its limits.
    names : sequence of str
        The coordinate along each axis.
    turning : sequence of bool
        Which of them are angles [°].
    unit : str
        Of lengths, or "".
    """
    for angle, its_unit in ((False, unit), (True, "°")):
        some = {a: name for a, name, t in zip("xyz", names, turning, strict=False) if t is angle}
        if some:
            name_lengths(ax, some, its_unit)


def _origin(limits: NDArray[np.float64]) -> float:
    """Return the number from which the numbers of an axis count: 0 unless the axis is far away."""
    span, middle = float(np.ptp(limits)), float(limits.mean())
    if not span * FAR_LENGTHS < abs(middle):
        return 0.0
    step = 10.0 ** np.floor(np.log10(max(span, 1e-15 * abs(middle))))
    return float(f"{step * np.rint(middle / step):.15g}")


def _tick(value: float, _: int, origin: float, power: int, largest: float) -> str:
    """Return the number of a tick: a function of the module, so that figures can be pickled."""
    return _number(value - origin, power, largest)


def _number(value: float, power: int, largest: float) -> str:
    """Return a number in units of a power of ten, without an exponent."""
    if abs(value) < 10.0**-DIGITS * largest:
        value = 0.0
    rounded = float(f"{value * 10.0**-power:.{DIGITS}g}")
    return str(np.format_float_positional(rounded, trim="-")).replace("-", "−")
