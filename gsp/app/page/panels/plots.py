"""The panel of plots: an index along a motion, and over a plane of positions."""

from __future__ import annotations

from typing import Any

import numpy as np
from nicegui import ui

from gsp.app.page import tables
from gsp.app.page.client import Client
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
MAP_MARGINS = {"left": 64, "right": 88, "top": 16, "bottom": 44}
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
    points = [[float(x), y] for x, y in zip(curve.places, _finite(curve.values), strict=True)]
    return {
        **_undrawable(curve.index.symbol, curve.values),
        "animation": False,
        "grid": {"left": 64, "right": 24, "top": 32, "bottom": 44},
        "tooltip": {"trigger": "axis"},
        "xAxis": {
            "type": "value",
            "name": curve.axis,
            "nameLocation": "middle",
            "nameGap": 28,
            "min": float(curve.places[0]),
            "max": float(curve.places[-1]),
            "axisLabel": {"hideOverlap": True, "showMinLabel": False, "showMaxLabel": False},
        },
        "yAxis": {"type": "value", "name": curve.label, "scale": True},
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
                    "data": [{"xAxis": curve.here}],
                },
            }
        ],
    }


def map_options(plot: curves.Map) -> dict[str, Any]:
    """Return the map of an index over a plane of positions, with contours and their labels."""
    values = _finite(plot.values.ravel())
    size = len(plot.second)
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
        "grid": MAP_MARGINS,
        "tooltip": {},
        "xAxis": [_cells(plot.first), _coordinate(plot.first, plot.axes[0], "bottom", 28)],
        "yAxis": [_cells(plot.second), _coordinate(plot.second, plot.axes[1], "left", 48)],
        "visualMap": {
            "show": bool(data),
            "seriesIndex": 0,
            "min": low,
            "max": high if high > low else low + 1.0,
            "right": 0,
            "top": "middle",
            "calculable": False,
            "text": _range_words(plot.index.symbol, known, low, high),
            "textStyle": {"lineHeight": 16},
            "precision": 3,
            "inRange": {"color": good},
        },
        "series": [
            {"type": "heatmap", "data": data},
            *_contours(plot, round_levels(low, high)),
            {
                "type": "scatter",
                "data": [[float(plot.first[middle]), float(plot.second[middle])]],
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
    return [f"{symbol}\n{above}{tables.number(high, 3)}", f"{below}{tables.number(low, 3)}"]


def _contours(plot: curves.Map, levels: list[float]) -> list[dict[str, Any]]:
    """Return the series of contour lines, and that of their labels."""
    values = plot.values
    lines: list[dict[str, Any]] = []
    labels: list[dict[str, Any]] = []
    taken = [0.5 * (np.array(values.shape) - 1.0)]  # the present pose
    for level in levels:
        found = contour(values, level)
        lines += [{"coords": _coordinates(plot, line)} for line in found]
        place = label_place(found, values.shape, taken)
        if place is not None:
            taken.append(place)
            text = {"formatter": tables.number(level, 4)}
            labels.append({"value": _coordinates(plot, place), "label": text})
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


def _coordinates(plot: curves.Map, steps: Array) -> list[Any]:
    """Return coordinates of places (..., 2) in steps of the grid."""
    start = np.array([plot.first[0], plot.second[0]])
    step = np.array([plot.first[1], plot.second[1]]) - start
    flat = (start + steps * step).ravel().tolist()
    found: list[Any] = np.array([float(f"{x:.6g}") for x in flat]).reshape(steps.shape).tolist()
    return found


def _cells(values: Array) -> dict[str, Any]:
    """Return the axis of the cells, which has no marks: they would be at odd numbers."""
    return {"type": "category", "data": [f"{x:.4g}" for x in values], "show": False}


def _coordinate(values: Array, name: str, position: str, gap: int) -> dict[str, Any]:
    """Return the axis of coordinates around the cells; its marks are at round numbers."""
    half = 0.5 * float(values[1] - values[0])
    return {
        "type": "value",
        "min": float(values[0]) - half,
        "max": float(values[-1]) + half,
        "position": position,
        "name": name,
        "nameLocation": "middle",
        "nameGap": gap,
        "splitLine": {"show": False},
        "axisLabel": {"hideOverlap": True, "showMinLabel": False, "showMaxLabel": False},
        "axisTick": {"show": True},
        "axisLine": {"show": True, "onZero": False},
    }


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
