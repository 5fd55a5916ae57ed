"""Sliders, buttons and fields of the pose, and of the joints with their limits."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from nicegui import ui

from gsp.app.page import tables
from gsp.app.page.client import Client
from gsp.app.page.fields import NumberField, resolved
from gsp.app.page.panels.modes import modes_section
from gsp.app.state import motion
from gsp.app.state import session as sessions
from gsp.app.state.motion import COORDINATES, coordinates
from gsp.app.state.reading import JointReading
from gsp.app.state.session import entered, entered_or_none

# Names for screen readers.
NAMES = ("position x", "position y", "position z", "roll", "pitch", "yaw")
# Reach of sliders to either side, in sizes of the design and degrees; pitch has its own.
SLIDER_REACH, SLIDER_REACH_DEG, PITCH_DEG = 1.5, 180.0, 89.0
# Steps of a slider over its range, at least; a step is rounded to a power of ten.
SLIDER_STEPS = 600
# Notes on values that a slider does not reach, and the share of its range that is rounding.
BELOW, ABOVE, SLIDER_ROUNDING = "◂ below the slider", "above the slider ▸", 1e-9
# Reach of the slider of a distance to either side of its first value, in sizes of the design.
JOINT_REACH = 0.6


class Row:
    """A coordinate or a joint: a button, a slider, a button and a field.

    Parameters
    ----------
    label, name : str
        What is printed, and what screen readers say.
    set_value : function of a float
        Called with the value of the slider.
    enter : function of a str
        Called with the entry of the field.
    nudge : function of 1 or −1
        Called by the buttons.
    """

    def __init__(
        self,
        label: str,
        name: str,
        set_value: Callable[[float], object],
        enter: Callable[[str], object],
        nudge: Callable[[int], object],
    ) -> None:
        self._set = set_value
        with ui.element("div").classes("gsp-control"):
            ui.label(label)
            self._button("remove", f"{name} minus", partial(nudge, -1))
            self.slider = ui.slider(
                min=0.0, max=1.0, step=0.001, on_change=lambda e: self._changed(e.value)
            ).props(f'aria-label="{name}"')
            for key, end in (("home", "min"), ("end", "max")):
                self.slider.on(f"keydown.{key}.prevent", partial(self._go_to, end))
            self._button("add", f"{name} plus", partial(nudge, 1))
            self.field = NumberField(take=enter, name=f"{name} value", props="hide-bottom-space")
            self.outside = ui.label().classes("gsp-outside")

    def show(self, value: float, low: float, high: float) -> None:
        """Show a value; the slider reaches from low to high, and a note states one beyond it."""
        slack = SLIDER_ROUNDING * (high - low)
        below, above = value < low - slack, value > high + slack
        self.outside.text = BELOW if below else ABOVE if above else ""
        self.outside.set_visibility(below or above)
        unit = 10.0 ** np.floor(np.log10(max((high - low) / SLIDER_STEPS, 1e-12)))
        # Numbers: the slider would compare texts letter by letter.
        ends = {"min": float(low), "max": float(high), "step": float(unit)}
        if any(self.slider.props.get(name) != end for name, end in ends.items()):
            self.slider.props.update(ends)
            self.slider.update()
        # Without rounding, which screen readers would announce.
        shown = float(f"{np.nan_to_num(value, nan=low):.12g}")
        self.slider.value = float(np.clip(shown, low, high))
        self.field.show(resolved(value, max(abs(low), abs(high))), high - low)

    def enable(self, able: bool) -> None:
        """Allow or forbid changes."""
        for part in (self.slider, self.field.part):
            part.set_enabled(able)

    def _go_to(self, end: str) -> None:
        self.slider.value = self.slider.props[end]

    def _button(self, icon: str, name: str, call: Callable[[], object]) -> None:
        ui.button(icon=icon, on_click=call).props(f'flat dense aria-label="{name}"')

    def _changed(self, value: float | None) -> None:
        if value is not None:
            self._set(float(value))


def motion_panel(client: Client) -> None:
    """Build the sliders of the pose, the buttons with their increments, and reset."""
    rows: list[Row] = []

    def heading(text: str) -> None:
        ui.html(f"<h2>{text}</h2>", sanitize=False)

    def add(number: int) -> None:
        name = COORDINATES[number]
        rows.append(
            Row(
                name,
                NAMES[number],
                lambda v: client.change(lambda s: motion.with_coordinate(s, name, v)),
                lambda text: client.change(
                    lambda s: motion.with_coordinate(s, name, entered(NAMES[number], text))
                ),
                lambda sign: client.change(lambda s: motion.nudged(s, name, sign)),
            )
        )

    heading("Position")
    for number in range(3):
        add(number)
    heading("Rotation [°], R = Rz(yaw) Ry(pitch) Rx(roll)")
    for number in range(3, 6):
        add(number)
    axis = ui.label().classes("gsp-note")
    least = ui.html("", sanitize=False).classes("gsp-wide")
    steps = _increments(client)

    def follow() -> None:
        state = client.state
        values, middle = coordinates(state.pose), sessions.started(state.design).pose.position
        for number, row in enumerate(rows):
            if number < 3:
                reach, centre = SLIDER_REACH * state.size, middle[number]
            else:
                reach, centre = (PITCH_DEG if number == 4 else SLIDER_REACH_DEG), 0.0
            row.show(float(values[number]), centre - reach, centre + reach)
        direction, angle = motion.axis_and_angle(state.pose)
        words = ", ".join(f"{x + 0.0:.4f}" for x in direction)
        turned = f"Rotation by {angle:.4g}° about the axis ({words})"
        axis.text = turned if angle > 0.0 else "No rotation"
        least.content = tables.least_left(client.reading)
        steps()

    client.on_move(follow, "motion")


def _increments(client: Client) -> Callable[[], None]:
    """Build what the buttons do; return the function that shows it."""
    ui.html("<h2>Buttons − and +</h2>", sanitize=False)
    with ui.element("div").classes("gsp-row"):
        step = NumberField(
            "Increment of positions",
            lambda text: client.change(
                lambda s: sessions.with_step(s, entered("increment of positions", text))
            ),
        )
        turn = NumberField(
            "Increment of rotations [°]",
            lambda text: client.change(
                lambda s: sessions.with_turn(s, entered("increment of rotations", text))
            ),
        )
    with ui.element("div").classes("gsp-row"):
        frame = ui.toggle(
            {"base": "Base axes", "platform": "Platform axes"},
            on_change=lambda e: client.change(lambda s: sessions.with_frame(s, e.value)),
        ).props('no-caps dense aria-label="Axes of the buttons"')
        ui.button("Motion reset", icon="restart_alt", on_click=lambda: client.change(motion.reset))

    def show() -> None:
        state = client.state
        step.show(state.step)
        turn.show(state.turn_deg)
        frame.value = state.frame

    return show


def legs_panel(client: Client) -> None:
    """Build the sliders of the joints, by which the platform follows, and the limits."""
    ui.html("<h2>Connector lengths: the platform follows</h2>", sanitize=False)
    box = ui.element("div").classes("gsp-list")
    rows: list[Row] = []

    def build() -> None:
        box.clear()
        rows.clear()
        with box:
            for number, name in enumerate(client.state.design.joint_names):
                rows.append(_joint_row(client, number, name))

    def follow() -> None:
        state = client.state
        first = sessions.started(state.design).pose
        middle = np.nan_to_num(state.design.at(first).joints, nan=state.size)
        for joint, row in zip(client.reading.joints, rows, strict=True):
            row.show(joint.value, *joint_range(joint, float(middle[joint.number]), state.size))
            row.enable(len(rows) == 6 and not joint.reason)
        limits()

    limits = _limits(client)
    modes_section(client)
    build()
    client.on_load(build)
    client.on_move(follow, "legs")


def joint_range(joint: JointReading, middle: float, size: float) -> tuple[float, float]:
    """Return the ends of the slider of a joint: within its stroke, around its first value."""
    if joint.angular:
        return max(joint.low, 0.0), min(joint.high, 180.0)
    low = max(joint.low, middle - JOINT_REACH * size, 0.0)
    high = min(joint.high, middle + JOINT_REACH * size)
    value = np.clip(joint.value, max(joint.low, 0.0), joint.high)
    value = float(value) if np.isfinite(value) else middle
    return min(low, value), max(high, value, low + 1e-9 * size)


def _joint_row(client: Client, number: int, name: str) -> Row:
    angular = bool(client.state.design.angular[number])

    def moved(state: sessions.Session, value: float) -> sessions.Session:
        return motion.with_joint(state, number, float(np.deg2rad(value)) if angular else value)

    def set_value(value: float) -> None:
        client.change(lambda s: moved(s, value))

    def enter(text: str) -> None:
        client.change(lambda s: moved(s, entered(f"joint {name}", text)))

    def nudge(sign: int) -> None:
        step = client.state.turn_deg if angular else client.state.step
        set_value(client.reading.joints[number].value + sign * step)

    return Row(name, f"joint {name}", set_value, enter, nudge)


def _limits(client: Client) -> Callable[[], None]:
    """Build the fields of the strokes, and whether motions stop at them; return what shows them."""
    ui.html("<h2>Limits of all distances</h2>", sanitize=False)
    with ui.element("div").classes("gsp-row"):
        low = NumberField("Least", props="clearable")
        high = NumberField("Greatest", props="clearable")
        ui.button("Set limits", on_click=lambda: set_limits()).props("outline")
    ui.checkbox(
        "Motions stop at limits",
        value=True,
        on_change=lambda e: client.change(lambda s: sessions.stopping(s, e.value)),
    )

    def set_limits() -> None:
        client.change(
            lambda s: sessions.with_strokes(
                s, entered_or_none("least", low.text), entered_or_none("greatest", high.text)
            )
        )
        low.restore()
        high.restore()

    def show() -> None:
        for field, value in zip((low, high), sessions.common_strokes(client.state), strict=True):
            field.show(value)

    return show
