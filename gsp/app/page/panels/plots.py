"""The panel of plots, and that of the catalogue ranked at the present pose."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from nicegui import run, ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.panels.contours import contour, label_place, round_levels
from gsp.app.state import choices, curves
from gsp.app.state.session import started
from gsp.catalogue import design_names, instantiate, mechanism
from gsp.errors import GspError
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.model.design import Design

SYMBOLS = {name: INDICES[name].symbol for name in curves.PLOTTED}
RANKED = {name: symbol for name, symbol in SYMBOLS.items() if not INDICES[name].share_of}
BLUE, VERMILION, INK = "#0072B2", "#D55E00", "#1F2933"
# The template, which a user need not choose.
PRESENT = "the present design"
# Rows of the ranking on one page of its table.
ROWS_PER_PAGE = 12
COLUMNS = (
    {"name": "rank", "label": "Rank", "field": "rank", "sortable": True},
    {"name": "name", "label": "Mechanism", "field": "name", "sortable": True, "align": "left"},
    {"name": "group", "label": "Class", "field": "group", "sortable": True, "align": "left"},
    {"name": "value", "label": "Value", "field": "value", "sortable": True},
    {"name": "why", "label": "Note", "field": "why", "align": "left"},
)


def plots_panel(client: Client) -> None:
    """Build the panel of plots."""
    with ui.element("div").classes("gsp-row"):
        index = ui.select(SYMBOLS, value="control_number", label="Index to plot")
        motion = ui.select(list(curves.MOTIONS), value="z", label="Motion")
        plane = ui.select(list(curves.PLANES), value="xy", label="Plane of the map")
        for part in (index, motion, plane):
            part.props("dense outlined")
    note = ui.label().classes("gsp-note").props("role=status")
    line = ui.echart(_no_plot()).classes("gsp-plot").props('role=img aria-label="index along"')
    field = ui.echart(_no_plot()).classes("gsp-plot").props('role=img aria-label="index over"')

    def draw() -> None:
        try:
            curve = curves.curve(client.state, index.value, motion.value)
            plot = curves.map_over(client.state, index.value, plane.value)
        except GspError as error:
            note.text = str(error)
            return
        note.text = "Orange: the present pose. The map has the present rotation."
        _set(line, curve_options(curve))
        _set(field, map_options(plot))

    for part in (index, motion, plane):
        part.on_value_change(draw)
    client.on_move(draw, "plots")


def curve_options(curve: curves.Curve) -> dict[str, Any]:
    """Return the plot of an index along a motion, with a line at the present pose."""
    points = [[float(x), y] for x, y in zip(curve.places, _finite(curve.values), strict=True)]
    return {
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
        "animation": False,
        "grid": {"left": 64, "right": 88, "top": 16, "bottom": 44},
        "tooltip": {},
        "xAxis": [_categories(plot.first, plot.axes[0], 28), _steps(size)],
        "yAxis": [_categories(plot.second, plot.axes[1], 44), _steps(size)],
        "visualMap": {
            "seriesIndex": 0,
            "min": low,
            "max": high if high > low else low + 1.0,
            "right": 0,
            "top": "middle",
            "calculable": False,
            "text": [plot.index.symbol, ""],
            "precision": 3,
            "inRange": {"color": good},
        },
        "series": [
            {"type": "heatmap", "data": data},
            *_contours(plot.values, round_levels(low, high)),
            {
                "type": "scatter",
                "data": [[middle, middle, float(known.mean())]],
                "symbol": "circle",
                "symbolSize": 12,
                "itemStyle": {"color": "#FFFFFF", "borderColor": VERMILION, "borderWidth": 3},
            },
        ],
    }


def _contours(values: Array, levels: list[float]) -> list[dict[str, Any]]:
    """Return the series of contour lines, and that of their labels."""
    lines: list[dict[str, Any]] = []
    labels: list[dict[str, Any]] = []
    taken = [0.5 * (np.array(values.shape) - 1.0)]  # the present pose
    for level in levels:
        found = contour(values, level)
        lines += [{"coords": line.round(3).tolist()} for line in found]
        place = label_place(found, values.shape, taken)
        if place is not None:
            taken.append(place)
            text = {"formatter": tables.number(level, 4)}
            labels.append({"value": place.round(3).tolist(), "label": text})
    axes = {"xAxisIndex": 1, "yAxisIndex": 1, "silent": True}
    written = {"show": True, "position": "inside", "fontSize": 11, "color": INK}
    written |= {"textBorderColor": "#FFFFFF", "textBorderWidth": 2}
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


def _steps(size: int) -> dict[str, Any]:
    """Return an axis in steps of the grid, as categories have no places between them."""
    return {"type": "value", "min": -0.5, "max": size - 0.5, "show": False}


def _categories(values: Array, name: str, gap: int) -> dict[str, Any]:
    return {
        "type": "category",
        "data": [f"{x:.3g}" for x in values],
        "name": name,
        "nameLocation": "middle",
        "nameGap": gap,
        "axisLabel": {"interval": 4},
    }


def _finite(values: Array) -> list[float | None]:
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in values]


def _no_plot() -> dict[str, Any]:
    return {"series": []}


def _set(chart: ui.echart, options: dict[str, Any]) -> None:
    chart.options.clear()
    chart.options.update(options)
    chart.update()


def catalogue_panel(client: Client) -> None:
    """Build the ranking of the 195 mechanisms at the present pose; a click loads one."""
    names = [PRESENT, *design_names()]
    used: list[Design] = []  # the template of the table
    with ui.element("div").classes("gsp-row"):
        index = ui.select(RANKED, value="control_number", label="Index to rank by")
        template = ui.select(names, value=PRESENT, label="Template of the anchors")
        for part in (index, template):
            part.props("dense outlined")
        button = ui.button("Rank at this pose", icon="sort")
    note = ui.label("195 mechanisms on the anchor lines of the template.").classes("gsp-note")
    table = _ranking_table()

    async def rank() -> None:
        button.disable()
        try:
            name = template.value
            chosen = client.state.design if name == PRESENT else choices.named_template(name)
            found = await run.io_bound(curves.ranking, client.state, index.value, chosen) or ()
            table.columns[3]["label"] = INDICES[index.value].symbol
            used[:] = [chosen]
            table.rows = [_row(i, one) for i, one in enumerate(found, 1)]
            note.text = f"Ranked at the present pose, best first; length {_length(client)}."
            without = [one.reason for one in found if np.isnan(one.value)]
            if without:
                note.text += f" {len(without)} have no value: {max(without, key=without.count)}."
        except GspError as error:
            note.text = str(error)
        finally:
            button.enable()

    def load(name: str) -> None:
        if used:
            length = client.state.length
            design = instantiate(mechanism(name), used[0])
            client.load(replace(started(design, client.state.pose), length=length))

    button.on_click(rank)
    table.on("load", lambda event: load(str(event.args)))


def _ranking_table() -> ui.table:
    """Return an empty table of mechanisms, of which a click on a name emits "load"."""
    columns: list[dict[str, Any]] = [dict(column) for column in COLUMNS]
    table = ui.table(columns=columns, rows=[], row_key="name", pagination=ROWS_PER_PAGE)
    table.classes("gsp-wide").props("dense flat")
    table.add_slot(
        "body-cell-name",
        '<q-td :props="props"><q-btn flat dense no-caps color="primary" :label="props.row.name" '
        "@click=\"$parent.$emit('load', props.row.name)\" /></q-td>",
    )
    return table


def _row(rank: int, one: curves.Ranked) -> dict[str, Any]:
    return {
        "rank": None if np.isnan(one.value) else rank,
        "name": one.name,
        "group": one.group,
        "value": float(f"{one.value:.5g}") if np.isfinite(one.value) else None,
        "why": one.reason,
    }


def _length(client: Client) -> str:
    length = client.state.length
    return "none" if length is None else tables.number(length)
