"""Links that restore a state: the design, the pose and the length as the query of a URL."""

from __future__ import annotations

import base64
import binascii
import zlib
from collections.abc import Mapping
from urllib.parse import urlencode

import numpy as np

from gsp.app.state import choices
from gsp.app.state.session import Session, check_place, started, with_length
from gsp.catalogue import design as published
from gsp.catalogue import design_names
from gsp.catalogue.placement import TEMPLATE
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.design.toml import toml_from_design


def query(state: Session) -> str:
    """Return the query of a link to a state.

    A published design is given by its name, another one by its whole file, compressed. The
    position and the rotation (as a quaternion) are written so that they read back bit by bit.

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
        words["file"] = packed(toml_from_design(state.design))
    words["position"] = ",".join(map(repr, state.pose.position.tolist()))
    words["rotation"] = ",".join(map(repr, (state.pose.quaternion + 0.0).tolist()))
    if state.length != state.design.characteristic_length:
        words["length"] = "none" if state.length is None else repr(state.length)
    return urlencode(words)


def restored(words: Mapping[str, str], default: Design) -> Session:
    """Return the state of a link; what it does not give is that of a new state.

    Parameters
    ----------
    words : mapping from the names of the query to texts
    default : Design
        Where the link names none.

    Raises
    ------
    GspError
        On an unknown design, a file that cannot be read, or numbers that cannot be used.
    """
    design = default
    if "file" in words:
        design = choices.from_file(unpacked(words["file"]), "design of the link")
    elif "design" in words:
        template = words.get("template", TEMPLATE)
        design = choices.named(words["design"], template)
    state = started(design)
    if "position" in words or "rotation" in words:
        position = state.pose.position
        if "position" in words:
            position = _numbers("position", words["position"], 3)
        rotation = _numbers("rotation", words.get("rotation", "0,0,0,1"), 4)
        state = started(design, Pose.from_quaternion(position, rotation))
        check_place(state, state.pose.position)
    if "length" in words:
        none = words["length"] == "none"
        state = with_length(state, None if none else _numbers("length", words["length"], 1).item())
    return state


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
