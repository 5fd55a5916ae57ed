"""The assembly modes of the present joint values, in the panel of legs."""

from __future__ import annotations

from functools import partial

from nicegui import ui

from gsp.app.page.client import Client
from gsp.app.page.jobs import job
from gsp.app.scene.modes import Modes, modes_of, taken
from gsp.app.state.session import Session
from gsp.errors import GspError
from gsp.kinematics.modes.modes import STATUS_MEANINGS

SIGNS = {-1.0: "det J < 0", 0.0: "singular", 1.0: "det J > 0"}


def modes_section(client: Client) -> None:
    """Build the search for all assembly modes, and a button for each that is found."""
    ui.html("<h2>Assembly modes: all poses with these joint values</h2>", sanitize=False)
    note = ui.label().classes("gsp-note").props("role=status aria-live=polite")
    with ui.element("div").classes("gsp-row"):
        find = ui.button("Find all assembly modes", icon="auto_awesome_motion").props("outline")
        hide = ui.button("Hide", on_click=lambda: client.take_modes(None)).props(
            'flat aria-label="Hide the assembly modes"'
        )
    buttons = (
        ui.element("div")
        .classes("gsp-row gsp-numbers")
        .props('role=group aria-label="Assembly modes"')
    )
    drawn: list[Modes] = []
    searching: list[Session] = []

    async def search() -> None:
        state = client.state
        searching.append(state)
        find.disable()
        note.text = "processing; the first search for legs of one kind takes longer"
        try:
            found = await job(modes_of, state)
        except GspError as error:
            note.text = str(error)
            return
        finally:
            searching.clear()
            find.set_enabled(not unable(client.state))
        if found is not None and found.belong_to(client.state):
            client.take_modes(found)
        else:
            note.text = "the joints were changed meanwhile"

    def follow() -> None:
        modes = client.modes
        hide.set_visibility(modes is not None)
        if modes is None:
            note.text = unable(client.state)
        find.set_enabled(not unable(client.state) and not searching)
        if drawn != [modes]:
            buttons.clear()
            drawn[:] = [] if modes is None else [modes]
            if modes is not None:
                _choices(client, modes, buttons)
        if modes is not None:
            note.text = words(modes)
            _mark(buttons, modes.present(client.state))

    find.on_click(search)
    client.on_move(follow, "legs")


def unable(state: Session) -> str:
    """Return why the modes of a design cannot be searched for, "" where they can."""
    number = len(state.design.joint_names)
    return "" if number == 6 else f"For designs with six actuators only; this one has {number}."


def words(modes: Modes) -> str:
    """Return how many modes there are, and what their colours in the scene mean."""
    count = len(modes.sides)
    status = STATUS_MEANINGS.get(modes.status, "")
    sentence = f" {status[:1].upper()}{status[1:]}." if status else ""
    if not count:
        return f"No mode is listed.{sentence}"
    return (
        f"{count} {'mode' if count == 1 else 'modes'}.{sentence} In the scene the others are grey "
        "where det J has the sign of the present one, else purple. A choice is a jump, and no "
        "motion."
    )


def _choices(client: Client, modes: Modes, buttons: ui.element) -> None:
    def choose(number: int) -> None:
        client.change(lambda state: taken(state, modes, number))

    with buttons:
        for number, side in enumerate(modes.sides.tolist()):
            button = ui.button(str(number + 1), on_click=partial(choose, number))
            button.props(f'dense no-caps aria-label="assembly mode {number + 1}, {SIGNS[side]}"')


def _mark(buttons: ui.element, present: int | None) -> None:
    """Show which mode is the present one, for screen readers too."""
    for number, button in enumerate(buttons):
        here = number == present
        button.props(f"aria-pressed={str(here).lower()}")
        button.props(remove="outline") if here else button.props("outline")
