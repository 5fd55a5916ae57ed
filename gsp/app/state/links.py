"""Links that restore a state: the design, the pose and the length as the query of a URL."""

from __future__ import annotations

import base64
import binascii
import zlib
from collections.abc import Iterable, Mapping
from urllib.parse import urlencode

import numpy as np

from gsp.app.state import choices
from gsp.app.state.session import Session, check_angles, check_place, started, with_length
from gsp.catalogue import design as published
from gsp.catalogue import design_names
from gsp.catalogue.placement import TEMPLATE
from gsp.errors import GspError, InvalidInput, UnknownName, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.design.toml import toml_from_design

# What a link can state.
WORDS = ("design", "template", "file", "position", "rotation", "rpy_deg", "length")
# Words of which a link has one at most, as both state the same.
ALTERNATIVES = (("design", "file"), ("rotation", "rpy_deg"))
# Letters of a link: servers and browsers take some 60 000.
LONGEST_LINK = 32_000


def query(state: Session) -> str:
    """Return the query of a link to a state.

    A published design is given by its name, another one by its whole file, compressed. The
    position and the rotation (as a quaternion) are written so that they read back bit by bit.

    Raises
    ------
    GspError
        On designs that a link cannot hold: they have too many legs, or too long a file.

    Examples
    --------
    >>> import gsp
    >>> query(started(gsp.catalogue.design("lee-2000-3-3")))
    'design=lee-2000-3-3&position=0.0%2C0.0%2C1.0&rotation=0.0%2C0.0%2C0.0%2C1.0'
    """
    words: dict[str, str] = {}
    if _published(state.design):
        words["design"] = state.design.name
    else:
        text = toml_from_design(state.design)
        choices.from_file(text, "link")  # what cannot be opened is not given
        words["file"] = packed(text)
    words["position"] = ",".join(map(repr, state.pose.position.tolist()))
    words["rotation"] = ",".join(map(repr, (state.pose.quaternion + 0.0).tolist()))
    if state.length != state.design.characteristic_length:
        words["length"] = "none" if state.length is None else repr(state.length)
    found = urlencode(words)
    if len(found) > LONGEST_LINK:
        wanted = f"a design of which the link has at most {LONGEST_LINK} letters"
        raise InvalidInput(expected("link", wanted, len(found)))
    return found


class Address:
    """The link to a state, for the address of a page that is loaded again.

    Browsers limit how often an address changes, so it follows a state that is at rest. The address
    with which a page was opened stays until its state changes.

    Parameters
    ----------
    state : Session
        The first one.
    """

    def __init__(self, state: Session) -> None:
        self._seen = self._kept = _place(state)

    def due(self, state: Session) -> str:
        """Return the query of a state that has changed and is the one of the last call, else ""."""
        now = _place(state)
        rests, self._seen = _same(now, self._seen), now
        if not rests or _same(now, self._kept):
            return ""
        self._kept = now
        try:
            return query(state)
        except GspError:  # no link holds it: "Copy a link" states it
            return ""


Place = tuple[Design, Pose, float | None]


def _place(state: Session) -> Place:
    """Return what a link states."""
    return state.design, state.pose, state.length


def _same(one: Place, other: Place) -> bool:
    return one[0] is other[0] and one[1] is other[1] and one[2] == other[2]


def restored(words: Mapping[str, str], default: Design) -> Session:
    """Return the state of a link; what it does not give is that of a new state.

    Parameters
    ----------
    words : mapping from the names of the query to texts
        Of `WORDS`. "design": a name of `choices.named`, on the "template"; "file": as `packed` has
        it. "position": three numbers [unit]. "rotation": a quaternion x, y, z, w, or "rpy_deg":
        roll, pitch and yaw [degrees]; without them a given position has no rotation. "length"
        [unit], or "none".
    default : Design
        Where the link names none.

    Raises
    ------
    GspError
        On other names, an unknown design, a file that cannot be read, or numbers that cannot be
        used.
    """
    _check_words(words)
    design = default
    if "file" in words:
        design = choices.from_file(unpacked(words["file"]), "design of the link")
    elif "design" in words:
        template = words.get("template", TEMPLATE)
        design = choices.named(words["design"], template)
    state = started(design)
    if not {"position", "rotation", "rpy_deg"}.isdisjoint(words):
        position = state.pose.position
        if "position" in words:
            position = _numbers("position", words["position"], 3)
        if "rotation" in words:
            pose = Pose.from_quaternion(position, _numbers("rotation", words["rotation"], 4))
        else:
            angles = _numbers("rpy_deg", words.get("rpy_deg", "0,0,0"), 3)
            check_angles(angles)
            pose = Pose.from_rpy(position, angles, degrees=True)
        state = started(design, pose)
        check_place(state, state.pose.position)
    if "length" in words:
        none = words["length"] == "none"
        state = with_length(state, None if none else _numbers("length", words["length"], 1).item())
    return state


def parsed(pairs: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return the parameters of a link by their names.

    Raises
    ------
    InvalidInput
        Where a parameter is given twice, also with the same value.

    Examples
    --------
    >>> parsed([("design", "lee-2000-3-3"), ("length", "2")])
    {'design': 'lee-2000-3-3', 'length': '2'}
    """
    words: dict[str, str] = {}
    for name, text in pairs:
        if name in words and name in WORDS:  # others are unknown anyway
            got = f"{brief(words[name])} and {brief(text)}"
            raise InvalidInput(expected("link", f"one {name}", got))
        words[name] = text
    return words


def _check_words(words: Mapping[str, str]) -> None:
    """Raise an error for names that a link does not have, or not together."""
    for name in words:
        if name not in WORDS:
            raise UnknownName("parameter of a link", name, WORDS)
    for one, other in ALTERNATIVES:
        if one in words and other in words:
            raise InvalidInput(expected("link", f"{one} or {other}", "both"))
    if "template" in words and "design" not in words:
        raise InvalidInput(expected("link", "a design with the template", "the template alone"))


def packed(text: str) -> str:
    """Return a text compressed, in the letters of URLs."""
    return base64.urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode().rstrip("=")


def unpacked(text: str) -> str:
    """Return the text that `packed` compressed; at most as long as a design file may be.

    Raises
    ------
    InvalidInput
    """
    try:
        data = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
        reader = zlib.decompressobj()
        plain = reader.decompress(data, choices.LARGEST_FILE)
        if not reader.eof:
            raise zlib.error("too long or cut off")
        return plain.decode()
    except (binascii.Error, zlib.error, ValueError) as error:
        raise InvalidInput(expected("design of the link", "a packed file", brief(text))) from error


def _published(design: Design) -> bool:
    """Whether a design is a published one, and not one changed from it."""
    if design.name not in design_names():
        return False
    return toml_from_design(design) == toml_from_design(published(design.name))


def _numbers(what: str, text: str, count: int) -> Array:
    try:
        values = np.array([float(word) for word in text.split(",")])
    except ValueError:
        values = np.empty(0)
    if values.shape != (count,):
        raise InvalidInput(
            expected(what, f"{count} numbers" if count > 1 else "a number", brief(text))
        )
    return values
