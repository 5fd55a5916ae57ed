"""Undefined is NaN, singular is the worst value, and both stay in their element of the batch."""

import numpy as np
import pytest

import gsp
from gsp.errors import MissingParameter
from gsp.indices import INDICES
from tests.support import random_design, random_pose, turn

CORE = {
    "condition_number": np.inf,
    "condition_number_ellipsoid": np.inf,
    "control_number": 0.0,
    "quality_index": 0.0,
    "manipulability": 0.0,
    "minimum_singular_value": 0.0,
}
GIVEN = {
    "length": 0.8,
    "ellipsoid": gsp.Ellipsoid([0.5, 0.7, 0.4], [0.1, 0.2, 0.3]),
    "maximum": 2.0,
}
RING = np.stack(
    [np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3), np.zeros(6)], 1
)


def value(index, posture):
    record = INDICES[index]
    return record.function(posture, **{key: GIVEN[key] for key in record.parameters})


def singular_postures():
    """Name, design, pose; each with a rigid motion that leaves no zero in its numbers."""
    rng = np.random.default_rng(3)
    here, pose = gsp.Pose([0.0, 0.0, 0.0]), random_pose(rng)
    r = turn(rng.standard_normal(3))
    u, w = r[:, 0], r[:, 1]
    points, others = rng.uniform(-1, 1, (2, 6, 3))
    on_line = np.outer(rng.uniform(-1, 1, 6), u)
    along = np.tile(u, (6, 1))
    twice = points.copy(), others.copy()
    for anchors in twice:
        anchors[1] = anchors[0]
    shifted = points + np.outer(rng.uniform(1, 2, 6), u)
    sps = ["D1"] * 6
    return {
        "translated hexagon": (gsp.Design(sps, RING, RING), gsp.Pose([0, 0, 1])),
        "hexagon turned by 90°": (
            gsp.Design(sps, 2 * RING, RING), gsp.Pose.from_rpy([0, 0, 1], [0, 0, 90], degrees=True),
        ),
        "a leg twice": (gsp.Design(sps, *twice), pose),
        "all legs on one line": (gsp.Design(sps, on_line, on_line + 3 * u), here),
        "parallel legs": (
            gsp.Design(sps, points, (shifted - pose.position) @ pose.rotation), pose,
        ),
        "one platform point": (gsp.Design(sps, points, np.tile(others[0], (6, 1))), pose),
        "D3 with parallel base lines": (gsp.Design(["D3"] * 6, points, others, along), pose),
        "three equal angles": (
            gsp.Design(["D1"] * 3 + ["A1"] * 3, points, others, along, np.tile(w, (6, 1))), pose,
        ),
        "three equal pairs of lines": (
            gsp.Design(["D4 A1"] * 3, points[:3], others[:3], along[:3], np.tile(w, (3, 1))), pose,
        ),
        "D2 with one platform line": (
            gsp.Design(["D2"] * 6, points, on_line, None, along), pose,
        ),
    }  # fmt: skip


@pytest.mark.parametrize("index", CORE)
@pytest.mark.parametrize("name", singular_postures())
def test_singular_is_the_worst_value(name, index):
    design, pose = singular_postures()[name]
    posture = design.at(pose)
    assert posture.undefined == ()
    assert posture.singular()
    assert value(index, posture) == CORE[index] == INDICES[index].worst


@pytest.mark.parametrize("name", singular_postures())
def test_singular_by_the_definition(name):
    """The postures above are singular: a twist of size one moves no actuator."""
    design, pose = singular_postures()[name]
    assert np.linalg.matrix_rank(design.at(pose).homogeneous(0.8)) < 6


@pytest.mark.parametrize("index", CORE)
def test_no_posture_is_better_than_the_best(index):
    rng = np.random.default_rng(0)
    record = INDICES[index]
    low, high = sorted((record.best, record.worst))
    for name in ("D1^6", "D1 D2 D3 D4 A1^2", "D4^3 A1^3"):
        legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
        posture = random_design(rng, legs).at(random_pose(rng, (500,)))
        numbers = value(index, posture)
        if index != "quality_index":  # its maximum is the user's
            assert (numbers >= low).all()
            assert (numbers <= high).all()
    assert record.better == ("higher" if record.best > record.worst else "lower")


