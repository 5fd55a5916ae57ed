"""The scene with its tools: views, what is shown, the colour, the region of positions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from nicegui import ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.jobs import job
from gsp.app.page.mechanism import SHOWN, VIEWS, MechanismView
from gsp.app.scene.region import region_of
from gsp.app.state.session import Session
from gsp.errors import GspError
from gsp.indices import INDICES

# Seconds between two looks at whether the rotation has changed: a region has some 100 kilobytes.
REGION_STEP = 0.3


def scene(client: Client, name: Callable[[], str]) -> MechanismView:
    """Build the scene and its tools.

    Parameters
    ----------
    client : Client
    name : function
        Returns the name of a file of the picture.
    """
    with ui.element("div").classes("gsp-card gsp-stage"):
        view = MechanismView(client.state, client.reading, client.colour)
    symbols = {name: index.symbol for name, index in INDICES.items() if not index.slow}
    with ui.element("div").classes("gsp-card gsp-tools"):
        for one in VIEWS:
            ui.button(one.capitalize(), on_click=lambda n=one: view.look(n)).props(
                f'flat dense aria-label="{one} view"'
            )
        boxes = {
            key: ui.checkbox(
                label, value=first, on_change=lambda event, n=key: view.show(n, event.value)
            ).props("dense size=sm")
            for key, (label, first) in SHOWN.items()
        }
        _region(client, view)
        colour = ui.select(symbols, value=client.colour_by, label="Colour of the platform")
        colour.props("dense outlined options-dense").style("min-width:10rem")
        ui.button(icon="photo_camera", on_click=lambda: view.save(name())).props(
            'flat dense aria-label="Save the picture"'
        )

    def coloured() -> None:
        client.colour_by = colour.value
        view.place(client.state, client.reading, client.colour)

    def loaded() -> None:
        boxes["ellipsoid"].set_visibility(client.state.design.ellipsoid is not None)

    colour.on_value_change(coloured)
    loaded()
    client.on_load(loaded)
    client.on_load(lambda: view.load(client.state, client.reading, client.colour))
    client.on_move(lambda: view.place(client.state, client.reading, client.colour))
    client.on_move(_modes(client, view))
    return view


def _modes(client: Client, view: MechanismView) -> Callable[[], None]:
    """Return what draws the other assembly modes where they have changed."""
    drawn: list[object] = [None, None]

    def follow() -> None:
        modes = client.modes
        now = [modes, modes.present(client.state) if modes is not None else None]
        if now != drawn:
            drawn[:] = now
            view.show_modes(client.state, modes)

    return follow


def _region(client: Client, view: MechanismView) -> None:
    """Build the box of the region of positions, which follows rotation and limits."""
    box = ui.checkbox("Workspace").props("dense size=sm")
    note = ui.label().classes("gsp-note").props("role=status aria-live=polite")
    drawn: list[Session] = []  # of which state the region is

    async def look() -> None:
        state = client.state
        if not box.value or (drawn and _same(drawn[0], state)):
            return
        drawn[:] = [state]
        try:
            found = await job(region_of, state)
        except GspError as error:
            view.show_region(None)
            note.text = str(error)
            return
        if found is not None and box.value and client.state.design is state.design:
            view.show_region(found)
            note.text = tables.volume(found, state.design.unit)

    def changed() -> None:
        drawn.clear()
        if not box.value:
            note.text = ""
            view.show_region(None)

    box.on_value_change(changed)
    client.on_load(drawn.clear)
    ui.timer(REGION_STEP, look)


def _same(one: Session, other: Session) -> bool:
    """Whether two states have the same region."""
    return one.design is other.design and bool(
        np.array_equal(one.pose.rotation, other.pose.rotation)
    )
