"""Readings as HTML: the facts below the scene, the indices, the limits, the Jacobian."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

from gsp.app.scene.drawing import merit_colour
from gsp.app.scene.region import Surface
from gsp.app.state.matrices import LINES
from gsp.app.state.reading import IndexReading, JointReading, Reading, determinant_of, powers
from gsp.app.state.session import Session
from gsp.determinant import Maximum
from gsp.geometry.vectors import Array
from gsp.indices.table import ARROWS
from gsp.model.units import power_base
from gsp.rounding import rounded_down

# What is left of a stroke, as a share of its bounds, below which it is rounding: motions end so
# near to a limit.
LEFT_ROUNDING = 1e-7


def number(value: float, digits: int = 5) -> str:
    """Return a number for people: "—" for NaN, a true minus sign."""
    if np.isnan(value):
        return "—"
    if np.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    return f"{value + 0.0:.{digits}g}".replace("-", "−")


def facts(state: Session, reading: Reading) -> str:
    """Return the facts below the scene: det J, λ, CTN, CDN_CL, and what is left of the strokes."""
    unit = reading.index("manipulability").unit
    bracket = "" if unit in ("1", "mixed") else f" [{powers(unit)}]"
    values = [(f"det J{bracket}", _resolved(reading.determinant, reading.singular))]
    shown = [reading.index(n) for n in ("quality_index", "control_number", "condition_number")]
    values += [(one.index.symbol, one.value) for one in shown]
    least, near = reading.least, reading.index("singularity_distance")
    redundant = len(reading.joints) > len(reading.jacobian.T)
    if redundant:  # J is not square
        values[0] = (f"|det J|{bracket}", reading.index("manipulability").value)
    cells = [(name, number(value, 7 if "det" in name else 5)) for name, value in values]
    gauges = {values[0][0]: _note(f"√det JᵀJ of {len(reading.joints)} rows")} if redundant else {}
    if np.isfinite(least.left):
        cells.append((f"least left, {least.name}", _left(least)))
        gauges[cells[-1][0]] = _stroke_gauge(least)
    if not near.reason:
        bound = number(rounded_down(near.value, 4))
        cells.append((f"to singularity [{near.unit}]", f"≥ {bound}"))
        gauges[cells[-1][0]] = _singularity_gauge(near.value, state.length)
    if reading.singular:
        cells.append(("posture", "singular"))
    if reading.undefined:
        cells.append(("undefined", ", ".join(reading.undefined)))
    body = "".join(
        f'<div class="gsp-fact"><dt>{escape(name)}</dt><dd>{escape(value)}</dd>'
        f"{gauges.get(name, '')}</div>"
        for name, value in cells
    )
    return f'<dl class="gsp-facts" style="margin:0">{body}</dl>'


def _note(words: str) -> str:
    """Return a note below a fact."""
    return f'<dd class="gsp-share"><small>{escape(words)}</small></dd>'


def _resolved(value: float, singular: bool) -> float:
    """Return a number that is zero where a posture is singular: what is left of it is rounding."""
    return 0.0 if singular and np.isfinite(value) else value


def least_left(reading: Reading) -> str:
    """Return the limit that is nearest, with a gauge; "" where no joint has one."""
    least = reading.least
    if not np.isfinite(least.left):
        return ""
    return (
        f'<dl class="gsp-least"><dt>Least left, {escape(least.name)}</dt>'
        f"<dd>{escape(_left(least))}</dd>{_stroke_gauge(least)}</dl>"
    )


def _left(joint: JointReading) -> str:
    """Return what is left of a stroke; nothing is left where it is rounding."""
    bounds = [abs(x) for x in (joint.low, joint.high, joint.value) if np.isfinite(x)]
    left = 0.0 if abs(joint.left) <= LEFT_ROUNDING * max(bounds) else joint.left
    return f"{number(left, 4)} {joint.unit}".rstrip()


def _stroke_gauge(joint: JointReading) -> str:
    """Return the gauge of what is left of a stroke; "" without both limits."""
    if np.isnan(joint.free):
        return ""
    words = f"{_percent(joint.free)} of half the stroke"
    return _meter(joint.free, f"left of {joint.name}: {words}", words)


def _singularity_gauge(distance: float, length: float | None) -> str:
    """Return the gauge of the proven distance, as a share of the characteristic length."""
    if length is None or np.isnan(distance):
        return ""
    words = f"≥ {_percent(distance / length)} of the length"
    name = (
        f"to the nearest singular pose: at least {words[2:].replace('the', 'the characteristic')}"
    )
    return _meter(distance / length, name, words)


def _percent(share: float) -> str:
    """Return a share in percent, rounded down: of a lower bound it is one."""
    percent = 0.0 if abs(share) <= LEFT_ROUNDING else rounded_down(100.0 * share, 2)
    # No power of ten for 100 and more, nor digits beyond the two that are known.
    return f"{number(percent, 2 if abs(percent) < 99.5 else 15)} %"


def _meter(share: float, name: str, words: str) -> str:
    """Return a gauge of a share in [0, 1], with a name for screen readers and words beside it."""
    now = 100.0 * min(max(share, 0.0), 1.0)
    bar = _bar(share, merit_colour(min(max(share, 0.0), 1.0)))
    return (
        f'<dd class="gsp-share"><span role="meter" aria-label="{escape(name)}" aria-valuemin="0" '
        f'aria-valuemax="100" aria-valuenow="{now:.0f}">{bar}</span><small>{words}</small></dd>'
    )


def indices(readings: Iterable[IndexReading]) -> str:
    """Return the table of the indices: value, direction, best value, gauge; below them a reason."""
    rows = []
    for one in readings:
        index = one.index
        unit = powers(one.unit)
        best = number(index.best, 4)
        gauge = "" if one.reason else _gauge(one)
        name = escape(index.name.replace("_", " "))
        rows.append(
            f'<tr><th scope="row" title="{name}">{escape(index.symbol)}</th>'
            f'<td class="n">{number(one.value)} {escape(unit)}</td>'
            f'<td class="way" aria-label="{index.better}">{ARROWS[index.better]}'
            f"<span> {index.better}</span></td>"
            f'<td class="n">{best}</td><td>{gauge}</td></tr>'
        )
        if one.reason:
            rows.append(f'<tr><td class="why" colspan="5">{escape(one.reason)}</td></tr>')
    return table(("index", "value", "better", "best", "merit"), rows, numbers=(1, 3))


def maximum(found: Maximum, unit: str) -> str:
    """Return the maximum of |det J| in a sentence: its value, and how well it is known.

    Parameters
    ----------
    found : Maximum
    unit : str
        Of the index "manipulability" for the design.
    """
    value = f"{number(found.value, 8)} {powers(unit) if unit != 'mixed' else ''}".rstrip()
    if found.method == "closed form":
        how = "by a closed form"
    elif found.proven:
        how = "found by a search, and proven: no pose has a larger one"
    elif found.starts:
        how = (
            f"the largest that a search found; {found.agreed} of its {found.starts} starts ended "
            "there, and it is not proven"
        )
    else:
        how = "the largest that a search found, and it is not proven"
    return f"|det J|max = {value}, {how}"


def volume(found: Surface, unit: str) -> str:
    """Return the volume of a sampled region with its error."""
    error = 100.0 * found.volume_error / found.volume if found.volume > 0.0 else np.inf
    share = f" ± {error:.0f} %" if 0.5 <= error < 100.0 else " ± 1 %" if error < 0.5 else ""
    cube = f" {power_base(unit)}³" if unit else ""
    cut = ", cut off" if found.cut else ""
    return f"volume ≈ {number(found.volume, 3)}{cube}{share}, sampled{cut}"


def limits(readings: Sequence[JointReading]) -> str:
    """Return the table of the joints: value, limits, and what is left to the nearer one."""
    rows = []
    for one in readings:
        left = escape(_left(one)) if np.isfinite(one.left) else "no limit"
        if one.reason:
            left = f'<span class="why">{escape(one.reason)}</span>'
        inside = one.left >= -LEFT_ROUNDING * abs(one.value)
        bar = "" if np.isnan(one.share) else _bar(one.share, "#0072B2" if inside else "#D55E00")
        rows.append(
            f'<tr><th scope="row">{escape(one.name)}</th>'
            f'<td class="n">{number(one.value, 6)} {escape(one.unit)}</td>'
            f'<td class="n">{number(one.low, 4)} … {number(one.high, 4)}</td>'
            f'<td class="n">{left}</td><td>{bar}</td></tr>'
        )
    return table(("joint", "value", "limits", "left", "place"), rows, numbers=(1, 2, 3))


def matrix(values: Array, state: Session, form: str) -> str:
    """Return the Jacobian as a table: rows are joints, or columns for "lines".

    Below it is the determinant of the matrix that is shown, which "lines" gives the other sign.
    """
    names = state.design.joint_names
    lines = ("L", "M", "N", "P", "Q", "R")
    twist = (
        "v<sub>x</sub>",
        "v<sub>y</sub>",
        "v<sub>z</sub>",
        "ω<sub>x</sub>",
        "ω<sub>y</sub>",
        "ω<sub>z</sub>",
    )
    heads, sides = (names, lines) if form == LINES else (twist, names)
    rows = [
        f'<tr><th scope="row">{side}</th>'
        + "".join(f'<td class="n">{_decimals(x)}</td>' for x in row)
        + "</tr>"
        for side, row in zip(sides, values.tolist(), strict=True)
    ]
    shown = table(
        ("joint" if form != LINES else "row", *heads), rows, numbers=range(1, len(heads) + 1)
    )
    value = determinant_of(values)
    if np.isnan(value):
        return shown
    value = _resolved(value, bool(state.design.at(state.pose).singular()))
    return f'{shown}<p class="gsp-note">determinant of this matrix: {number(value, 7)}</p>'


def _decimals(value: float) -> str:
    """Return an entry with three decimals, as figure 42 has it, or five digits of a small one."""
    if np.isnan(value):
        return "—"
    shown = f"{value:.3f}" if abs(value) >= 0.1 or abs(value) < 5e-13 else f"{value:.3g}"
    return ("0.000" if shown == "-0.000" else shown).replace("-", "−")


def _gauge(one: IndexReading) -> str:
    return "" if np.isnan(one.gauge) else _bar(one.gauge, merit_colour(one.gauge))


def _bar(share: float, colour: str) -> str:
    width = 100.0 * min(max(share, 0.0), 1.0)
    return (
        f'<span class="gsp-gauge" aria-hidden="true">'
        f'<span style="width:{width:.1f}%;background:{colour}"></span></span>'
    )


def table(heads: Sequence[str], rows: Iterable[str], numbers: Iterable[int] = ()) -> str:
    """Return a table of rows that are HTML; columns of numbers are set to the right."""
    right = set(numbers)
    cells = "".join(
        f'<th scope="col"{" class=n" if i in right else ""}>{head}</th>'
        for i, head in enumerate(heads)
    )
    head = f"<thead><tr>{cells}</tr></thead>"
    return f'<table class="gsp-table">{head}<tbody>{"".join(rows)}</tbody></table>'
