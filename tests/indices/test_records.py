"""Records of indices reject facts that cannot be."""

from dataclasses import replace

import pytest

from gsp.errors import InvalidInput
from gsp.indices import INDICES, Invariance
from gsp.indices.record import ALL_SIX

INDEX = INDICES["condition_number"]


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
