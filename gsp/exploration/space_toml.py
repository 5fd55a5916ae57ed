"""The TOML form of a space of designs: names of functions, and the values of their arguments."""

from __future__ import annotations

import json
from collections.abc import Callable
from types import MappingProxyType
from typing import Any

import numpy as np

from gsp.catalogue import design as published_design
from gsp.catalogue import design_names, place
from gsp.checks import is_a
from gsp.errors import InvalidInput, UnknownName, brief, expected
from gsp.families import hexapod, nawratil
from gsp.families.texts import FAMILIES, function_of_family
from gsp.model.design import Design, toml_from_design

# The function that puts legs on the positions of a template, of which a file has the name.
PLACE = "place"
# Functions that are called as in Python, with angles in radians; families have them in degrees.
FUNCTIONS: MappingProxyType[str, Any] = MappingProxyType(
    {"gsp.hexapod": hexapod, "gsp.families.nawratil.isotropic": nawratil.isotropic}
)
MAKERS = (*FAMILIES, PLACE, *FUNCTIONS)

Find = Callable[[str], Design]


def toml_from_space(space: Any) -> str:
    """Return a space as TOML, from which `read_space` makes the same designs, bit by bit.

    Parameters
    ----------
    space : Space

    Raises
    ------
    InvalidInput
        If its function is none that a file names, or a fixed value is no text, number, bool or
        list of these.
    """
    name, fixed = _name(space), dict(space.fixed)
    if name == PLACE:
        fixed["template"] = _template(fixed.get("template"))
    lines = [f"make = {json.dumps(name)}"]
    tables = ("ranges", space.ranges), ("choices", space.choices), ("fixed", fixed)
    for table, values in tables:
        if values:
            lines += ["", f"[{table}]"]
            lines += [f"{key} = {_value(f'{table}.{key}', one)}" for key, one in values.items()]
    return "\n".join(lines) + "\n"


def _name(space: Any) -> str:
    """Return the name that a file has for the function of a space."""
    make: Any = space.make
    if make is place or getattr(make, "of_file", "") == PLACE:
        return PLACE
    names = [name for name, function in FUNCTIONS.items() if function is make]
    names += [name for name in FAMILIES if function_of_family(name) is make]
    if not names:
        got = space.record()["make"]
        wanted = "a function that files can name: gsp.hexapod, gsp.catalogue.place or one of them"
        raise InvalidInput(expected("space.make", wanted, got))
    return names[0]


def _template(template: Any) -> str:
    """Return the name of a published design that is equal to a template."""
    if isinstance(template, str):
        return template
    if is_a(template, Design) and template.name in design_names():
        published = published_design(template.name)
        if toml_from_design(published) == toml_from_design(template):
            return template.name
    wanted = "a published design as the template; any other one stands in a file of its own"
    raise InvalidInput(expected("space.fixed['template']", wanted, brief(template)))


def _value(what: str, value: Any) -> str:
    if is_a(value, np.ndarray | np.generic):
        value = value.tolist()
    if is_a(value, bool):
        return str(value).lower()
    if is_a(value, str):
        return json.dumps(value, ensure_ascii=False)
    if is_a(value, int | float):
        return repr(value)
    if is_a(value, list | tuple):
        return f"[{', '.join(_value(what, one) for one in value)}]"
    raise InvalidInput(
        expected(f"space.{what}", "a text, a number, a bool or a list", brief(value))
    )


def function_of_name(name: str, find: Find) -> Callable[..., Design]:
    """Return the function that a file names; `find` finds the template of placements.

    Raises
    ------
    UnknownName
    """
    if name == PLACE:
        return _placing(find)
    if name in FUNCTIONS:
        make: Callable[..., Design] = FUNCTIONS[name]
        return make
    if name not in FAMILIES:
        raise UnknownName("make", name, MAKERS)
    return function_of_family(name)


def _placing(find: Find) -> Callable[..., Design]:
    found: dict[str, Design] = {}

    def placed(*, legs: str, template: Any) -> Design:
        if not isinstance(template, str):
            got = repr(template)
            raise InvalidInput(expected("template", "the name or file of a design", got))
        if template not in found:
            found[template] = find(template)
        return place(legs, found[template])

    placed.__qualname__ = placed.__name__ = PLACE
    placed.of_file = PLACE  # type: ignore[attr-defined]
    return placed
