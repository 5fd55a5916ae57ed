"""Every public callable documents its parameters, returns and errors."""

from __future__ import annotations

import ast
import builtins
import dataclasses
import enum
import importlib
import inspect
import pkgutil
import re
import textwrap
from collections.abc import Iterable, Iterator
from functools import cache, cached_property
from pathlib import Path
from types import FunctionType, ModuleType
from typing import NamedTuple

import pytest

import gsp
from gsp import arguments
from gsp.errors import InvalidInput
from tests.numpydoc import Docstring, Field, parse

ROOT = Path(__file__).parents[1]
ARRAY = re.compile(r"\b(ArrayLike|Array|NDArray|Mask)\b")
BATCH = re.compile(r"\b(Pose|Posture|PlanarPose|PlanarPosture)\b")
NUMBER = re.compile(r"\b(float|Array|ArrayLike)\b")
VALUES = re.compile(r"\b(float|Array|Mask|NDArray\[np\.(bool_|int\d*|float64)\]|Volume|Spheres)")
SHAPE = re.compile(r"\(\.\.\.|\((\w+|\.\.\.)?(, ?[\w.+ ]+)*,?\)|shape|single")
UNIT = re.compile(r"\[[^\]]+\]")
# An interval such as [0, 1], (-π, π] or [0, ∞) is a range, not a unit.
NUMERAL = r"[-−+]?(?:\d[\d./e]*|\d*π(?:/\d)?|∞|inf)°?"
INTERVAL = re.compile(rf"[\[(]{NUMERAL}, ?{NUMERAL}[\])]")
# Packages of formulas: each function states the source of the equation that it computes.
FORMULAS = (
    "gsp.indices.",
    "gsp.families.",
    "gsp.statics.",
    "gsp.kinematics.",
    "gsp.geometry.frames.changes",
    "gsp.geometry.frames.screws",
    "gsp.geometry.rotations",
    "gsp.determinant.bounds",
    "gsp.determinant.search.gradient",
    "gsp.proof.boxes",
    "gsp.proof.distance",
    "gsp.proof.extremes",
)
# Packages of models, poses and sets: each function and property that returns numbers does.
NUMBERS = (
    "gsp.determinant.",
    "gsp.geometry.",
    "gsp.indices.",
    "gsp.kinematics.",
    "gsp.limits.",
    "gsp.model.",
    "gsp.planar.",
    "gsp.proof.",
    "gsp.statics.",
    "gsp.workspace.",
)
BUILT_IN = {*dir(builtins), "Array", "Any"}  # words of annotations that name no record
CHECKS = re.compile(r"\b(check|require)_\w+\(|^\s*@(arguments\.)?validated\(", re.MULTILINE)


# --- which names are public ---


def packages() -> Iterator[ModuleType]:
    yield gsp
    for found in pkgutil.walk_packages(gsp.__path__, "gsp."):
        if not found.name.endswith("__main__"):
            module = importlib.import_module(found.name)
            if hasattr(module, "__all__"):
                yield module


def public(module: ModuleType) -> Iterator[object]:
    """Functions and classes that a module states; of a public module without `__all__`, its own."""
    if hasattr(module, "__all__"):
        for name in module.__all__:
            value = getattr(module, name)
            yield from public(value) if isinstance(value, ModuleType) else (value,)
    else:
        for name, value in vars(module).items():
            if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__:
                yield value


def members(kind: type) -> Iterator[object]:
    """Public methods and properties of a class, with those of its bases in the library."""
    own = [base for base in reversed(kind.__mro__) if base.__module__.startswith("gsp.")]
    for name, value in {k: v for base in own for k, v in vars(base).items()}.items():
        if not name.startswith("_"):
            if isinstance(value, classmethod | staticmethod):
                yield value.__func__
            elif isinstance(value, FunctionType | property | cached_property):
                yield value


