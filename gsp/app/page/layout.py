"""The page: bar, scene, facts, and the panels beside them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from nicegui import ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.dialogs import (
    configuration_dialog,
    copy,
    file_dialog,
    jacobian_dialog,
    notify,
)
from gsp.app.page.mechanism import SCENE, MechanismView
from gsp.app.page.panels.controls import legs_panel, motion_panel
from gsp.app.page.panels.indices import indices_panel
from gsp.app.page.panels.plots import plots_panel
from gsp.app.page.panels.ranking import catalogue_panel
from gsp.app.page.panels.recorded import recorded_section
from gsp.app.page.stage import scene
from gsp.app.searches import Searches
from gsp.app.state import choices, links
from gsp.app.state.session import started
from gsp.errors import GspError
from gsp.files.names import file_stem
from gsp.model.design import Design
from gsp.model.design.toml import toml_from_design

CSS = "".join(
    path.read_text(encoding="utf-8")
    for path in (Path(__file__).parent / "style.css", SCENE / "scene.css")
)
CONNECTION, SLIDERS = (
    (Path(__file__).parent / name).read_text(encoding="utf-8")
    for name in ("connection.js", "sliders.js")
)
OFFLINE = "Not connected: changes are not taken. The page connects again by itself."
# Seconds between two looks at whether the address is that of the state.
ADDRESS_STEP = 0.3
TABS = {
    "motion": "Motion",
    "legs": "Legs",
    "indices": "Indices",
    "plots": "Plots",
    "catalogue": "Catalogue",
}
# Arrow keys go through the items of a menu.
ARROWS = """(event) => {
  const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (!way) return;
  event.preventDefault();
  const items = [...event.currentTarget.querySelectorAll("[role=menuitem]")];
  const here = Math.max(items.indexOf(document.activeElement), way > 0 ? -1 : 0);
  items.at((here + way) % items.length).focus();
}"""
# Quasar puts a menu at the end of the page, beside all landmarks of screen readers: it is one.
LANDMARK = """() => requestAnimationFrame(() => {
  for (const menu of document.querySelectorAll("[id^=q-portal--menu]")) {
    menu.role = "region";
    menu.ariaLabel = "Menu";
  }
})"""

# Where the page has one column, the panel of a tab may be below the screen.
INTO_VIEW = """(event) => {
  const narrow = window.matchMedia("(max-width: 900px)").matches, tabs = event.currentTarget;
  if (!narrow || !event.target.closest("[role=tab]")) return;
  requestAnimationFrame(() => tabs.scrollIntoView({ block: "start", behavior: "smooth" }));
}"""


def build(default: Design, searches: Searches, query: Iterable[tuple[str, str]]) -> Client:
    """Build the page of one client.

    Parameters
    ----------
    default : Design
        Of links that name none.
    searches : Searches
    query : names with texts
        Of the link; what cannot be used gives a message.

    Returns
    -------
    Client
    """
    try:
        state = links.restored(links.parsed(query), default)
    except GspError as error:
        state = started(default).saying(f"the link cannot be used: {error}")
    client = Client(state, searches)
    ui.add_css(CSS)
    ui.add_body_html(
        f'<div id="gsp-offline" role="alert" data-text="{OFFLINE}" hidden></div>'
        f'<script type="module">{CONNECTION}</script><script type="module">{SLIDERS}</script>'
    )
    ui.colors(primary="#005f99")
    _bar(client)
    with ui.element("div").classes("gsp-page"):
        with ui.element("div").classes("gsp-left"):
            view = scene(client, lambda: file_stem(client.state.design.name))
            _facts(client)
        with ui.element("div").classes("gsp-card"):
            _panels(client, view)
    client.on_load(client.look_up_soon)
    client.poll()
    ui.timer(0.05, client.look_up, once=True)
    _keep_address(client)
    ui.context.client.on_delete(client.leave)
    return client


def _keep_address(client: Client) -> None:
    """Keep the link to the state in the address: a page that is loaded again has its state.

    Pages are loaded again by their users, and by themselves after a restart of the server.
    """
    address = links.Address(client.state)

    def look() -> None:
        if query := address.due(client.state):
            ui.navigate.history.replace(f"/?{query}")

    ui.timer(ADDRESS_STEP, look)


def _link(client: Client) -> str:
    """Return the query of a link to the state; "" with a message where no link holds it."""
    try:
        return links.query(client.state)
    except GspError as error:
        notify(str(error), warning=True)
        return ""


def _bar(client: Client) -> None:
    configuration, jacobian = configuration_dialog(client), jacobian_dialog(client)

    def report() -> None:
        if query := _link(client):
            ui.navigate.to(f"/report?{query}", new_tab=True)

    with ui.element("header").classes("gsp-bar"):
        ui.html("<h1>gsp · platform analysis</h1>", sanitize=False)
        chosen = ui.select(
            list(choices.names()),
            label="Design or mechanism",
            with_input=True,
            on_change=lambda event: choose(event.value),
        ).props(
            'dense dark outlined options-dense hide-bottom-space aria-label="Design or mechanism"'
        )
        for text, icon, call in (
            ("Configuration", "tune", configuration.open),
            ("Jacobian matrix", "grid_on", jacobian.open),
            ("Report", "description", report),
        ):
            ui.button(text, icon=icon, on_click=call).props("flat text-color=white dense")
        _file_menu(client)

    def choose(name: str | None) -> None:
        if name and not client.refreshing:
            try:
                client.load(started(choices.named(name)))
            except GspError as error:
                notify(str(error), warning=True)

    def follow() -> None:
        name = client.state.design.name
        if name in choices.names():
            chosen.set_options(list(choices.names()), value=name)
        else:
            own = choices.shortened(name or "own design")
            chosen.set_options([own, *choices.names()], value=own)

    client.on_load(follow)
    client.refreshing = True
    follow()
    client.refreshing = False


def _file_menu(client: Client) -> None:
    """Build the menu of files, links and pictures."""

    def opened(text: str, name: str) -> None:
        client.load(started(choices.from_file(text, name)))

    def saved() -> None:
        text = toml_from_design(client.state.design.replace(home=client.state.pose))
        ui.download.content(text, f"{file_stem(client.state.design.name)}.toml", "application/toml")

    async def link() -> None:
        if query := _link(client):
            origin = await ui.run_javascript("window.location.origin")
            await copy(f"{origin}/?{query}", "The link to this state was copied")

    dialog = file_dialog("Open a design file", "Design file", ".toml", choices.LARGEST_FILE, opened)
    with (
        ui.button("File", icon="folder").props("flat text-color=white dense") as button,
        ui.menu().on("keydown", js_handler=ARROWS).on("before-show", js_handler=LANDMARK),
    ):
        for text, call in (
            ("Open a design file …", dialog.open),
            ("Save the design, with this pose", saved),
            ("Copy a link to this state", link),
        ):
            ui.menu_item(text, call).props("role=menuitem")
    # The item that opened the dialog had the focus, and is gone.
    dialog.on("hide", js_handler=f"() => document.getElementById('{button.html_id}').focus()")


def _facts(client: Client) -> None:
    with ui.element("div").classes("gsp-card"):
        shown = ui.html("", sanitize=False).classes("gsp-wide")
    message = ui.label().classes("gsp-message").props("role=status aria-live=polite")

    def follow() -> None:
        shown.content = tables.facts(client.state, client.reading)
        message.text = client.state.message

    client.on_move(follow)


def _panels(client: Client, view: MechanismView) -> None:
    tabs = ui.tabs().classes("gsp-tabs").mark("panels")
    tabs.on("click", js_handler=INTO_VIEW)
    with tabs.props('dense align=left mobile-arrows aria-label="Panels"'):
        for name, label in TABS.items():
            ui.tab(name, label)
    with ui.tab_panels(tabs, value="motion", animated=False).classes("gsp-wide"):
        for name, panel in (
            ("motion", lambda client: _motion(client, view)),
            ("legs", _legs),
            ("indices", indices_panel),
            ("plots", plots_panel),
            ("catalogue", catalogue_panel),
        ):
            with ui.tab_panel(name), ui.element("div").classes("gsp-panel"):
                panel(client)
    tabs.on_value_change(lambda event: client.show(event.value))


def _motion(client: Client, view: MechanismView) -> None:
    motion_panel(client)
    recorded_section(client, view, lambda: file_stem(client.state.design.name))


def _legs(client: Client) -> None:
    legs_panel(client)
    ui.html("<h2>Joints and what is left of their strokes</h2>", sanitize=False)
    shown = ui.html("", sanitize=False).classes("gsp-wide")

    def follow() -> None:
        shown.content = tables.limits(client.reading.joints)

    client.on_move(follow, "legs")
