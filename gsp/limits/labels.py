"""Labels of boundary points and curves: [0 1 − − 1 0], as the source writes them."""

from __future__ import annotations

from collections.abc import Iterable

from gsp.checks import check_text
from gsp.errors import InvalidInput, brief, expected

# Active bounds: (number of the quantity, 0 for its least or 1 for its greatest value) each.
Active = tuple[tuple[int, int], ...]

MARKS = "01"
FREE = "-"


def label(active: Iterable[tuple[int, int]], names: tuple[str, ...], joints: int) -> str:
    """Return the label of active constraints: per joint 0 (least), 1 (greatest) or - (between).

    Other quantities that are at a bound follow by name: "- 1 - - 1 - | base cone 2=1".

    Parameters
    ----------
    active : pairs of int
        Number of the quantity, and 0 for its least or 1 for its greatest value.
    names : tuple of str
        Of the quantities, joints first.
    joints : int
        Number of joints.

    Returns
    -------
    str

    *Source: Workspace-3, §3.4.2*
    """
    marks = [FREE] * joints
    others = []
    for i, side in sorted(active):
        if i >= joints:
            others.append(f"{names[i]}={side}")
        elif marks[i] != FREE:
            marks[i] += MARKS[side]
        else:
            marks[i] = MARKS[side]
    return " ".join(marks) + "".join(f" | {other}" for other in others)


def active_from_label(text: str, joints: int) -> Active:
    """Return the active joints of a label such as "0 1 - - 1 0", "[01−−10]" or "(0 1 1 1 1 0)".

    Parameters
    ----------
    text : str
    joints : int
        Number of joints.

    Returns
    -------
    tuple of (int, int)
        Number of the joint, and 0 for its least or 1 for its greatest value.

    Raises
    ------
    InvalidInput
        If it is not a text, or does not have one mark per joint.

    Examples
    --------
    >>> active_from_label("[0 1 − − 1 0]", 6)
    ((0, 0), (1, 1), (4, 1), (5, 0))
    """
    text = check_text("label", text)
    marks = [c for c in text.replace("−", FREE).replace("–", FREE) if c in MARKS + FREE]
    rest = set(text) - set("01-−–[]() ,")
    if len(marks) != joints or rest:
        wanted = f"{joints} marks 0, 1 or -, such as {' '.join((MARKS * joints)[:joints])}"
        raise InvalidInput(expected("label", wanted, brief(text)))
    return tuple((i, MARKS.index(mark)) for i, mark in enumerate(marks) if mark != FREE)
