"""Records of indices reject facts that cannot be."""

import pickle
from dataclasses import replace

import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.indices import INDICES, Invariance
from gsp.indices.record import ALL_SIX

INDEX = INDICES["condition_number"]
DESIGN = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


@pytest.mark.parametrize(
    "changes",
    [
        {"name": 3},
        {"name": ""},
        {"symbol": None},
        {"function": "det"},
        {"better": "sideways"},
        {"best": "good"},
        {"worst": float("nan")},
        {"worst": True},
        {"best": INDEX.worst, "worst": INDEX.best},
        {"parameters": "length"},
        {"parameters": ("width",)},
        {"parameters": (), "needs": ("length",)},
        {"length_for": "all"},
        {"unit_power": "length^2"},
        {"source": 1},
        {"properties": True},
        {"invariance": None},
        {"actuators": 0},
        {"routine": "yes"},
        {"share_of": None},
    ],
    ids=str,
)
def test_an_index_of_wrong_facts_is_an_error(changes):
    with pytest.raises(
        InvalidInput, match=next(iter(changes)) if len(changes) == 1 else "expected"
    ):
        replace(INDEX, **changes)


@pytest.mark.parametrize(("record", "value"), [(ALL_SIX, "yes"), (Invariance(), "sometimes")])
def test_statements_about_an_index_have_known_words(record, value):
    for name in vars(record):
        with pytest.raises(InvalidInput, match=name):
            replace(record, **{name: value})


def test_an_index_that_is_a_share_is_another_one_over_the_maximum():
    """Exactly those with the parameter "maximum"."""
    posture = DESIGN.at(DESIGN.home)
    shares = {name: index for name, index in INDICES.items() if index.share_of}
    assert set(shares) == {n for n, index in INDICES.items() if "maximum" in index.parameters}
    for index in shares.values():
        whole = INDICES[index.share_of].function(posture)
        assert index.function(posture, maximum=5.0) == pytest.approx(whole / 5.0, rel=1e-14)
        assert INDICES[index.share_of].of_determinant == index.of_determinant


def test_a_pickled_index_is_equal():
    """Also its functions: workers in other processes get records so."""
    for index in INDICES.values():
        assert pickle.loads(pickle.dumps(index)) == index
