"""Results have the same bits for any number of workers, and again for the same seed.

Generated: every public callable with `workers`, `seed` or `rng`, called with its example arguments.
Larger cases are beside the tests of `evaluate`, `rank`, `certify` and `reachable`.
"""

import inspect

import numpy as np
import pandas as pd
import pytest

from tests import boundary

SEEDS = ("seed", "rng")


def numbers(result):
    """The arrays of a result, one after the other."""
    if isinstance(result, pd.DataFrame):
        return [column.to_numpy() for _, column in result.items()]
    if isinstance(result, dict):
        return numbers(list(result.values()))
    if isinstance(result, tuple | list):
        return [array for part in result for array in numbers(part)]
    if isinstance(result, type):
        return []
    if hasattr(result, "__dataclass_fields__"):
        return [a for name in result.__dataclass_fields__ for a in numbers(getattr(result, name))]
    if hasattr(result, "position") and hasattr(result, "rotation"):
        return [result.position, result.rotation]
    if isinstance(result, np.ndarray | float | int | str):
        return [np.asarray(result)]
    return []


def agree(name, one, other):
    found, again = numbers(one), numbers(other)
    assert found, name
    assert len(found) == len(again)
    for a, b in zip(found, again, strict=True):
        if a.dtype.kind != "O":
            np.testing.assert_array_equal(a, b, err_msg=name)


@pytest.mark.parametrize("name", boundary.names("workers"))
def test_the_number_of_workers_changes_no_bit(name):
    function, given = boundary.public_callables()[name], boundary.arguments(name)
    given["executor"] = None
    if "executor" not in inspect.signature(function).parameters:
        del given["executor"]
    one, three = (boundary.call(function, {**given, "workers": n}) for n in (1, 3))
    agree(name, one, three)


@pytest.mark.parametrize("name", boundary.names(*SEEDS))
def test_a_seed_gives_the_same_bits_again(name):
    function, given = boundary.public_callables()[name], boundary.arguments(name)
    key = next(k for k in SEEDS if k in given)
    if "store" in given:
        given["store"] = False
    one, two = (boundary.call(function, {**given, key: 5}) for _ in range(2))
    agree(name, one, two)


@pytest.mark.parametrize("name", [n for n in boundary.names("rng") if n.endswith("sample")])
def test_another_seed_gives_other_samples(name):
    function, given = boundary.public_callables()[name], boundary.arguments(name)
    one, two = (numbers(boundary.call(function, {**given, "rng": k})) for k in (5, 6))
    assert any((a != b).any() for a, b in zip(one, two, strict=True))