def identity(thing: object) -> str:
    if isinstance(thing, property):
        thing = thing.fget
    elif isinstance(thing, cached_property):
        thing = thing.func
    return f"{thing.__module__}.{thing.__qualname__}"


def callables() -> dict[str, object]:
    found = {}
    for module in packages():
        for value in public(module):
            value = inspect.unwrap(value) if callable(value) else value  # functools.cache
            if isinstance(value, FunctionType | type):
                found[identity(value)] = value
                inner = members(value) if isinstance(value, type) else ()
                found |= {identity(member): member for member in inner}
    own = {name: value for name, value in found.items() if name.startswith("gsp.")}
    return dict(sorted((own | returned(own.values())).items()))


# --- which records they return ---


def returned(things: Iterable[object]) -> dict[str, object]:
    """Records that callables return or hold, by their annotations, with all that these return."""
    waiting, found = list(things), {}
    while waiting:
        for kind in annotated(waiting.pop()):
            if identity(kind) not in found:
                new = {identity(one): one for one in (kind, *members(kind))}
                found |= new
                waiting += new.values()
    return found


def annotated(thing: object) -> Iterator[type]:
    """Classes of the library in the annotation of what is returned, or of the fields of a class."""
    if isinstance(thing, property | cached_property):
        thing = thing.fget if isinstance(thing, property) else thing.func
    notes = inspect.get_annotations(thing)
    fields = [str(note) for name, note in notes.items() if not name.startswith("_")]
    held = [note for note in fields if "Callable" not in note]
    texts = held if isinstance(thing, type) else [notes.get("return", "")]
    module = importlib.import_module(thing.__module__)
    for word in set(re.findall(r"[A-Za-z]\w*", " ".join(map(str, texts)))) - BUILT_IN:
        kind = vars(module).get(word) or imported(module).get(word)
        if isinstance(kind, type) and kind.__module__.startswith("gsp."):
            yield kind


@cache
def imported(module: ModuleType) -> dict[str, object]:
    """What a module imports from the library for its annotations only."""
    source = inspect.getsource(module)
    nodes = ast.walk(ast.parse(source)) if "TYPE_CHECKING" in source else ()
    return {
        one.asname or one.name: getattr(importlib.import_module(node.module), one.name)
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("gsp")
        for one in node.names
    }


# --- what is missing in the docstring of one ---


def missing(thing: object) -> list[str]:
    """What is missing in the docstring of a class, function, method or property."""
    doc = parse(inspect.getdoc(thing) if thing.__doc__ else None)
    if not doc.first.rstrip().endswith((".", ":")):
        return ["a first line that is a sentence"]
    if isinstance(thing, type):
        return missing_of_class(thing, doc)
    if isinstance(thing, property | cached_property):
        function = thing.fget if isinstance(thing, property) else thing.func
        source = missing_of_source(function) if returns_numbers(function) else ()
        return [*missing_of_value(function, doc), *source]
    return [
        *missing_of_parameters(thing, doc.fields("Parameters")),
        *missing_of_value(thing, doc),
        *missing_of_errors(thing, doc),
        *missing_of_source(thing),
    ]


def missing_of_class(kind: type, doc: Docstring) -> list[str]:
    if issubclass(kind, Exception | enum.Enum):
        return []
    if hasattr(kind, "_fields"):  # a NamedTuple
        return list(missing_of_parameters(kind, doc.fields("Attributes")))
    if not dataclasses.is_dataclass(kind) and "__init__" not in vars(kind):
        return []
    attributes = doc.fields("Attributes")
    stated = {n: f for n, f in attributes.items() if n in parameters(kind)}
    own = vars(kind)
    return [
        *missing_of_parameters(kind, stated | doc.fields("Parameters")),
        *(
            error
            for name in ("__init__", "__post_init__")
            if isinstance(own.get(name), FunctionType) and name in inspect.getsource(kind)
            for error in missing_of_errors(own[name], doc)
        ),
    ]


