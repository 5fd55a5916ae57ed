"""Every public callable raises an error of the library for every invalid argument.

The callables are found by enumeration; one without example arguments fails. A call must end within
a limit of time, with an error of the library, or with a result where a value is valid for the
function. After an error there is no new file.
"""

import inspect
import re
import signal
import warnings
from collections.abc import Mapping, Sequence
from contextlib import contextmanager
from itertools import count, repeat
from operator import attrgetter
from os import PathLike
from pathlib import Path
from types import MappingProxyType

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.errors import GspError
from tests import boundary, campaign
from tests.test_copies import LONGEST_REPR, changeable

INVALID = MappingProxyType({
    "None": None, "text": "abc", "number as text": "1.5", "complex": 1j, "bool": True,
    "nan": float("nan"), "inf": np.inf, "negative": -1.0, "zero": 0, "list": [1.0],
    "ragged": [[1, 2], [3]], "object": object(), "great integer": 10**400,
    "array": np.array([1.0, 2.0]), "dict": {"a": 1}, "complex array": np.array([1j, 2, 3]),
    "texts": ["1", "2", "3"], "bools": [True, False, True], "empty text": "", "function": len,
    "date": np.datetime64("2020-01-01"), "bytes": b"\x00\x01", "set": {1.0, 2.0}, "empty": [],
    "type": gsp.Pose, "masked": np.ma.array([1.0, 2, 3], mask=[0, 1, 0]),
    "objects": np.array([None, "a", 3], dtype=object), "nested": [[[[1.0]]]],
    "no axes": np.array(3), "four axes": np.zeros((2, 3, 4, 5)), "matrices": [np.eye(3)] * 2,
    "nans": np.full((6, 3), np.nan), "huge": 1e308, "surrogate": "\ud800", "frame": pd.DataFrame(),
    "long name": "y" * 300,
    "view": memoryview(np.ones((3, 2))), "view of six": memoryview(np.ones((6, 6))),
    "structured": np.zeros(3, dtype=[("x", float), ("y", float)]),
    "dates": np.array(["2020-01-01"] * 3, dtype="datetime64[D]"), "interval": np.timedelta64(1),
    "greatest": np.full((6, 6), 1e308), "greatest pairs": np.full((3, 2), 1e308),
    "bytes of six": b"\4" * 6, "bytes of two": bytearray(b"\4\5"),
    "complex matrix": 1j * np.eye(3), "frame of pairs": pd.DataFrame(np.full((3, 2), "a")),
})  # fmt: skip

# Arrays of numbers: some arguments have their shape.
SHAPES = ("no axes", "four axes", "matrices")

# Seconds that one call may take, on a busy machine too; and if it is late, when tried again, as
# the first call of a compiled function may compile it.
SECONDS_OF_A_CALL, COMPILING = 30, 240
# Callables of which one call takes long: each argument gets a few of the invalid values.
SLOW = ("mapping.section", "surfaces.surface", "planar_section", "checking.check",
        "rendering.render", "rendering.render_motion", "Pose.sample", "corner_poses",
        "simulate")  # fmt: skip


# What is right for an argument, by callable, and cannot be held here: all of a long work, or a
# function of the user whose own errors come out.
RIGHT = MappingProxyType(
    {
        ("checking.check", "papers"): {"None"},
        ("largest.largest_box", "budget"): {"None"},
        ("example_set.over_example_set", "function"): {"function"},
        ("parameters.maxima", "make"): {"function"},
        ("parameters.over_designs", "make"): {"function"},
        ("parameters.over_designs", "pose"): {"function"},
    }
)


def tried(name, argument):
    """Return the kinds of invalid values for an argument of a callable."""
    right = next((v for (c, a), v in RIGHT.items() if a == argument and name.endswith(c)), ())
    return [kind for kind in INVALID if kind not in right]


LATE = "late"


class Late(BaseException):
    """A call that takes too long."""


@contextmanager
def limit(seconds):
    def late(*_):
        raise Late

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def escaped(function, given):
    """Return the outcome of a call if it is neither a result nor an error of the library."""
    found = outcome(function, given, SECONDS_OF_A_CALL)
    return outcome(function, given, COMPILING) if found == LATE else found


def outcome(function, given, seconds):
    """Return what a call raised besides errors of the library, LATE after so many seconds."""
    try:
        with limit(seconds), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            boundary.call(function, given)
    except GspError as error:
        text = str(error)
        return None if 5 < len(text) < 2000 else f"a message of {len(text)} characters"
    except Late:
        return LATE
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return None


