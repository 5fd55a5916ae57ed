"""A page of the reference for each public module, from the docstrings of its names."""

from __future__ import annotations

import importlib
import re
from types import ModuleType

import gsp
from gsp.indices import INDICES
from website.markdown import page as make
from website.markdown import table

OVERVIEW = "reference/index.md"
# Modules that are public beside the packages that `gsp` names: records and errors.
MORE = ("gsp.errors",)
SOURCE = re.compile(r"\n\s*(\*Source: .*?\*)\s*(?=\n\s*\n|\Z)", re.DOTALL)
# What mkdocstrings writes for an argument that has a type and no description.
NO_DESCRIPTION = re.compile(r'\s*–\s*<div class="doc-md-description">\s*</div>')
SECTION = re.compile(r"\n[ \t]*\w[\w ]*\n[ \t]*-{3,}[ \t]*\n")


def public_modules() -> dict[str, ModuleType]:
    """Return the public modules by name: gsp, its packages, and the modules that they name."""
    found: dict[str, ModuleType] = {}
    todo = [gsp, *(importlib.import_module(name) for name in MORE)]
    while todo:
        module = todo.pop(0)
        found[module.__name__] = module
        values = (getattr(module, name) for name in names(module))
        todo += [v for v in values if isinstance(v, ModuleType) and v.__name__ not in found]
    return dict(sorted(found.items()))


def names(module: ModuleType) -> list[str]:
    """Return what a module states in `__all__`, else its own functions and classes."""
    if hasattr(module, "__all__"):
        return [name for name in module.__all__ if not name.startswith("_")]
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and is_callable(value) and value.__module__ == module.__name__
    ]


def documented() -> dict[str, tuple[str, str]]:
    """Return where each public name is documented: path of the definition, and module.

    A name that several modules state is on the page of the first: `gsp` before its packages.
    """
    places: dict[str, tuple[str, str]] = {}
    seen: dict[str, str] = {}
    for name, module in public_modules().items():
        for member in names(module):
            value = getattr(module, member)
            if is_callable(value):
                home = f"{value.__module__}.{value.__qualname__}"
                places[f"{name}.{member}"] = (home, seen.setdefault(home, name))
    return places


def is_callable(value: object) -> bool:
    """Return whether a value is a function, also one that keeps its results, or a class."""
    return callable(value) and hasattr(value, "__qualname__")


def page(name: str) -> str:
    """Return the path of the page of a module."""
    return f"reference/{name}.md"


def pages() -> dict[str, str]:
    """Return the pages of the reference and their overview: path, and Markdown."""
    modules = public_modules()
    return {OVERVIEW: overview(), **{page(n): text(n, m) for n, m in modules.items()}}


def overview() -> str:
    """Return the page with one row per module."""
    rows = [
        (f"[`{name}`]({name}.md)", first_line(module)) for name, module in public_modules().items()
    ]
    return make(
        "# Reference",
        "These pages are made from the docstrings. Symbols, units and shapes: "
        "[conventions](../docs/conventions.md).",
        table(("module", "what"), rows),
    )


def text(name: str, module: ModuleType) -> str:
    """Return the page of one module: each of its names, or a link to where it stands.

    The functions of the indices have pages of their own.
    """
    places = documented()
    elsewhere = {f"{i.function.__module__}.{i.function.__qualname__}" for i in INDICES.values()}
    heads, blocks, packages = [], [], []
    for member in names(module):
        value = getattr(module, member)
        full = f"{name}.{member}"
        if isinstance(value, ModuleType):
            packages.append((f"[`{value.__name__}`]({value.__name__}.md)", first_line(value)))
        elif full in places:
            home, owner = places[full]
            heads.append((f"[`{full}`][{home}]", first_line(value)))
            if owner == name and home not in elsewhere:
                blocks.append(f"::: {home}\n    options:\n      heading: {full}")
    return make(
        f"# {name}",
        first_line(module),
        table(("name", "what"), heads) if heads else "",
        "## Packages\n\n" + table(("package", "what"), packages) if packages else "",
        *blocks,
    )


def first_line(thing: object) -> str:
    """Return the first sentence of a docstring."""
    return (thing.__doc__ or "").strip().partition("\n\n")[0].replace("\n", " ")


def with_references(markdown: str) -> str:
    """Return a text in which public names in backticks are links to the reference."""
    places = {name: home for name, (home, _) in documented().items()}

    def linked(match: re.Match[str]) -> str:
        name = match[0].strip("`")
        return f"[{match[0]}][{places[name]}]" if name in places else match[0]

    lines = []
    for part in re.split(r"(^```.*?^```$)", markdown, flags=re.DOTALL | re.MULTILINE):
        if part.startswith("```"):
            lines.append(part)
        else:
            lines.append(re.sub(r"(?<![\[`])`[\w.]+`(?![\]`])", linked, part))
    return "".join(lines)


def source_first(docstring: str) -> str:
    """Return a docstring whose source is before the first section.

    It is last in the code, after the sections, where numpydoc takes it for a part of the last.
    """
    section, source = SECTION.search(docstring), SOURCE.search(docstring)
    if not section or not source or source.start() < section.start():
        return docstring
    rest = docstring[: source.start()] + docstring[source.end() :]
    return f"{rest[: section.start()]}\n\n{source[1]}\n{rest[section.start() :]}"


def without_dashes(html: str) -> str:
    """Return a page without the dash after arguments and results that have no description."""
    return NO_DESCRIPTION.sub("", html)
