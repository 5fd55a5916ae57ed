"""One client: its state, and the parts of the page that follow it."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from dataclasses import replace

from nicegui import background_tasks, run

from gsp.app.scene.drawing import merit_colour
from gsp.app.scene.modes import Modes
from gsp.app.searches import Search, Searches
from gsp.app.state.reading import COMPILED, read
from gsp.app.state.session import Session
from gsp.determinant.maxima import known_maximum
from gsp.errors import GspError

Change = Callable[[Session], Session]


class Client:
    """The state of one open page. Parts of the page register what follows a change.

    Parameters
    ----------
    state : Session
    searches : Searches
        Those of the server.
    """

    def __init__(self, state: Session, searches: Searches) -> None:
        self.name = uuid.uuid4().hex
        self.state = state
        self._read()
        self.searches = searches
        self.search: Search | None = None
        self.colour_by = "control_number"
        self.refreshing = False
        self.panel = "motion"
        self.modes: Modes | None = None
        self._moved: list[tuple[str, Callable[[], None]]] = []
        self._loaded: list[Callable[[], None]] = []

    @property
    def behind(self) -> bool:
        """Whether slow indices can be computed since the last reading."""
        return COMPILED.is_set() and not self._complete

    def on_move(self, follow: Callable[[], None], panel: str = "") -> None:
        """Call a function after each change of the state, while a panel is shown ("": always).

        What is not shown is not sent: a step of a slider takes a few kilobytes then.
        """
        self._moved.append((panel, follow))

    def show(self, panel: str) -> None:
        """Show a panel, as the state is now."""
        self.panel = panel
        self._call([follow for name, follow in self._moved if name == panel])

    def on_load(self, follow: Callable[[], None]) -> None:
        """Call a function after another design was loaded, before those of `on_move`."""
        self._loaded.append(follow)

    @property
    def colour(self) -> str:
        """Colour of the platform, by the merit of the chosen index."""
        return merit_colour(self.reading.index(self.colour_by).gauge)

    def change(self, change: Change) -> bool:
        """Apply a change of the state; an error becomes the message and nothing else changes.

        Returns
        -------
        bool
            Whether there was no error.
        """
        if self.refreshing:  # a control was set by this page, and not by the user
            return True
        before = self.state.design
        try:
            self.state = change(self.state)
            done = True
        except GspError as error:
            self.state = self.state.saying(str(error))
            done = False
        self._follow(loaded=self.state.design is not before)
        return done

    def load(self, state: Session) -> None:
        """Take another state, of another design as a rule."""
        self.leave()
        self.state = state
        self._follow(loaded=True)

    async def look_up(self) -> None:
        """Take the maximum of |det J| if it is known without a search."""
        design = self.state.design
        try:
            found = await run.io_bound(known_maximum, design)
        except GspError:  # no domain without a home pose: `ask` states it
            return
        if found is not None and self.state.design is design:
            self.state = replace(self.state, maximum=found)
            self._follow(loaded=False)

    async def ask(self) -> None:
        """Request the maximum of |det J|; see `poll`."""
        try:
            self.search = await run.io_bound(self.searches.ask, self.state.design, self.name)
        except GspError as error:
            self.state = self.state.saying(str(error))
        self.poll()

    def poll(self) -> None:
        """Take the result of the search that was requested, if it has ended."""
        found = self.search
        if found is not None and not found.running:
            self.search = None
            if found.maximum is not None:
                self.state = replace(self.state, maximum=found.maximum, message="")
            elif found.reason:
                self.state = self.state.saying(f"maximum of |det J|: {found.reason}")
        self._follow(loaded=False)

    def stop(self) -> None:
        """Leave the search, and show that there is none."""
        self.leave()
        self.poll()

    def look_up_soon(self) -> None:
        """Start `look_up`, which does not keep the page waiting."""
        background_tasks.create(self.look_up())

    def leave(self) -> None:
        """Stop waiting for the search that was requested."""
        if self.search is not None:
            self.searches.leave(self.search, self.name)
            self.search = None

    def take_modes(self, modes: Modes | None) -> None:
        """Take the assembly modes of the present joint values, or drop them."""
        self.modes = modes
        self._follow(loaded=False)

    def _follow(self, *, loaded: bool) -> None:
        self._read()
        if self.modes is not None and not self.modes.belong_to(self.state):
            self.modes = None
        moved = [follow for name, follow in self._moved if name in ("", self.panel)]
        self._call([*self._loaded, *moved] if loaded else moved)

    def _read(self) -> None:
        self._complete = COMPILED.is_set()
        self.reading = read(self.state, slow=self._complete)

    def _call(self, functions: list[Callable[[], None]]) -> None:
        """Call functions that set controls, which counts as no change by the user."""
        self.refreshing = True
        try:
            for function in functions:
                function()
        finally:
            self.refreshing = False
