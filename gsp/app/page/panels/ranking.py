"""The panel of the catalogue, ranked at the present pose."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from nicegui import run, ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.state import choices, curves
from gsp.app.state.session import started
from gsp.catalogue import instantiate, mechanism
from gsp.errors import GspError
from gsp.indices import INDICES
from gsp.model.design import Design

RANKED = {name: INDICES[name].symbol for name in curves.PLOTTED if not INDICES[name].share_of}
NOT_RANKED = "Not ranked yet: 195 mechanisms on the anchor lines of the template."
# The template, which a user need not choose.
PRESENT = "the present design"
# Rows of the ranking on one page of its table.
ROWS_PER_PAGE = 12
COLUMNS = (
    {"name": "rank", "label": "Rank", "field": "rank", "sortable": True},
    {"name": "name", "label": "Mechanism", "field": "name", "sortable": True, "align": "left"},
    {"name": "group", "label": "Class", "field": "group", "sortable": True, "align": "left"},
    {"name": "value", "label": "Value", "field": "value", "sortable": True},
    {
        "name": "why",
        "label": "Note",
        "field": "why",
        "align": "left",
        "style": "white-space: normal; min-width: 8rem",
    },
)

# Heads are buttons, as cells of a head cannot have the focus; the click goes on to the cell.
HEAD = """<q-th :props="props" :aria-sort="!props.col.__thClass.includes('sorted') ? null
  : props.col.__thClass.includes('sort-desc') ? 'descending' : 'ascending'">
  <button v-if="props.col.sortable" type="button" class="gsp-sort">{{ props.col.label }}</button>
  <span v-else>{{ props.col.label }}</span>
</q-th>"""
# Rows without a value are the last ones in both directions.
SORT = """(rows, by, down) => {
  if (!by) return rows;
  const none = (row) => row[by] === null || row[by] === "";
  const order = (a, b) => (typeof a === "number" ? a - b : String(a).localeCompare(String(b)));
  const sign = down ? -1 : 1;
  return [...rows].sort((a, b) => none(a) - none(b) || (none(a) ? 0 : sign * order(a[by], b[by])));
}"""


def catalogue_panel(client: Client) -> None:
    """Build the ranking of the 195 mechanisms at the present pose; a click loads one."""
    names = [PRESENT, *choices.published_names()]
    used: list[Design] = []  # the template of the table
    with ui.element("div").classes("gsp-row"):
        index = ui.select(RANKED, value="control_number", label="Index to rank by")
        template = ui.select(names, value=PRESENT, label="Template of the anchors")
        for part in (index, template):
            part.props("dense outlined")
        button = ui.button("Rank at this pose", icon="sort")
    note = ui.label(NOT_RANKED).classes("gsp-note").props("role=status aria-live=polite")
    table = _ranking_table()
    table.set_visibility(False)

    async def rank() -> None:
        button.disable()
        try:
            name = template.value
            chosen = client.state.design if name == PRESENT else choices.named_template(name)
            found = await run.io_bound(curves.ranking, client.state, index.value, chosen) or ()
            table.columns[3]["label"] = INDICES[index.value].symbol
            used[:] = [chosen]
            table.rows = [_row(i, one) for i, one in enumerate(found, 1)]
            table.set_visibility(True)
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
    table.classes("gsp-wide gsp-ranking").props("dense flat hide-no-data binary-state-sort")
    table.props[":sort-method"] = SORT
    table.add_slot("header-cell", HEAD)
    table.add_slot(
        "body-cell-name",
        '<q-td :props="props"><q-btn flat dense no-caps color="primary" :label="props.row.name" '
        "@click=\"$parent.$emit('load', props.row.name)\" />"
        '<div v-if="props.row.why" class="gsp-under">{{ props.row.why }}</div></q-td>',
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
