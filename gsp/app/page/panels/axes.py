"""Axes of the plots of the page: numbers that leave out a power of ten, and their labels."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.app.state.reading import RAISED
from gsp.geometry.vectors import Array

# ECharts would make the room smaller where numbers are long.
GRID = {"outerBoundsMode": "none"}
# Powers of ten that numbers on axes have in full.
LEAST_IN_FULL, MOST_IN_FULL = -3, 5


def power_of_ten(values: Array) -> int:
    """Return the power of ten that the numbers of an axis leave out, 0 where they need none.

    >>> power_of_ten(np.array([2e-7, -3e-6])), power_of_ten(np.array([0.1, 2.0]))
    (-6, 0)
    """
    known = np.abs(values[np.isfinite(values)])
    power = int(np.floor(np.log10(known.max()))) if known.any() else 0
    return 0 if LEAST_IN_FULL <= power < MOST_IN_FULL else power


def with_power(label: str, power: int) -> str:
    """Return a label, with its unit in brackets if there is one, with a power of ten.

    >>> with_power("x [m]", -6), with_power("GCI", 7), with_power("CTN", 0)
    ('x [10⁻⁶ m]', 'GCI [10⁷]', 'CTN')
    """
    if power == 0:
        return label
    name, bracket, unit = label.partition(" [")
    factor = f"10{str(power).translate(RAISED)}"
    return f"{name} [{factor} {unit}" if bracket else f"{name} [{factor}]"


def scaled(values: Array, label: str) -> tuple[Array, str]:
    """Return the numbers and the label of an axis."""
    power = power_of_ten(values)
    return values / 10.0**power, with_power(label, power)


def texts(values: Array) -> list[str]:
    """Return numbers at equal distances with the digits that tell them apart."""
    places = max(1 - int(np.floor(np.log10(values[1] - values[0]))), 0)
    return [f"{x + 0.0:.{places}f}" for x in values]


def coordinate(values: Array, name: str, position: str, gap: int) -> dict[str, Any]:
    """Return the axis of coordinates around the cells; its marks are at round numbers."""
    half = 0.5 * float(values[1] - values[0])
    return {
        "type": "value",
        "min": float(values[0]) - half,
        "max": float(values[-1]) + half,
        "position": position,
        "name": name,
        "nameLocation": "middle",
        "nameGap": gap,
        "splitLine": {"show": False},
        "axisLabel": {"hideOverlap": True, "showMinLabel": False, "showMaxLabel": False},
        "axisTick": {"show": True},
        "axisLine": {"show": True, "onZero": False},
    }


def cells(values: Array) -> dict[str, Any]:
    """Return the axis of the cells, which has no marks: they would be at odd numbers."""
    return {"type": "category", "data": texts(values), "show": False}
