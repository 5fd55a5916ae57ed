"""A page for each index, from its record and the docstring of its function."""

from __future__ import annotations

import math

from gsp.indices import INDICES, Index
from website.markdown import page as make
from website.markdown import table

OVERVIEW = "indices/index.md"

# The six properties of the record, as the pages name them.
PROPERTIES = {
    "non_negative": "not negative",
    "zero_iff_singular": "zero at singular postures and only there",
    "motion_invariant": "unchanged by a motion of the whole mechanism",
    "similarity_invariant": "unchanged by a change of its size",
    "geometric": "has a geometric meaning",
    "real_time": "computable in real time",
}
# The facts of `Invariance`, as the pages name them.
DESCRIPTIONS = {
    "base_turn": "other axes of the base frame",
    "base_shift": "another origin of the base frame",
    "platform_turn": "other axes of the platform frame",
    "platform_shift": "another origin of the platform frame",
    "order": "legs in another order",
    "exchange": "base and platform exchanged",
    "mirror": "the mirror image",
    "slide": "anchors moved along their lines",
    "reversal": "lines with the opposite sense",
}
LENGTH_FOR = {
    "": "",
    "angular": "`length` for legs with A1 actuators",
    "cylindrical": "`length` for legs with cylindrical joints",
}


def page(name: str) -> str:
    """Return the path of the page of an index."""
    return f"indices/{name}.md"


def pages() -> dict[str, str]:
    """Return the pages of the indices and their overview: path, and Markdown."""
    return {OVERVIEW: overview(), **{page(i.name): text(i) for i in INDICES.values()}}


def overview() -> str:
    """Return the page with one row per index."""
    heads = ("index", "symbol", "range", "best", "changes with the unit of length", "needs")
    rows = [
        (f"[`{i.name}`]({i.name}.md)", i.symbol, span(i), number(i.best), unit(i), needs(i))
        for i in INDICES.values()
    ]
    return make(
        "# Indices",
        "One page per index, made from its record in `gsp.indices.INDICES`. "
        "How to choose one: [choosing an index](../docs/choosing-an-index.md).",
        table(heads, rows),
        "## The six properties",
        "Of the merit of a posture: the value where higher is better, else its reciprocal. Tests "
        "check each statement, the negative ones by an example.",
        table(
            ("", *PROPERTIES.values()),
            [(i.symbol, *(yes(i, flag) for flag in PROPERTIES)) for i in INDICES.values()],
        ),
    )


def text(index: Index) -> str:
    """Return the page of one index."""
    facts = [
        ("name", f"`gsp.indices.{index.name}`"),
        ("symbol", index.symbol),
        ("range", span(index)),
        ("better", index.better),
        ("best value", number(index.best)),
        ("worst value", number(index.worst)),
        ("changes with the unit of length", unit(index)),
        ("needs", needs(index)),
        ("number of actuators", index.actuators or "any"),
        ("computed where no index is named", "yes" if index.routine else "no"),
        ("source", index.source),
    ]
    properties = [(what, yes(index, flag) or "no") for flag, what in PROPERTIES.items()]
    descriptions = [(what, getattr(index.invariance, f)) for f, what in DESCRIPTIONS.items()]
    name = f"gsp.indices.{index.name}"
    return make(
        f"# {index.symbol}: {index.name.replace('_', ' ')}",
        table(("record", ""), facts),
        "## Properties of the merit",
        table(("property", ""), properties),
        "## The same mechanism described differently",
        table(("description", "values"), descriptions),
        "## Definition",
        f"::: {index.function.__module__}.{index.function.__qualname__}\n"
        f"    options:\n      heading: {name}\n      heading_level: 3",
    )


def span(index: Index) -> str:
    """Return the range of an index, from the smaller end to the larger one."""
    return " … ".join(number(end) for end in sorted((index.best, index.worst)))


def needs(index: Index) -> str:
    """Return what an index needs."""
    parts = [f"`{name}`" for name in index.needs] + [LENGTH_FOR[index.length_for]]
    return ", ".join(part for part in parts if part) or "nothing"


def unit(index: Index) -> str:
    """Return how a value changes with the unit of length."""
    powers = {"1": "no", "no power": "yes, by no fixed power"}
    return powers.get(index.unit_power, f"yes, as {index.unit_power}")


def yes(index: Index, flag: str) -> str:
    """Return "yes" if an index has one of the six properties, else nothing."""
    return "yes" if getattr(index.properties, flag) else ""


def number(value: float) -> str:
    """Return a number of a record as text."""
    known = {math.inf: "∞", math.pi / 2: "π/2"}
    return known.get(value, f"{value:g}")
