"""Designs named on the command line: files, published designs, mechanisms."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from gsp.catalogue import design as published_design
from gsp.catalogue import design_names, instantiate, mechanism, mechanisms, place
from gsp.catalogue.placement import TEMPLATE
from gsp.cli.outputs.console import warn
from gsp.errors import GspError, MalformedFile, UnknownDesign, UnknownMechanism
from gsp.families.texts import design_of_family, is_family
from gsp.model.design import Design, read_design
from gsp.model.mechanism import Mechanism

if TYPE_CHECKING:
    from gsp.planar import PlanarDesign

_MECHANISM = re.compile(r"^[\s$\\]*[DA][\s_{]*[\d₀-₉]", re.IGNORECASE)
# Legs one by one, such as D1-D2-0-D4A1-D1-D2, or a mechanism, and the template after an @.
_PLACEMENT = re.compile(r"^(?:D\d(?:A1)?|A1|0)(?:-(?:D\d(?:A1)?|A1|0))+$", re.IGNORECASE)
ON_TEMPLATE = "@"

HINT = "Known: mechanisms by `gsp catalogue`, designs by `gsp catalogue --designs`, files (.toml)"
PLANAR = "It is a planar design: see `gsp planar`"
DIMENSIONS = "A mechanism alone has no dimensions: expected a published design or a file (.toml)"


def _is_file(text: str, *, planar: bool = False) -> bool:
    """Whether a text names a file; one that ends in .toml does, though there may be none.

    A name of the library is that, also if there is a file of this name: "./NAME" is the file.
    """
    if text.lower().endswith(".toml"):
        return True
    try:
        found = Path(text).is_file()
    except OSError:  # too long for a name
        return False
    if found and Path(text).name == text and _is_known(text, planar=planar):
        warn(f"{text} is taken from the library; the file of this name is ./{text}")
        return False
    return found


# The package of planar mechanisms takes half of the time of a short command to load: it is imported
# where a design is planar, or may be.
def _planar_names() -> tuple[str, ...]:
    from gsp.planar import planar_design_names

    return planar_design_names()


def _is_known(text: str, *, planar: bool) -> bool:
    """Whether a text is the name of a design, a family with parameters, or of a mechanism."""
    if planar:
        return text in _planar_names()
    if text in design_names() or is_family(text):
        return True
    try:
        mechanism(text)
    except UnknownMechanism:
        return False
    return True


def find_design(text: str) -> Design:
    """Return the design in a file of that path, the published design of that name, or of a family.

    "lee-3-6(a=15, b=30, beta=0.2)" is a design of a family: see `gsp.families.texts`.
    "D1-D2-0-D4A1-D1-D2@DESIGN" is a placement on the anchors of a design, and "D1^3D2^3@DESIGN" a
    mechanism as `instantiate` places it; a placement without "@DESIGN" is on the default template.
    """
    legs, at, template = text.partition(ON_TEMPLATE)
    if _PLACEMENT.match(legs):
        return place(legs, find_design(template if at else TEMPLATE))
    if at and _MECHANISM.match(legs):
        return instantiate(mechanism(legs), find_design(template))
    if _is_file(text):
        design = _read_spatial(text)
        return design if design.name else design.replace(name=Path(text).stem)
    if is_family(text):
        return design_of_family(text)
    if text not in design_names():
        hint = DIMENSIONS if _MECHANISM.match(text) else HINT
        hint = PLANAR if text in _planar_names() else hint
        raise UnknownDesign("design", text, design_names(), hint)
    return published_design(text)


def _read_spatial(text: str) -> Design:
    """Return the design in a file; the error of a planar one states the command for it."""
    try:
        return read_design(text)
    except MalformedFile as error:
        from gsp.planar import read_planar_design

        try:
            read_planar_design(text)
        except GspError:
            raise error from None
        raise MalformedFile(f"{text}: expected a design in space. {PLANAR}") from error


def find_planar_design(text: str) -> PlanarDesign:
    """Return the planar design in a file of that path, else the published one of that name."""
    from gsp.planar import planar_design, read_planar_design

    if not _is_file(text, planar=True):
        return planar_design(text)
    design = read_planar_design(text)
    return design if design.name else design.replace(name=Path(text).stem)


def find_mechanism_or_design(text: str) -> Mechanism | Design:
    """Return a mechanism of the catalogue, or a design: published, in a file, or a placement.

    Raises
    ------
    UnknownMechanism, UnknownDesign, MalformedFile
    """
    placed = ON_TEMPLATE in text or _PLACEMENT.match(text)
    if placed or _is_file(text) or is_family(text) or text in design_names():
        return find_design(text)
    if _MECHANISM.match(text):
        return mechanism(text)
    known = (*design_names(), *(m.name for m in mechanisms()))
    hint = PLANAR if text in _planar_names() else HINT
    raise UnknownDesign("design or mechanism", text, known, hint)
