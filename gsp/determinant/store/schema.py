"""The table of the store: its columns, and the check of what is put into them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected

if TYPE_CHECKING:
    import sqlalchemy as sa

# "summits" is `Maximum.n_local_maxima`: stores of older versions have the column by that name.
INTEGERS = (
    "evaluations",
    "seed",
    "starts",
    "agreed",
    "summits",
    "singles",
    "converged",
    "attained",
    "version",
)
TEXTS = ("position", "rotation", "design", "domain", "library")
FIELDS = ("key", "value", *INTEGERS, *TEXTS, "found")


def check_entry(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return an entry if it has known columns, a key, texts, and a value ≥ 0.

    Raises
    ------
    InvalidInput
    """
    entry = arguments.mapping("entry", entry)
    unknown = set(entry) - set(FIELDS)
    if unknown:
        raise InvalidInput(expected("entry", f"the columns {', '.join(FIELDS)}", brief(unknown)))
    if not isinstance(entry.get("key"), str):
        raise InvalidInput(expected("entry: key", "a text", brief(entry.get("key"))))
    for name in TEXTS:
        if not isinstance(entry.get(name), str | None):
            raise InvalidInput(expected(f"entry: {name}", "a text", brief(entry[name])))
    value = arguments.one(arguments.numbers)("entry: value", entry.get("value"))
    if value < 0.0:
        raise InvalidInput(expected("entry: value", "a number ≥ 0", brief(value)))
    return {**entry, "value": value}


def table_of_maxima(sa: Any) -> sa.Table:
    """Return the table, which belongs to no database yet."""
    text, number, whole = sa.Text, sa.Double, sa.BigInteger
    return sa.Table(  # type: ignore[no-any-return]
        "gsp_maxima",
        sa.MetaData(),
        sa.Column("key", sa.String(64), primary_key=True),
        sa.Column("value", number),
        sa.Column("worker", text),
        sa.Column("expires", number),
        *(sa.Column(name, whole) for name in INTEGERS),
        *(sa.Column(name, text) for name in TEXTS),
        sa.Column("found", number),
    )