def parameters(thing: object) -> dict[str, str]:
    """Parameters of a callable with the text of their annotations."""
    signature = inspect.signature(thing)
    return {
        p.name: p.annotation if isinstance(p.annotation, str) else str(p.annotation)
        for p in signature.parameters.values()
        if p.name not in ("self", "cls") and not p.name.startswith("_")
    }


def missing_of_parameters(thing: object, fields: dict[str, Field]) -> Iterator[str]:
    wanted = parameters(thing)
    yield from (f"parameter {name}" for name in wanted if name not in fields)
    yield from (f"no parameter {name}" for name in fields if name not in wanted)
    for name, annotation in wanted.items():
        if name in fields:
            yield from missing_of_field(name, annotation, fields[name])


def missing_of_field(name: str, annotation: str, field: Field) -> Iterator[str]:
    said = f"{field.kind} {field.text}"
    if not field.kind:
        yield f"type of {name}"
    if "Callable" in annotation:
        return
    if (ARRAY.search(annotation) or BATCH.search(annotation)) and not SHAPE.search(said):
        yield f"shape of {name}"
    if NUMBER.search(annotation) and not states_unit(said):
        yield f"unit of {name}"


def states_unit(said: str) -> bool:
    """Whether a text has a unit in brackets, beside the ranges in it."""
    return bool(UNIT.search(INTERVAL.sub("", said)))


def missing_of_value(function: FunctionType, doc: Docstring) -> Iterator[str]:
    annotation = str(function.__annotations__.get("return", ""))
    if annotation in ("None", "NoReturn"):
        return
    section = doc.sections.get("Returns", doc.sections.get("Yields", ""))
    said = section or doc.head
    if not section and not returns_said(doc):
        yield "what is returned"
    if ARRAY.search(annotation) and not SHAPE.search(said):
        yield "shape of what is returned"
    if NUMBER.search(annotation) and not states_unit(said):
        yield "unit of what is returned"


def returns_said(doc: Docstring) -> bool:
    """Whether the first line is about the value: "Return …", or a noun phrase and no command."""
    return doc.first.split()[0].strip(".:,") not in {
        "Build", "Check", "Collect", "Compute", "Convert", "Draw", "Evaluate", "Export", "Find",
        "Get", "Give", "Load", "Look", "Make", "Move", "Parse", "Rank", "Read", "Run", "Sample",
        "Say", "Simulate", "Solve", "Sort", "Sweep", "Take", "Trace", "Turn", "Write",
    }  # fmt: skip


def is_formula(function: FunctionType) -> bool:
    """Functions of packages with formulas; those that describe a record of an index are none."""
    if function.__module__ == "gsp.indices.record":
        return False
    numbers = function.__module__.startswith(NUMBERS) and returns_numbers(function)
    return numbers or function.__module__.startswith(FORMULAS)


def returns_numbers(function: FunctionType) -> bool:
    return bool(VALUES.search(str(function.__annotations__.get("return", ""))))


def missing_of_errors(function: FunctionType, doc: Docstring) -> Iterator[str]:
    """Errors that the function raises itself, and those of the checks that it calls."""
    source = textwrap.dedent(inspect.getsource(function))
    section = doc.sections.get("Raises", "")
    raised = {
        node.exc.func.id
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Raise)
        and isinstance(node.exc, ast.Call)
        and isinstance(node.exc.func, ast.Name)
    }
    yield from (f"error {name}" for name in sorted(raised) if name not in section)
    if CHECKS.search(source) and not section:
        yield "errors"


def missing_of_source(function: FunctionType) -> Iterator[str]:
    if is_formula(function) and "*Source" not in (function.__doc__ or ""):
        yield "source"


ALL = callables()


@pytest.mark.parametrize("name", ALL)
def test_docstring_is_complete(name):
    assert missing(ALL[name]) == []


