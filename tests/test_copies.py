"""Copied and unpickled records: their arrays are read-only as those of the originals, and equal."""

import copy
import pickle
from types import MappingProxyType

import numpy as np
import pytest

import gsp
from tests import boundary

# A store is a connection.
KINDS = sorted(set(boundary.instances()) - {"Store"})


def arrays(value, path="", seen=None):
    """Yield all arrays that a record holds, by the names that lead to them."""
    seen = {} if seen is None else seen
    if id(value) in seen:
        return
    seen[id(value)] = value
    if isinstance(value, np.ndarray):
        yield path, value
    elif isinstance(value, dict | MappingProxyType):
        for key, item in value.items():
            yield from arrays(item, f"{path}[{key!r}]", seen)
    elif isinstance(value, tuple | list):
        for number, item in enumerate(value):
            yield from arrays(item, f"{path}[{number}]", seen)
    if type(value).__module__.startswith("gsp") and hasattr(value, "__dict__"):
        for key, item in vars(value).items():
            yield from arrays(item, f"{path}.{key}", seen)


def unpickled(value):
    return pickle.loads(pickle.dumps(value))


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
    np.testing.assert_array_equal(region.decide(points), other.decide(points))


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
@pytest.mark.parametrize("kind", ["Record", "Space"])
def test_mappings_of_records_are_read_only_in_copies(kind, again):
    original = boundary.instances()[kind]
    other = again(original)
    for name, value in vars(original).items():
        if isinstance(value, MappingProxyType):
            copied = getattr(other, name)
            assert copied == value
            assert copied is not value
            with pytest.raises(TypeError, match="does not support item assignment"):
                copied["x"] = 1
