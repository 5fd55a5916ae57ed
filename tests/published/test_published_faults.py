"""Verdicts that no input can change, as the claim is that nothing matters, fall by other changes.

Such a record states it (`invariant`), with its claim as text or its reason as proof. A fault is put
into one function that its recomputation calls: its numbers are changed by some percent. The verdict
must fall for one of these functions at least; if it did not, it would hold for any library.

The short form takes some of the records, in an order drawn from one seed; the full form all.
"""

import functools
import importlib
import inspect
import sys
from contextlib import contextmanager

import numpy as np
import pytest

import gsp
from gsp.errors import FailedComputation, MalformedFile
from gsp.model.posture import Posture
from gsp.published.computing import compute
from tests import campaign
from tests.published.records import RECORDS
from tests.published.test_published_inputs import changes, falls, recomputed

# What reads and compares records, and checks arguments, is not part of a recomputation.
NO_PART = ("gsp.published.checking", "gsp.published.computing", "gsp.published.record",
           "gsp.published.numbers",
           "gsp.published.quantities", "gsp.arguments", "gsp.checks", "gsp.installed", "gsp.errors",
           "gsp.files")  # fmt: skip


# The other ones have an input of which `test_published_inputs` shows that it matters.
FIXED = [record for record in RECORDS if set(record.arguments) <= set(record.invariant)]


def constant(result):
    """Return zeros for numbers, and for a design one whose base and platform are equal."""
    if isinstance(result, float | np.floating | np.ndarray):
        return 0.0 * np.asarray(result)
    if isinstance(result, gsp.Design):
        return result.replace(platform_points=result.base_points)
    return NotImplemented


def of_other_size(result):
    """Return half of a sequence, or a design with its last leg twice."""
    if isinstance(result, gsp.Design):
        twice = [*range(len(result.legs)), len(result.legs) - 1]
        names = ("base_points", "platform_points", "base_directions", "platform_directions")
        given = (None if (v := getattr(result, n)) is None else v[twice] for n in names)
        return gsp.Design([result.legs[i].name for i in twice], *given)
    if isinstance(result, tuple | list):
        return result[: len(result) // 2]
    return NotImplemented


def damaged(result):
    """Return a result with its numbers changed by up to 10 %, each by another share."""
    if isinstance(result, bool | np.bool_):
        return not result
    if isinstance(result, float | np.floating):
        return 1.1 * result + 0.05
    if isinstance(result, np.ndarray) and result.dtype.kind == "f":
        shares = 0.1 * np.sin(1.0 + np.arange(result.size)).reshape(result.shape)
        return result * (1.0 + shares) + 0.05 * shares
    if isinstance(result, gsp.Design):
        return result.replace(platform_points=damaged(result.platform_points))
    if type(result) is tuple:
        return tuple(damaged(part) for part in result)
    return NotImplemented


def called(record):
    """Return the functions of the library, by modules and names, that a recomputation calls."""
    found, own = {}, (record.quantity, "design_names")  # the latter are files, not numbers

    def watch(frame, event, _):
        module = frame.f_globals.get("__name__", "")
        name = frame.f_code.co_name
        if event != "call" or not module.startswith("gsp.") or module in NO_PART:
            return
        function = inspect.unwrap(frame.f_globals.get(name, watch))
        if getattr(function, "__code__", None) is frame.f_code and name not in own:
            found.setdefault((module, name))

    forget()
    sys.setprofile(watch)
    try:
        compute(record)
    finally:
        sys.setprofile(None)
    # What is kept from earlier calls is not called again.
    return [*found, ("gsp.catalogue", "mechanisms"), ("gsp.catalogue", "instantiate")]


def forget():
    """Clear what recomputations keep."""
    for label, module in list(sys.modules.items()):
        if label.startswith("gsp.published.quantities"):
            for value in vars(module).values():
                getattr(value, "cache_clear", bool)()


@contextmanager
def faulty(module, name, damage):
    """Damage the results of a function wherever the library refers to it."""
    function = getattr(importlib.import_module(module), name)

    @functools.wraps(function)
    def wrong(*args, **kwargs):
        result = function(*args, **kwargs)
        other = damage(result)
        return result if other is NotImplemented else other

    places = [
        (found, key)
        for label, found in list(sys.modules.items())
        if label.startswith("gsp") and found is not None
        for key, value in list(vars(found).items())
        if value is function
    ]
    forget()
    try:
        for found, key in places:
            setattr(found, key, wrong)
        yield
    finally:
        for found, key in places:
            setattr(found, key, function)
        forget()


def fallen(record):
    """Return the first function of which a fault makes the verdict fall, or None."""
    for damage in (damaged, constant, of_other_size):
        for module, name in called(record):
            with faulty(module, name, damage):
                try:
                    value = compute(record)
                except (FailedComputation, MalformedFile) as error:
                    if damage is of_other_size and "shape (" in str(error):
                        return module, name
                    continue
                except RuntimeError:
                    continue
            if falls(record, value):
                return module, name
    return one_column_more(record)


def one_column_more(record):
    """Return the name of a property if the verdict falls by a wrong number of its columns."""
    whole = Posture.jacobian
    with pytest.MonkeyPatch.context() as patch:
        wider = property(lambda self: np.pad(whole.__get__(self), [(0, 0), (0, 1)]))
        patch.setattr(Posture, "jacobian", wider)
        try:
            value = compute(record)
        except (FailedComputation, MalformedFile):
            return None
    return "Posture.jacobian" if falls(record, value) else None


def by_a_great_change(record):
    """Whether the verdict falls by a change of an input that is invariant near its value."""
    for key, value in record.arguments.items():
        for other in changes(value, key):
            found = recomputed(record, key, other)
            if found is not None and falls(record, found):
                return True
    return False


def drawn(short):
    order = np.random.default_rng(11).permutation(len(FIXED))
    found = [FIXED[i] for i in order[: campaign.count(short, len(FIXED))]]
    return [pytest.param(record, id=f"{record.origin}-{record.quantity}") for record in found]


@pytest.mark.parametrize("record", drawn(2))
@pytest.mark.filterwarnings("ignore")
def test_a_verdict_that_no_input_changes_falls_by_a_fault_of_the_library(record):
    assert fallen(record) is not None or by_a_great_change(record)


def test_records_that_no_input_changes_state_the_claim_or_a_reason():
    unexplained = [r.origin for r in FIXED if r.arguments and not (r.text or r.proof)]
    assert not unexplained
