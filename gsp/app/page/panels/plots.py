"""The panel of plots: an index along a motion, and over a plane of positions."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from nicegui import ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.panels.axes import (
    GRID,
    cells,
    coordinate,
    power_of_ten,
    scaled,
    texts,
    with_power,
)
from gsp.app.page.panels.contours import contour, label_place, round_levels
from gsp.app.state import curves
from gsp.app.state.reading import missing_words
from gsp.errors import GspError
from gsp.figures.gaps import gap_words
from gsp.geometry.vectors import Array
from gsp.indices import INDICES

SYMBOLS = {name: INDICES[name].symbol for name in curves.PLOTTED}
# Decimal places of the line at the present pose: two are the default, too few for small designs.
MARK_DIGITS = 20
# The margins of the map [px]: style.css makes what is between them a square.
MAP_MARGINS = {"left": 80, "right": 80, "top": 16, "bottom": 44}
BLUE, VERMILION, INK = "#0072B2", "#D55E00", "#1F2933"


def plots_panel(client: Client) -> None:
    """Build the panel of plots."""
    with ui.element("div").classes("gsp-row"):
        index = ui.select(SYMBOLS, value="control_number", label="Index to plot")
        motion = ui.select(list(curves.MOTIONS), value="z", label="Motion")
        plane = ui.select(list(curves.PLANES), value="xy", label="Plane of the map")
        for part in (index, motion, plane):
            part.props("dense outlined")
    note = ui.label().classes("gsp-note").props("role=status")
    line = ui.echart(_no_plot()).classes("gsp-plot").props("role=img")
    with ui.element("div").classes("gsp-map"):
        field = ui.echart(_no_plot()).props("role=img")

    def draw() -> None:
        names = plot_names(index.value, motion.value, plane.value)
        try:
            curve = curves.curve(client.state, index.value, motion.value)
            plot = curves.map_over(client.state, index.value, plane.value)
        except GspError as error:
            words = missing_words(client.state, INDICES[index.value])
            note.text = f"{SYMBOLS[index.value]}: {words}" if words else str(error)
            for chart, name in zip((line, field), names, strict=True):
                _set(chart, _no_plot(), f"{name}: no plot")
            return
        gaps = [gap_words(one.index.symbol, one.values) for one in (curve, plot)]
        note.text = " ".join([
            "Orange: the present pose. The map has the present rotation.",
            *(f"{name}: {gap}." for name, gap in zip(("Curve", "Map"), gaps, strict=True) if gap),
        ])  # fmt: skip
        options = curve_options(curve), map_options(plot)
        for chart, name, option, gap in zip((line, field), names, options, gaps, strict=True):
            _set(chart, option, f"{name}: {gap}" if gap else name)

    for part in (index, motion, plane):
        part.on_value_change(draw)
    client.on_move(draw, "plots")


def plot_names(index: str, motion: str, plane: str) -> tuple[str, str]:
    """Return the names of the two plots for screen readers.

    >>> plot_names("control_number", "turn about x", "xz")
    ('CTN by a turn about x', 'CTN over x and z')
    """
    way = f"by a {motion}" if motion.startswith("turn") else f"along {motion}"
    return f"{SYMBOLS[index]} {way}", f"{SYMBOLS[index]} over {plane[0]} and {plane[1]}"


def curve_options(curve: curves.Curve) -> dict[str, Any]:
    """Return the plot of an index along a motion, with a line at the present pose."""
    places, axis = scaled(curve.places, curve.axis)
    values, label = scaled(curve.values, curve.label)
    points = [[x, y] for x, y in zip(places.tolist(), _finite(values), strict=True)]
    here = curve.here / 10.0 ** power_of_ten(curve.places)
    return {
        **_undrawable(curve.index.symbol, curve.values),
        "animation": False,
        "grid": {"left": 72, "right": 24, "top": 32, "bottom": 44} | GRID,
        "tooltip": {"trigger": "axis", "confine": True},
        "xAxis": {
            "type": "value",
            "name": axis,
            "nameLocation": "middle",
            "nameGap": 28,
            "min": float(places[0]),
            "max": float(places[-1]),
            "axisLabel": {"hideOverlap": True, "showMinLabel": False, "showMaxLabel": False},
        },
        "yAxis": {"type": "value", "name": label, "scale": True},
        "series": [
            {
                "type": "line",
                "showSymbol": False,
                "data": points,
                "lineStyle": {"color": BLUE, "width": 2},
                "itemStyle": {"color": BLUE},
                "markLine": {
                    "symbol": "none",
                    "precision": MARK_DIGITS,
                    "label": {"show": False},
                    "lineStyle": {"color": VERMILION, "width": 2, "type": "solid"},
                    "data": [{"xAxis": here}],
                },
            }
        ],
    }


def map_options(plot: curves.Map) -> dict[str, Any]:
    """Return the map of an index over a plane of positions, with contours and their labels."""
    values = _finite(plot.values.ravel())
    size = len(plot.second)
    (first, across), (second, up) = map(scaled, (plot.first, plot.second), plot.axes)
    data = [[k // size, k % size, v] for k, v in enumerate(values) if v is not None]
    known = np.array([v for v in values if v is not None] or [0.0, 1.0])
    # A few values near singular poses would take the whole range of colours.
    low, high = (float(x) for x in np.percentile(known, [2.0, 98.0]))
    good = [VERMILION, "#F0C842", BLUE]
    if plot.index.better == "lower":
        good = good[::-1]
    middle = size // 2
    return {
        **_undrawable(plot.index.symbol, plot.values),
        "animation": False,
        "grid": MAP_MARGINS | GRID,
        "tooltip": {
            "confine": True,
            ":formatter": _tooltip([across, up, plot.index.symbol], texts(first), texts(second)),
        },
        "xAxis": [cells(first), coordinate(first, across, "bottom", 28)],
        "yAxis": [cells(second), coordinate(second, up, "left", 62)],
        "visualMap": {
            "show": bool(data),
            "seriesIndex": 0,
            "min": low,
            "max": high if high > low else low + 1.0,
            "right": 0,
            "top": "middle",
            "calculable": False,
            "hoverLink": False,
            "text": _range_words(plot.index.symbol, known, low, high),
            "textStyle": {"lineHeight": 16},
            "precision": 3,
            "inRange": {"color": good},
        },
        "series": [
            {"type": "heatmap", "data": data},
            *_contours(plot.values, first, second, round_levels(low, high)),
            {
                "type": "scatter",
                "data": [[float(first[middle]), float(second[middle])]],
                "xAxisIndex": 1,
                "yAxisIndex": 1,
                "symbol": "circle",
                "symbolSize": 12,
                "itemStyle": {"color": "#FFFFFF", "borderColor": VERMILION, "borderWidth": 3},
            },
        ],
    }


def _range_words(symbol: str, known: Array, low: float, high: float) -> list[str]:
    """Return what stands at the upper and the lower end of the colours."""
    above, below = "≥ " if known.max() > high else "", "≤ " if known.min() < low else ""
    power = power_of_ten(known)
    top, bottom = (tables.number(x / 10.0**power, 3) for x in (high, low))
    name = with_power(symbol, power).replace(" [", "\n[")
    return [f"{name}\n{above}{top}", f"{below}{bottom}"]


def _tooltip(names: list[str], first: list[str], second: list[str]) -> str:
    """Return a function of the page that states the place and the value of a cell of a map."""
    return (
        f"(cell) => {{ const names = {json.dumps(names)};"
        f" const places = [{json.dumps(first)}, {json.dumps(second)}];"
        " if (cell.seriesType !== 'heatmap') return '';"
        " const [i, j, value] = cell.value, texts = [places[0][i], places[1][j], value];"
        " const words = document.createElement('div');"
        " words.innerText = names.map((name, k) => `${name}: ${texts[k]}`).join('\\n');"
        " return words.innerHTML; }"
    )


def _contours(
    values: Array, first: Array, second: Array, levels: list[float]
) -> list[dict[str, Any]]:
    """Return the series of contour lines, and that of their labels."""
    lines: list[dict[str, Any]] = []
    labels: list[dict[str, Any]] = []
    taken = [0.5 * (np.array(values.shape) - 1.0)]  # the present pose
    for level in levels:
        found = contour(values, level)
        lines += [{"coords": _coordinates(first, second, line)} for line in found]
        place = label_place(found, values.shape, taken)
        if place is not None:
            taken.append(place)
            text = {"formatter": tables.number(level, 4)}
            labels.append({"value": _coordinates(first, second, place), "label": text})
    axes = {"xAxisIndex": 1, "yAxisIndex": 1, "silent": True}
    written = {"show": True, "position": "inside", "fontSize": 11, "color": INK}
    written |= {"backgroundColor": "#FFFFFFE6", "padding": [1, 3], "borderRadius": 3}
    return [
        {
            "type": "lines",
            "coordinateSystem": "cartesian2d",
            "polyline": True,
            "data": lines,
            "lineStyle": {"color": INK, "width": 1, "opacity": 0.8},
            **axes,
        },
        {"type": "scatter", "symbolSize": 1, "data": labels, "label": written, **axes},
    ]


def _coordinates(first: Array, second: Array, steps: Array) -> list[Any]:
    """Return coordinates of places (..., 2) in steps of the grid, to a thousandth of one."""
    start = np.array([first[0], second[0]])
    step = np.array([first[1], second[1]]) - start
    places = 3 - int(np.floor(np.log10(step.min())))
    found: list[Any] = np.round(start + steps * step, places).tolist()
    return found


def _undrawable(symbol: str, values: Array) -> dict[str, Any]:
    """Return the text in the middle of a plot that has no value to draw."""
    if np.isfinite(values).any():
        return {}
    # Beside the present pose, on a ground that hides the line through it.
    written = {"fontSize": 12, "fontWeight": "normal", "color": INK, "width": 180}
    title = {"text": gap_words(symbol, values), "left": "center", "top": "25%", "padding": 3}
    title |= {"textStyle": written | {"overflow": "break"}, "backgroundColor": "#FFFFFFE6"}
    return {"title": title}


def _finite(values: Array) -> list[float | None]:
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in values]


def _no_plot() -> dict[str, Any]:
    return {"series": []}


def _set(chart: ui.echart, options: dict[str, Any], name: str) -> None:
    """Show a plot, which has a name for screen readers."""
    chart.options.clear()
    chart.options.update(options)
    chart.props["aria-label"] = name
    chart.update()
