"""How docstrings are prepared for the reference: an extension of griffe."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import griffe

from website.reference import source_first


class Constructors(griffe.Extension):
    """Show the inherited constructor of records that are made with `init=False`.

    griffe would take them for dataclasses whose constructor has no arguments.
    """

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        """Add the constructors to the classes of a package."""
        for record in list(classes(pkg)):
            inherited = record.inherited_members.get("__init__")
            if inherited and "__init__" not in record.members and without_init(record):
                made = griffe.Function(
                    "__init__", parameters=inherited.parameters, returns=inherited.returns
                )
                record.set_member("__init__", made)


def classes(module: griffe.Module) -> Iterator[griffe.Class]:
    """Yield the classes that are defined in a module and in the modules below it."""
    for member in module.members.values():
        if isinstance(member, griffe.Class):
            yield member
        elif isinstance(member, griffe.Module):
            yield from classes(member)


def without_init(record: griffe.Class) -> bool:
    """Return whether a class is a dataclass that makes no constructor."""
    return any("init=False" in str(decorator.value) for decorator in record.decorators)


class Sources(griffe.Extension):
    """Move the source of a formula above the sections of its docstring."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Change the docstring of one object."""
        if obj.docstring:
            obj.docstring.value = source_first(obj.docstring.value)
