"""XML files of which errors name the file, the line, the element and the key."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from gsp.arguments import LARGEST_NUMBER
from gsp.errors import MalformedFile, brief, cut, expected
from gsp.files.cells import number_of
from gsp.files.writing import read_text
from gsp.geometry.vectors import Array, unit

Node = ElementTree.Element
MODEL_BYTES = 50_000_000  # bytes


class XmlFile:
    """An XML file, and the numbers in it.

    Attributes
    ----------
    path : Path
    root : Element
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lines: dict[Node, int] = {}
        self.root = self._parsed(read_text(path, most=MODEL_BYTES))

    def _parsed(self, text: str) -> Node:
        builder, parser = ElementTree.TreeBuilder(), expat.ParserCreate()
        parser.buffer_text = True

        def start(tag: str, attributes: dict[str, str]) -> None:
            self._lines[builder.start(tag, attributes)] = parser.CurrentLineNumber

        def entity(*_: object) -> NoReturn:
            wanted = expected("XML", "no declarations of entities", "one")
            raise MalformedFile(f"{self.path}, line {parser.CurrentLineNumber}: {wanted}")

        parser.StartElementHandler = start
        parser.EndElementHandler = builder.end
        parser.CharacterDataHandler = builder.data
        parser.EntityDeclHandler = entity
        try:
            parser.Parse(text, True)
            return builder.close()
        except expat.ExpatError as error:
            reason = expat.errors.messages[error.code]
            raise MalformedFile(f"{self.path}, line {error.lineno}: not XML: {reason}") from error

    def where(self, node: Node) -> str:
        """Return an element as messages name it: "line 3, <joint name='d1'>"."""
        name, tag = node.get("name"), cut(node.tag)
        named = f"<{tag}>" if name is None else f"<{tag} name={brief(name)}>"
        return f"line {self._lines[node]}, {named}"

    def fail(self, node: Node, key: str, wanted: str, got: str) -> NoReturn:
        """Raise an error at an element.

        Raises
        ------
        MalformedFile
        """
        place = f"{self.path}, {self.where(node)}" + (f", {key}" if key else "")
        raise MalformedFile(expected(place, wanted, got))

    def attribute(self, node: Node, key: str) -> str:
        """Return an attribute that an element must have."""
        value = node.get(key)
        if not value:
            self.fail(node, key, "a name", "none" if value is None else "an empty text")
        return value

    def only(self, node: Node, tag: str) -> Node | None:
        """Return the child of that name, None if there is none; there may not be two."""
        found = node.findall(tag)
        if len(found) > 1:
            self.fail(node, f"<{tag}>", "one at most", f"{len(found)}")
        return found[0] if found else None

    def child(self, node: Node, tag: str) -> Node:
        """Return the child that an element must have, and only once."""
        found = self.only(node, tag)
        if found is None:
            self.fail(node, f"<{tag}>", "one", "none")
        return found

    def names(self, nodes: Sequence[Node]) -> list[str]:
        """Return the names of elements, of which none may be that of another."""
        known: set[str] = set()
        for node in nodes:
            name = self.attribute(node, "name")
            if name in known:
                self.fail(node, "name", "a name of its own", brief(name))
            known.add(name)
        return [self.attribute(node, "name") for node in nodes]

    def refuse_macros(self) -> None:
        """Raise an error at an element of xacro, whose program writes the model that is meant.

        Raises
        ------
        MalformedFile
        """
        for node in self.root.iter():
            if node.tag.startswith("xacro:"):
                self.fail(node, "", "a model that the program xacro has written", "a macro of it")

    def text(self, node: Node, tag: str) -> str:
        """Return the text of the child that an element must have."""
        found = (self.child(node, tag).text or "").strip()
        if not found:
            self.fail(node, f"<{tag}>", "a text", "none")
        return found

    def numbers(self, node: Node, key: str, text: str | None, count: int) -> Array:
        """Return finite numbers that are separated by spaces; those of a vector have squares."""
        values = np.array([number_of(x) for x in (text or "").split()])
        if values.size != count or not np.isfinite(values).all():
            kind = "a finite number" if count == 1 else f"{count} finite numbers"
            self.fail(node, key, kind, brief(text) if text else "none")
        if count > 1 and np.abs(values).max() > LARGEST_NUMBER:
            wanted = f"numbers of at most {LARGEST_NUMBER:g} in size"
            self.fail(node, key, wanted, brief(text))
        return values

    def number(self, node: Node, key: str, default: float) -> float:
        """Return the number of an attribute, or a default without it."""
        text = node.get(key)
        return default if text is None else float(self.numbers(node, key, text, 1)[0])

    def limit(self, node: Node, key: str, text: str, none: float) -> float:
        """Return a finite limit, or `none`, the infinite number of no limit."""
        return none if number_of(text) == none else float(self.numbers(node, key, text, 1)[0])

    def direction(self, node: Node, key: str, text: str) -> Array:
        """Return a unit vector."""
        vector = self.numbers(node, key, text, 3)
        if not vector.any():
            self.fail(node, key, "a direction other than zero", brief(text))
        return unit(vector)