NAMES = boundary.names()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An own folder with the files that examples read, and no figure left open."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    boundary.write_files()
    yield tmp_path
    plt.close("all")


@pytest.mark.parametrize("name", NAMES)
def test_only_errors_of_the_library_are_raised(name, folder):
    function, given = boundary.public_callables()[name], boundary.arguments(name)
    rng = np.random.default_rng(len(name))
    few = name.endswith(SLOW)
    number = campaign.count(1 if few else 4, len(INVALID))
    for argument in given:
        for kind in rng.permutation(tried(name, argument))[:number]:
            found = escaped(function, {**given, argument: INVALID[kind]})
            assert found is None, f"{argument}: {kind}: {found}"


# Records of the other kind: of the plane for those in space, and of what belongs to a record.
RECORDS = MappingProxyType({
    "Design": boundary.DESIGN, "Pose": boundary.POSE, "Posture": boundary.DESIGN.at(boundary.POSE),
    "PlanarDesign": boundary.PLANAR, "PlanarPose": boundary.PLANAR_POSE,
    "PlanarPosture": boundary.PLANAR.at(boundary.PLANAR_POSE), "PoseBox": boundary.BOX,
    "Mechanism": boundary.DESIGN.mechanism, "PlanarMechanism": gsp.planar.mechanisms()[0],
    "Ellipsoid": boundary.SPHERE, "Limits": gsp.Limits(), "Path": boundary.PATH,
})  # fmt: skip
# The records with a counterpart in the plane.
PAIRED = ("Design", "Pose", "Posture", "Mechanism")


@pytest.mark.parametrize("name", NAMES)
def test_records_of_other_kinds_are_refused(name, folder):
    """Only errors of the library come out: always for a planar record instead of a spatial one."""
    function, given = boundary.public_callables()[name], boundary.arguments(name)
    rng = np.random.default_rng(len(name))
    number = campaign.count(1 if name.endswith(SLOW) else 3, len(RECORDS))
    for argument, example in given.items():
        other = counterpart(type(example).__name__)
        for kind in {other, *rng.permutation(list(RECORDS))[:number]} - {""}:
            changed = {**given, argument: RECORDS[kind]}
            found = escaped(function, changed)
            assert found is None, f"{argument}: {kind}: {found}"
            if kind == other:
                with pytest.raises(GspError):
                    boundary.call(function, changed)


def counterpart(kind):
    """Return the name of the record in the plane for one in space, and the reverse; or ""."""
    if kind in PAIRED:
        return f"Planar{kind}"
    bare = kind.removeprefix("Planar")
    return bare if bare != kind and bare in PAIRED else ""


def _fails(*_, **__):
    raise RuntimeError("an error of the object itself")


# Special methods that objects may define, but for `__call__`: an object with it is a function.
SPECIAL = tuple(
    f"__{name}__"
    for name in (
        "iter len getitem contains reversed next array array_interface index int float complex "
        "bool round abs neg add radd sub rsub mul rmul truediv rtruediv matmul rmatmul pow eq ne "
        "lt le gt ge hash repr str format bytes fspath enter exit getattr"
    ).split()
)


def hostile(*names, base=object, given=()):
    """An object whose methods of these names, by default all, raise an error of its own."""
    return type("Hostile", (base,), dict.fromkeys(names or SPECIAL, _fails))(*given)


class Classless:
    """An object that does not state its class."""

    __class__ = property(_fails)


# Methods that Python itself needs to make an object and to ask for its attributes.
KEPT = ("__new__", "__init__", "__class__", "__init_subclass__", "__getattribute__", "__dir__",
        "__getnewargs__", "__subclasshook__", "__doc__", "__setattr__", "__delattr__")  # fmt: skip


def all_raise(value):
    """The same value, of a subclass of its type whose methods all raise an error of their own."""
    methods = [name for name in dir(type(value)) if name not in KEPT]
    return hostile(*methods, base=type(value), given=(value,))


def keyed(mapping):
    """The same mapping, whose keys are texts whose methods all raise an error of their own."""
    kinds = [type("Hostile", (str,), {"__hash__": str.__hash__}) for _ in mapping]
    changed = {kind(key): value for kind, (key, value) in zip(kinds, mapping.items(), strict=True)}
    for kind in kinds:  # now that the mapping is made
        for name in set(dir(str)) - {*KEPT}:
            setattr(kind, name, _fails)
    return changed


