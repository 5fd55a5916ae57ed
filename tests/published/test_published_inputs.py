"""Each recomputation depends on every input that its record names, unless it is `invariant`.

An input is changed, the value is computed again, and is judged by the record as it stands: the
verdict must fall. Of an input that is listed as `invariant` the value must not change if it is
changed a little, and for one other value at least if it is a name or a count.

The short form changes some of the inputs, in an order drawn from one seed; the full form all.
"""

import dataclasses
import re

import numpy as np
import pytest

from gsp import catalogue, published
from gsp.errors import FailedComputation, InvalidInput, MalformedFile
from gsp.indices import INDICES
from gsp.published.checking import judge
from gsp.published.computing import compute
from tests import campaign
from tests.published.records import RECORDS

LETTERS = {
    "lee-3-3": {}, "lee-3-6": {"beta": 0.2}, "lee-6-6": {"alpha": 0.15, "beta": 0.2},
    "lee-centre": {"rho": 0.15}, "lee-side": {"rho": 0.15},
}  # fmt: skip
# Other values of the inputs that are names.
CHOICES = {
    "family": tuple(LETTERS),
    "design": tuple(catalogue.designs()["name"]),
    "index": (*INDICES, "rank", "one-sided", "CTN"),
    "axis": ("x", "y", "z"),
    "about": ("own", "base"),
    "heights": ("(2)", "(27)"),
    "what": ("value", "theta", "h"),
    "origin": ("base", "platform", "midway"),
    "letter": ("kappa", "h", "alpha"),
    "energies": ("maximal/minimal", "minimal/maximal"),
    "criterion": ("distance", "angle", "pitch_error"),
    "system": ("congruence", "bundle", "field", "regulus", "two pencils", "one line", "parallel"),
    "nominal": ("nategh-agheli-nominal", "nategh-agheli-real"),
    "joint": ("d1", "d2", "d3", "d4", "d5", "d6", "theta4", "theta5"),
    "mechanism": ("D1^6", "D4^3 A1^3", "D1 D2 D3 D4 A1^2", "D3^6", "D1^5 D3"),
    "constraint": ("D1", "D2", "D3", "D4", "A1"),
    "chain": ("SPS", "SPC", "CPS", "CCC"),
    "label": ("000000", "111111", "-0000-", "011110", "01--10", "11--11", "0-0---", "-1-1--"),
    "labels": ("-0000-", "00--00", "0-11-0", "-1111-", "11--11"),
    "unit": ("deg", "rad"),
    "lowest": ("horizontal", "point A"),
    "side": ("base", "platform"),
    "matrix": ("IDAll", "IDBound"),
    "reading": (
        "as printed", "inside", "without the bracket", "((d × s) × s) × R b",
    ),
    "change": ("base", "platform", "exchange"),
    "equation": ("(3.3)", "(3.5)", "(3.7)", "(B.1)", "(C.1)"),
}  # fmt: skip


def changes(value, key, small=False):
    """Other values of an input; small ones if it is to be invariant."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, str):
        return [other for other in CHOICES[key] if other != value]
    if isinstance(value, int):
        return [value + 1, value - 1, value + 2]
    if isinstance(value, float):
        step = 1e-3 * max(abs(value), 1e-9) if small else 0.1 * max(abs(value), 1.0)
        return [value + step, value - step] + (
            [] if small else [0.5 * value + 0.3, 2.0 * value, 0.7]
        )
    if isinstance(value, tuple):
        return [
            [*value[:i], other, *value[i + 1 :]]
            for i in range(len(value))
            for other in changes(value[i], key, small)
        ] or [[2]]
    return [{**value, k: other} for k in value for other in changes(value[k], k, small)]


def changed(record, key, value):
    arguments = {**record.arguments, key: value}
    if key == "family":
        letters = {letter for needed in LETTERS.values() for letter in needed}
        arguments = {k: v for k, v in arguments.items() if k not in letters}
        needed = LETTERS[value].items()
        arguments |= {k: record.arguments.get(k, v) for k, v in needed}
    return dataclasses.replace(record, arguments=arguments)


def recomputed(record, key, value):
    """The changed value of a quantity, or None if the change is refused."""
    try:
        return compute(changed(record, key, value))
    except (FailedComputation, MalformedFile):
        return None


INPUTS = [(record, key) for record in RECORDS for key in record.arguments]


def drawn(inputs, short):
    """Return the inputs that this form changes, with their names."""
    order = np.random.default_rng(20).permutation(len(inputs))
    found = [inputs[i] for i in order[: campaign.count(short, len(inputs))]]
    return [pytest.param(r, key, id=f"{r.origin}-{r.quantity}-{key}") for r, key in found]


def falls(record, value):
    """Whether the verdict no longer holds for a value, by the letters of the record."""
    if record.verdict == "misprint" and record.correct is None:
        return not np.allclose(value, compute(record), rtol=1e-9, atol=1e-12, equal_nan=True)
    return not all(row["holds"] for row in judge(record, value))


def tried(record, key, values):
    found = [recomputed(record, key, value) for value in values]
    return [value for value in found if value is not None]


def matters(record, key):
    """Whether another input must make the verdict fall: all angles of horns are printed as 0."""
    zero = key == "joint" and str(record.printed) == "0"
    return key not in record.invariant and not zero


@pytest.mark.parametrize(("record", "key"), drawn([(r, k) for r, k in INPUTS if matters(r, k)], 80))
def test_the_verdict_falls_if_an_input_is_changed(record, key):
    values = changes(record.arguments[key], key)
    done = False
    for value in values:
        computed = recomputed(record, key, value)
        if computed is not None:
            done = True
            if falls(record, computed):
                return
    assert not done, f"{key} does not matter"
    assert recomputed(record, key, "nonsense") is None


@pytest.mark.parametrize(
    ("record", "key"), drawn([(r, k) for r, k in INPUTS if k in r.invariant], 30)
)
def test_an_invariant_input_does_not_change_the_value(record, key):
    here = compute(record)
    values = changes(record.arguments[key], key, small=True)
    found = tried(record, key, values)
    assert found, "every change is refused"
    known = (record.printed != "") if record.printed.shape else np.array(True)
    same = [np.isclose(value, here, rtol=1e-6, atol=1e-6)[known].all() for value in found]
    names = isinstance(record.arguments[key], str | int)
    assert any(same) if names else all(same)


@pytest.mark.parametrize("places", [b"figure", re.compile(b"figure"), 5, "(", ["a"]], ids=repr)
def test_places_are_a_regular_expression_of_text(places):
    with pytest.raises(InvalidInput, match="places: expected a regular expression"):
        published.check("Workspace-A", places=places)
