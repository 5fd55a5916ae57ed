"""The errors: kinds, messages, and that they survive pickling."""

import inspect
import pickle

import pytest

from gsp import errors
from gsp.errors import GspError, UnknownMechanism, UnknownName, expected

KINDS = [k for _, k in inspect.getmembers(errors, inspect.isclass) if issubclass(k, GspError)]

BUILT_IN = {
    "InvalidInput": ValueError, "InvalidRotation": ValueError, "InvalidDesign": ValueError,
    "MalformedFile": ValueError, "MissingParameter": TypeError, "UnwritableOutput": OSError,
    "UnknownName": KeyError, "UnknownMechanism": KeyError, "UnknownDesign": KeyError,
    "UnknownIndex": KeyError, "UndefinedPosture": ArithmeticError,
}  # fmt: skip


@pytest.mark.parametrize(("name", "built_in"), BUILT_IN.items())
def test_kinds_mix_in_the_built_in_that_fits(name, built_in):
    kind = getattr(errors, name)
    assert issubclass(kind, GspError)
    assert issubclass(kind, built_in)


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.__name__)
def test_messages_and_pickling(kind):
    plain = [p.default is inspect.Parameter.empty for p in _parameters(kind)]
    error = kind(*["x", "y", ["yes", "z"]][: sum(plain)]) if plain else kind("x: expected y")
    assert "x" in str(error)
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is kind
    assert str(copy) == str(error)


def _parameters(kind):
    if "__init__" not in vars(kind) and not issubclass(kind, UnknownName):
        return []
    return list(inspect.signature(kind.__init__).parameters.values())[1:]


def test_nearest_names():
    error = UnknownMechanism("mechanism", "D1^5 D", ["D1^6", "D1^5 D2", "A1"], "Six of them")
    assert error.nearest[0] == "D1^5 D2"
    assert str(error) == "unknown mechanism 'D1^5 D'; nearest: D1^5 D2, D1^6. Six of them"
    assert UnknownMechanism("mechanism", "??", ["D1^6"]).nearest == ()


def test_expected():
    assert expected("x", "y", "z", "there") == "x (there): expected y, received z"
