"""Whether a stored maximum is valid: its key is that of its design, its value that of its pose.

Databases can be changed by others, and SQLite accepts any value in any column. So entries are
checked whenever they are read: served, listed, exported or imported.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from gsp import arguments
from gsp.checks import check_array
from gsp.determinant.canonical import design_of, key_of, region_of
from gsp.determinant.record import METHOD
from gsp.determinant.store.database import Store
from gsp.determinant.store.entries import maximum_of
from gsp.determinant.store.schema import FIELDS, INTEGERS
from gsp.errors import GspError, InvalidInput, brief, expected

STRUCTURES = ("position", "rotation", "design", "domain")
# Characters of the name and version of the library that found a maximum.
LONGEST_LIBRARY = 200
# The end of the year 9999, which `datetime` can represent [s].
LATEST = 253402300799.0


@arguments.validated(row=arguments.mapping)
def checked_entry(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return an entry of the store with its value computed anew at its pose.

    Parameters
    ----------
    row : mapping
        With the columns of the store; position, rotation, design and domain as JSON texts, or as
        what they stand for.

    Returns
    -------
    dict
        With all columns of `FIELDS`.

    Raises
    ------
    InvalidInput
        If a column is missing or wrong, the key is not that of the design, or |det J| at the pose
        differs from the value.
    """
    try:
        return _checked(structured(row))
    except KeyError as error:
        raise InvalidInput(expected("entry", f"a column {error}", "none")) from error
    except GspError:
        raise
    except (
        ValueError,
        TypeError,
        LookupError,
        OverflowError,
        AttributeError,
        RecursionError,
    ) as error:
        wanted = "numbers and JSON in its columns"
        raise InvalidInput(expected("entry", wanted, "others")) from error


@arguments.validated(row=arguments.mapping)
def damage(row: Mapping[str, Any]) -> str:
    """Return why an entry of the store is not valid, or an empty text if it is.

    Parameters
    ----------
    row : mapping
        As `checked_entry` takes it.

    Returns
    -------
    str

    Raises
    ------
    InvalidInput
        If `row` is not a mapping.
    """
    try:
        checked_entry(row)
    except GspError as error:
        return str(error)
    return ""


@arguments.validated(store=arguments.kind(Store), key=arguments.text)
def remove_damaged(store: Store, key: str) -> bool:
    """Remove the entry of a key if it is damaged, and return whether it was.

    A damaged value may be larger than every true one, so that none would replace it.

    Parameters
    ----------
    store : Store
    key : str

    Returns
    -------
    bool

    Raises
    ------
    InvalidInput
        If `store` is not a Store, or `key` is not a text.
    """
    entry = store.get(key)
    if entry is None or entry["value"] is None or not damage(entry):
        return False
    # A value that is not a number, as SQLite allows, cannot be compared.
    value = entry["value"] if isinstance(entry["value"], float) else None
    return bool(store.remove(key, value))


def structured(row: Mapping[Any, Any]) -> dict[str, Any]:
    """Return a row with structures for JSON texts, and None for what is missing."""
    values = {str(k): None if isinstance(v, float) and math.isnan(v) else v for k, v in row.items()}
    return {
        k: _read(k, v) if k in STRUCTURES and isinstance(v, str) and v else v
        for k, v in values.items()
    }


def _read(name: str, text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InvalidInput(expected(name, "JSON", brief(text))) from error


def _checked(row: dict[str, Any]) -> dict[str, Any]:
    design = row["design"]
    legs, rows = (design.get(k) if isinstance(design, dict) else None for k in ("legs", "rows"))
    if not isinstance(legs, list) or not isinstance(rows, list):
        wanted = 'an object with the lists "legs" and "rows"'
        raise InvalidInput(expected("design", wanted, brief(design)))
    domain = _domain(row.get("domain"))
    key = key_of(legs, rows, domain)
    if key != row["key"]:
        raise InvalidInput(expected("key", f"{key}, which its design has", brief(row["key"])))
    maximum = maximum_of(row, design_of(legs, rows), region_of(domain))
    kept = {name: row.get(name) for name in FIELDS}
    if not _names_library(kept["library"]):
        wanted = f"a text of at most {LONGEST_LIBRARY} characters"
        raise InvalidInput(expected("library", wanted, brief(kept["library"])))
    texts = {k: None if kept[k] is None else json.dumps(kept[k]) for k in STRUCTURES}
    whole = {k: int(v) for k in INTEGERS if (v := getattr(maximum, k, None)) is not None}
    version = METHOD if kept["version"] is None else int(float(kept["version"]))
    moment = _moment(kept["found"])
    value = maximum.value
    return {**kept, **texts, **whole, "value": value, "version": version, "found": moment}


def _domain(value: Any) -> list[Any] | None:
    """Return the domain of an entry in the form of `Canonical.domain`."""
    match value:
        case None:
            return None
        case ["box", corners, str(order)]:
            return ["box", check_array("domain", corners, (2, 6)).tolist(), order]
        case ["near home", displacement, angle]:
            return ["near home", *check_array("domain", [displacement, angle], (2,)).tolist()]
    wanted = 'null, ["box", [low, high], order] or ["near home", displacement, angle]'
    raise InvalidInput(expected("domain", wanted, brief(value)))


def _names_library(value: Any) -> bool:
    """Return whether a value is a short text that can be encoded, or None."""
    if value is None:
        return True
    if not isinstance(value, str) or len(value) > LONGEST_LIBRARY:
        return False
    return not any("\ud800" <= letter <= "\udfff" for letter in value)


def _moment(value: Any) -> float | None:
    """Return the time at which a maximum was found, in seconds since 1970."""
    moment = None if value is None else float(value)
    if moment is not None and not 0.0 <= moment <= LATEST:
        raise InvalidInput(expected("found", "seconds since 1970", brief(value)))
    return moment
