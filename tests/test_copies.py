"""Copied and unpickled records: their arrays are read-only as those of the originals, and equal."""

import copy
import pickle
from dataclasses import fields, is_dataclass
from functools import cached_property

import numpy as np
import pytest

import gsp
from gsp.errors import GspError
from tests import boundary

# A store is a connection.
INTERMEDIATE = "_few_parts"  # vectors of the assembly of a posture
LONGEST_REPR = 500  # characters
KINDS = sorted(set(boundary.instances()) - {"Store"})


def arrays(value, path="", seen=None):
    """Yield all arrays that a record holds, by the names that lead to them."""
    seen = {} if seen is None else seen
    if id(value) in seen:
        return
    seen[id(value)] = value
    if isinstance(value, np.ndarray):
        yield path, value
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from arrays(item, f"{path}[{key!r}]", seen)
    elif isinstance(value, tuple | list):
        for number, item in enumerate(value):
            yield from arrays(item, f"{path}[{number}]", seen)
    if type(value).__module__.startswith("gsp") and hasattr(value, "__dict__"):
        for key, item in vars(value).items():
            yield from arrays(item, f"{path}.{key}", seen)


def given(value):
    """Yield what the public names of a record give, and what it keeps of them: name and value."""
    for name in dir(type(value)):
        kind = getattr(type(value), name, None)
        kept = isinstance(kind, cached_property) and name != INTERMEDIATE
        if kept or not (name.startswith("_") or callable(kind)):
            try:
                yield name, getattr(value, name)
            except (GspError, AttributeError):
                pass  # of records of another kind, as the area of a region in space
    if is_dataclass(value):
        yield from ((field.name, getattr(value, field.name)) for field in fields(value))


def changeable(value):
    """Return where a record gives the same array or collection twice that can be changed.

    Named tuples may have lists: Pinocchio takes no others.
    """
    first, second = (dict(given(value)) for _ in range(2))
    found = []
    for name in first.keys() & second.keys():
        before, after = (dict(arrays(one[name], name)) for one in (first, second))
        for path in before.keys() & after.keys():
            shared = np.may_share_memory(before[path], after[path])
            found += [path] if shared and before[path].flags.writeable else []
        same = first[name] is second[name]
        collection = type(first[name]) in (list, dict) and not hasattr(value, "_fields")
        found += [name] if same and collection and name[0] != "_" else []
    return found


def unpickled(value):
    return pickle.loads(pickle.dumps(value))


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_that_a_record_keeps_can_be_changed(kind):
    """Else an operation in place on what it gave would change its later results."""
    assert not changeable(boundary.instances()[kind])


@pytest.mark.parametrize("kind", KINDS)
def test_no_attribute_of_a_record_can_be_assigned_or_deleted(kind):
    record = boundary.instances()[kind]
    for name, value in list(vars(record).items()) if hasattr(record, "__dict__") else []:
        with pytest.raises((AttributeError, TypeError)):
            setattr(record, name, value)
        with pytest.raises((AttributeError, TypeError)):
            delattr(record, name)


# docs/conventions.md, "Records"; the others of `instances` that compare by value are named tuples.
BY_VALUE = ("Index", "Mechanism", "PlanarMechanism", "Solids")


@pytest.mark.parametrize("kind", KINDS)
def test_records_are_compared_by_identity_but_for_those_that_the_page_names(kind):
    original = boundary.instances()[kind]
    by_value = kind in BY_VALUE or isinstance(original, tuple)
    assert (copy.copy(original) == original) is by_value


@pytest.mark.parametrize("kind", KINDS)
def test_a_repr_is_short(kind):
    assert len(repr(boundary.instances()[kind])) <= LONGEST_REPR


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, unpickled])
@pytest.mark.parametrize("kind", KINDS)
def test_what_was_read_only_is_read_only_in_copies(kind, again):
    original = boundary.instances()[kind]
    before, after = dict(arrays(original)), dict(arrays(again(original)))
    for path in before.keys() & after.keys():
        np.testing.assert_array_equal(before[path], after[path])
        assert before[path].flags.writeable or not after[path].flags.writeable, path


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, unpickled])
def test_a_copy_of_a_design_computes_from_its_own_arrays(again):
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    before = design.at(design.home).jacobian  # makes what the design keeps
    other = again(design)
    assert "groups" not in vars(other)
    np.testing.assert_array_equal(other.at(other.home).jacobian, before)
    with pytest.raises(ValueError, match="read-only"):
        other.base_points[0, 0] = 9.0


@pytest.mark.parametrize("question", ["fixed", "orientations"])
def test_an_unpickled_region_decides_the_same_points(question):
    design = boundary.HEXAPOD
    region = {
        "fixed": lambda: gsp.workspace.fixed_orientation(design, resolution=2.5),
        "orientations": lambda: gsp.workspace.orientations(design, [0, 0, 8], resolution=0.8),
    }[question]()
    other = unpickled(region)
    points = 0.5 * (region.low + region.high)
    np.testing.assert_array_equal(region.contains(points), other.contains(points))
    np.testing.assert_array_equal(region._decide(points), other._decide(points))


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, unpickled])
def test_copies_of_a_symmetry_are_read_only(again):
    other = again(gsp.catalogue.symmetries(gsp.catalogue.design("toz-kucuk-2016-d3-6"))[1])
    assert not other.base.flags.writeable
    assert not other.platform.flags.writeable


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, unpickled])
def test_copies_of_a_motion_have_a_read_only_position(again):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    motion = gsp.instantaneous_motion(design.at(design.home), length=90.0)
    assert not motion.position.flags.writeable
    assert not again(motion).position.flags.writeable


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, unpickled])
@pytest.mark.parametrize("kind", ["Certificate", "IndexMap", "PathCertificate", "Record", "Space"])
def test_mappings_of_records_are_read_only_in_copies(kind, again):
    original = boundary.instances()[kind]
    other = again(original)
    for name, value in vars(original).items():
        if isinstance(value, dict):
            copied = getattr(other, name)
            assert copied.keys() == value.keys()
            with pytest.raises(TypeError, match="does not support item assignment"):
                copied["x"] = 1


def test_a_record_is_not_equal_to_an_array():
    """One answer, not one for each element, and no arithmetic that takes the record apart."""
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    poses = gsp.Pose([[0.0, 0.0, 1.5], [0.0, 0.0, 1.6], [0.0, 0.0, 1.7]])
    path = gsp.sweeps.turn(design.home, "z", [0.0, 1.0])
    for record in (design, poses, design.home, design.at(poses), path):
        for other in (np.zeros(3), np.eye(3), np.float64(1.0)):
            assert (record == other) is False
            assert (other == record) is False
            assert (record != other) is True
        with pytest.raises(TypeError):
            np.ones(3) * record
