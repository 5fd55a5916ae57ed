"""Names of units of length.

Any text can name the unit of a design: names are compared letter by letter, and nothing is
converted implicitly. The names of `METRES_PER_UNIT` can be converted.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Any

from gsp.checks import check_line
from gsp.errors import InvalidInput, brief, expected

# Both letters that look like µ are in use: the sign of the unit and the Greek letter.
METRES_PER_UNIT = MappingProxyType(
    {"um": 1e-6, "µm": 1e-6, "\u03bcm": 1e-6, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "m": 1.0,
     "in": 0.0254, "inch": 0.0254, "ft": 0.3048}
)  # fmt: skip


def check_unit(what: str, value: Any) -> str:
    """Return the name of a unit of length, "" for none.

    Raises
    ------
    InvalidInput
        If it is not a text of one line, consists of spaces, or begins or ends with one: it would
        look like another unit.
    """
    text = check_line(what, value)
    if text != text.strip():
        wanted = 'the name of a unit without spaces around it, or ""'
        raise InvalidInput(expected(what, wanted, brief(value)))
    return text


def power_base(unit: str) -> str:
    """Return the name of a unit as the base of a power: in parentheses if it is no single word.

    >>> power_base("mm") + "³", power_base("furlong / fortnight") + "³"
    ('mm³', '(furlong / fortnight)³')
    """
    return unit if unit.isalpha() or not unit else f"({unit})"
