"""The scene: one custom element that draws a mechanism."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nicegui
from nicegui import ui

from gsp.app.page.fields import resolved
from gsp.app.scene.drawing import drawing, placement
from gsp.app.scene.modes import Modes, ghosts
from gsp.app.scene.region import Surface
from gsp.app.state.reading import Reading
from gsp.app.state.session import Session

# three.js is part of NiceGUI, so nothing is loaded from elsewhere.
THREE = Path(nicegui.__file__).parent / "elements" / "scene" / "dist"
SCENE = Path(__file__).parents[1] / "scene" / "web"
# Seconds that a browser has for a film; frames of a GIF take it some 50 ms each.
SECONDS_FOR_FILM = 120.0
VIEWS = ("space", "plan", "front", "side")
# What can be shown, and whether it is at first.
SHOWN = {
    "numbers": ("Leg numbers", True),
    "names": ("Joint names", False),
    "axes": ("Axes", True),
    "ellipsoid": ("Operation ellipsoid", True),
    "screw": ("Screw axis", False),
}


class MechanismView(
    ui.element,
    component="mechanism.js",
    esm={"nicegui-scene": str(THREE), "gsp-scene": str(SCENE)},
):
    """A mechanism in space. The design is sent once, some sixty numbers at each pose.

    Parameters
    ----------
    state : Session
    reading : Reading
    colour : str
        Of the platform.
    """

    def __init__(self, state: Session, reading: Reading, colour: str) -> None:
        super().__init__()
        self.shown = {name: first for name, (_, first) in SHOWN.items()}
        self._props["shown"] = self.shown
        self._props["view"] = VIEWS[0]
        self._keep(state, reading, colour)
        self._props["drawing"] = drawing(state)

    def load(self, state: Session, reading: Reading, colour: str) -> None:
        """Draw another design."""
        self._keep(state, reading, colour)
        self._props["drawing"] = drawing(state)
        self._call("build", self._props["drawing"], self._props["place"])
        self.look(VIEWS[0])

    def place(self, state: Session, reading: Reading, colour: str) -> None:
        """Draw another pose of the same design."""
        self._keep(state, reading, colour)
        self._call("move", self._props["place"])

    def show(self, name: str, value: bool) -> None:
        """Show or hide one of `SHOWN`."""
        self.shown[name] = value
        self._call("options", self.shown)

    def look(self, view: str) -> None:
        """Look from one of `VIEWS`; the whole mechanism is in the picture."""
        self._props["view"] = view
        self._call("look", view)

    def show_modes(self, state: Session, modes: Modes | None) -> None:
        """Draw the assembly modes besides the present one; None removes them."""
        self._call("ghosts", [] if modes is None else ghosts(state, modes))

    def show_region(self, surface: Surface | None) -> None:
        """Draw a region of positions; None removes it."""
        self._call("reach", None if surface is None else surface.numbers())

    async def film(self, kind: str, places: list[dict[str, Any]], seconds: float, name: str) -> str:
        """Let the browser save a motion as "gif" or "video"; return why it could not, or ""."""
        try:
            reason = await self.run_method(
                "film", kind, places, seconds, name, timeout=SECONDS_FOR_FILM
            )
        except TimeoutError:
            return "the browser did not finish the film; pages that are not in view hardly work"
        return str(reason)

    def save(self, name: str) -> None:
        """Let the browser save the picture as PNG."""
        self._call("picture", f"{name}.png")

    def _call(self, name: str, *words: Any) -> None:
        self.run_method("call", name, *words)

    def _keep(self, state: Session, reading: Reading, colour: str) -> None:
        """Keep the place, for browsers that load the page again."""
        place: dict[str, Any] = placement(state, reading, colour)
        words = ", ".join(f"{resolved(x, state.size):.4g}" for x in state.pose.position.tolist())
        unit = f" {state.design.unit}" if state.design.unit else ""
        self._props["place"] = place
        self._props["label"] = (
            f"{state.design.name or 'design'}: platform at {words}{unit}; "
            "arrow keys turn the view, + and − zoom"
        )
