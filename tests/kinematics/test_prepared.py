"""`gsp.prepare`: one pose at a time gives what a posture and the index's function give."""

import copy
import pickle
from dataclasses import FrozenInstanceError
from multiprocessing.reduction import ForkingPickler

import numpy as np
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.evaluation.backends import COMPILED
from gsp.indices import INDICES

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
BOX = gsp.PoseBox([(-60, 60), (-60, 60), (90, 190)], [(-30, 30)] * 3, degrees=True)
GIVEN = {"length": 95.0, "maximum": 1e6, "ellipsoid": gsp.Ellipsoid([50, 40, 30], [3, 2, 10])}


@pytest.mark.parametrize("name", COMPILED)
@pytest.mark.parametrize("number", [0, 60, 120, 180])
def test_it_gives_the_jacobian_and_the_value(name, number):
    design = instantiate(mechanisms()[number], TEMPLATE)
    fast = gsp.prepare(design, name, **GIVEN)
    arguments = {key: GIVEN[key] for key in INDICES[name].parameters}
    for pose in (BOX.sample(5, rng=number)[i] for i in range(5)):
        jacobian, value = fast(pose.position, pose.rotation)
        posture = design.at(pose)
        scale = np.abs(posture.jacobian).max()
        np.testing.assert_allclose(jacobian, posture.jacobian, rtol=0, atol=1e-14 * scale)
        assert value == pytest.approx(
            float(INDICES[name].function(posture, **arguments)), rel=1e-10
        )


def test_what_is_undefined_is_as_in_a_posture():
    ring = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    design = gsp.Design(["D1"] * 6, ring, ring)
    jacobian, value = gsp.prepare(design, length=1.0)([0, 0, 0], np.eye(3))
    assert np.isnan(value)
    assert np.isnan(jacobian).all()


def test_a_singular_posture_has_the_worst_value():
    ring = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    fast = gsp.prepare(gsp.Design(["D1"] * 6, 2 * ring, ring), length=1.0)
    assert fast([0, 0, 1], np.eye(3))[1] == np.inf


@pytest.mark.parametrize(
    ("position", "rotation", "message"),
    [
        ([0, 0], np.eye(3), "position"),
        ([0, 0, np.nan], np.eye(3), "finite"),
        ([0, 0, 1], 2 * np.eye(3), "rotation matrix"),
        ([0, 0, 1], -np.eye(3), "rotation matrix"),
        ([[0, 0, 1]], np.eye(3), "single pose"),
        ("here", np.eye(3), "real numbers"),
    ],
)
def test_bad_poses_raise_the_errors_of_pose(position, rotation, message):
    with pytest.raises(gsp.GspError, match=message):
        gsp.prepare(TEMPLATE)(position, rotation)


def test_indices_that_it_does_not_cover_are_errors():
    with pytest.raises(gsp.GspError, match="nearest"):
        gsp.prepare(TEMPLATE, "condition")
    with pytest.raises(gsp.GspError, match="maximum"):
        gsp.prepare(TEMPLATE, "quality_index")


@pytest.mark.parametrize("number", [0, 60, 120, 180])
def test_joints_and_jacobian_are_those_of_a_posture(number):
    design = instantiate(mechanisms()[number], TEMPLATE)
    robot = gsp.prepare(design)
    pose = BOX.sample(30, rng=number).reshape(5, 6)
    posture = design.at(pose)
    size = design.rms_radius
    np.testing.assert_allclose(robot.joints(pose), posture.joints, rtol=0, atol=4e-15 * size)
    one = pose[2, 3]
    np.testing.assert_allclose(
        robot.jacobian(one),
        posture.jacobian[2, 3],
        rtol=0,
        atol=1e-14 * np.abs(posture.jacobian).max(),
    )
    np.testing.assert_array_equal(robot.joints(one), robot.joints(pose)[2, 3])


def test_forward_gives_the_bits_of_the_function_also_after_a_bad_sample():
    robot = gsp.prepare(TEMPLATE)
    truth = BOX.sample(20, rng=3)
    joints = robot.joints(truth).copy()
    joints[5], joints[9, 2] = np.nan, 1e9
    for i in range(20):
        one = robot.forward(joints[i], TEMPLATE.home)
        same = gsp.forward(TEMPLATE, joints[i], TEMPLATE.home)
        assert one.status == same.status
        assert one.status.shape == one.residual.shape == one.iterations.shape == ()
        assert one.pose.position.tobytes() == same.pose.position.tobytes()
        assert one.pose.rotation.tobytes() == same.pose.rotation.tobytes()
        assert one.iterations == same.iterations
        assert one.residual.tobytes() == same.residual.tobytes()
    assert robot.forward(joints[5], TEMPLATE.home).status == "undefined"
    assert robot.forward(joints[6], TEMPLATE.home).converged