HOSTILE = MappingProxyType({
    "object": hostile(), "objects": [hostile()] * 6,
    "sequence": hostile(base=Sequence), "mapping": hostile(*SPECIAL, "keys", base=Mapping),
    "path": hostile(*SPECIAL, base=PathLike),
    **{name: hostile(f"__{name}__") for name in ("array", "iter", "index", "float", "repr")},
    **{f"{name}s": [hostile(f"__{name}__")] * 3 for name in ("array", "iter", "index", "float")},
    "length": hostile("__len__", "__getitem__"), "class": Classless(),
    "classes": [Classless()] * 3, "class of a value": {"number": Classless()},
    "text": all_raise("CTN"), "texts": [all_raise("CTN")] * 2, "dictionary": all_raise({"a": 1}),
    "tuple": all_raise((1.0, 2.0)), "list": all_raise([1.0, 2.0]), "integer": all_raise(2),
    "names": keyed({"number": 1.0}), "number": all_raise(1.5), "bytes": all_raise(b"a"),
    "endless": count(), "endless texts": repeat("CTN"),
    "array of them": np.array([hostile("__float__", "__eq__"), hostile("__eq__")], dtype=object),
})  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_errors_of_an_object_itself_do_not_come_out(name, folder):
    function, given = boundary.public_callables()[name], boundary.arguments(name)
    rng = np.random.default_rng(len(name))
    number = campaign.count(1, len(HOSTILE))
    for argument in given:
        for kind in {"object", "text", *rng.permutation(list(HOSTILE))[:number]}:
            found = escaped(function, {**given, argument: HOSTILE[kind]})
            assert found is None, f"{argument}: {kind}: {found}"


def disguised(value):
    """The same argument with texts, also those that it holds, of a subclass of `str`."""
    if isinstance(value, str):
        return all_raise(value)
    if type(value) in (list, tuple):
        return type(value)(map(disguised, value))
    return keyed(value) if isinstance(value, dict) else value


def test_texts_of_subclasses_are_read_as_texts(folder):
    """They are accepted wherever texts are, as `numpy.str_` and members of enumerations."""
    for name in NAMES:
        function, given = boundary.public_callables()[name], boundary.arguments(name)
        texts = {k: v for k, v in given.items() if holds_text(v)}
        if texts and name not in boundary.WITHOUT_EXAMPLE:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                boundary.call(function, {**given, **{k: disguised(v) for k, v in texts.items()}})


def holds_text(value):
    """Whether a value is a text, a mapping of names, or a list with one of these."""
    if type(value) in (list, tuple):
        return any(map(holds_text, value))
    return isinstance(value, str | dict) and len(value) > 0


class HostileFrame(pd.DataFrame):
    """A table that does not state its columns."""

    @property
    def columns(self):
        raise RuntimeError("an error of the object itself")


def twice(table):
    """Return a table with each column twice."""
    doubled = pd.concat([table, table], axis=1)
    doubled.attrs.update(table.attrs)
    return doubled


@pytest.mark.parametrize("make", [twice, HostileFrame])
def test_tables_without_a_column_of_each_name_are_refused(make, folder):
    for name in boundary.names("table", "frame", "checked"):
        function, given = boundary.public_callables()[name], boundary.arguments(name)
        for argument, table in given.items():
            if isinstance(table, pd.DataFrame):
                with pytest.raises(GspError, match="expected"):
                    boundary.call(function, {**given, argument: make(table)})


def test_folders_with_names_that_are_too_long_are_refused(folder):
    found = boundary.names("parts")
    assert len(found) > 2
    for name in found:
        given = {**boundary.arguments(name), "parts": INVALID["long name"]}
        with pytest.raises(GspError, match="File name too long"):
            boundary.call(boundary.public_callables()[name], given)


# Of a long list of results so many are looked at.
MOST_RESULTS = 3


def records(result):
    """The records and named tuples of the library in a result."""
    if isinstance(result, tuple | list) and not hasattr(result, "_fields"):
        return [one for item in result[:MOST_RESULTS] for one in records(item)]
    return [result] if type(result).__module__.startswith("gsp.") else []


def test_examples_are_accepted_and_records_cannot_be_changed(folder):
    """Else the error of one argument would hide what another one does."""
    for name in NAMES:
        if name not in boundary.WITHOUT_EXAMPLE:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                given = boundary.arguments(name)
                result = boundary.call(boundary.public_callables()[name], given)
            for record in records(result):
                assert not changeable(record), f"{name}: {type(record).__name__}"
                assert len(repr(record)) <= LONGEST_REPR, name


