"""Effects of manufacturing errors: closed forms, first order against copies, descriptions."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.exploration import Deviations, index_tolerance, pose_tolerance
from gsp.exploration.tolerance.deviations import sizes_of
from gsp.model.dimensions import Dimensions
from tests.support import random_design, random_pose, turn

HEXAPOD = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
POSES = gsp.PoseBox.around(HEXAPOD.home, [0.2] * 6).sample(2, rng=1)
POINT = np.array([0.1, -0.2, 0.3])
MIXED = ("D1", "D2", "D3", "D4", "D4 A1")
SIZES = Deviations(
    base_points=1e-3, platform_points=2e-3, base_directions=1e-3, platform_directions=2e-3,
    joints=1e-3,
)  # fmt: skip


def general():
    rng = np.random.default_rng(3)
    return random_design(rng, MIXED), random_pose(rng, (2,))


def times(deviations, factor):
    names = ("base_points", "platform_points", "base_directions", "platform_directions", "joints")
    return Deviations(**{name: factor * getattr(deviations, name) for name in names})


# --- poses ---


def test_errors_of_legs_have_the_covariance_of_the_inverse_jacobian():
    sizes = np.linspace(1.0, 2.0, 6)
    found = pose_tolerance(HEXAPOD, POSES, Deviations(joints=1e-5 * sizes), samples=1024)
    inverse = np.linalg.inv(HEXAPOD.at(POSES).jacobian)
    wanted = inverse @ np.diag((1e-5 * sizes) ** 2) @ np.swapaxes(inverse, -1, -2)
    np.testing.assert_allclose(found.first_order, wanted, rtol=1e-10, atol=1e-22)
    scale = np.sqrt(np.diagonal(wanted, axis1=-2, axis2=-1))
    error = (found.covariance - wanted) / scale[..., None] / scale[..., None, :]
    assert abs(error).max() < 0.01
    assert abs(found.mean / scale).max() < 0.01
    assert (found.lost == 0.0).all()


def test_equal_errors_of_points_count_as_errors_of_legs():
    """An isotropic error of an anchor changes the length by its part along the leg."""
    found = pose_tolerance(
        HEXAPOD, POSES, Deviations(base_points=3e-4, platform_points=4e-4, joints=12e-4), samples=2
    )
    inverse = np.linalg.inv(HEXAPOD.at(POSES).jacobian)
    wanted = 13e-4**2 * inverse @ np.swapaxes(inverse, -1, -2)
    np.testing.assert_allclose(found.first_order, wanted, rtol=1e-10, atol=1e-18)
    table = found.shares()
    sums = table.groupby("part")["position"].sum()
    np.testing.assert_allclose(
        sums[["base_points", "platform_points", "joints"]], np.array([9, 16, 144]) / 169, rtol=1e-10
    )
    np.testing.assert_allclose(table[["position", "rotation"]].sum(), 1.0, rtol=1e-12)


def test_the_first_order_differs_by_the_square_of_the_errors():
    """All kinds of legs; copies of a size and of half of it have the same errors but for it."""
    design, poses = general()
    apart = []
    for factor in (1e-3, 5e-4):
        found = pose_tolerance(design, poses, times(SIZES, factor), samples=8, point=POINT)
        linear = np.einsum("...ip,mp->m...i", found.gain, found.errors)
        apart.append(abs(found.displacements - linear).max(axis=0))
        assert (apart[-1] < 0.05 * abs(linear).max(axis=0)).all()
    np.testing.assert_allclose(apart[0] / apart[1], 4.0, rtol=0.02)


def test_the_gain_is_that_of_forward_kinematics():
    design, poses = general()
    dimensions = Dimensions.of(design)
    found = pose_tolerance(design, poses, SIZES, samples=2, point=POINT)
    readings, place = design.at(poses).joints, poses.position + poses.rotation @ POINT
    for i in range(len(dimensions)):
        ends = []
        for step in (1e-6, -1e-6):
            values = step * np.eye(len(dimensions))[i]
            joints = readings + dimensions.zero_points(values)
            pose = gsp.forward(dimensions.at(values), joints, poses).pose
            move = pose.rotation @ np.swapaxes(poses.rotation, -1, -2)
            spin = 0.5 * np.stack(
                [move[:, j, k] - move[:, k, j] for j, k in ((2, 1), (0, 2), (1, 0))], axis=-1
            )
            ends.append(np.hstack((pose.position + pose.rotation @ POINT - place, spin)))
        difference = (ends[0] - ends[1]) / 2e-6
        size = max(1.0, abs(difference).max())
        np.testing.assert_allclose(found.gain[..., i], difference, atol=1e-7 * size)


def test_shares_are_those_of_one_part_at_a_time():
    """The variance over copies of which only one part of one leg has errors."""
    found = pose_tolerance(HEXAPOD, HEXAPOD.home.moved([0.1, 0, 0, 0.2, 0.1, 0]), SIZES, samples=2)
    pose = HEXAPOD.home.moved([0.1, 0, 0, 0.2, 0.1, 0])
    lengths = np.linalg.norm(found.displacements.reshape(2, 2, 3), axis=-1)
    np.testing.assert_allclose(found.quantiles(1.0), lengths.max(axis=0), rtol=1e-12)
    table = found.shares().set_index(["part", "leg"])
    total = np.trace(found.first_order[:3, :3]), np.trace(found.first_order[3:, 3:])
    for part, leg in [("base_points", 2), ("platform_points", 5), ("joints", 1)]:
        sizes = np.zeros(6)
        sizes[leg - 1] = getattr(SIZES, part)
        alone = pose_tolerance(HEXAPOD, pose, Deviations(**{part: sizes}), samples=256)
        sums = np.trace(alone.covariance[:3, :3]), np.trace(alone.covariance[3:, 3:])
        wanted = np.array(sums) / total
        np.testing.assert_allclose(table.loc[(part, leg)], wanted, rtol=0.02)


def test_uniform_errors():
    found = pose_tolerance(
        HEXAPOD, POSES, Deviations(joints=1e-4, distribution="uniform"), samples=512
    )
    normal = pose_tolerance(HEXAPOD, POSES, Deviations(joints=1e-4 / np.sqrt(3.0)), samples=2)
    np.testing.assert_allclose(found.first_order, normal.first_order, rtol=1e-12, atol=1e-24)
    joints = found.errors[:, [name.startswith("zero") for name in found.names]]
    assert 0.99e-4 < abs(joints).max() <= 1e-4
    np.testing.assert_allclose(joints.std(axis=0), 1e-4 / np.sqrt(3.0), rtol=0.01)


def test_another_unit_and_other_frames():
    ours = pose_tolerance(HEXAPOD, POSES, SIZES, samples=16, point=POINT)
    lengths = ("base_points", "platform_points", "joints")
    longer = Deviations(**{name: 1000.0 * getattr(SIZES, name) for name in lengths})
    theirs = pose_tolerance(
        HEXAPOD.scaled(1000.0), POSES.scaled(1000.0), longer, samples=16, point=1000.0 * POINT
    )
    units = np.repeat([1000.0, 1.0], 3)
    np.testing.assert_allclose(theirs.displacements, units * ours.displacements, atol=1e-9)
    # Another origin of the platform, the same point; the base in other axes.
    shift = np.array([0.5, 0.2, -0.4])
    other = HEXAPOD.with_origin(shift)
    same = pose_tolerance(
        other, POSES.compose(gsp.Pose(shift)), SIZES, samples=16, point=POINT - shift
    )
    np.testing.assert_allclose(same.displacements, ours.displacements, atol=1e-10)
    np.testing.assert_allclose(same.first_order, ours.first_order, rtol=1e-8, atol=1e-16)
    frame = gsp.Pose([3.0, -2.0, 1.0], turn([0.4, 0.5, -0.6]))
    moved = HEXAPOD.replace(base_points=HEXAPOD.base_points @ frame.rotation.T + frame.position)
    turned = pose_tolerance(moved, frame.compose(POSES), SIZES, samples=16, point=POINT)
    big = np.kron(np.eye(2), frame.rotation)
    wanted = big @ ours.first_order @ big.T
    np.testing.assert_allclose(turned.first_order, wanted, rtol=1e-8, atol=1e-16)


def test_singular_poses_and_lost_copies_are_undefined():
    platform = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    flat = gsp.Pose([0.0, 0.0, 1.0], turn([0.0, 0.0, np.pi / 2]))
    found = pose_tolerance(platform, flat, Deviations(joints=1e-3), samples=4)
    assert np.isnan(found.first_order).all()
    assert found.lost == 1.0
    assert np.isnan(found.mean).all()
    assert np.isnan(found.covariance).all()
    assert np.isnan(found.quantiles()).all()
    assert found.shares()["position"].isna().all()


# --- indices ---

TASK = gsp.Task(poses=POSES, wanted=["mean CTN", "worst CDN_CL", "mean |det J|"], length=0.8)


def test_the_first_order_of_indices_is_that_of_copies():
    sizes = Deviations(base_points=1e-4, platform_points=2e-4)
    found = index_tolerance(HEXAPOD, TASK, sizes, samples=512, seed=3)
    assert list(found.table.index) == [wish.column for wish in TASK.wanted]
    np.testing.assert_allclose(found.table["deviation"], found.table["first_order"], rtol=0.06)
    values = found.samples[found.table.index]
    np.testing.assert_allclose(found.table["mean"], values.mean(), rtol=1e-12)
    inside = (values >= found.table["low"]) & (values <= found.table["high"])
    np.testing.assert_allclose(inside.mean(), 0.95, atol=0.01)
    np.testing.assert_allclose(found.shares.drop(columns=["part", "leg"]).sum(), 1.0, rtol=1e-12)


def test_indices_differ_from_their_first_order_by_the_square():
    dimensions = Dimensions.of(HEXAPOD, ["base_points", "platform_points"])
    apart = []
    for size in (1e-4, 5e-5):
        found = index_tolerance(HEXAPOD, TASK, Deviations(base_points=size), samples=4)
        change = found.samples[found.table.index] - found.table["nominal"]
        errors = found.samples[list(dimensions.names)].to_numpy()
        slopes = [slope(dimensions, error, list(found.table.index)) for error in errors]
        apart.append(abs(change.to_numpy() - slopes).max(axis=0))
    np.testing.assert_allclose(apart[0] / apart[1], 4.0, rtol=0.05)


def slope(dimensions, errors, columns):
    """Derivatives of values along errors: central differences of `gsp.rank`."""
    copies = [dimensions.at(step * errors).replace(name=f"{step}") for step in (1e-2, -1e-2)]
    indices = [column.rpartition("_")[0] for column in columns]
    table = gsp.rank(copies, POSES, indices, length=0.8).set_index("design")[columns]
    return ((table.loc["0.01"] - table.loc["-0.01"]) / 2e-2).to_numpy(dtype=float)


def test_copies_have_the_values_of_their_dimensions_and_the_seed():
    sizes = Deviations(base_points=1e-3)
    found = index_tolerance(HEXAPOD, TASK, sizes, samples=4, seed=7)
    again = index_tolerance(HEXAPOD, TASK, sizes, samples=4, seed=7)
    assert found.samples.equals(again.samples)
    assert found.table.attrs["seed"] == 7
    assert found.table.attrs["version"] == gsp.__version__
    dimensions = Dimensions.of(HEXAPOD)
    errors = found.samples.reindex(columns=list(dimensions.names), fill_value=0.0).to_numpy()
    copy = dimensions.at(errors[2])
    wanted = gsp.indices.control_number(copy.at(POSES)).mean()
    np.testing.assert_allclose(found.samples.loc[2, "control_number_mean"], wanted, rtol=1e-13)


def test_an_index_without_a_gradient_has_no_first_order():
    task = gsp.Task(poses=POSES, wanted="worst SD", length=0.8)
    found = index_tolerance(HEXAPOD, task, Deviations(base_points=1e-3), samples=8)
    assert np.isnan(found.table["first_order"].iloc[0])
    assert found.table["deviation"].iloc[0] > 0.0


# --- sizes ---


def test_sizes_belong_to_coordinates_by_their_names():
    design, _ = general()
    points, lines, joints = np.arange(15.0).reshape(5, 3), np.arange(5.0), np.arange(6.0)
    sizes = Deviations(base_points=points, platform_directions=lines, joints=joints)
    dimensions = Dimensions.of(design)
    found = dict(zip(dimensions.names, sizes_of(sizes, dimensions), strict=True))
    assert found["base_y4"] == points[3, 1]
    assert found["platform_x2"] == 0.0
    assert (found["platform_line2a"], found["platform_line5b"]) == (1.0, 4.0)
    assert [found[f"zero_{name}"] for name in design.joint_names] == joints.tolist()
    assert "base_line1a" not in found
    sample = sizes.sample(design, 8, seed=1)
    assert list(sample.columns) == list(dimensions.names)
    assert (sample["base_x1"] == 0.0).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Deviations(joints=-1.0), "deviations.joints: expected one number ≥ 0"),
        (lambda: Deviations(joints=np.ones((2, 2))), "deviations.joints"),
        (lambda: Deviations(distribution="cauchy"), "deviations.distribution: expected normal or"),
        (lambda: pose_tolerance(HEXAPOD, POSES, Deviations(joints=[1.0, 2.0])),
         "deviations.joints: expected one number or 6"),
        (lambda: pose_tolerance(HEXAPOD, POSES, Deviations(base_points=np.ones((6, 2)))),
         r"deviations.base_points: expected one number or 6, or shape \(6, 3\)"),
        (lambda: pose_tolerance(HEXAPOD, POSES, SIZES, point=np.ones((2, 3))), "single point"),
        (lambda: pose_tolerance(random_design(np.random.default_rng(1), ["D1"] * 7), POSES, SIZES),
         "design: expected six actuators, received 7"),
        (lambda: index_tolerance(HEXAPOD, TASK, Deviations(joints=1.0)),
         "deviations: expected errors of anchor points or lines"),
        (lambda: index_tolerance(HEXAPOD, gsp.Task(poses=POSES, wanted="mean CTN",
                                                   limits=gsp.Limits()), SIZES),
         "task.limits: expected none"),
        (lambda: index_tolerance(HEXAPOD, TASK, SIZES, samples=1), "samples"),
        (lambda: index_tolerance(HEXAPOD, TASK, SIZES, samples=2**40), "samples: .* of memory"),
        (lambda: pose_tolerance(HEXAPOD, POSES, SIZES, samples=2**40), "samples: .* of memory"),
    ],
)  # fmt: skip
def test_wrong_arguments(call, message):
    with pytest.raises(InvalidInput, match=message):
        call()
