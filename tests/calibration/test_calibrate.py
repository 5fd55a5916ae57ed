"""Calibration: dimensions are recovered, errors are those stated, and what is missing is said."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.stats import chi2

import gsp
from gsp.calibration.measurements import Measurements, State
from gsp.errors import InvalidInput
from gsp.model.dimensions import ANCHORS, PARTS, Dimensions
from tests import campaign
from tests.support import random_design, random_pose, turn

NOMINAL = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
BOX = gsp.PoseBox.around(NOMINAL.home, [0.4] * 6)
POSES = BOX.sample(40, rng=2)
MIXED = ("D1", "D2", "D3", "D4", "A1", "D4 A1")
# More legs than six: sensors of which some are redundant.
SENSORS = gsp.Design(
    ["D1"] * 8,
    np.vstack((NOMINAL.base_points, [[0.0, 0.0, -0.3], [0.5, 0.2, -0.2]])),
    np.vstack((NOMINAL.platform_points, [[0.0, 0.1, 0.3], [0.1, 0.5, 0.2]])),
    home=NOMINAL.home,
)


def made(nominal, seed, size=0.02):
    """A copy with errors of all coordinates, and the values of these."""
    dimensions = Dimensions.of(nominal)
    values = np.random.default_rng(seed).normal(0.0, size, len(dimensions))
    return dimensions.at(values), dimensions.zero_points(values), values


def readings(nominal, seed, poses):
    design, zeros, _ = made(nominal, seed)
    return design.at(poses).joints - zeros


def distances(points):
    return np.linalg.norm(points[:, None] - points, axis=-1)


def test_42_parameters_from_full_poses():
    design, zeros, values = made(NOMINAL, 1)
    found = gsp.calibrate(NOMINAL, readings(NOMINAL, 1, POSES), POSES)
    assert found.converged
    assert len(found.names) == 42
    np.testing.assert_allclose(found.deviations, values, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.zero_points, zeros, rtol=0, atol=1e-9)
    for part in ANCHORS[:2]:
        np.testing.assert_allclose(getattr(found.design, part), getattr(design, part), atol=1e-9)
    assert found.not_identified == ()
    assert found.identified.all()
    assert found.degrees_of_freedom == 40 * 6 - 42


def test_a_published_machine_from_its_nominal_dimensions():
    """`Viso`, after Nategh and Agheli: anchors that are 3.6 to 6.1 mm off, lengths up to 4.8 mm."""
    nominal = gsp.catalogue.design("nategh-agheli-nominal")
    real = gsp.catalogue.design("nategh-agheli-real")
    lengths = [604.4299, 607.2473, 600.4441, 605.9031, 604.5251, 600.0616]
    zeros = np.array(lengths) - 604.8652
    box = gsp.PoseBox.around(nominal.home, [150.0] * 3 + [0.3] * 3)
    poses, others = box.sample(20, rng=3), box.sample(200, rng=4)
    wanted = np.hstack((real.base_points, real.platform_points, zeros[:, None]))

    def calibrated(noise):
        given = readings_of(real, zeros, poses)
        given = given + np.random.default_rng(0).normal(0.0, noise, given.shape)
        found = gsp.calibrate(nominal, given, poses, joint_errors=0.002)
        assert found.converged
        assert found.not_identified == ()
        sides = found.design.base_points, found.design.platform_points, found.zero_points[:, None]
        return found, np.hstack(sides) - wanted

    def worst_reading(design, offsets):
        """At poses that no calibration has."""
        apart = readings_of(design, offsets, others) - readings_of(real, zeros, others)
        return np.abs(apart).max()

    exact, errors = calibrated(0.0)
    np.testing.assert_allclose(errors, 0.0, atol=1e-8)
    found, errors = calibrated(0.002)
    assert np.abs(errors).max() < 0.15
    away = found.deviations - exact.deviations
    assert 1e-3 < chi2.cdf(away @ np.linalg.solve(found.covariance, away), 42) < 1 - 1e-3
    assert worst_reading(nominal, 0.0) > 10.0
    assert worst_reading(found.design, found.zero_points) < 0.01


def test_lines_and_angles_from_full_poses():
    """A point along its line changes no distance to the line, and is not identified."""
    nominal = random_design(np.random.default_rng(3), MIXED)
    poses = random_pose(np.random.default_rng(4), (60,))
    design, zeros, _ = made(nominal, 5, size=0.01)
    found = gsp.calibrate(nominal, readings_of(design, zeros, poses), poses)
    assert found.converged
    np.testing.assert_allclose(found.zero_points, zeros, rtol=0, atol=1e-9)
    for part in ANCHORS[2:]:
        np.testing.assert_allclose(getattr(found.design, part), getattr(design, part), atol=1e-9)
    # Both points of A1 change nothing. Two lines each of D4 and D4 A1, one of D2 and D3.
    assert found.not_identified[0].startswith("6 coordinates of points of A1 legs, whose angles")
    assert found.not_identified[1] == "6 slides of points along lines"
    turned = random_pose(np.random.default_rng(6), (20,))
    np.testing.assert_allclose(found.design.at(turned).joints, design.at(turned).joints, atol=1e-8)


def readings_of(design, zeros, poses):
    return design.at(poses).joints - zeros


def test_too_few_poses():
    """Six poses leave one combination of the seven coordinates of each leg."""
    poses = POSES[:6]
    found = gsp.calibrate(NOMINAL, readings(NOMINAL, 1, poses), poses)
    assert found.not_identified[0].startswith("6 other combinations of base_x1, base_y1, base_z1,")
    alone = gsp.calibrate(NOMINAL, readings(NOMINAL, 1, POSES[:1]), POSES[:1], free="joints")
    assert alone.not_identified == ()


def test_places_alone_leave_the_turn_of_the_platform_frame():
    design, zeros, _ = made(NOMINAL, 1)
    point = np.array([0.1, 0.2, 0.3])
    places = POSES.position + POSES.rotation @ point
    found = gsp.calibrate(NOMINAL, readings(NOMINAL, 1, POSES), places, point=point)
    assert found.converged
    assert found.not_identified == ("3 motions of the platform frame",)
    np.testing.assert_allclose(found.design.base_points, design.base_points, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.zero_points, zeros, rtol=0, atol=1e-9)
    np.testing.assert_allclose(
        distances(np.vstack((found.design.platform_points, point))),
        distances(np.vstack((design.platform_points, point))),
        atol=1e-9,
    )
    names = np.array(found.names)[~found.identified]
    assert all(name.startswith("platform_") for name in names)
    assert np.isinf(found.standard_errors[~found.identified]).all()


def test_redundant_sensors_leave_both_frames():
    design, zeros, _ = made(SENSORS, 7)
    found = gsp.calibrate(SENSORS, readings(SENSORS, 7, POSES), guess=POSES)
    assert found.converged
    assert found.not_identified == (
        "6 motions of the base frame",
        "6 motions of the platform frame",
    )
    np.testing.assert_allclose(found.zero_points, zeros, rtol=0, atol=1e-9)
    for part in ANCHORS[:2]:
        ours, theirs = (distances(getattr(one, part)) for one in (found.design, design))
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)


@pytest.mark.parametrize("poses", ["places", "none"])
def test_of_all_that_fit_alike_the_nearest_is_returned(poses):
    nominal = SENSORS if poses == "none" else NOMINAL
    given = None if poses == "none" else POSES.position
    found = gsp.calibrate(nominal, readings(nominal, 1, POSES), given, guess=POSES)
    along = found.undetermined / Dimensions.of(nominal).sizes ** 2 @ found.deviations
    assert len(along) == (12 if poses == "none" else 3)
    assert abs(along).max() < 1e-10
    assert abs(found.deviations).max() > 0.02


def test_poses_without_turns_do_not_tell_base_from_platform():
    poses = gsp.Pose(POSES.position)
    found = gsp.calibrate(NOMINAL, readings(NOMINAL, 1, poses), poses)
    assert len(found.undetermined) == 18
    assert "6 motions" not in " ".join(found.not_identified)
    assert not found.identified[[name.startswith("base_") for name in found.names]].any()
    assert found.identified[[name.startswith("zero_") for name in found.names]].all()
    # b − a is what such poses determine.
    design, _, _ = made(NOMINAL, 1)
    apart = [one.platform_points - one.base_points for one in (found.design, design)]
    np.testing.assert_allclose(*apart, rtol=0, atol=1e-9)


# --- errors ---


@pytest.mark.parametrize("kind", ["poses", "noisy poses", "places", "sensors"])
def test_deviations_have_the_stated_covariance(kind):
    """Σ dᵀ C⁻¹ d over repeats has the distribution χ², and so has that of the residuals."""
    nominal = SENSORS if kind == "sensors" else NOMINAL
    poses, repeats, error = BOX.sample(40, rng=3), campaign.count(6, 48), 1e-5
    exact = readings(nominal, 1, poses)
    target = None if kind == "sensors" else poses.position if kind == "places" else poses
    pose_errors = {"noisy poses": [2e-5, 1e-5], "places": 2e-5}.get(kind)
    options = {"joint_errors": error, "pose_errors": pose_errors}
    if target is not poses:
        options["guess"] = poses
    truth = gsp.calibrate(nominal, exact, target, **options)
    sizes = Dimensions.of(nominal).sizes
    squares, rank, residual, freedoms = 0.0, 0, 0.0, 0
    for seed in range(repeats):
        rng = np.random.default_rng(seed)
        measured = target
        if kind == "noisy poses":
            measured = poses.moved(rng.normal(size=(40, 6)) * np.repeat([2e-5, 1e-5], 3))
        elif kind == "places":
            measured = target + rng.normal(0.0, 2e-5, (40, 3))
        noisy = exact + rng.normal(0.0, error, exact.shape)
        found = gsp.calibrate(nominal, noisy, measured, **options)
        known = len(found.names) - len(found.undetermined)
        values, vectors = np.linalg.eigh(found.covariance / sizes / sizes[:, None])
        away = vectors[:, -known:].T @ ((found.deviations - truth.deviations) / sizes)
        squares, rank = squares + (away**2 / values[-known:]).sum(), rank + known
        residual, freedoms = residual + found.chi_squared, freedoms + found.degrees_of_freedom
    assert rank == repeats * {"places": 39, "sensors": 44}.get(kind, 42)
    assert 1e-3 < chi2.cdf(squares, rank) < 1 - 1e-3
    assert 1e-3 < chi2.cdf(residual, freedoms) < 1 - 1e-3


def test_errors_that_are_not_given_are_estimated():
    noise = np.random.default_rng(0).normal(0.0, 1e-4, (40, 6))
    given = readings(NOMINAL, 1, POSES) + noise
    found = gsp.calibrate(NOMINAL, given, POSES)
    known = gsp.calibrate(NOMINAL, given, POSES, joint_errors=1e-4)
    np.testing.assert_allclose(found.deviations, known.deviations, rtol=0, atol=1e-10)
    factor = known.chi_squared / known.degrees_of_freedom
    size = np.abs(found.covariance).max()
    wanted = factor * known.covariance
    np.testing.assert_allclose(found.covariance, wanted, rtol=1e-6, atol=1e-12 * size)


# --- independent minimisers ---


@pytest.mark.parametrize(
    "loss", campaign.some(["linear", "cauchy", "huber", "arctan", "soft_l1"], 2)
)
def test_losses_are_those_of_scipy(loss):
    """The same minimum as `scipy.optimize.least_squares` finds, by its own differences."""
    rng = np.random.default_rng(8)
    given = readings(NOMINAL, 1, POSES) + rng.normal(0.0, 1e-3, (40, 6))
    given[rng.random((40, 6)) < 0.05] += 0.02
    found = gsp.calibrate(
        NOMINAL, given, POSES, joint_errors=1e-3, loss=loss, loss_scale=1.5, tolerance=1e-10,
        max_iterations=1000,
    )  # fmt: skip
    dimensions = Dimensions.of(NOMINAL)

    def residuals(values):
        joints = dimensions.at(values).at(POSES).joints - dimensions.zero_points(values)
        return ((joints - given) / 1e-3).ravel()

    start = found.deviations + rng.normal(0.0, 1e-4, 42)
    wanted = least_squares(
        residuals, start, loss=loss, f_scale=1.5, xtol=1e-12, ftol=1e-14, gtol=1e-10, max_nfev=50
    )
    assert found.converged
    np.testing.assert_allclose(found.deviations, wanted.x, rtol=0, atol=1e-6)


def test_a_robust_loss_withstands_outliers():
    _, _, values = made(NOMINAL, 1)
    rng = np.random.default_rng(9)
    given = readings(NOMINAL, 1, POSES) + rng.normal(0.0, 1e-4, (40, 6))
    wrong = rng.random((40, 6)) < 0.05
    given[wrong] += 0.05
    plain, robust = (
        gsp.calibrate(NOMINAL, given, POSES, joint_errors=1e-4, loss=loss, max_iterations=500)
        for loss in ("linear", "cauchy")
    )
    assert abs(robust.deviations - values).max() < 0.05 * abs(plain.deviations - values).max()
    assert robust.weights[wrong].max() < 0.01 < robust.weights[~wrong].min()


def test_poses_with_errors_are_unknowns():
    """The same minimum as that over dimensions and poses together, without eliminating these."""
    poses, rng = BOX.sample(12, rng=5), np.random.default_rng(10)
    given = readings(NOMINAL, 1, poses) + rng.normal(0.0, 1e-3, (12, 6))
    found = gsp.calibrate(NOMINAL, given, poses, joint_errors=1e-3, pose_errors=[2e-3, 1e-3])
    dimensions = Dimensions.of(NOMINAL)

    def residuals(unknowns):
        values, steps = unknowns[:42], unknowns[42:].reshape(12, 6)
        near = gsp.Pose(poses.position + steps[:, :3], turn(steps[:, 3:]) @ poses.rotation)
        joints = dimensions.at(values).at(near).joints - dimensions.zero_points(values)
        parts = ((joints - given) / 1e-3, steps / np.repeat([2e-3, 1e-3], 3))
        return np.concatenate([part.ravel() for part in parts])

    wanted = least_squares(residuals, np.zeros(42 + 72), xtol=1e-13, ftol=1e-15, gtol=1e-10)
    np.testing.assert_allclose(found.chi_squared, 2.0 * wanted.cost, rtol=1e-6)
    np.testing.assert_allclose(found.deviations, wanted.x[:42], rtol=0, atol=1e-5)
    steps = found.poses.position - poses.position
    np.testing.assert_allclose(steps, wanted.x[42:].reshape(12, 6)[:, :3], rtol=0, atol=1e-5)


# --- derivatives and descriptions ---


@pytest.mark.parametrize("rotation", [True, False])
def test_derivatives_are_central_differences(rotation):
    """For all kinds of legs, away from the nominal dimensions and from the measured poses."""
    rng = np.random.default_rng(11)
    nominal, poses = random_design(rng, MIXED), random_pose(rng, (5,))
    dimensions = Dimensions.of(nominal)
    measured = Measurements(
        joints=rng.normal(size=(5, 7)), joint_errors=rng.uniform(0.5, 2.0, 7),
        position=rng.normal(size=(5, 3)), rotation=random_pose(rng, (5,)).rotation if rotation
        else None, point=rng.normal(size=3), position_error=0.7, rotation_error=0.4, exact=False,
    )  # fmt: skip
    state = State(rng.normal(0.0, 0.1, len(dimensions)), poses)
    found = measured.linear(dimensions, state)
    residuals = measured.residuals(dimensions, state)
    np.testing.assert_allclose(found.residuals, residuals, rtol=1e-14)
    step, size = 1e-6, nominal.rms_radius

    def difference(high, low):
        ends = [measured.residuals(dimensions, one) for one in (high, low)]
        return (ends[0] - ends[1]) / (2 * step)

    for i, axis in enumerate(np.eye(len(dimensions)) * dimensions.sizes):
        ends = [State(state.values + sign * step * axis, poses) for sign in (1, -1)]
        np.testing.assert_allclose(found.by_dimensions[..., i], difference(*ends), atol=2e-7)
    for i, axis in enumerate(np.eye(6) * np.repeat([size, 1.0], 3)):
        ends = [State(state.values, poses.moved(sign * step * axis)) for sign in (1, -1)]
        np.testing.assert_allclose(found.by_pose[..., i], difference(*ends), atol=2e-7)


def test_another_unit():
    noise = np.random.default_rng(0).normal(0.0, 1e-4, (40, 6))
    given = readings(NOMINAL, 1, POSES) + noise
    point = np.array([0.1, 0.2, 0.3])
    places = POSES.position + POSES.rotation @ point
    ours = gsp.calibrate(
        NOMINAL, given, places, point=point, joint_errors=1e-4, pose_errors=2e-4, guess=POSES
    )
    theirs = gsp.calibrate(
        NOMINAL.scaled(1000.0), given * 1000.0, places * 1000.0, point=point * 1000.0,
        joint_errors=0.1, pose_errors=0.2, guess=POSES.scaled(1000.0),
    )  # fmt: skip
    assert ours.not_identified == theirs.not_identified
    np.testing.assert_allclose(theirs.deviations, 1000.0 * ours.deviations, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(theirs.covariance, 1e6 * ours.covariance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(theirs.chi_squared, ours.chi_squared, rtol=1e-9)


def test_other_frames():
    """Poses in other axes of the base and of another origin of the platform fit as well."""
    given = readings(NOMINAL, 1, POSES) + np.random.default_rng(0).normal(0.0, 1e-4, (40, 6))
    ours = gsp.calibrate(NOMINAL, given, POSES, joint_errors=1e-4)
    move = gsp.Pose([3.0, -2.0, 1.0], turn([0.4, 0.5, -0.6]))
    other = NOMINAL.replace(
        base_points=NOMINAL.base_points @ move.rotation.T + move.position,
        platform_points=NOMINAL.platform_points - [0.1, 0.2, 0.3],
        home=None,
    )
    poses = move.compose(POSES).compose(gsp.Pose([0.1, 0.2, 0.3]))
    theirs = gsp.calibrate(other, given, poses, joint_errors=1e-4)
    np.testing.assert_allclose(theirs.chi_squared, ours.chi_squared, rtol=1e-8)
    np.testing.assert_allclose(theirs.zero_points, ours.zero_points, rtol=0, atol=1e-9)
    np.testing.assert_allclose(theirs.singular_values, ours.singular_values, rtol=1e-8)


def test_what_is_not_free_stays():
    given = readings(NOMINAL, 1, POSES)
    found = gsp.calibrate(NOMINAL, given, POSES, free=["platform_points", "joints"])
    assert np.array_equal(found.design.base_points, NOMINAL.base_points)
    assert len(found.names) == 24
    one = gsp.calibrate(NOMINAL, given, POSES, free="joints")
    wanted = (NOMINAL.at(POSES).joints - given).mean(axis=0)
    np.testing.assert_allclose(one.zero_points, wanted, rtol=0, atol=1e-12)


def test_the_table_has_a_row_per_coordinate():
    found = gsp.calibrate(NOMINAL, readings(NOMINAL, 1, POSES), POSES, joint_errors=1e-4)
    table = found.table().set_index("name")
    assert table.loc["platform_y3", "nominal"] == NOMINAL.platform_points[2, 1]
    values = found.design.platform_points[2, 1], found.zero_points[4]
    np.testing.assert_allclose(table.loc[["platform_y3", "zero_d5"], "value"], values, rtol=1e-14)
    assert set(table["part"]) == {"base_points", "platform_points", "joints"}
    roots = np.sqrt(np.diagonal(found.covariance))
    np.testing.assert_array_equal(table["standard_error"], roots)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"joints": np.ones((4, 5))}, r"joints: expected shape"),
        ({"joints": np.ones(6)}, r"joints: expected shape"),
        ({"poses": POSES[:3]}, r"poses: expected batch shape \(40,\)"),
        ({"poses": np.ones((3, 3))}, r"poses: expected shape \(40, 3\)"),
        ({"poses": gsp.Pose(NOMINAL.base_points[0] - NOMINAL.platform_points[0])[None]},
         "batch shape"),
        ({"guess": POSES[:2]}, r"guess: expected batch shape \(\) or \(40,\)"),
        ({"loss_scale": 1e200}, "loss_scale: expected"),
        ({"loss_scale": 1e-200}, "loss_scale: expected"),
        ({"joint_errors": -1.0}, "joint_errors: expected a positive number"),
        ({"joint_errors": [1.0, 2.0]}, "joint_errors: expected one number or 6"),
        ({"pose_errors": [1.0, 2.0]}, "joint_errors: expected standard errors beside pose_errors"),
        ({"pose_errors": 1.0, "joint_errors": 1.0}, "pose_errors: expected two numbers"),
        ({"poses": POSES.position, "joint_errors": 1.0}, "pose_errors: expected the standard err"),
        ({"free": "anchors"}, "free: expected some of base_points"),
        ({"free": "base_directions"}, "free: expected parts that the design has"),
        ({"loss": "huber"}, "joint_errors: expected standard errors, for loss='huber'"),
        ({"loss": "square"}, "loss: expected linear or soft_l1"),
        ({"poses": None, "design": NOMINAL.replace(home=None)}, "guess: expected a pose near"),
        ({"poses": None, "guess": POSES[:2]}, r"guess: expected batch shape \(\) or \(40,\)"),
        ({"guess": POSES}, "guess: expected None beside measured poses"),
        ({"poses": None, "pose_errors": 1.0, "joint_errors": 1.0}, "pose_errors: expected None"),
        ({"poses": None, "point": [0.0, 0.0, 1.0]}, "point: expected the origin without poses"),
    ],
)  # fmt: skip
def test_wrong_arguments(changes, message):
    given = {"design": NOMINAL, "joints": readings(NOMINAL, 1, POSES), "poses": POSES, **changes}
    with pytest.raises(InvalidInput, match=message):
        gsp.calibrate(**given)


def test_a_leg_of_no_length_is_an_error():
    pose = gsp.Pose([NOMINAL.base_points[0] - NOMINAL.platform_points[0]])
    with pytest.raises(InvalidInput, match="poses: expected poses at which every leg is defined"):
        gsp.calibrate(NOMINAL, np.ones((1, 6)), pose)


def test_parts_are_those_of_designs():
    assert PARTS[:4] == tuple(part for part in PARTS if hasattr(NOMINAL, part))