def test_an_unknown_keyword_is_refused_by_the_function_that_was_called(folder):
    """Its message names this function, also where keywords are passed on to another one."""
    for name in NAMES:
        function, given = boundary.public_callables()[name], boundary.arguments(name)
        with pytest.raises((TypeError, GspError), match=r"\bcolour\b") as caught:
            boundary.call(function, {**given, "colour": 1})
        # The constructor of a class may be that of its base.
        known = {kind.__name__ for kind in getattr(function, "__mro__", (function,))}
        words = set(re.findall(r"\w+", str(caught.value)))
        assert known & words, f"{name}: {caught.value}"


ROOT = Path(__file__).parent.parent
PAGES = (ROOT / "README.md", *ROOT.glob("docs/**/*.md"), *ROOT.glob("docs/gallery/*.py"),
         *ROOT.glob("notebooks/*.ipynb"))  # fmt: skip
# A function of the insides that a page on the design names.
INSIDE = "gsp.geometry.matrices.newton"


def documented():
    """The dotted names in the pages, also of what they import."""
    for page in PAGES:
        text = page.read_text()
        yield from re.findall(r"gsp(?:\.\w+)+", text)
        for module, names in re.findall(r"from (gsp[\w.]*) import ([\w, ]+)", text):
            yield from (f"{module}.{name.split()[0]}" for name in names.split(","))


def test_functions_that_the_pages_name_are_enumerated():
    """So packages below the public ones are enumerated too, if users are told of them."""
    public = {p.function for p in boundary.public().values()}
    for name in {*documented()} - {INSIDE}:
        try:
            named = attrgetter(name.removeprefix("gsp."))(gsp)
        except AttributeError:
            continue  # tests of the pages hold that their code runs
        if inspect.isfunction(named):
            assert named in public, name


def test_every_parameter_has_an_example():
    for name in NAMES:
        given = boundary.arguments(name)
        for parameter in inspect.signature(boundary.public_callables()[name]).parameters.values():
            if parameter.kind == parameter.VAR_POSITIONAL:
                assert any(key.startswith(f"*{parameter.name}") for key in given), name
            elif parameter.kind != parameter.VAR_KEYWORD:
                assert parameter.name in given, f"{name}: {parameter.name}"


def test_examples_belong_to_callables():
    """A key of a table that no callable has is an example that nobody uses."""
    for key in (*boundary.OVERRIDES, *boundary.VARIADIC, *boundary.WITHOUT_EXAMPLE):
        assert any(f".{name}".endswith(f".{key}") for name in NAMES), key


# --- what has to work ---

DESIGN = gsp.catalogue.design("toz-kucuk-2016-d3-6")


def read_only(values):
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array


FORMS = MappingProxyType(
    {
        "read-only": read_only,
        "float32": lambda values: np.array(values, dtype=np.float32),
        "strided": lambda values: np.repeat(np.array(values, dtype=float), 2, axis=-1)[..., ::2],
        "Fortran order": lambda values: np.asfortranarray(values, dtype=float),
        "numpy scalars": lambda values: np.vectorize(np.float64, otypes=[object])(values).tolist(),
        "pandas": lambda values: (
            pd.Series(values) if np.ndim(values) == 1 else pd.DataFrame(np.asarray(values))
        ),
        "integers": lambda values: np.rint(np.array(values)).astype(int),
    }
)


@pytest.mark.parametrize("form", FORMS)
def test_arrays_of_all_forms_are_accepted(form):
    make = FORMS[form]
    position = np.array([10.0, -10.0, 138.0])
    points, other = 100.0 * np.eye(6, 3), 90.0 * np.eye(6, 3)[::-1] + 1.0
    design = gsp.Design(["D1"] * 6, make(points), make(other), strokes=make([[50, 300]] * 6))
    np.testing.assert_array_equal(design.base_points, points)
    assert design.base_points.flags.c_contiguous
    pose = gsp.Pose(make(position), np.eye(3))
    np.testing.assert_array_equal(pose.position, position)
    ellipsoid = gsp.Ellipsoid(make([3, 2, 1]))
    np.testing.assert_array_equal(ellipsoid.semi_axes, [3, 2, 1])
    table = gsp.rank([DESIGN, DESIGN], DESIGN.home, "λ", maximum=make([1e7, 2e7]))
    low, high = sorted(table["quality_index_mean"])
    assert high == pytest.approx(2.0 * low)
    solved = gsp.forward(DESIGN, make(DESIGN.at(DESIGN.home).joints), DESIGN.home)
    assert solved.pose.shape == ()


