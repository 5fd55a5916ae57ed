"""The files of a checkout that are generated from the catalogue."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from gsp.catalogue.enumeration import mechanisms, table
from gsp.catalogue.equations import EQUATIONS, SYMBOLS
from gsp.catalogue.published import design, design_names
from gsp.files.writing import write_text
from gsp.model.constraints import CONSTRAINTS
from gsp.model.drives import drives_text
from gsp.model.legs import LEGS

CSV, PAGE = Path("catalogue/mechanisms.csv"), Path("docs/catalogue.md")


def generated() -> dict[Path, str]:
    """Return the generated files: path inside the checkout, and text."""
    return {CSV: table().to_csv(index=False, lineterminator="\n"), PAGE: _page()}


def stale(root: Path) -> list[Path]:
    """Return the generated files under `root` that are missing or out of date."""
    return [path for path, text in generated().items() if _read(root / path) != text]


def write(root: Path) -> list[Path]:
    """Write the generated files that are out of date, and return them."""
    texts = generated()
    paths = stale(root)
    for path in paths:
        (root / path).parent.mkdir(exist_ok=True)
        write_text(root / path, texts[path], overwrite=True)
    return paths


def _read(path: Path) -> str | None:
    return path.read_text(encoding="utf-8") if path.is_file() else None


def _page() -> str:
    groups = dict.fromkeys(m.group for m in mechanisms())
    parts = [
        "# Catalogue",
        "This page and `catalogue/mechanisms.csv` are generated: `gsp catalogue --write` writes "
        "them, `gsp catalogue --check` checks whether they are up to date.",
        "## Constraints",
        f"{SYMBOLS}. A row times the twist (v, ω) is the rate of the joint.",
        _constraints(),
        "## Legs",
        "Joints from base to platform; the actuated one in brackets.",
        _legs(),
        "## Published designs",
        _designs(),
        f"## The {len(mechanisms())} mechanisms",
        "Multisets of six constraints with at most three angular ones. *Exchanged* is the "
        "mechanism with base and platform exchanged.",
    ]
    for group in groups:
        parts += [f"### Class {group}", _mechanisms(group)]
    return "\n\n".join(parts) + "\n"


def _constraints() -> str:
    heads = ("constraint", "base", "platform", "quantity", "value", "row", "source")
    rows = [
        (
            c.name,
            c.base,
            c.platform,
            c.quantity,
            EQUATIONS[c.name].value,
            EQUATIONS[c.name].text,
            c.source,
        )
        for c in CONSTRAINTS
    ]
    return _markdown(heads, rows)


def _legs() -> str:
    rows = [(leg.name, leg.chain, " ".join(map(str, leg.joints)), str(leg.idle)) for leg in LEGS]
    return _markdown(("constraints", "chain", "joints", "idle freedoms"), rows)


def _designs() -> str:
    heads = ("design", "mechanism", "legs", "drives", "unit", "characteristic length", "source")
    rows = [
        (
            f"`{d.name}`",
            d.mechanism.name,
            str(d.n_legs),
            drives_text(d.drives),
            d.unit,
            "" if d.characteristic_length is None else f"{d.characteristic_length:.6g}",
            d.source,
        )
        for d in map(design, design_names())
    ]
    return _markdown(heads, rows)


def _mechanisms(group: str) -> str:
    frame = table()
    frame = frame[frame["class"] == group]
    rows = [
        (
            str(i),
            row["name"] + (" (symmetric)" if row["symmetric"] else ""),
            row["chains"],
            str(row["loops"]),
            row["exchanged"],
        )
        for i, row in enumerate(frame.to_dict("records"), int(frame.index[0]) + 1)
    ]
    return _markdown(("", "mechanism", "legs", "loops", "exchanged"), rows)


def _markdown(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(
        "| " + " | ".join(c.replace("|", "\\|") for c in line) + " |" for line in lines
    )
