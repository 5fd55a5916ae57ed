"""The dialogs: configuration (figure 41 of the dissertation) and Jacobian (figure 42)."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from html import escape
from typing import Any

from nicegui import events, ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.fields import NumberField
from gsp.app.state import choices, matrices
from gsp.app.state.session import entered, started
from gsp.errors import GspError
from gsp.families.circular import hexapod
from gsp.model.design import Design

# Browsers offer `navigator.clipboard` to pages of the same machine and by https alone, so a page of
# another machine copies from a field. A field outside of a dialog would not get the focus.
COPY = """async (text) => {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const had = document.activeElement, field = document.createElement("textarea");
    field.value = text;
    field.style = "position: fixed; top: 0; opacity: 0";
    (had?.parentElement ?? document.body).append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    had?.focus({ preventScroll: true });
    return done;
  }
}"""
SECONDS_TO_COPY = 5.0


def notify(text: str, *, warning: bool = False) -> None:
    """Show a note for some seconds, at the top: below it would cover buttons of tall dialogs."""
    ui.notify(text, type="warning" if warning else None, position="top", multi_line=True)


def named_dialog(name: str) -> ui.dialog:
    """Return a dialog that screen readers announce by its name."""
    return ui.dialog().props(f'aria-label="{name}"')


def file_dialog(
    name: str,
    label: str,
    ending: str,
    letters: int,
    read: Callable[[str, str], None],
    note: str = "",
) -> ui.dialog:
    """Build a dialog that takes the text of a file; what cannot be read gives a message.

    Parameters
    ----------
    name, label, note : str
        Of the dialog and of its field; what is said above the field.
    ending : str
        Of the names of files, such as ".toml".
    letters : int
        Most letters of a file; a letter has up to four bytes.
    read : function (text, name of the file)
        May raise GspError; otherwise the dialog closes.
    """
    most = 4 * letters

    async def uploaded(event: events.UploadEventArguments) -> None:
        try:
            read((await event.file.read()).decode("utf-8-sig"), event.file.name)
            dialog.close()
        except UnicodeDecodeError:
            notify(f"{event.file.name}: expected text in UTF-8", warning=True)
        except GspError as error:
            notify(str(error), warning=True)

    def rejected() -> None:
        notify(f"file: expected one ending in {ending}, of at most {most:,} bytes", warning=True)

    with named_dialog(name) as dialog, ui.card().classes("gsp-dialog"):
        ui.html(f"<h2>{name}</h2>", sanitize=False)
        if note:
            ui.label(note).classes("gsp-note")
        ui.upload(
            label=f"{label} ({ending})",
            auto_upload=True,
            max_file_size=most,
            on_upload=uploaded,
            on_rejected=rejected,
        ).props(f'accept="{ending}"').classes("gsp-wide")
        ui.button("Cancel", on_click=dialog.close).props("flat")
    return dialog


def configuration_dialog(client: Client) -> ui.dialog:
    """Build the dialog of platforms by their dimensions: Lee's families, and hexapods."""
    with named_dialog("Configuration") as dialog, ui.card().classes("gsp-dialog"):
        ui.html("<h2>Configuration</h2>", sanitize=False)
        families = (
            ("lee", "Triangles and hexagons", _lee),
            ("hexapod", "Hexapod on circles", _hexapod),
        )
        with ui.tabs().props('dense align=left no-caps aria-label="Families"') as tabs:
            for name, label, _ in families:
                ui.tab(name, label)
        with ui.tab_panels(tabs, value="lee").classes("gsp-wide"):
            for name, _, build in families:
                with ui.tab_panel(name):
                    build(client, dialog)
    return dialog


def _lee(client: Client, dialog: ui.dialog) -> None:
    ui.label(choices.SIZES).classes("gsp-note")
    with ui.element("div").classes("gsp-halves"):
        halves = {
            "Top": _half("Top", choices.TOP_SIZE),
            "Base": _half("Base", choices.BASE_SIZE),
        }

    def make() -> Design:
        top, base = (
            choices.Half(
                kind=kind.value,
                size=entered(f"{title} size", size.text),
                separation=way.value,
                percent=_percent(title, percent) if kind.value == choices.HEXAGON else 0.0,
            )
            for title, (kind, size, way, percent) in halves.items()
        )
        return choices.configured(top, base)

    _buttons(client, dialog, make, "platform")(part for half in halves.values() for part in half)


def _percent(title: str, field: NumberField) -> float:
    return entered(f"{title} separation [%]", field.text)


def _half(title: str, size: float) -> tuple[ui.select, NumberField, ui.select, NumberField]:
    with ui.column().classes("gsp-wide").style("gap:.4rem"):
        ui.html(f"<h3 style='font-size:1rem;margin:0'>{title}</h3>", sanitize=False)
        kind = ui.select(list(choices.TYPES), label=f"{title} type", value=choices.TRIANGLE)
        side = NumberField(f"{title} size", value=size)
        way = ui.select(
            list(choices.SEPARATIONS), label=f"{title} joint separation", value=choices.EDGES
        )
        percent = NumberField(f"{title} separation [%]", value=0.0)
        for part in (kind, side.part, way, percent.part):
            part.props("dense outlined").classes("gsp-wide")
        for part in (way, percent.part):
            part.bind_enabled_from(kind, "value", lambda value: value == choices.HEXAGON)
    return kind, side, way, percent


