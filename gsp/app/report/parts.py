"""Sections of a report about the design and one pose: geometry, joints, Jacobian, indices."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

from gsp.app.page import tables
from gsp.app.page.tables import number, table
from gsp.app.report import pictures
from gsp.app.report.meanings import MEANINGS
from gsp.app.report.study import Place, Study, attempted
from gsp.app.report.summary import measured
from gsp.app.scene.figure import figure
from gsp.app.state.matrices import HOMOGENEOUS, LINES, PLAIN, matrix
from gsp.app.state.reading import IndexReading, powers
from gsp.geometry.vectors import Array
from gsp.model.drives import drives_text
from gsp.rounding import digits_within, rounded_down

# Where the characteristic length is from.
LENGTH_WORDS = {"design": "", "task": ", of the task", "report": ", chosen for this report"}
# The index that has a section of its own.
DISTANCE = "singularity_distance"


def geometry(study: Study) -> str:
    """Return the scene, which can be turned; a picture of it for paper; and the plan view."""
    scene = figure(study.shown.design, study.state.pose)
    return (
        f'<div class="scene">{scene._repr_html_()}</div>'
        f'<div class="pair"><div class="paper">{pictures.in_space(study)}</div>'
        f"<div>{pictures.from_above(study)}</div></div>"
        "<p class=note>Drag, wheel, two fingers or the arrow keys turn the scene.</p>"
    )


def dimensions(study: Study) -> str:
    """Return the legs with their anchors and lines."""
    design, size = study.state.design, study.state.size
    columns = {
        "leg": [str(i + 1) for i in range(design.n_legs)],
        "constraints": [escape(leg.name) for leg in design.legs],
        "joints": [escape(" ".join(map(str, leg.joints))) for leg in design.legs],
        "base point": [_vector(point, size) for point in design.base_points],
        "base line": [_vector(line) for line in design.base_directions],
        "platform point": [_vector(point, size) for point in design.platform_points],
        "platform line": [_vector(line) for line in design.platform_directions],
    }
    used = {name: texts for name, texts in columns.items() if any(texts)}
    rows = cells(zip(*used.values(), strict=True))
    return (
        listed(_facts(study))
        + wide(table(tuple(used), rows))
        + "<p class=note>Joints from base to platform, the driven ones in brackets. Base points "
        "and lines are in base axes, those of the platform in platform axes.</p>"
    )


def _facts(study: Study) -> list[tuple[str, str]]:
    design = study.shown.design
    length = measured(study.length, design.unit, 6)
    mechanism = design.mechanism
    kind = (mechanism.name, f"class {mechanism.group}", drives_text(design.drives))
    facts = [
        ("mechanism", ", ".join(part for part in kind if part)),
        ("unit of length", design.unit or "not stated"),
        ("source", design.source or "not stated"),
        (
            "characteristic length",
            f"{length}{LENGTH_WORDS[study.length_of]}",
        ),
    ]
    if design.ellipsoid is not None:
        axes = " × ".join(number(float(axis), 4) for axis in design.ellipsoid.semi_axes)
        facts.append(("operation ellipsoid, semi-axes", f"{axes} {design.unit}".rstrip()))
    return facts


def joints(study: Study) -> str:
    """Return the joint values, the strokes and what is left of them."""
    text = wide(tables.limits(study.reading.joints))
    if study.limits is not None and study.limits.strokes is not None:
        text += "<p class=note>The limits are the strokes of the task.</p>"
    elif study.state.design.strokes is None:
        text += "<p class=note>The design states no strokes.</p>"
    return text


def jacobian(study: Study) -> str:
    """Return the inverse Jacobian in the unit of the design, and dimensionless."""
    state = study.state
    parts = ["<h3>In the unit of the design</h3>"]
    parts.append(wide(tables.matrix(matrix(state, PLAIN), state, PLAIN)))
    unit = powers(study.reading.index("manipulability").unit)
    if np.isfinite(study.reading.determinant):
        parts.append(f"<p>det J = {escape(measured(study.reading.determinant, unit, 7))}</p>")
    parts.append("<h3>Dimensionless, by the characteristic length</h3>")
    parts.append(wide(tables.matrix(matrix(state, HOMOGENEOUS), state, HOMOGENEOUS)))
    if state.design.between_points:
        parts.append("<h3>Lines of the legs as columns</h3>")
        parts.append(wide(tables.matrix(matrix(state, LINES), state, LINES)))
    parts.append(
        "<p class=note>Rate of a joint = row times twist (v, ω) of the platform: v is the velocity "
        "of its origin, ω its angular velocity, in base axes.</p>"
    )
    return "".join(parts)


def indices(study: Study) -> str:
    """Return the indices: value, best value, what each measures, and whether it is good."""
    rows = [_index(study, one) for one in study.reading.indices]
    heads = ("index, and what it measures", "value", "better, best", "is it good?")
    others = study.others - {study.state.design.mechanism.name}
    return (
        f'<div class="stack">{table(heads, rows, numbers=(1,))}</div>'
        f"<p class=note>Good: a value in the first quarter of this design and the {len(others)} "
        "other mechanisms of the catalogue that are not singular on the same anchor lines at this "
        "pose; poor: in the last quarter. This compares mechanisms with these dimensions; other "
        "dimensions may be better.</p>"
    )


def _index(study: Study, one: IndexReading) -> str:
    index, place = one.index, study.places[one.index.name]
    name, meaning = escape(index.name.replace("_", " ")), escape(MEANINGS[index.name])
    why = f'<br><span class="why">{escape(one.reason)}</span>' if one.reason else ""
    value = escape(measured(_better_bound(study, one), powers(one.unit), 5))
    return (
        f'<tr><th scope="row">{escape(index.symbol)} <span class="why">{name}: {meaning}</span>'
        f'{why}</th><td class="n">{value}</td>'
        f"<td>{index.better}, {number(index.best, 4)}</td><td>{_verdict(place)}</td></tr>"
    )


def _better_bound(study: Study, one: IndexReading) -> float:
    """Return the value; of the distance to singular poses the better bound of its own section."""
    near = attempted(lambda: study.distance)[0] if one.index.name == DISTANCE else None
    return one.value if near is None else rounded_down(max(one.value, float(near.lower)), 5)


def _verdict(place: Place | None) -> str:
    if place is None:
        return ""
    where = f'<span class="why">{place.better} of {place.total} better</span>'
    return f'<span class="verdict {place.verdict}">{place.verdict}</span> {where}'


def listed(facts: Iterable[tuple[str, str]]) -> str:
    """Return names and texts as a list."""
    body = "".join(f"<div><dt>{escape(k)}</dt><dd>{escape(v)}</dd></div>" for k, v in facts)
    return f"<dl>{body}</dl>"


def cells(rows: Iterable[Sequence[str]]) -> list[str]:
    """Return rows of a table whose first cell is its name; texts are HTML."""
    return [
        f'<tr><th scope="row">{first}</th>{"".join(f"<td>{cell}</td>" for cell in rest)}</tr>'
        for first, *rest in rows
    ]


def _vector(vector: Array, size: float = 1.0) -> str:
    """Return three numbers, six digits of a size; nothing for a direction that is not used."""
    values = vector.tolist()
    if np.isnan(values[0]):
        return ""
    return ", ".join(number(x, digits_within(x, size)) for x in values)


def wide(html: str) -> str:
    """Return a table that scrolls alone where the screen is narrower."""
    return f'<div class="wide" tabindex="0">{html}</div>'
