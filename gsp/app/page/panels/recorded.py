"""A recorded motion, in the panel of motions: record, play, files, film."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from nicegui import ui

from gsp.app.page.client import Client
from gsp.app.page.dialogs import file_dialog
from gsp.app.page.mechanism import MechanismView
from gsp.app.scene.drawing import film as frames
from gsp.app.state.recording import LARGEST_TABLE, Recording, from_table

# Seconds between two frames that are played.
PLAY_STEP = 0.05
MAKING = "processing: the browser makes the film; keep this page in view until it is saved"
IDLE, RECORDING, PLAYING = "", "recording", "playing"


def recorded_section(client: Client, view: MechanismView, name: Callable[[], str]) -> None:
    """Build the buttons of a recorded motion; the scene makes the films.

    Parameters
    ----------
    client : Client
    view : MechanismView
    name : function
        Returns the name of files.
    """
    deck = Deck(client)
    ui.html("<h2>Recorded motion</h2>", sanitize=False)
    with ui.element("div").classes("gsp-row gsp-icons"):
        record = _button("Record a motion", deck.record)
        play = _button("Play the motion", deck.play)
        place = ui.slider(min=0.0, max=1.0, step=0.01, value=0.0).props(
            'aria-label="time of the motion"'
        )
    with ui.element("div").classes("gsp-row gsp-icons"):
        saves = _saves(deck, view, name)
        _button("Open a motion from a table", _dialog(client, deck.take).open, "Open …")
    note = ui.label().classes("gsp-note").props("role=status aria-live=polite")

    def show() -> None:
        for part in (play, place, *saves):
            part.set_enabled(len(deck.motion.times) > 1 and deck.doing != RECORDING)
        record.set_enabled(deck.doing != PLAYING)
        _switch(record, "stop" if deck.doing == RECORDING else "fiber_manual_record")
        _switch(play, "pause" if deck.doing == PLAYING else "play_arrow")
        note.text = deck.note or deck.words()
        was, client.refreshing = client.refreshing, True
        place.value = deck.share
        client.refreshing = was

    place.on_value_change(lambda event: deck.scrub(event.value))
    deck.show = show
    ui.timer(PLAY_STEP, deck.step)
    client.on_load(deck.follow)
    client.on_move(deck.sample)
    show()


class Deck:
    """A motion of a client, and what is done with it: it is recorded, played, or none of both."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.motion = Recording(design=client.state.design)
        self.doing, self.note = IDLE, ""
        self.since = self.at = 0.0
        self.show: Callable[[], None] = lambda: None

    @property
    def share(self) -> float:
        """Which share of the motion is over."""
        return self.at / self.motion.seconds if self.motion.seconds else 0.0

    def words(self) -> str:
        """Return what is done, or what the motion is."""
        if self.doing == RECORDING:
            return "recording: move the platform, then stop"
        if len(self.motion.times) < 2:
            return "no motion yet: record one, or open a table"
        return f"{len(self.motion.times)} samples in {self.motion.seconds:.3g} s"

    def follow(self) -> None:
        """Take the design of the client: one with other limits alone keeps the motion."""
        design = self.client.state.design
        if self.motion.moves(design):
            self.motion = replace(self.motion, design=design)
        else:
            self.take(Recording(design=design), go=False)

    def take(self, motion: Recording, go: bool = True) -> None:
        """Take another motion, and go to its first pose."""
        self.motion, self.doing, self.at, self.note = motion, IDLE, 0.0, ""
        if go:
            self._go(0.0)
        self.show()

    def record(self) -> None:
        """Begin a new motion, or end it."""
        if self.doing == RECORDING:
            self.sample()
            self.doing = IDLE
        else:
            state = self.client.state
            self.motion = Recording(design=state.design).with_sample(0.0, state.pose)
            self.doing, self.since, self.at, self.note = RECORDING, time.monotonic(), 0.0, ""
        self.show()

    def sample(self) -> None:
        """Take the present pose, while a motion is recorded."""
        if self.doing == RECORDING:
            now = time.monotonic() - self.since
            self.motion = self.motion.with_sample(now, self.client.state.pose)

    def play(self) -> None:
        """Play the motion from where it is, or stop it there."""
        if self.doing == PLAYING:
            self.doing = IDLE
        elif self.motion.seconds:
            start = self.at if self.at < self.motion.seconds else 0.0
            self.doing, self.since = PLAYING, time.monotonic() - start
        self.show()

    def step(self) -> None:
        """Go to where the motion is by now, while it is played."""
        if self.doing == PLAYING:
            self._go(time.monotonic() - self.since)
            if self.at >= self.motion.seconds:
                self.doing = IDLE
            self.show()

    def scrub(self, share: float) -> None:
        """Go to a share of the motion that the user chose."""
        if not self.client.refreshing and self.motion.seconds:
            self.doing = IDLE
            self._go(share * self.motion.seconds)
            self.show()

    def _go(self, at: float) -> None:
        self.at = min(at, self.motion.seconds)
        pose = self.motion.pose(self.at)
        self.client.change(lambda state: replace(state, pose=pose, message=""))


def _saves(deck: Deck, view: MechanismView, name: Callable[[], str]) -> list[ui.button]:
    """Build the buttons that save a motion."""

    async def film(kind: str) -> None:
        places = frames(deck.client.state, deck.motion.frames(), deck.client.colour_by)
        deck.note = MAKING
        deck.show()
        reason = await view.film(kind, places, deck.motion.seconds, name())
        deck.note = reason or f"{len(places)} frames were saved"
        deck.show()

    def table() -> None:
        ui.download.content(deck.motion.table(), f"{name()}-motion.csv", "text/csv")

    return [
        _button("Save the motion as GIF", partial(film, "gif"), "GIF"),
        _button("Save the motion as video", partial(film, "video"), "Video"),
        _button("Save the motion as a table", table, "Table"),
    ]


def _dialog(client: Client, opened: Callable[[Recording], None]) -> ui.dialog:
    """Build the dialog of motions from tables."""
    return file_dialog(
        "Open a motion", "Motion", ".csv", LARGEST_TABLE,
        lambda text, name: opened(from_table(client.state, text, name)),
        "A table with the columns x, y, z, angle_1, angle_2, angle_3 (roll, pitch, yaw in "
        "degrees), or with the joints of the design (angles in radians); and time, if it is not "
        "every 0.1 s.",
    )  # fmt: skip


def _button(name: str, call: Callable[[], object], text: str = "") -> ui.button:
    return ui.button(text, on_click=call).props(f'outline dense aria-label="{name}"')


def _switch(button: ui.button, icon: str) -> None:
    """Show what a button does next, and whether it is doing it, for screen readers too."""
    pressed = "true" if icon in ("stop", "pause") else "false"
    button.props(f"icon={icon} aria-pressed={pressed}")