# Fields of a hexapod: name, label, first value.
HEXAPOD = (
    ("base_radius", "Base radius", 2.0),
    ("base_angle", "Base pair angle [°]", 20.0),
    ("platform_radius", "Platform radius", 1.0),
    ("platform_angle", "Platform pair angle [°]", 20.0),
    ("height", "Height", 1.5),
)


def _hexapod(client: Client, dialog: ui.dialog) -> None:
    with ui.element("div").classes("gsp-halves"):
        fields = {name: (label, NumberField(label, value=value)) for name, label, value in HEXAPOD}
        kind = ui.select(["pairs", "zigzag"], label="Arrangement", value="pairs").props(
            "dense outlined"
        )

    def make() -> Design:
        numbers: dict[str, Any] = {
            name: entered(label, field.text) for name, (label, field) in fields.items()
        }
        return hexapod(**numbers, arrangement=kind.value, degrees=True)

    _buttons(client, dialog, make, "hexapod")([kind, *(field for _, field in fields.values())])


def _buttons(
    client: Client, dialog: ui.dialog, make: Callable[[], Design], what: str
) -> Callable[[Iterable[NumberField | ui.select]], None]:
    """Build OK and Cancel; a design that there is not gives a message and changes nothing.

    Returns
    -------
    function of fields
        Makes the message follow them: it states what is wrong now, or nothing.
    """
    message = ui.label().classes("gsp-message").props("role=alert")

    def made() -> Design | None:
        try:
            design = make()
        except GspError as error:
            message.text = str(error)
            return None
        message.text = ""
        return design

    def accept() -> None:
        design = made()
        if design is not None:
            client.load(started(design))
            dialog.close()

    def look() -> None:
        if message.text:
            made()

    def clear() -> None:
        message.text = ""

    def follow(fields: Iterable[NumberField | ui.select]) -> None:
        for field in fields:
            part = field.part if isinstance(field, NumberField) else field
            part.on_value_change(look)

    dialog.on_value_change(clear)
    with ui.row().classes("gsp-end"):
        ui.button("Cancel", on_click=dialog.close).props("flat")
        ui.button("OK", on_click=accept).props(f'aria-label="OK: this {what}"')
    return follow


def jacobian_dialog(client: Client) -> ui.dialog:
    """Build the dialog of the Jacobian: its forms, det J, the indices, and texts to copy."""
    words = {
        matrices.PLAIN: "Rows, in the unit of the design",
        matrices.HOMOGENEOUS: "Rows, homogeneous",
        matrices.LINES: "Lines as columns (Lee)",
    }
    with named_dialog("Jacobian matrix") as dialog, ui.card().classes("gsp-dialog"):
        ui.html("<h2>Jacobian matrix</h2>", sanitize=False)
        form = ui.select(words, value=matrices.PLAIN, label="Form").props("dense outlined")
        form.classes("gsp-wide")
        table = ui.html("", sanitize=False).classes("gsp-matrix gsp-wide")
        table.props('tabindex=0 role=region aria-label="Entries of the matrix"')
        facts = ui.html("", sanitize=False).classes("gsp-wide")
        shown = ui.html("", sanitize=False).classes("gsp-scroll")
        shown.props('tabindex=0 role=region aria-label="Indices"')
        with ui.row():
            for kind in matrices.FORMATS:
                ui.button(f"Copy as {kind}", on_click=lambda k=kind: copied(k)).props("outline")
            ui.button("Close", on_click=dialog.close)

    async def copied(kind: str) -> None:
        try:
            text = matrices.as_text(client.state, form.value, kind)
        except GspError as error:
            notify(str(error), warning=True)
            return
        await copy(text, f"Copied as {kind}")

    def follow() -> None:
        if not dialog.value:
            return
        state, reading = client.state, client.reading
        try:
            values = matrices.matrix(state, form.value)
            table.content = tables.matrix(values, state, form.value)
        except GspError as error:
            table.content = f'<p class="gsp-note">{escape(str(error))}</p>'
        facts.content = tables.facts(state, reading)
        shown.content = tables.indices(reading.indices)

    form.on_value_change(follow)
    dialog.on_value_change(follow)
    client.on_move(follow)
    return dialog


async def copy(text: str, said: str) -> None:
    """Copy a text, and notify that it was copied (`said`), or was not."""
    try:
        done = await ui.run_javascript(f"({COPY})({json.dumps(text)})", timeout=SECONDS_TO_COPY)
    except TimeoutError:
        done = False
    if done:
        notify(said)
    else:
        notify("The browser did not copy the text", warning=True)
