"""Recording scalar formulas, and printing them as straight-line code.

A formula written for numbers is run once on `Traced` symbols. What it does is recorded as a graph,
in which equal terms are one node, and the graph is printed as code without loops or branches, which
compilers turn into vector instructions.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from types import MappingProxyType
from typing import Any

BINARY = frozenset("+-*/<")


class Traced:
    """A scalar that is not known yet: an operation, and what it is applied to."""

    __slots__ = ("args", "graph", "number", "op")

    def __init__(self, graph: Graph, op: str, args: tuple[Any, ...], number: int) -> None:
        self.graph, self.op, self.args, self.number = graph, op, args, number

    def __add__(self, other: Any) -> Traced:
        return self.graph.apply("+", self, other)

    def __radd__(self, other: Any) -> Traced:
        return self.graph.apply("+", other, self)

    def __sub__(self, other: Any) -> Traced:
        return self.graph.apply("-", self, other)

    def __rsub__(self, other: Any) -> Traced:
        return self.graph.apply("-", other, self)

    def __mul__(self, other: Any) -> Traced:
        return self.graph.apply("*", self, other)

    def __rmul__(self, other: Any) -> Traced:
        return self.graph.apply("*", other, self)

    def __truediv__(self, other: Any) -> Traced:
        return self.graph.apply("/", self, other)

    def __rtruediv__(self, other: Any) -> Traced:
        return self.graph.apply("/", other, self)

    def __neg__(self) -> Traced:
        return self.graph.apply("-", 0.0, self)

    def __lt__(self, other: Any) -> Traced:
        return self.graph.apply("<", self, other)

    def __gt__(self, other: Any) -> Traced:
        return self.graph.apply("<", other, self)

    def __bool__(self) -> bool:
        raise TypeError("a formula that is traced cannot branch; use choose()")


class Graph:
    """What was recorded: nodes in the order of their making, equal ones once."""

    def __init__(self) -> None:
        self.nodes: dict[tuple[str, tuple[Any, ...]], Traced] = {}

    def apply(self, op: str, *args: Any) -> Any:
        """Return the node of an operation; sums and products with 0 and 1 are simplified."""
        simple = _simplified(op, args)
        if simple is not None:
            return simple
        key = (op, tuple(a.number if isinstance(a, Traced) else ("c", a) for a in args))
        if key not in self.nodes:
            self.nodes[key] = Traced(self, op, args, len(self.nodes))
        return self.nodes[key]

    def symbol(self, text: str) -> Traced:
        """Return a node that prints as the given text."""
        node: Traced = self.apply("symbol", text)
        return node


def _simplified(op: str, args: tuple[Any, ...]) -> Any:
    """Return the value of x + 0, x − 0, 0 · x, 1 · x and x / 1 where they stand in the formula."""
    if op not in "+-*/" or len(args) != 2:
        return None
    x, y = args
    zero_x, zero_y = (isinstance(v, int | float) and v == 0 for v in args)
    one_x, one_y = (isinstance(v, int | float) and v == 1 for v in args)
    rules = (
        (op == "+" and zero_x, y),
        (op in "+-" and zero_y, x),
        (op == "*" and (zero_x or zero_y), 0.0),
        (op == "/" and zero_x, 0.0),
        (op == "*" and one_x, y),
        (op in "*/" and one_y, x),
    )
    return next((value for holds, value in rules if holds), None)


def root(x: Any) -> Any:
    """Square root of a number of any kind: float, traced, or with a `sqrt` method."""
    if isinstance(x, Traced):
        return x.graph.apply("sqrt", x)
    return math.sqrt(x) if isinstance(x, int | float) else x.sqrt()


def choose(condition: Any, yes: Any, no: Any) -> Any:
    """Return `yes` where the condition holds, else `no`; both have been computed."""
    if isinstance(condition, Traced):
        return condition.graph.apply("choose", condition, yes, no)
    return yes if condition else no


PYTHON = MappingProxyType(
    {"sqrt": "sqrt({})", "choose": "({1} if {0} else {2})", "line": "{0} = {1}"}
)
C = MappingProxyType(
    {"sqrt": "sqrt({})", "choose": "({0} ? {1} : {2})", "line": "const double {0} = {1};"}
)


def straight_line(
    outputs: Sequence[tuple[str, Any]], language: MappingProxyType[str, str], invariant: str = "\0"
) -> tuple[list[str], list[str]]:
    """Print what the outputs need: lines that do not change in the loop, and lines of its body.

    Parameters
    ----------
    outputs : sequence of (format of a statement, value)
        Such as ("out[i + 32] = {}", value).
    language : PYTHON or C
    invariant : str
        Symbols whose text starts so are read once, before the loop.
    """
    needed = _needed(value for _, value in outputs)
    uses = Counter(a.number for node in needed for a in node.args if isinstance(a, Traced))
    text: dict[int, str] = {}
    before: list[str] = []
    body: list[str] = []
    for node in needed:
        written = _printed(node, text, language)
        if node.op == "<" or (uses[node.number] < 2 and node.op != "symbol" and len(written) < 60):
            text[node.number] = written
            continue
        text[node.number] = f"t{node.number}"
        place = before if node.op == "symbol" and written.startswith(invariant) else body
        place.append(language["line"].format(text[node.number], written))
    for statement, value in outputs:
        body.append(statement.format(_argument(value, text)))
    return before, body


def _needed(values: Iterable[Any]) -> list[Traced]:
    found: dict[int, Traced] = {}
    waiting = [v for v in values if isinstance(v, Traced)]
    while waiting:
        node = waiting.pop()
        if node.number not in found:
            found[node.number] = node
            waiting += [a for a in node.args if isinstance(a, Traced)]
    return [found[number] for number in sorted(found)]


def _argument(value: Any, text: dict[int, str]) -> str:
    return text[value.number] if isinstance(value, Traced) else repr(float(value))


def _printed(node: Traced, text: dict[int, str], language: MappingProxyType[str, str]) -> str:
    if node.op == "symbol":
        return str(node.args[0])
    args = [_argument(a, text) for a in node.args]
    if node.op not in BINARY:
        return language[node.op].format(*args)
    left, right = args
    return f"-{right}" if node.op == "-" and left == "0.0" else f"({left} {node.op} {right})"


Formula = Callable[..., Any]
