"""The table of the indices, and how one is found by its name or symbol."""

from __future__ import annotations

from collections.abc import Iterable
from types import MappingProxyType
from typing import Any

from gsp.checks import check_items, check_separated, is_a, plain_text
from gsp.errors import InvalidInput, UnknownIndex, brief, expected
from gsp.indices.cdn_cl import CONDITION_NUMBER, LOCAL_CONDITIONING, MINIMUM_SINGULAR_VALUE
from gsp.indices.cdn_oe import CONDITION_NUMBER_ELLIPSOID
from gsp.indices.cdn_plain import CONDITION_NUMBER_PLAIN
from gsp.indices.cdn_points import CONDITION_NUMBER_POINTS
from gsp.indices.ctn import CONTROL_NUMBER
from gsp.indices.det_j import MANIPULABILITY, QUALITY_INDEX
from gsp.indices.forces import GREATEST_FORCE
from gsp.indices.linear_complex import (
    COMPLEX_DEVIATION_ROTATION,
    COMPLEX_DEVIATION_TRANSLATION,
)
from gsp.indices.rigidity import RIGIDITY_RATE
from gsp.indices.singularity import SINGULARITY_DISTANCE
from gsp.indices.stiffness import STIFFNESS_X, STIFFNESS_Y, STIFFNESS_Z

INDICES = MappingProxyType(
    {
        index.name: index
        for index in (
            CONDITION_NUMBER,
            CONDITION_NUMBER_ELLIPSOID,
            CONTROL_NUMBER,
            QUALITY_INDEX,
            MANIPULABILITY,
            MINIMUM_SINGULAR_VALUE,
            CONDITION_NUMBER_PLAIN,
            CONDITION_NUMBER_POINTS,
            COMPLEX_DEVIATION_ROTATION,
            COMPLEX_DEVIATION_TRANSLATION,
            RIGIDITY_RATE,
            SINGULARITY_DISTANCE,
            GREATEST_FORCE,
            LOCAL_CONDITIONING,
            STIFFNESS_X,
            STIFFNESS_Y,
            STIFFNESS_Z,
        )
    }
)

# Indices that are shares of the maximum of another one: λ.
MAXIMUM_SHARES = tuple(name for name, index in INDICES.items() if index.share_of)

# Marks of `Index.better` in tables.
ARROWS = MappingProxyType({"higher": "↑", "lower": "↓"})

# Names and symbols in small letters. casefold() makes "Σ_min", "σ_min" and "ς_min" one word.
_KNOWN = MappingProxyType(
    {index.symbol.casefold(): name for name, index in INDICES.items()}
    | {name: name for name in INDICES}
)


def index_name(text: str) -> str:
    """Return the name of an index that is given by its name or its symbol, in any case.

    Parameters
    ----------
    text : str
        Such as "control_number", "control-number", "CTN" or "λ".

    Raises
    ------
    UnknownIndex
        With the nearest names and symbols.

    *Source: the symbols are those of TozKucuk2016, Lee2000 and Nawratil.*

    Examples
    --------
    >>> index_name("CTN"), index_name("λ"), index_name("|det J|")
    ('control_number', 'quality_index', 'manipulability')
    """
    text = plain_text(text)
    key = text.strip().casefold() if is_a(text, str) else ""
    found = _KNOWN.get(key) or _KNOWN.get(key.replace("-", "_"))
    if found is None:
        symbols = [index.symbol for index in INDICES.values()]
        given = text if is_a(text, str) else brief(text)
        known = f"Known: {', '.join(symbols)}, and their names"
        raise UnknownIndex("index", given, (*INDICES, *symbols), known)
    return found


def index_names(given: Iterable[str] | str) -> tuple[str, ...]:
    """Return the names of indices given by names or symbols, each once, in the order given.

    Parameters
    ----------
    given : str or iterable of str
        Names or symbols; a text may hold several, separated by commas. "all" stands for all
        indices.

    Raises
    ------
    InvalidInput
        If `given` is neither a text nor a collection of texts, is empty, or has an empty item.
    UnknownIndex

    *Source: the symbols are those of TozKucuk2016, Lee2000 and Nawratil.*

    Examples
    --------
    >>> index_names("CTN, λ")
    ('control_number', 'quality_index')
    """
    several = not is_a(given, str)
    items = check_items("indices", given, "names of indices") if several else (plain_text(given),)
    words: list[Any] = []
    for item in items:
        words += check_separated("indices", item) if is_a(item, str) else (item,)
    names: list[str] = []
    for word in words:
        every = is_a(word, str) and word.strip().casefold() == "all"
        names += list(INDICES) if every else [index_name(word)]
    if not names:
        raise InvalidInput(expected("indices", "at least one name", "none"))
    return tuple(dict.fromkeys(names))