def test_bound_of_the_smallest_singular_value():
    """At most sqrt(n/3): the squares of the translational parts of n rows sum up to n."""
    rng = np.random.default_rng(0)
    posture = random_design(rng, ["D1"] * 9).at(random_pose(rng, (500,)))
    assert (gsp.indices.minimum_singular_value(posture, 1e-3) <= np.sqrt(3.0)).all()
    assert gsp.indices.minimum_singular_value(posture, 1e-3).max() > 0.9


@pytest.mark.parametrize("bad", [0, 3, 6])
@pytest.mark.parametrize("index", CORE)
def test_one_undefined_pose_changes_nothing_else(index, bad):
    rng = np.random.default_rng(bad)
    legs = ["D1", "D2", "D3", "D4 A1", "A1"]
    design, pose = random_design(rng, legs), random_pose(rng, (7,))
    positions = pose.position.copy()
    lines = design.at(pose).lines
    positions[bad] -= lines.d[bad, 0]  # brings the anchors of leg 1 together
    spoiled = design.at(gsp.Pose(positions, pose.rotation))
    ((where, joint, reason),) = spoiled.undefined
    assert (where, joint, reason) == ((bad,), "d1", "the anchor points coincide")
    np.testing.assert_array_equal(spoiled.defined, np.arange(7) != bad)
    good = np.arange(7) != bad
    one, two = value(index, design.at(pose)), value(index, spoiled)
    assert np.isnan(two[bad])
    np.testing.assert_array_equal(two[good], one[good])  # bit by bit
    np.testing.assert_array_equal(spoiled.jacobian[good], design.at(pose).jacobian[good])
    assert not spoiled.singular()[bad]


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
@pytest.mark.parametrize("index", CORE)
def test_batch_shapes(index, shape):
    rng = np.random.default_rng(2)
    design, pose = random_design(rng, ["D1", "D2", "D3", "D4 A1", "A1"]), random_pose(rng, shape)
    numbers = value(index, design.at(pose))
    assert np.shape(numbers) == shape
    for place in np.ndindex(shape):
        np.testing.assert_allclose(numbers[place], value(index, design.at(pose[place])), rtol=1e-11)


def test_records():
    assert list(INDICES)[:1] == ["condition_number"]
    assert set(CORE) <= set(INDICES)
    for name, record in INDICES.items():
        assert record.name == name
        assert set(record.needs) <= set(record.parameters)
        assert getattr(gsp.indices, name) is record.function
        assert record.source
        assert record.function.__doc__.splitlines()[0].endswith(".")
    with pytest.raises(TypeError):
        INDICES["new"] = INDICES["condition_number"]


@pytest.mark.parametrize(
    ("legs", "cdn_oe", "ctn"),
    [
        (["D1"] * 6, False, False),
        (["D1"] * 5 + ["D2"], False, True),
        (["D4"] * 6, False, True),
        (["D1"] * 5 + ["A1"], True, True),
    ],
)
def test_when_a_length_is_needed(legs, cdn_oe, ctn):
    rng = np.random.default_rng(0)
    posture = random_design(rng, legs).at(random_pose(rng))
    calls = {
        "condition_number_ellipsoid": (cdn_oe, {"ellipsoid": GIVEN["ellipsoid"]}),
        "control_number": (ctn, {}),
    }
    for name, (needed, given) in calls.items():
        record = INDICES[name]
        assert ("length" in record.missing(posture.design, ["ellipsoid"])) == needed
        if needed:
            with pytest.raises(MissingParameter, match="length: expected a positive number, as"):
                record.function(posture, **given)
            assert np.isfinite(record.function(posture, length=1.0, **given))
        else:
            assert record.function(posture, **given) == record.function(
                posture, length=3.0, **given
            )
