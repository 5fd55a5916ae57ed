"""The scene: one custom element that draws a mechanism."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nicegui
from nicegui import ui

from gsp.app.state.drawing import drawing, placement
from gsp.app.state.reading import Reading
from gsp.app.state.session import Session

# three.js is part of NiceGUI, so nothing is loaded from elsewhere.
THREE = Path(nicegui.__file__).parent / "elements" / "scene" / "dist"
VIEWS = ("space", "plan", "front", "side")
# What can be shown, and whether it is at first.
SHOWN = {
    "numbers": ("Leg numbers", True),
    "names": ("Joint names", False),
    "axes": ("Axes", True),
    "ellipsoid": ("Operation ellipsoid", True),
    "screw": ("Screw axis", False),
}


class MechanismView(ui.element, component="mechanism.js", esm={"nicegui-scene": str(THREE)}):
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
        self.run_method("build", self._props["drawing"], self._props["place"])
        self.look(VIEWS[0])

    def place(self, state: Session, reading: Reading, colour: str) -> None:
        """Draw another pose of the same design."""
        self._keep(state, reading, colour)
        self.run_method("move", self._props["place"])

    def show(self, name: str, value: bool) -> None:
        """Show or hide one of `SHOWN`."""
        self.shown[name] = value
        self.run_method("options", self.shown)

    def look(self, view: str) -> None:
        """Look from one of `VIEWS`; the whole mechanism is in the picture."""
        self._props["view"] = view
        self.run_method("look", view)

    def save(self, name: str) -> None:
        """Let the browser save the picture as PNG."""
        self.run_method("picture", f"{name}.png")

    def _keep(self, state: Session, reading: Reading, colour: str) -> None:
        """Keep the place, for browsers that load the page again."""
        place: dict[str, Any] = placement(state, reading, colour)
        words = ", ".join(f"{x:.4g}" for x in state.pose.position)
        self._props["place"] = place
        self._props["label"] = (
            f"{state.design.name or 'design'}: platform at {words} {state.design.unit}; "
            "arrow keys turn the view, + and − zoom"
        )