@pytest.mark.parametrize("form", ["strided", "Fortran order", "pandas"])
def test_the_order_in_memory_changes_no_bit(form):
    make = FORMS[form]
    rng = np.random.default_rng(0)
    points, other, lines = rng.normal(size=(3, 8, 3))
    position = rng.normal(size=(200, 3))
    turn = np.linalg.qr(rng.normal(size=(200, 3, 3)))[0]
    turn *= np.linalg.det(turn)[:, None, None]
    here = gsp.Design(["D1", "D3"] * 4, points, other, lines).at(gsp.Pose(position, turn))
    legs = ["D1", "D3"] * 4
    there = gsp.Design(legs, make(points), make(other), make(lines)).at(
        gsp.Pose(make(position), turn if form == "pandas" else make(turn))
    )
    assert here.design.rms_radius == there.design.rms_radius
    for name in ("joints", "jacobian"):
        np.testing.assert_array_equal(getattr(here, name), getattr(there, name))
    for name in ("condition_number", "manipulability", "minimum_singular_value"):
        index = gsp.indices.INDICES[name]
        given = {"length": 0.7} if "length" in index.parameters else {}
        same = index.function(here, **given) == index.function(there, **given)
        assert same.all(), name


@pytest.mark.parametrize("name", gsp.PACKAGES)
def test_every_public_package_is_an_attribute(name):
    assert getattr(gsp, name).__name__ == f"gsp.{name}"
    assert getattr(gsp, name).__doc__


@pytest.mark.parametrize("form", [np.array, pd.DataFrame, memoryview, np.ma.array, read_only])
def test_pairs_are_accepted_as_arrays_of_all_kinds(form):
    pairs = np.array([[-1.0, 1.0], [0.0, 2.0], [3.0, 4.0]])
    given = pairs.copy() if form is memoryview else pairs
    box = gsp.PoseBox(form(given), form(given))
    np.testing.assert_array_equal(box.low, np.tile(pairs[:, 0], 2))
    np.testing.assert_array_equal(box.high, np.tile(pairs[:, 1], 2))
    np.testing.assert_array_equal(gsp.Limits(position=form(given)).position, pairs)


@pytest.mark.parametrize(
    "take", [lambda x: gsp.PoseBox(x, [0, 0, 0]), lambda x: gsp.Limits(position=x)]
)
def test_masked_pairs_are_refused(take):
    pairs = np.ma.array([[0.0, 1.0]] * 3, mask=[[0, 0], [0, 1], [0, 0]])
    with pytest.raises(GspError, match="masked"):
        take(pairs)


MIXED = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
REFUSED = MappingProxyType({
    "tolerance": lambda: gsp.instantaneous_motion(MIXED.at(MIXED.home), length=90.0).fit("a"),
    "great tolerance": (
        lambda: gsp.instantaneous_motion(MIXED.at(MIXED.home), length=90.0).multiplicity(10**400)
    ),
    "great integer in real time": lambda: gsp.prepare(DESIGN)(10**400, np.eye(3)),
    "grid": lambda: gsp.PoseBox([0, 0, 1], [0, 0, 0]).grid(10**4),
    "angles of a sheared matrix": lambda: gsp.geometry.angles_from_rotation(np.eye(3) + 0.1),
    "angles of zeros": lambda: gsp.geometry.angles_from_rotation(np.zeros((3, 3))),
    "shape": lambda: gsp.planar.PlanarPose([[0, 0], [1, 0]]).reshape(5),
    "factor": lambda: gsp.Ellipsoid(1.0).scaled("2"),
    "label": lambda: gsp.workspace.Shells([[0, 0, 0]], [1], [2]).label([(3, 0)]),
})  # fmt: skip


@pytest.mark.parametrize("call", REFUSED)
def test_methods_of_results_raise_on_invalid_arguments(call):
    with pytest.raises(GspError):
        REFUSED[call]()


def test_empty_batches_have_empty_results():
    shape = (0, 6, 6)
    whitened = gsp.Ellipsoid(1.0).whiten(np.empty(shape), np.empty((0, 3, 3)))
    assert whitened.shape == shape
    assert gsp.Ellipsoid(1.0).whiten(np.empty((0, 6)), np.eye(3)).shape == (0, 6)
    lift = gsp.catalogue.design("workspace-6-3")
    unturned = gsp.PoseBox([0, 0, 0], [0, 0, 0])
    reached = gsp.workspace.dextrous(lift, unturned, resolution=6.0)
    assert reached.contains(np.empty((0, 3))).shape == (0,)
    none = gsp.Pose(np.zeros((0, 3)))
    for name, index in gsp.indices.INDICES.items():
        given = {"length": 90.0, "ellipsoid": gsp.Ellipsoid(50.0), "maximum": 1.0}
        kept = {key: given[key] for key in index.parameters}
        assert index.function(MIXED.at(none), **kept).shape == (0,), name