def test_solutions_of_calls_are_records_apart():
    """They are made without the checks of their constructors, and hold the same."""
    robot = gsp.prepare(TEMPLATE)
    joints = robot.joints(BOX.sample(2, rng=3))
    first, second = (robot.forward(one, TEMPLATE.home) for one in joints)
    same = gsp.forward(TEMPLATE, joints[0], TEMPLATE.home)
    assert repr(first) == repr(same)
    assert vars(first).keys() == vars(same).keys()
    for name, array in (*vars(first.pose).items(), *list(vars(first).items())[1:]):
        held = vars(same.pose).get(name, vars(same).get(name))
        assert (array.dtype, array.shape) == (held.dtype, held.shape)
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="cannot set WRITEABLE"):
            array.setflags(write=True)
    assert not np.shares_memory(first.pose.position, second.pose.position)
    again = pickle.loads(pickle.dumps(first))
    assert again.pose.position.tobytes() == first.pose.position.tobytes()
    with pytest.raises(FrozenInstanceError):
        first.status = None
    # More iterations than are kept as numbers.
    far = TEMPLATE.home.moved([60, 50, -30, 1.0, -0.8, 0.9])
    for most in (1, 400):
        slow = robot.forward(joints[0], far, tolerance=1e-300, max_iterations=most)
        by_function = gsp.forward(TEMPLATE, joints[0], far, tolerance=1e-300, max_iterations=most)
        assert slow.iterations == by_function.iterations
        assert not slow.iterations.flags.writeable


def test_without_a_length_only_the_index_is_missing():
    design = TEMPLATE.replace(characteristic_length=None)
    robot = gsp.prepare(design)
    assert robot.forward(robot.joints(design.home), design.home).converged
    with pytest.raises(gsp.GspError, match="length"):
        robot.index(design.home)
    with pytest.raises(gsp.GspError, match="length"):
        gsp.prepare(design, "condition_number")


@pytest.mark.parametrize("joints", ["x", [1, 2, 3], None, [True] * 6, [[1, 2]] * 3])
def test_bad_joints_are_errors(joints):
    with pytest.raises(gsp.GspError, match="joints"):
        gsp.prepare(TEMPLATE).forward(joints, TEMPLATE.home)


def test_batches_are_errors_where_one_pose_is_expected():
    robot = gsp.prepare(TEMPLATE)
    for function in (robot.jacobian, robot.index):
        with pytest.raises(gsp.GspError, match="single pose"):
            function(BOX.sample(2, rng=0))
        with pytest.raises(gsp.GspError, match=r"a gsp\.Pose"):
            function([0, 0, 0])


@pytest.mark.parametrize(
    "again",
    [copy.copy, copy.deepcopy, lambda one: ForkingPickler.loads(ForkingPickler.dumps(one))],
    ids=["copy", "deepcopy", "pickle"],
)
def test_copies_and_pickles_are_made_again_from_the_arguments(again):
    robot = gsp.prepare(TEMPLATE, "quality_index", maximum=1e7)
    same = again(robot)
    pose = BOX.sample(1, rng=2)[0]
    assert same.index(pose) == robot.index(pose)
    np.testing.assert_array_equal(same.jacobian(pose), robot.jacobian(pose))
    np.testing.assert_array_equal(same.joints(pose), robot.joints(pose))


def odd_values(numbers):
    """What `Pose` and `forward` refuse, although numpy converts it to numbers."""
    array = np.array(numbers, dtype=float)
    fields = np.zeros(array.shape, dtype=[("x", float)])
    fields["x"] = array
    return {
        "complex": array + 0j,
        "complex list": (array + 1j).tolist(),
        "texts": array.astype(str),
        "text list": array.astype(str).tolist(),
        "bools": array.astype(bool),
        "bool list": array.astype(bool).tolist(),
        "dates": array.astype("datetime64[D]"),
        "intervals of time": array.astype("timedelta64[D]"),
        "structured": fields,
        "masked": np.ma.array(array, mask=np.ones(array.shape, dtype=bool)),
        "objects": np.where(array > np.inf, array, None),
    }


@pytest.mark.parametrize("kind", odd_values([1.0]))
def test_what_poses_refuse_is_refused(kind):
    home = TEMPLATE.home
    robot = gsp.prepare(TEMPLATE, length=95.0)
    joints = robot.joints(home)
    place, turn, lengths = (odd_values(x)[kind] for x in (home.position, np.eye(3), joints))
    for call in (
        lambda: robot(place, home.rotation),
        lambda: robot(home.position, turn),
        lambda: robot.forward(lengths, home),
        lambda: gsp.Pose(place, home.rotation),
        lambda: gsp.forward(TEMPLATE, lengths, home),
    ):
        with pytest.raises(gsp.errors.InvalidInput, match="real numbers"):
            call()


@pytest.mark.parametrize("make", [np.float32, int, ">f8", object])
def test_numbers_of_other_kinds_are_those_of_a_pose(make):
    robot = gsp.prepare(TEMPLATE, length=95.0)
    place = TEMPLATE.home.position.astype(make)
    jacobian, value = robot(place, np.eye(3, dtype=make))
    expected = robot(place.astype(float), np.eye(3))
    np.testing.assert_array_equal(jacobian, expected[0])
    assert value == expected[1]


@pytest.mark.parametrize("again", [lambda one: one, copy.copy, copy.deepcopy])
@pytest.mark.parametrize("name", ["design", "index_name", "new"])
def test_it_cannot_be_changed(again, name):
    """As records: of another design it would compute with the geometry of the first."""
    robot = again(gsp.prepare(TEMPLATE))
    before = vars(robot).copy()
    with pytest.raises(FrozenInstanceError, match=name):
        setattr(robot, name, None)
    with pytest.raises(FrozenInstanceError, match=name):
        delattr(robot, name)
    assert vars(robot) == before