@pytest.mark.parametrize("name", ALL)
def test_no_range_before_a_unit_is_read_as_a_link(name):
    """In Markdown "[0, 1] [1]" is the text "0, 1" with a link to the target "1"."""
    text = re.sub(r"`[^`]*`", "", inspect.getdoc(ALL[name]) or "")
    prose = [line for line in text.splitlines() if not line.lstrip().startswith((">>>", "..."))]
    assert not re.search(r"\] \[", " ".join(prose))


def test_public_names_are_found():
    """Classes, methods, properties, functions; in packages and in public modules."""
    assert {
        "gsp.model.design.designs.Design",
        "gsp.model.design.designs.Design.at",
        "gsp.model.design.anchored.AnchoredDesign.n_legs",
        "gsp.ranking.order.rank",
        "gsp.families.nawratil.symmetric_sets.set_m",
        "gsp.sweeps.tables.sweep",
    } <= set(ALL)


def test_records_that_are_returned_are_found():
    """Of functions, methods and fields, also where an annotation names what is imported later."""
    assert {
        "gsp.indices.motion.InstantaneousMotion.fit",  # gsp.instantaneous_motion
        "gsp.kinematics.prepared.Prepared.joints",  # gsp.prepare
        "gsp.model.posture.assembled.Undefined",  # Posture.undefined
        "gsp.limits.kinds.Quantity",  # RayEnds.bounds: its field `named`
        "gsp.workspace.sets.inside.regular.RegularPart",  # Region.regular_parts
    } <= set(ALL)


def undocumented(a: ArrayLike, b: float, c: Pose) -> Array:  # noqa: F821
    """Compute.

    Parameters
    ----------
    b : float
    c :
    d : int
    """
    raise RuntimeError(check_array(a))  # noqa: F821


def documented(a: ArrayLike, *b: float, flag: bool = False) -> Array:  # noqa: F821
    """Return the sums.

    Parameters
    ----------
    a : (..., 3) array_like [mm]
    *b : float [1]
    flag : bool

    Returns
    -------
    (..., 3) array [mm]

    *Source: none.*
    """


@arguments.validated(n=arguments.number)
def validated(n: float) -> float:
    """Return the number.

    Parameters
    ----------
    n : float [1]

    Returns
    -------
    float [1]
    """
    return n


@dataclasses.dataclass
class Validated:
    """A number.

    Attributes
    ----------
    n : float [1]
    """

    n: float

    def __post_init__(self) -> None:
        if self.n < 0.0:
            raise InvalidInput("n")


class Bracket(NamedTuple):
    """A share of all.

    Attributes
    ----------
    low : float
        In [0, 1].
    high : float [1]
        In (0, 1].
    """

    low: float
    high: float
    middle: float


def test_ranges_are_no_units_and_fields_of_named_tuples_are_found():
    assert missing(Bracket) == ["parameter middle", "unit of low"]


def test_errors_of_decorators_and_of_records_are_found():
    assert missing(validated) == ["errors"]
    assert missing(Validated) == ["error InvalidInput"]


def test_a_missing_source_is_found():
    """Of functions in packages of formulas, and of what returns numbers in the other packages."""

    def function(a: float) -> float: ...

    def other(a: float) -> str: ...

    function.__module__ = other.__module__ = "gsp.model.posture"
    assert list(missing_of_source(function)) == ["source"]
    assert list(missing_of_source(other)) == []
    other.__module__ = "gsp.families.lee"
    assert list(missing_of_source(other)) == ["source"]
    other.__doc__ = "*Source: Lee2000, eq. (1)*"
    assert list(missing_of_source(other)) == []


def test_what_is_missing_is_found():
    assert set(missing(undocumented)) == {
        "parameter a", "no parameter d", "unit of b", "type of c", "shape of c",
        "what is returned", "shape of what is returned", "unit of what is returned",
        "error RuntimeError", "errors",
    }  # fmt: skip
    assert missing(documented) == []
