"""The panel of the indices, with their length, and the search for the maximum of |det J|."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.fields import NumberField
from gsp.app.state import session as sessions
from gsp.app.state.session import entered_or_none

# Seconds between two looks at a search.
POLL = 0.3


def indices_panel(client: Client) -> None:
    """Build the table of the indices, the length that they need, and the maximum of |det J|."""
    shown = ui.html("", sanitize=False).classes("gsp-scroll")
    shown.props('tabindex=0 role=region aria-label="Table of the indices"')
    length = NumberField(
        "Characteristic length",
        lambda text: client.change(
            lambda s: sessions.with_length(s, entered_or_none("characteristic length", text))
        ),
        props="clearable",
    )
    follow_maximum = _maximum(client)

    def follow() -> None:
        shown.content = tables.indices(client.reading.indices)
        length.show(client.state.length)
        follow_maximum()

    client.on_move(follow, "indices")


def _maximum(client: Client) -> Callable[[], None]:
    """Build "Get maximum" with its progress; return the function that shows its state."""
    ui.html("<h2>Maximum of |det J|</h2>", sanitize=False)
    text = ui.label().classes("gsp-note").props("role=status aria-live=polite")
    bar = ui.linear_progress(0.0, show_value=False).props('aria-label="progress of the search"')
    with ui.element("div").classes("gsp-row"):
        ask = ui.button("Get maximum", on_click=client.ask)
        stop = ui.button("Stop", on_click=client.stop).props("outline")

    def follow() -> None:
        search, found = client.search, client.state.maximum
        bar.set_visibility(search is not None)
        stop.set_visibility(search is not None)
        ask.set_visibility(search is None and found is None)
        if search is not None:
            bar.value = search.done / search.total if search.total else 0.0
            text.text = f"{search.status}: {search.done} of {search.total or '…'} rounds"
        elif found is not None:
            text.text = tables.maximum(found, client.reading.index("manipulability").unit)
        else:
            text.text = "not known yet; λ needs it"

    # A look at the search changes nothing else, so the rest of the page is not sent again.
    def look() -> None:
        if client.search is not None:
            if client.search.running:
                follow()
            else:
                client.poll()
        elif client.behind:
            client.poll()

    ui.timer(POLL, look)
    return follow
