"""A page for each published design: its file's record, picture, joints and indices at home."""

from __future__ import annotations

from pathlib import Path

import gsp
from gsp.catalogue import design_names
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.model.posture import Posture
from website.markdown import fence, table
from website.markdown import page as make

OVERVIEW = "designs/index.md"


def page(name: str) -> str:
    """Return the path of the page of a design."""
    return f"designs/{name}.md"


def picture(name: str) -> str:
    """Return the path of the picture of a design."""
    return f"designs/{name}.png"


def pages() -> dict[str, str]:
    """Return the pages of the published designs and their overview: path, and Markdown."""
    return {
        OVERVIEW: overview(),
        **{page(name): text(gsp.catalogue.design(name)) for name in design_names()},
    }


def overview() -> str:
    """Return the page with one row per design, and their pictures."""
    frame = gsp.catalogue.designs()
    rows = [
        (f"[{r['name']}]({r['name']}.md)", r["mechanism"], r["class"], r["n_legs"], r["source"])
        for r in frame.to_dict("records")
    ]
    cards = [f"- [![{name}]({name}.png)]({name}.md)\n  {name}" for name in frame["name"]]
    return make(
        "# Published designs",
        "One page per file of `catalogue/designs/`. The 195 mechanisms, which have no dimensions, "
        "are in the [catalogue](../docs/catalogue.md).",
        table(("design", "mechanism", "class", "legs", "source"), rows),
        '<div class="gallery" markdown>',
        "\n".join(cards),
        "</div>",
    )


def text(design: Design) -> str:
    """Return the page of one design."""
    name = design.name
    return make(
        f"# {name}",
        table(("record", ""), facts(design)),
        f"![{name}: legs, base and platform]({name}.png)",
        "## Dimensions",
        "Points and directions of the base in base axes, those of the platform in platform axes.",
        dimensions(design),
        strokes(design),
        "## At home",
        at_home(design),
        "## Use",
        fence(f'import gsp\n\ndesign = gsp.catalogue.design("{name}")', "python"),
        f"The file: [`catalogue/designs/{name}.toml`](../catalogue/designs/{name}.toml).",
    )


def facts(design: Design) -> list[tuple[str, str]]:
    """Return the facts of the record other than points and directions."""
    length, ellipsoid = design.characteristic_length, design.ellipsoid
    unit = design.unit
    return [
        ("source", design.source),
        ("mechanism", f"{design.mechanism.name}, class {design.mechanism.group}"),
        ("unit of length", unit or "not stated"),
        ("characteristic length", "not stated" if length is None else f"{length:.6g} {unit}"),
        (
            "semi-axes of the ellipsoid",
            "not stated" if ellipsoid is None else numbers(ellipsoid.semi_axes),
        ),
    ]


def dimensions(design: Design) -> str:
    """Return the table of anchor points and directions, one row per leg."""
    columns = {
        "base point": design.base_points,
        "base direction": design.base_directions,
        "platform point": design.platform_points,
        "platform direction": design.platform_directions,
    }
    used = {head: rows for head, rows in columns.items() if (rows == rows).any()}
    drives = ("drive",) if design.driven else ()
    rows = [
        (
            i + 1,
            " ".join(constraint.name for constraint in leg.constraints),
            leg.chain,
            *(numbers(c[i]) for c in used.values()),
            *[str(leg.drive) for _ in drives],
        )
        for i, leg in enumerate(design.legs)
    ]
    return table(("leg", "constraints", "chain", *used, *drives), rows)


def strokes(design: Design) -> str:
    """Return the table of the strokes, or nothing."""
    if design.strokes is None:
        return ""
    rows = [
        (name, f"{low:.6g}", f"{high:.6g}", unit)
        for name, unit, (low, high) in zip(
            design.joint_names, design.joint_units, design.strokes, strict=True
        )
    ]
    return table(("joint", "least", "greatest", "unit"), rows)


def at_home(design: Design) -> str:
    """Return joints and indices at the pose that the source studies."""
    if design.home is None:
        return "The source studies no single pose."
    posture = design.at(design.home)
    angles = design.home.angles(degrees=True)
    joints = [
        (name, f"{value:.7g}", unit)
        for name, value, unit in zip(
            posture.joint_names, posture.joints, design.joint_units, strict=True
        )
    ]
    return make(
        f"Position ({numbers(design.home.position)}), roll, pitch, yaw ({numbers(angles)})°.",
        table(("joint", "value", "unit"), joints),
        table(("index", "symbol", "value", "better"), indices(posture)),
        "Indices that need what the record does not have (a length, an ellipsoid, the maximum of "
        "|det J|) are left out.",
    )


def indices(posture: Posture) -> list[tuple[str, str, str, str]]:
    """Return the routine indices whose needs the record meets, one row each."""
    design = posture.design
    values = gsp.evaluate(design, posture.pose, backend="numpy").iloc[0]
    rows = []
    for name, value in values.items():
        index = INDICES[str(name)]
        link = f"[`{name}`](../indices/{name}.md)"
        rows.append((link, index.symbol, f"{value:.6g}", index.better))
    return rows


def numbers(values: object) -> str:
    """Return numbers with six digits, unbroken; nothing for an unused direction."""
    texts = [f"{round(float(v), 12) + 0.0:.6g}" for v in values]  # type: ignore[attr-defined]
    return "" if "nan" in texts else ",\N{NO-BREAK SPACE}".join(texts)


def draw(folder: Path) -> dict[str, Path]:
    """Draw the designs into a folder, and return the pictures: path on the site, and file."""
    from gsp.plots.common.style import save_figure
    from gsp.plots.mechanisms import mechanism

    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for name in design_names():
        design = gsp.catalogue.design(name)
        files[picture(name)] = path = folder / f"{name}.png"
        save_figure(mechanism(design, design.home).get_figure(), path)
    return files
