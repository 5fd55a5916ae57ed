"""Poses and boxes of poses: conversions, checks, samples."""

import numpy as np
import pinocchio
import pytest

import gsp
from gsp.checks import MOST_BATCH_AXES
from gsp.errors import InvalidIndex, InvalidInput, InvalidRotation
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import ANGLE_SETS, check_rotation, rotation_from_angles
from tests.support import random_pose, turn

RNG = np.random.default_rng(0)
ANGLES = RNG.uniform(-1.4, 1.4, (50, 3))
SHAPES = [(), (1,), (3, 1, 2), (0,)]


def about(axis, angle):
    """Rotation about a coordinate axis, by its definition."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def test_named_sets_by_their_products():
    for a, b, c in ANGLES:
        x, y, z = about(0, a), about(1, b), about(2, c)
        np.testing.assert_allclose(rotation_from_angles([a, b, c]), z @ y @ x, atol=1e-15)
        r = rotation_from_angles([a, b, c], "approach-roll")
        np.testing.assert_allclose(r, y @ x @ z, atol=1e-15)
        # Capitals turn about moving axes, small letters about fixed ones.
        r = rotation_from_angles([c, b, a], "ZYX")
        np.testing.assert_allclose(r, z @ y @ x, atol=1e-15)


def test_degrees():
    np.testing.assert_allclose(
        rotation_from_angles(np.rad2deg(ANGLES), degrees=True),
        rotation_from_angles(ANGLES),
        atol=1e-15,
    )
    pose = Pose.from_rpy([0, 0, 0], [10, 20, 30], degrees=True)
    np.testing.assert_allclose(pose.angles(degrees=True), [10, 20, 30], rtol=1e-14)
    np.testing.assert_allclose(np.rad2deg(pose.angles()), [10, 20, 30], rtol=1e-14)


@pytest.mark.parametrize("order", [*ANGLE_SETS, "ZYX", "xyz", "YXZ"])
def test_angles_undo_from_angles(order):
    poses = Pose.from_angles(np.zeros(3), ANGLES, order)
    np.testing.assert_allclose(poses.angles(order), ANGLES, atol=1e-13)


@pytest.mark.parametrize("order", [*ANGLE_SETS, "ZYX"])
def test_angles_of_a_degenerate_set_still_give_the_rotation(order):
    values = np.array([0.3, np.pi / 2, -0.4])
    if order == "approach-roll":
        values = values[[1, 0, 2]]
    pose = Pose.from_angles([0, 0, 0], values, order)
    again = Pose.from_angles([0, 0, 0], pose.angles(order), order)
    np.testing.assert_allclose(again.rotation, pose.rotation, atol=1e-7)


@pytest.mark.parametrize("shape", SHAPES)
def test_batch_shapes(shape):
    pose = random_pose(np.random.default_rng(0), shape)
    assert pose.shape == shape
    assert pose.size == np.prod(shape)
    assert pose.position.shape == (*shape, 3)
    assert pose.rotation.shape == (*shape, 3, 3)
    assert pose.angles().shape == (*shape, 3)
    assert pose.inverse().shape == pose.compose(pose).shape == shape
    assert Pose.from_rpy(pose.position, pose.angles()).shape == shape
    assert Pose.from_quaternion(pose.position, np.ones((*shape, 4))).shape == shape
    assert "Pose(" in repr(pose)


def test_broadcast():
    pose = Pose([1, 2, 3], np.broadcast_to(np.eye(3), (4, 1, 3, 3)))
    assert pose.shape == (4, 1)
    pose = Pose(np.zeros((5, 3)), pose.rotation)
    assert pose.shape == (4, 5)
    with pytest.raises(InvalidInput, match="batch shapes"):
        Pose(np.zeros((2, 3)), np.broadcast_to(np.eye(3), (3, 3, 3)))


def test_arrays_are_kept_bit_by_bit_and_read_only():
    rotation = turn([0.1, 0.2, 0.3])
    pose = Pose(np.full((2, 3), 0.1), rotation)
    np.testing.assert_array_equal(pose.rotation[1], rotation)
    for part in (
        pose,
        pose[0],
        pose[[1, 0]],
        pose.reshape(1, 2),
        pose.inverse(),
        pose.compose(pose),
    ):
        for array in (part.position, part.rotation):
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0.0
    rotation[0, 0] = 5.0
    assert pose.rotation[0, 0, 0] != 5.0


def test_indexing_is_that_of_the_batch_axes():
    pose = random_pose(np.random.default_rng(0), (4, 3))
    for index in (2, (1, 2), slice(1, 3), (slice(None), 1), [0, 3], ..., (..., 1), None):
        np.testing.assert_array_equal(
            pose[index].position, pose.position[index_with_axes(index, 1)]
        )
        np.testing.assert_array_equal(
            pose[index].rotation, pose.rotation[index_with_axes(index, 2)]
        )
    mask = pose.position[..., 0] > 0
    assert pose[mask].shape == (mask.sum(),)
    assert len(pose) == 4
    assert len(list(pose)) == 4
    with pytest.raises(IndexError):
        pose[4]
    with pytest.raises(TypeError):
        len(pose[0, 0])
    with pytest.raises(TypeError, match="a single pose has no items"):
        list(pose[0, 0])
    with pytest.raises(gsp.GspError, match=r"limits\.indices: expected texts"):
        gsp.Limits(indices=pose[0, 0])
    assert pose
    assert pose[0, 0]
    assert not pose[:0]
    for index in (4, (0, 0, 0), "x", 1.5, {}, np.zeros((2, 2), bool)):
        with pytest.raises(InvalidIndex, match="batch shape"):
            pose[index]


def index_with_axes(index, n):
    index = index if isinstance(index, tuple) else (index,)
    rest = () if any(i is Ellipsis for i in index) else (...,)
    return (*index, *rest, *(slice(None),) * n)


def test_reshape():
    pose = random_pose(np.random.default_rng(0), (4, 3))
    np.testing.assert_array_equal(pose.reshape(12).position, pose.position.reshape(12, 3))
    assert pose.reshape(2, -1).shape == (2, 6)
    assert pose.reshape((3, 4)).shape == (3, 4)
    assert Pose([0, 0, 1]).reshape(1).shape == (1,)
    for bad in ((5,), ("a",), (1.5,), (7, -1)):
        with pytest.raises(InvalidInput, match="axes of a batch of 12 poses"):
            pose.reshape(*bad)


def test_compose_and_inverse_are_those_of_pinocchio():
    rng = np.random.default_rng(1)
    one, two = random_pose(rng), random_pose(rng)
    product, back = one.to_se3() * two.to_se3(), one.to_se3().inverse()
    np.testing.assert_allclose(one.compose(two).position, product.translation, atol=1e-15)
    np.testing.assert_allclose(one.compose(two).rotation, product.rotation, atol=1e-15)
    np.testing.assert_allclose(one.inverse().position, back.translation, atol=1e-15)
    np.testing.assert_allclose(one.inverse().rotation, back.rotation, atol=1e-15)
    many = one.compose(random_pose(rng, (3, 1))).compose(random_pose(rng, (4,)))
    assert many.shape == (3, 4)
    identity = many.compose(many.inverse())
    np.testing.assert_allclose(identity.position, 0.0, atol=1e-14)
    np.testing.assert_allclose(
        identity.rotation, np.broadcast_to(np.eye(3), (3, 4, 3, 3)), atol=1e-14
    )


def test_compose_of_rotations_at_the_tolerance():
    """Two rotations that are just accurate enough compose: errors may add up."""
    rough = np.eye(3) + 0.49e-9
    np.fill_diagonal(rough, 1.0)
    pose = Pose([0, 0, 0], rough)
    assert pose.compose(pose).compose(pose).shape == ()


@pytest.mark.parametrize("bad", [None, "pose", np.eye(4), Pose], ids=repr)
def test_invalid_arguments_of_compose_are_errors(bad):
    with pytest.raises(InvalidInput, match=r"pose: expected a gsp\.Pose"):
        Pose([0, 0, 0]).compose(bad)


def test_compose_of_shapes_that_do_not_fit():
    with pytest.raises(InvalidInput, match="broadcast"):
        random_pose(RNG, (2,)).compose(random_pose(RNG, (3,)))


@pytest.mark.parametrize("shape", [(0, 6), (2, 6), (4, 6), (2, 1, 2, 6)])
def test_twists_that_do_not_fit_the_poses_are_errors(shape):
    with pytest.raises(InvalidInput, match="pose, twist: expected batch shapes that broadcast"):
        random_pose(RNG, (3,)).moved(np.zeros(shape))


def test_more_axes_than_numpy_broadcasts_are_errors():
    """The most that are accepted pass through the whole assembly."""
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    most = gsp.Pose(np.broadcast_to(design.home.position, (*(1,) * MOST_BATCH_AXES, 3)))
    posture = design.at(most)
    assert posture.homogeneous(1.0).shape == (*most.shape, 6, 6)
    for index in gsp.indices.INDICES.values():
        if not index.parameters:
            assert np.shape(index.function(posture)) == most.shape, index.name
    with pytest.raises(InvalidInput, match=r"position: expected at most \d+ axes, received 40"):
        gsp.Pose(np.zeros((1,) * 39 + (3,)))
    with pytest.raises(InvalidInput, match="share: expected at most"):
        design.home.interpolate(design.home, np.zeros((1,) * 40))


def test_se3_round_trip():
    pose = random_pose(np.random.default_rng(2), (3,))
    placements = pose.to_se3()
    assert all(isinstance(p, pinocchio.SE3) for p in placements)
    for again in (Pose.from_se3(placements), Pose.from_se3(iter(placements))):
        np.testing.assert_array_equal(again.position, pose.position)
        np.testing.assert_array_equal(again.rotation, pose.rotation)
    one = Pose.from_se3(placements[1])
    assert one.shape == ()
    np.testing.assert_array_equal(one.rotation, pose.rotation[1])
    assert Pose.from_se3([]).shape == (0,)
    nested = random_pose(RNG, (2, 3)).to_se3()
    assert [len(row) for row in nested] == [3, 3]


@pytest.mark.parametrize("bad", [None, 5, "SE3", [1, 2], np.eye(4)], ids=repr)
def test_invalid_arguments_of_from_se3_are_errors(bad):
    with pytest.raises(InvalidInput, match="placement: expected SE3"):
        Pose.from_se3(bad)


@pytest.mark.parametrize("read", [lambda p: p.quaternion, lambda p: p.angles()])
def test_an_element_that_was_not_found_is_nan_and_leaves_the_others(read):
    hexapod = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    joints = np.stack([hexapod.at(hexapod.home).joints] * 3)
    joints[1] = np.nan
    found = gsp.forward(hexapod, joints, hexapod.home).pose
    values = read(found)
    assert np.isnan(values[1]).all()
    np.testing.assert_array_equal(values[::2], read(found[::2]))
    np.testing.assert_allclose(values[0], read(hexapod.home), atol=1e-9)


def test_quaternions_are_those_of_pinocchio():
    for q in RNG.standard_normal((10, 4)):
        expected = pinocchio.Quaternion(q / np.linalg.norm(q)).toRotationMatrix()
        for scale in (1.0, 1e-200, 1e200):
            pose = Pose.from_quaternion([0, 0, 0], q * scale)
            np.testing.assert_allclose(pose.rotation, expected, atol=1e-15)
    with pytest.raises(InvalidInput, match="non-zero quaternion"):
        Pose.from_quaternion(np.zeros((2, 3)), [[0, 0, 0, 1], [0, 0, 0, 0]])


BAD_ROTATIONS = {
    "reflection": np.diag([1.0, 1.0, -1.0]),
    "scaled": 1.001 * np.eye(3),
    "sheared": np.eye(3) + np.eye(3, k=1) * 1e-6,
    "zero": np.zeros((3, 3)),
    "overflow": np.array([[1e200, -1e200, 0], [1e200, 1e200, 0], [0, 0, 1]]),
    "overflow to inf": np.full((3, 3), 1e200),
    "minus identity": -np.eye(3),
}


@pytest.mark.parametrize("name", BAD_ROTATIONS)
def test_no_rotation(name):
    stack = np.stack((np.eye(3), BAD_ROTATIONS[name]))
    with pytest.raises(
        InvalidRotation, match=r"pose.rotation \(at index \[1\]\): expected a rotation"
    ):
        Pose(np.zeros((2, 3)), stack)
    with pytest.raises(InvalidRotation, match=r"det R = "):
        check_rotation("r", BAD_ROTATIONS[name])


def test_rotations_of_seven_digits_are_errors_and_of_twelve_are_accepted():
    with pytest.raises(InvalidRotation):
        Pose([0, 0, 0], turn([0.3, 0.2, 0.1]).round(7))
    Pose([0, 0, 0], turn([0.3, 0.2, 0.1]).round(12))


@pytest.mark.parametrize(
    "value", [[1, 2], 1.0, "abc", None, [1, 2, np.nan], [1j, 0, 0], np.zeros((3, 2))]
)
def test_bad_positions(value):
    with pytest.raises(InvalidInput, match=r"pose\.position"):
        Pose(value)


@pytest.mark.parametrize(
    "order", ["rpz", "", "xy", "xx", "XyZ", "xxx", None, 5, ["rpy"], "RPY"], ids=repr
)
def test_unknown_order(order):
    for call in (
        lambda: rotation_from_angles([0, 0, 0], order),
        lambda: Pose([0, 0, 0]).angles(order),
        lambda: PoseBox([0, 0, 0], [0, 0, 0], order=order),
    ):
        with pytest.raises(InvalidInput, match="order: expected rpy, approach-roll or a sequence"):
            call()


BOX = PoseBox([(-1, 1), (0, 2), 5], [(-10, 10), 0, (20, 40)], degrees=True)


def coordinates(pose, order="rpy"):
    return np.concatenate((pose.position, pose.angles(order)), axis=-1)


def test_box():
    np.testing.assert_array_equal(BOX.low[:3], [-1, 0, 5])
    np.testing.assert_allclose(BOX.high[3:], np.deg2rad([10, 0, 40]))
    with pytest.raises(ValueError, match="read-only"):
        BOX.low[0] = 0.0


def test_grid():
    pose = BOX.grid([3, 2, 1, 2, 1, 4])
    assert pose.shape == (3, 2, 1, 2, 1, 4)
    np.testing.assert_allclose(pose.position[:, 0, 0, 0, 0, 0, 0], [-1, 0, 1])
    np.testing.assert_allclose(pose.position[0, 0, 0, 0, 0, 0, 2], 5)
    np.testing.assert_allclose(
        pose.angles(degrees=True)[0, 0, 0, :, 0, -1], [[-10, 0, 40], [10, 0, 40]], atol=1e-12
    )
    assert BOX.grid(2).shape == (2,) * 6
    middle = BOX.grid(1)
    np.testing.assert_allclose(coordinates(middle).ravel(), (BOX.low + BOX.high) / 2, atol=1e-15)
    same = Pose.grid([(-1, 1), (0, 2), 5], [(-10, 10), 0, (20, 40)], 2, degrees=True)
    np.testing.assert_array_equal(same.rotation, BOX.grid(2).rotation)


@pytest.mark.parametrize(
    "counts", [0, -1, 1.5, "2", None, [1, 2], [1] * 7, [1, 1, 1, 1, 1, 0], True, []]
)
def test_bad_counts(counts):
    with pytest.raises(InvalidInput, match="counts: expected one or six integers ≥ 1"):
        BOX.grid(counts)


@pytest.mark.parametrize("method", ["halton", "sobol"])
@pytest.mark.parametrize("order", ["rpy", "approach-roll"])
def test_sample(method, order):
    box = PoseBox([(-1, 1), (0, 2), 5], [(-0.2, 0.2), 0, (0.3, 0.7)], order=order)
    pose = box.sample(100, rng=7, method=method)
    assert pose.shape == (100,)
    values = coordinates(pose, order)
    assert (values >= box.low - 1e-12).all()
    assert (values <= box.high + 1e-12).all()
    span = values.max(axis=0) - values.min(axis=0)
    assert (span >= 0.9 * (box.high - box.low)).all()
    again = box.sample(100, rng=np.random.default_rng(7), method=method)
    np.testing.assert_array_equal(again.position, pose.position)
    np.testing.assert_array_equal(again.rotation, pose.rotation)
    other = box.sample(100, rng=8, method=method)
    assert (other.position != pose.position).any()
    assert box.sample(1, rng=0, method=method).shape == (1,)


def test_sample_of_pose_is_that_of_its_box():
    pose = Pose.sample([(-1, 1), (0, 2), 5], [(-10, 10), 0, (20, 40)], 10, rng=3, degrees=True)
    np.testing.assert_array_equal(pose.rotation, BOX.sample(10, rng=3).rotation)


def test_a_generator_moves_on():
    rng = np.random.default_rng(0)
    assert (BOX.sample(5, rng=rng).position != BOX.sample(5, rng=rng).position).any()


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"n": 0}, "n: expected an integer"),
        ({"n": 5.0}, "n: expected an integer"),
        ({"n": None}, "n: expected"),
        ({"n": True}, "n: expected"),
        ({"n": 10**400}, "n: expected"),
        ({"rng": None}, "rng: expected a seed"),
        ({"rng": -1}, "rng: expected an integer ≥ 0"),
        ({"rng": "a"}, "rng: expected"),
        ({"rng": 1.0}, "rng: expected"),
        ({"method": "random"}, "method: expected"),
        ({"method": None}, "method: expected"),
        ({"method": np.ones(2)}, "method: expected"),
    ],
)
def test_bad_samples(given, match):
    with pytest.raises(InvalidInput, match=match):
        BOX.sample(**{"n": 5, "rng": 0, **given})


@pytest.mark.parametrize(
    "value",
    [
        None,
        1,
        "abc",
        [],
        [1, 2],
        [1, 2, 3, 4],
        [(2, 1), 0, 0],
        [np.nan, 0, 0],
        [(0, 1, 2), 0, 0],
        [1j, 0, 0],
        [(0, np.inf), 0, 0],
        ["0", 0, 0],
        [None, 0, 0],
    ],
    ids=repr,
)
def test_bad_boxes(value):
    with pytest.raises(InvalidInput, match=r"box\.position: expected three numbers or pairs"):
        PoseBox(value, [0, 0, 0])
    with pytest.raises(InvalidInput, match=r"box\.angles: expected three numbers or pairs"):
        PoseBox([0, 0, 0], value)


def test_positions_of_boxes_have_finite_squares():
    """Before, proofs over such a box printed warnings of overflow."""
    with pytest.raises(InvalidInput, match=r"box\.position: expected numbers of at most 1e\+100"):
        PoseBox([(-1e308, 1e308), 0, 0], [0, 0, 0])


def test_around():
    pose = Pose.from_rpy([[0, 0, 1], [1, 0, 2]], [[0, 0, 0], [0.1, -0.2, 0.3]])
    box = PoseBox.around(pose, [1, 1, 1, 0.1, 0.1, 0.1])
    np.testing.assert_allclose(box.low, [-1, -1, 0, -0.1, -0.3, -0.1], atol=1e-15)
    np.testing.assert_allclose(box.high, [2, 1, 3, 0.2, 0.1, 0.4], atol=1e-15)


@pytest.mark.parametrize(
    ("pose", "widths"),
    [
        (None, np.ones(6)),
        (Pose(np.zeros((0, 3))), np.ones(6)),
        (Pose([0, 0, 0]), np.ones(5)),
        (Pose([0, 0, 0]), -np.ones(6)),
        (Pose([0, 0, 0]), None),
        (Pose([0, 0, 0]), np.ones((2, 6))),
    ],
)
def test_bad_around(pose, widths):
    with pytest.raises(InvalidInput, match=r"pose: expected|half_widths: expected"):
        PoseBox.around(pose, widths)


def test_truth_is_whether_there_is_a_pose():
    poses = random_pose(np.random.default_rng(0), (3,))
    assert poses
    assert poses[0]
    assert not poses[:0]


@pytest.mark.parametrize("far", [1e101, -1e200, 1e308])
def test_positions_whose_squares_overflow_are_errors(far):
    with pytest.raises(InvalidInput, match=r"coordinates of at most 1e\+100"):
        gsp.Pose([[0.0, 0.0, 1.0], [0.0, far, 1.0]])
    with pytest.raises(InvalidInput, match=r"coordinates of at most 1e\+100"):
        gsp.planar.PlanarPose([far, 0.0])


def test_rotations_of_single_precision_are_made_orthonormal():
    exact = Pose.exp([0.0, 0.0, 0.0, 0.3, -1.2, 0.7]).rotation
    single = Pose([0.0, 0.0, 1.0], exact.astype(np.float32)).rotation
    np.testing.assert_allclose(single, exact, atol=3e-7)
    np.testing.assert_allclose(single.T @ single, np.eye(3), atol=2e-15)
    with pytest.raises(InvalidRotation):
        Pose([0.0, 0.0, 1.0], (1.001 * exact).astype(np.float32))


def test_a_twist_beyond_the_range_is_an_error():
    with pytest.raises(InvalidInput, match="twist: expected numbers of at most 1e"):
        Pose.exp(np.full(6, 1e200))
