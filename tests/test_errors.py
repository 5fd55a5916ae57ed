"""The errors: kinds, messages, and pickling."""

import datetime as dt
import inspect
import pickle

import numpy as np
import pytest

import gsp
from gsp import arguments, errors
from gsp.errors import GspError, InvalidInput, UnknownMechanism, brief, expected

KINDS = {
    name: kind
    for name, kind in inspect.getmembers(errors, inspect.isclass)
    if issubclass(kind, GspError) and kind is not GspError
}

BUILT_IN = {
    "EmptyWorkspace": ValueError, "FailedComputation": ArithmeticError,
    "InvalidDesign": ValueError, "InvalidInput": ValueError, "InvalidIndex": IndexError,
    "InvalidRotation": ValueError, "MalformedFile": ValueError,
    "MissingParameter": TypeError, "MissingSoftware": ImportError, "UndefinedPosture": ValueError,
    "UnknownDesign": KeyError, "UnknownIndex": KeyError, "UnknownMechanism": KeyError,
    "UnknownName": KeyError, "UnwritableOutput": OSError,
}  # fmt: skip
ARGUMENTS = {
    "MissingSoftware": ("matplotlib", "plots", "plots"),
    "UndefinedPosture": ("hexapod", [((2,), "d1", "the anchor points coincide")]),
    **{
        name: ("thing", "x", ["xy", "z"])
        for name in ("UnknownName", "UnknownDesign", "UnknownIndex", "UnknownMechanism")
    },
}


class Incomparable(str):
    """A text that cannot be compared."""

    __slots__ = ()
    __hash__ = str.__hash__

    def __eq__(self, other):
        raise RuntimeError("an error of the object itself")


def test_texts_are_compared_as_plain_texts():
    check = arguments.one_of("linear", "huber")
    assert type(check("loss", Incomparable("huber"))) is str
    with pytest.raises(InvalidInput, match="loss: expected linear or huber, received 'cubic'"):
        check("loss", Incomparable("cubic"))


def test_long_lists_are_written_by_their_first_items():
    assert brief(list(range(1000))) == f"{str(list(range(1000)))[:57]}..."
    nested = [[[0.0] * 3] * 10**6] * 10**6
    assert brief(nested) == f"{str([[[0.0] * 3] * 9])[:57]}..."
    assert brief(((), (1,), [2])) == "((), (1,), [2])"


def test_every_kind_has_its_built_in():
    assert set(KINDS) == set(BUILT_IN)


@pytest.mark.parametrize("name", BUILT_IN)
def test_kinds(name):
    kind = getattr(errors, name)
    assert issubclass(kind, GspError)
    assert issubclass(kind, BUILT_IN[name])
    error = kind(*ARGUMENTS.get(name, ("x: expected y, received z",)))
    assert str(error)
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is kind
    assert str(copy) == str(error)
    assert {k: v for k, v in vars(copy).items() if k != "_given"} == {
        k: v for k, v in vars(error).items() if k != "_given"
    }


def test_nearest_names():
    error = UnknownMechanism("mechanism", "D1^5 D", ["D1^6", "D1^5 D2", "A1"], "Six of them")
    assert error.nearest[0] == "D1^5 D2"
    assert str(error) == "unknown mechanism 'D1^5 D'; nearest: D1^5 D2, D1^6. Six of them"
    assert UnknownMechanism("mechanism", "??", ["D1^6"]).nearest == ()


def test_expected():
    assert len(expected("x", "y", np.arange(1e4).tolist())) < 100
    assert expected("x", "y", "z", "there") == "x (there): expected y, received z"


def test_brief_of_a_list_that_has_no_repr():
    deep = []
    for _ in range(100_000):
        deep = [deep]
    assert brief(deep) == "a deeply nested list"


@pytest.mark.parametrize("value", [np.array(3), np.ma.masked], ids=["array", "masked"])
def test_arrays_without_axes_are_not_sequences(value):
    """They are instances of Iterable, but cannot be iterated over."""
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    for call in (
        gsp.indices.index_names,
        lambda names: gsp.evaluate(design, design.home, names),
        lambda designs: gsp.rank(designs, design.home),
        lambda papers: gsp.published.select(papers),
    ):
        with pytest.raises(InvalidInput, match="expected"):
            call(value)


def test_dates_are_named_in_messages():
    """TOML has dates; a reader of the message may not know their Python forms."""
    zone = dt.timezone(dt.timedelta(hours=1))
    given = [dt.date(2020, 1, 2), dt.time(3, 4), dt.datetime(2020, 1, 2, 3, 4, tzinfo=zone)]
    assert [brief(value) for value in given] == ["a date", "a time", "a datetime"]
    assert brief([given[0], 1.0, given[2]]) == "[a date, 1.0, a datetime]"


def test_messages_can_be_printed_and_are_not_long():
    for text in ("\udc80", "a\0b", "a" * 1_000_000, "\x1b[31m", "λ ≥ 1\tm\n"):
        shown = str(InvalidInput(expected("path", "a file", text)))
        shown.encode()
        assert "\0" not in shown
        assert "\x1b" not in shown
        assert len(shown) < 4000
    assert str(InvalidInput("λ ≥ 1\tm\n")) == "λ ≥ 1\tm\n"
    assert str(InvalidInput("\udc80\0")) == r"\udc80\x00"


def test_a_number_beyond_a_bound_does_not_look_equal_to_it():
    assert errors.apart(0.1, 2.0) == ("0.1", "2")
    for bound in (1.0, 2.0 * np.pi, 1e100, 1e-300):
        value = np.nextafter(bound, np.inf)
        texts = errors.apart(value, bound, 0.5 * bound)
        assert len(set(texts)) == 3
        assert float(texts[0]) > float(texts[1])
    assert errors.apart(1.0, 1.0) == ("1", "1")
    with pytest.raises(InvalidInput, match=r"in \[0, 1\], received 1.0000000000000002"):
        arguments.shares("x", np.nextafter(1.0, 2.0))
    design = gsp.catalogue.design("workspace-6-3").replace(strokes=[[8.0, 12.0]] * 6)
    pose = gsp.Pose([0.0, 0.0, 10.0])
    joints = design.at(pose).joints
    close = np.stack((0.5 * joints, joints * (1.0 - 1e-9)), axis=1)
    reason = gsp.feasible(design.replace(strokes=close), pose).reason
    value, bound = (float(x) for x in reason.split(";")[0].split(" = ")[1].split(" > "))
    assert value > bound


def test_a_design_without_a_name_is_not_named():
    lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    message = "condition_number: expected length=, received none"
    for name, ending in (("lift", " (design 'lift')"), ("", "")):
        with pytest.raises(errors.MissingParameter) as caught:
            gsp.evaluate(lift.replace(name=name), lift.home, ["condition_number"])
        assert str(caught.value) == message + ending
