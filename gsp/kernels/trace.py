"""Recording scalar formulas as graphs.

A formula written for numbers is run once on `Traced` symbols. Its operations are recorded as a
graph without loops or branches, in which equal terms are one node. Code in any language, and on
vectors instead of scalars, can be made from it.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


class Traced:
    """A symbolic scalar: an operation and its operands.

    Operations are "+", "-", "*", "/", "<", "sqrt", "atan2", "choose", and the inputs "lane" and
    "uniform" (name of an array, place) and "scalar" (name).
    """

    __slots__ = ("args", "graph", "number", "op")

    def __init__(self, graph: Graph, op: str, args: tuple[Any, ...], number: int) -> None:
        self.graph, self.op, self.args, self.number = graph, op, args, number

    def __add__(self, other: Any) -> Any:
        return self.graph.apply("+", self, other)

    def __radd__(self, other: Any) -> Any:
        return self.graph.apply("+", other, self)

    def __sub__(self, other: Any) -> Any:
        return self.graph.apply("-", self, other)

    def __rsub__(self, other: Any) -> Any:
        return self.graph.apply("-", other, self)

    def __mul__(self, other: Any) -> Any:
        return self.graph.apply("*", self, other)

    def __rmul__(self, other: Any) -> Any:
        return self.graph.apply("*", other, self)

    def __truediv__(self, other: Any) -> Any:
        return self.graph.apply("/", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return self.graph.apply("/", other, self)

    def __neg__(self) -> Any:
        return self.graph.apply("-", 0.0, self)

    def __lt__(self, other: Any) -> Any:
        return self.graph.apply("<", self, other)

    def __gt__(self, other: Any) -> Any:
        return self.graph.apply("<", other, self)

    def sqrt(self) -> Any:
        """Square root, for `gsp.geometry.scalars`."""
        return self.graph.apply("sqrt", self)

    def atan2(self, other: Any) -> Any:
        """Angle with this as sine and `other` as cosine, for `gsp.geometry.scalars`."""
        return self.graph.apply("atan2", self, other)

    def choose(self, yes: Any, no: Any) -> Any:
        """Return `yes` where this condition holds, else `no`, for `gsp.geometry.scalars`."""
        return self.graph.apply("choose", self, yes, no)

    def __bool__(self) -> bool:
        raise TypeError("a formula that is traced cannot branch; use choose()")


class Graph:
    """The recorded operations: nodes in the order of their creation, equal ones once."""

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

    def lanes(self, array: str, count: int, start: int = 0) -> list[Traced]:
        """Return inputs that differ from pose to pose."""
        return [self.apply("lane", array, k) for k in range(start, start + count)]

    def uniform(self, array: str, count: int) -> list[Traced]:
        """Return inputs that are the same for all poses."""
        return [self.apply("uniform", array, k) for k in range(count)]

    def scalar(self, name: str) -> Traced:
        """Return one number that is the same for all poses."""
        node: Traced = self.apply("scalar", name)
        return node


def _simplified(op: str, args: tuple[Any, ...]) -> Any:
    """Return the simplified form of x + 0, x − 0, 0 · x, 1 · x and x / 1, else None."""
    if op not in "+-*/" or len(args) != 2:
        return None
    x, y = args
    zero_x, zero_y = (isinstance(v, int | float) and v == 0 for v in args)
    one_x, one_y = (isinstance(v, int | float) and v == 1 for v in args)
    # 0 · x is 0 even if x may be infinite: a constant 0 is a term that a leg does not have.
    rules = (
        (op == "+" and zero_x, y),
        (op in "+-" and zero_y, x),
        (op == "*" and (zero_x or zero_y), 0.0),
        (op == "/" and zero_x, 0.0),
        (op == "*" and one_x, y),
        (op in "*/" and one_y, x),
    )
    return next((value for holds, value in rules if holds), None)


def needed(values: Iterable[Any]) -> list[Traced]:
    """Return the nodes that some values depend on, each after those that it depends on itself."""
    found: dict[int, Traced] = {}
    waiting = [v for v in values if isinstance(v, Traced)]
    while waiting:
        node = waiting.pop()
        if node.number not in found:
            found[node.number] = node
            waiting += [a for a in node.args if isinstance(a, Traced)]
    return [found[number] for number in sorted(found)]
