"""Fields of numbers. They are texts, so that what is no number is received, and gets a message."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from gsp.rounding import digits_within

# What is rounding of a coordinate, as a share of the range in which it is.
FIELD_ROUNDING = 1e-12


class NumberField:
    """A field whose entry is taken by Enter, or when the focus leaves it.

    A field of the type "number" does not send what is no number: letters, or 1e400. What the
    entry means, and whether it can be used, is decided by `take`; afterwards the field shows the
    value of the state again, which is the former one if the entry was refused.

    Parameters
    ----------
    label : str
        What is printed, "" for nothing.
    take : function of a str, or None
        Called with an entry that differs from what is shown. None for fields that a button reads.
    name : str
        What screen readers say, if not the label.
    value : float or None
        What is shown first.
    props : str
        Further properties of the element.
    """

    def __init__(
        self,
        label: str = "",
        take: Callable[[str], object] | None = None,
        *,
        name: str = "",
        value: float | None = None,
        props: str = "",
    ) -> None:
        self._take = take
        self._shown = words(value)
        self.part = ui.input(label or None, value=self._shown).props(f"dense outlined {props}")
        self.part.props("autocomplete=off")
        if name:
            self.part.props(f'aria-label="{name}"')
        if take is not None:
            for event in ("keydown.enter", "blur", "clear"):
                self.part.on(event, self._entered)

    @property
    def text(self) -> str:
        """The entry, without spaces around it."""
        return (self.part.value or "").strip()

    def show(self, value: float | None, size: float = 0.0) -> None:
        """Show a value, with six digits of a size; an entry stays as long as the value does."""
        text = words(value, size)
        if text != self._shown:
            self._shown = text
            self.restore()

    def restore(self) -> None:
        """Show the value again, in place of an entry."""
        self.part.value = self._shown

    def _entered(self) -> None:
        if self._take is not None and self.text != self._shown:
            self._take(self.text)
            self.restore()


def resolved(value: float, scale: float) -> float:
    """Return a number, 0 where it is nearer to zero than the rounding of numbers of a scale.

    >>> resolved(-3.97569e-16, 2.0), resolved(-3.97569e-16, 1e-15), resolved(0.5, 2.0)
    (0.0, -3.97569e-16, 0.5)
    """
    return 0.0 if abs(value) <= FIELD_ROUNDING * scale else value


def words(value: float | None, size: float = 0.0) -> str:
    """Return a number with six digits, of a size if that is less; "" for None and NaN.

    >>> words(12.5), words(10000.0517, 2.0), words(None), words(float("nan"))
    ('12.5', '10000.0517', '', '')
    """
    if value is None or value != value:
        return ""
    return f"{value + 0.0:.{digits_within(value, size)}g}"
