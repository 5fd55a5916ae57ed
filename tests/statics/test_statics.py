"""Forces, stiffness and errors of the pose, against balances written here and differences."""

import numpy as np
import pytest
from mpmath import mp

import gsp
from gsp.errors import InvalidInput
from gsp.model.posture.derivatives import rows_and_derivatives

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
MIXED = [
    gsp.catalogue.instantiate(gsp.catalogue.mechanism(name), TEMPLATE)
    for name in ("D1^6", "D2^3 D3^3", "D4^6", "D1 D2 D3 D4 A1^2", "D4^3 A1^3")
]


def random_hexapod(rng, n=6, unit=1.0):
    return gsp.Design(["D1"] * n, unit * rng.normal(size=(n, 3)), unit * rng.normal(size=(n, 3)))


def poses(design, rng, n=3):
    steps = 0.05 * design.rms_radius * np.repeat([1.0, 1.0 / design.rms_radius], 3)
    return design.home.moved(steps * rng.normal(size=(n, 6)))


@pytest.mark.parametrize("n", [6, 7, 8])
def test_forces_of_legs_between_points_balance_force_and_moment(n):
    rng = np.random.default_rng(n)
    design, pose = random_hexapod(rng, n), gsp.Pose.exp(0.3 * rng.normal(size=(4, 6)))
    wrench = rng.normal(size=(4, 6))
    forces = design.at(pose).actuator_forces(wrench)
    ends = pose.position[:, None] + design.platform_points @ np.swapaxes(pose.rotation, -1, -2)
    along = ends - design.base_points
    pushes = forces[..., None] * along / np.linalg.norm(along, axis=-1, keepdims=True)
    moments = np.cross(ends - pose.position[:, None], pushes).sum(axis=1)
    assert np.allclose(pushes.sum(axis=1), -wrench[:, :3], atol=1e-11)
    assert np.allclose(moments, -wrench[:, 3:], atol=1e-11)
    assert np.allclose(design.at(pose).wrench(forces), -wrench, atol=1e-11)
    if n > 6:  # no other balance has a smaller sum of squares
        jacobian = design.at(pose).jacobian
        null = np.linalg.svd(np.swapaxes(jacobian, -1, -2))[2][:, 6:]
        assert np.abs(null @ forces[..., None]).max() < 1e-10


@pytest.mark.parametrize("design", MIXED, ids=lambda d: d.name)
def test_power_of_the_actuators_is_that_of_the_wrench(design):
    rng = np.random.default_rng(1)
    pose, step = poses(design, rng), 1e-5
    forces = rng.normal(size=6)
    wrench = design.at(pose).wrench(forces)
    for k in range(6):
        twist = np.eye(6)[k] * (design.rms_radius if k < 3 else 1.0)
        ends = (design.at(pose.moved(s * step * twist)).joints for s in (1.0, -1.0))
        rates = np.subtract(*ends) / (2.0 * step)
        assert np.allclose(rates @ forces, wrench @ twist, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("shift", [0.0, 1e4])
@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_actuator_forces_do_not_depend_on_frames_and_units(unit, shift):
    rng = np.random.default_rng(4)
    base, platform = rng.normal(size=(2, 6, 3))
    legs = ["D1", "D2", "D3", "D4", "D1", "A1"]
    lines = dict(
        base_directions=rng.normal(size=(6, 3)), platform_directions=rng.normal(size=(6, 3))
    )
    away = shift * np.array([0.6, -0.3, 0.7])
    one = gsp.Design(legs, base, platform, **lines)
    other = gsp.Design(legs, unit * base, unit * (platform + away), **lines)
    pose = gsp.Pose.exp(0.2 * rng.normal(size=6))
    far = gsp.Pose(unit * (pose.position - pose.rotation @ away), pose.rotation)
    force, moment = rng.normal(size=(2, 3))
    ours = one.at(pose).actuator_forces([*force, *moment])
    arm = pose.rotation @ away
    theirs = other.at(far).actuator_forces([*force, *(unit * (moment + np.cross(arm, force)))])
    expected = ours * np.where(one.angular, unit, 1.0)
    assert np.allclose(theirs, expected, rtol=1e-9 if shift else 1e-12, atol=0.0)


def test_a_singular_posture_in_a_batch_changes_no_other_forces():
    lift = gsp.hexapod(1.0, 0.4, 0.6, 0.4, 1.2)
    poses = lift.home.moved(0.1 * np.random.default_rng(0).normal(size=(20, 6)))
    flat = gsp.Pose(
        np.concatenate((poses.position, [[0.0, 0.0, 0.0]])),
        np.concatenate((poses.rotation, np.eye(3)[None])),
    )
    wrench = np.arange(1.0, 7.0)
    forces = lift.at(flat).actuator_forces(wrench)
    assert np.isnan(forces[-1]).all()
    np.testing.assert_array_equal(forces[:-1], lift.at(poses).actuator_forces(wrench))
    np.testing.assert_array_equal(forces[3], lift.at(poses[3]).actuator_forces(wrench))
    back = lift.at(flat).wrench(forces)
    np.testing.assert_allclose(back, [-wrench] * 20 + [[np.nan] * 6], rtol=1e-11)
    np.testing.assert_array_equal(np.isnan(lift.at(flat).actuator_forces(back)), np.isnan(forces))


@pytest.mark.parametrize("legs", [6, 8])
def test_nan_in_one_number_is_nan_in_all_that_depend_on_it(legs):
    rng = np.random.default_rng(legs)
    design = gsp.Design(["D1"] * legs, rng.normal(size=(legs, 3)), rng.normal(size=(legs, 3)))
    posture = design.at(gsp.Pose([0.0, 0.0, 2.0]))
    for call, number in ((posture.wrench, legs), (posture.actuator_forces, 6)):
        given = np.ones((3, number))
        given[1, 2] = np.nan
        assert np.isnan(call(given)).all(axis=1).tolist() == [False, True, False]
        given[1, 2] = np.inf
        with pytest.raises(InvalidInput, match=r"index \[1, 2\]\): expected finite"):
            call(given)


def test_singular_and_undefined_postures_have_no_balance():
    ring = [[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3.0]
    flat = gsp.Design(["D1"] * 6, ring, ring)
    posture = flat.at(gsp.Pose([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]))
    assert posture.singular().tolist()[0]
    assert np.isnan(posture.actuator_forces(np.ones(6))).all()
    assert np.isnan(gsp.statics.pose_errors(posture, 1.0).worst).all()
    assert np.isnan(gsp.statics.compliance(flat, posture.pose, 1.0)).all()
    assert np.isnan(gsp.statics.directional_stiffness(flat, posture.pose, 1.0, [1, 0, 0])).all()


def test_planar_forces_balance():
    rng = np.random.default_rng(3)
    base, platform = rng.normal(size=(2, 3, 2))
    design = gsp.planar.PlanarDesign(["D1"] * 3, base, platform)
    pose = gsp.planar.PlanarPose([0.1, 2.0], 0.3)
    wrench = rng.normal(size=3)
    forces = design.at(pose).actuator_forces(wrench)
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    arms = platform @ turn.T
    along = pose.position + arms - base
    pushes = forces[:, None] * along / np.linalg.norm(along, axis=-1, keepdims=True)
    moment = (arms[:, 0] * pushes[:, 1] - arms[:, 1] * pushes[:, 0]).sum()
    assert np.allclose([*pushes.sum(axis=0), moment], -wrench, atol=1e-12)


@pytest.mark.parametrize("design", MIXED, ids=lambda d: d.name)
def test_stiffness_is_the_change_of_the_wrench_of_springs(design):
    rng = np.random.default_rng(2)
    size, pose = design.rms_radius, poses(design, rng, 1)[0]
    units = np.repeat([size, 1.0], 3)
    k = rng.uniform(1.0, 2.0, 6) * np.where(design.angular, size**2, 1.0)
    preload = rng.normal(size=6) * np.repeat([size, size**2], 3)
    start = design.at(pose)
    balance = start.actuator_forces(preload)

    def external(x):
        moved = design.at(pose.moved(x))
        forces = balance - k * (moved.joints - start.joints)
        return -forces @ moved.jacobian

    h = 1e-5
    columns = [(external(h * e) - external(-h * e)) / (2.0 * h) for e in np.diag(units)]
    expected = np.stack(columns, axis=-1) / units
    found = gsp.stiffness(design, pose, k, preload=preload)
    scale = np.abs(expected * units).max()
    assert np.abs((found - expected) * units).max() < 1e-7 * scale
    free = gsp.stiffness(design, pose, k)
    assert np.allclose(free, start.jacobian.T @ np.diag(k) @ start.jacobian, rtol=1e-12)
    for load in (None, preload):
        whole = gsp.stiffness(design, pose, k, preload=load)
        product = gsp.statics.compliance(design, pose, k, preload=load) @ whole
        assert np.allclose(product * units / units[:, None], np.eye(6), atol=1e-8)


@pytest.mark.parametrize("design", MIXED, ids=lambda d: d.name)
def test_directional_stiffness_is_the_least_energy_of_a_unit_displacement(design):
    """tᵀKt of the twist with n · t = 1 whose wrench is along n, which without preload is least."""
    rng = np.random.default_rng(6)
    size, batch = design.rms_radius, poses(design, rng)
    k = rng.uniform(1.0, 2.0, 6) * np.where(design.angular, size**2, 1.0)
    load = rng.normal(size=6) * np.repeat([0.01 * size, 0.01 * size**2], 3)
    for n in (rng.normal(size=3), rng.normal(size=6) * np.repeat([1.0, size], 3),
              [0, 0, 0, *rng.normal(size=3)]):  # fmt: skip
        whole = np.concatenate((n, np.zeros(6 - len(n))))
        whole /= np.linalg.norm(whole[:3] if whole[:3].any() else whole)
        for preload in (None, load):
            found = gsp.statics.directional_stiffness(design, batch, k, n, preload=preload)
            scaled = np.repeat([size, 1.0], 3)  # twists in units of the design
            matrices = gsp.stiffness(design, batch, k, preload=preload)
            for value, matrix in zip(found, matrices, strict=True):
                border = np.zeros((7, 7))
                border[:6, :6] = matrix * np.outer(scaled, scaled)
                border[:6, 6] = border[6, :6] = whole * scaled
                twist = np.linalg.solve(border, np.eye(7)[6])[:6]
                assert value == pytest.approx(twist @ border[:6, :6] @ twist, rel=1e-8)


def test_directional_stiffness_of_the_cube_is_that_of_its_springs():
    """Two of the six edges along each of three directions across each other: 2 k everywhere."""
    design = gsp.catalogue.design("dehaeze-cubic-centred")
    for n in ([1, 0, 0], [0, 1, 0], [0, 0, 1], [1, -2, 3], [0, 0, -1e-50], [0, 1e90, 0]):
        found = gsp.statics.directional_stiffness(design, design.home, 5.0, n)
        assert found == pytest.approx(10.0, rel=1e-12)
    rows = gsp.statics.directional_stiffness(design, design.home, 5.0, np.eye(3))
    assert rows == pytest.approx([10.0] * 3, rel=1e-12)


@pytest.mark.parametrize(
    "wrong", [[0, 0, 0], [0] * 6, [1, 0], 1.0, [1, 0, 0, 0], "z", [np.nan, 0, 1], [1e-120, 0, 0],
              [[1, 0, 0]] * 2, [1e101, 0, 0], None]
)  # fmt: skip
def test_directions_that_are_none_are_errors(wrong):
    design = gsp.catalogue.design("dehaeze-cubic-centred")
    pose = gsp.Pose(design.home.position + np.zeros((3, 3)))
    with pytest.raises(InvalidInput, match=r"direction.*: expected"):
        gsp.statics.directional_stiffness(design, pose, 1.0, wrong)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("design", MIXED, ids=lambda d: d.name)
def test_compliance_under_a_preload_is_the_inverse_to_all_digits(design, unit):
    """Also with actuators of very unlike stiffness, where K has twice the digits of J to lose."""
    rng = np.random.default_rng(5)
    scaled = design.scaled(unit)
    pose, size = poses(scaled, rng, 1)[0], scaled.rms_radius
    units = np.where(scaled.angular, size**2, 1.0)
    jacobian, slopes = rows_and_derivatives(scaled.at(pose))
    for k in (np.ones(6), units * 10.0 ** rng.uniform(-6.0, 6.0, 6)):
        load = 0.1 * (k / units).min() * rng.normal(size=6) * np.repeat([size, size**2], 3)
        forces = scaled.at(pose).actuator_forces(load)
        found = gsp.statics.compliance(scaled, pose, k, preload=load)
        with mp.workdps(50):
            rows = mp.matrix(jacobian.tolist())
            change = sum(
                (
                    mp.mpf(f) * mp.matrix(s.tolist())
                    for f, s in zip(forces.tolist(), slopes, strict=True)
                ),
                mp.zeros(6),
            )
            true = (rows.T * mp.diag(k.tolist()) * rows - change) ** -1
            expected = np.array(true.tolist(), dtype=float)
        alike = np.outer(*[np.repeat([1.0, size], 3)] * 2)
        error = np.abs((found - expected) * alike).max() / np.abs(expected * alike).max()
        assert error < 1e-12


def test_eigenscrews_of_a_diagonal_stiffness_have_a_closed_form():
    k, c = np.array([2.0, 3.0, 5.0]), np.array([7.0, 11.0, 13.0])
    screws = gsp.statics.eigenscrews(np.diag([*k, *c]))
    values = np.sqrt(k * c)
    assert np.allclose(np.sort(screws.values), np.sort([*values, *-values]))
    assert np.allclose(np.sort(screws.pitch), np.sort([*np.sqrt(c / k), *-np.sqrt(c / k)]))
    assert np.allclose(screws.axis, 0.0)


def test_eigenscrews_do_not_depend_on_the_reference_point():
    rng = np.random.default_rng(5)
    design, pose = random_hexapod(rng), gsp.Pose.exp(0.2 * rng.normal(size=(3, 6)))
    k = rng.uniform(1.0, 2.0, 6)
    matrix = gsp.stiffness(design, pose, k)
    screws = gsp.statics.eigenscrews(matrix)
    swap = np.roll(np.eye(6), 3, axis=0)
    residual = matrix @ screws.twists - screws.values[..., None, :] * (swap @ screws.twists)
    assert np.abs(residual).max() < 1e-12 * np.abs(matrix).max()
    away = np.array([3.0, -5.0, 2.0])
    moved = gsp.Design(["D1"] * 6, design.base_points, design.platform_points - away)
    there = gsp.Pose(pose.position + pose.rotation @ away, pose.rotation)
    others = gsp.statics.eigenscrews(gsp.stiffness(moved, there, k))
    assert np.allclose(others.values, screws.values, rtol=1e-9)
    assert np.allclose(others.pitch, screws.pitch, rtol=1e-7)
    gap = (there.position - pose.position)[..., None, :] + others.axis - screws.axis
    turn = np.swapaxes(screws.twists, -1, -2)[..., 3:]
    assert np.abs(np.cross(gap, turn)).max() < 1e-7


def test_errors_of_the_pose_are_those_of_moved_platforms():
    rng = np.random.default_rng(6)
    design, pose = random_hexapod(rng), gsp.Pose.exp(0.2 * rng.normal(size=6))
    errors = rng.uniform(1e-7, 2e-7, 6)
    found = gsp.statics.pose_errors(design.at(pose), errors)
    signs = np.array(np.meshgrid(*[(-1.0, 1.0)] * 6)).reshape(6, -1).T
    joints = design.at(pose).joints + signs * errors
    ends = gsp.forward(design, joints, pose, tolerance=1e-14, backend="numpy").pose
    turns = gsp.geometry.log3(ends.rotation @ pose.rotation.T)
    moved = np.concatenate((ends.position - pose.position, turns), axis=-1)
    assert np.allclose(np.abs(moved).max(axis=0), found.worst, rtol=1e-4)
    # The mean over all signs of equal sizes is the covariance.
    assert np.allclose(moved.T @ moved / len(moved), found.covariance, rtol=1e-3, atol=1e-18)
    assert np.allclose(found.deviation**2, np.diag(found.covariance))


def test_errors_of_redundant_designs_are_those_of_weighted_least_squares():
    rng = np.random.default_rng(7)
    design, pose = random_hexapod(rng, 8), gsp.Pose.exp(0.2 * rng.normal(size=6))
    errors, jacobian = rng.uniform(1.0, 3.0, 8), design.at(pose).jacobian
    weights = np.diag(1.0 / errors**2)
    gain = np.linalg.solve(jacobian.T @ weights @ jacobian, jacobian.T @ weights)
    found = gsp.statics.pose_errors(design.at(pose), errors)
    assert np.allclose(found.gain, gain)
    assert np.allclose(found.covariance, gain @ np.diag(errors**2) @ gain.T)


@pytest.mark.parametrize("turn", [1e-3, 1e-6, 1e-7])
def test_eigenscrews_near_a_singular_posture_are_those_in_50_digits(turn):
    """The values are eigenvalues of Δ K; the small one is as far from zero as K determines it."""
    hexagons = gsp.hexapod(2.0, 0.0, 1.0, 0.0, 1.5)
    pose = gsp.Pose.from_rpy([0.0, 0.0, 1.5], [0.0, 0.0, np.pi / 2 - turn])
    matrix = gsp.stiffness(hexagons, pose, 1.0)
    matrix = 0.5 * (matrix + matrix.T)
    found = gsp.statics.eigenscrews(matrix)
    with mp.workdps(50):
        expected = mp.eig(mp.matrix(np.roll(matrix, 3, axis=0).tolist()), left=False, right=False)
        expected = sorted((float(mp.re(value)) for value in expected), reverse=True)
    np.testing.assert_allclose(found.values, expected, rtol=1e-12, atol=1e-15)
    wrench = matrix @ found.twists
    back = np.roll(found.twists, 3, axis=0) * found.values
    np.testing.assert_allclose(wrench, back, atol=1e-13)


def test_eigenscrews_of_singular_postures_are_refused():
    hexagons, rng = gsp.hexapod(2.0, 0.0, 1.0, 0.0, 1.5), np.random.default_rng(4)
    for height in rng.uniform(0.5, 3.0, 40):
        pose = gsp.Pose.from_rpy([0.0, 0.0, height], [0.0, 0.0, np.pi / 2])
        with pytest.raises(InvalidInput, match="to rounding"):
            gsp.statics.eigenscrews(gsp.stiffness(hexagons, pose, 1.0))


@pytest.mark.parametrize("unit", [1e-9, 1e-3, 1.0, 1e6])
def test_torques_beside_forces_cost_no_digits_of_redundant_designs(unit):
    """One number for all actuators makes the rows of torques 1/unit times those of forces."""
    rng = np.random.default_rng(7)
    points, lines = rng.normal(size=(2, 8, 3)), rng.normal(size=(2, 8, 3))
    design = gsp.Design(["A1"] * 4 + ["D1"] * 4, *(unit * points), *lines)
    posture = design.at(gsp.Pose.exp(0.3 * rng.normal(size=6) * np.repeat([unit, 1.0], 3)))
    with mp.workdps(50):
        jacobian = mp.matrix(posture.jacobian.tolist())
        inverse = (jacobian.T * jacobian) ** -1
        gain = np.array((inverse * jacobian.T).tolist(), dtype=float)
        square = np.array(inverse.tolist(), dtype=float)
    errors = gsp.statics.pose_errors(posture, 1e-3)
    for part in (slice(3), slice(3, 6)):
        np.testing.assert_allclose(
            errors.gain[part], gain[part], rtol=0, atol=1e-12 * np.abs(gain[part]).max()
        )
        for other in (slice(3), slice(3, 6)):
            right = square[part, other]
            nearly = {"rtol": 0, "atol": 1e-12 * np.abs(right).max()}
            np.testing.assert_allclose(errors.covariance[part, other] / 1e-6, right, **nearly)
            found = gsp.statics.compliance(design, posture.pose, 1e3)[part, other]
            np.testing.assert_allclose(found * 1e3, right, **nearly)


def test_a_preload_of_a_posture_that_is_undefined_is_nan():
    poses = gsp.Pose([TEMPLATE.home.position] * 2)
    preload = np.ones((2, 6))
    preload[1, 0] = np.nan
    found = gsp.stiffness(TEMPLATE, poses, 1.0, preload=preload)
    alone = gsp.stiffness(TEMPLATE, poses[0], 1.0, preload=preload[0])
    np.testing.assert_array_equal(found, [alone, np.full((6, 6), np.nan)])


@pytest.mark.parametrize("k", [0.0, -1.0, np.nan, [1.0, 2.0], "stiff", None, [[1.0] * 6] * 3])
def test_bad_stiffnesses_are_refused(k):
    with pytest.raises(InvalidInput, match=r"^k\b.*: expected"):
        gsp.stiffness(TEMPLATE, gsp.Pose([TEMPLATE.home.position] * 2), k)


def test_matrices_that_are_not_stiffnesses_are_refused():
    for matrix in (np.zeros((6, 6)), -np.eye(6), np.triu(np.ones((6, 6))), np.eye(5)):
        with pytest.raises(InvalidInput, match="stiffness: expected"):
            gsp.statics.eigenscrews(matrix)


def test_numbers_whose_squares_overflow_are_refused():
    posture = TEMPLATE.at(TEMPLATE.home)
    for call in (
        lambda: posture.wrench([1e308] * 6),
        lambda: posture.actuator_forces([1e308] * 6),
        lambda: gsp.stiffness(TEMPLATE, TEMPLATE.home, 1e308),
        lambda: gsp.stiffness(TEMPLATE, TEMPLATE.home, 1.0, preload=[1e308] * 6),
        lambda: gsp.statics.pose_errors(posture, 1e200),
    ):
        with pytest.raises(InvalidInput, match="at most 1e\\+100"):
            call()


@pytest.mark.parametrize("small", [5e-324, 1e-300, 1e-101])
def test_numbers_whose_inverses_overflow_are_errors(small):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    posture = design.at(design.home)
    calls = (
        lambda x: gsp.statics.compliance(design, design.home, x),
        lambda x: gsp.stiffness(design, design.home, [1.0] * 5 + [x]),
        lambda x: gsp.statics.pose_errors(posture, x),
    )
    for call in calls:
        with pytest.raises(gsp.GspError, match="at least 1e-100"):
            call(small)


@pytest.mark.parametrize("power", [-900, -300, 300, 980])
def test_eigenscrews_of_very_stiff_and_very_soft_platforms(power):
    matrix = gsp.stiffness(TEMPLATE, TEMPLATE.home, 1000.0)
    screws = gsp.statics.eigenscrews(matrix)
    scaled = gsp.statics.eigenscrews(np.ldexp(matrix, power))
    np.testing.assert_array_equal(scaled.values, np.ldexp(screws.values, power))
    np.testing.assert_array_equal(scaled.twists, screws.twists)


@pytest.mark.parametrize("size", [1e-300, 1.0, 1e308])
def test_a_stiffness_of_rank_one_has_no_eigenscrews(size):
    with pytest.raises(InvalidInput, match="positive definite"):
        gsp.statics.eigenscrews(np.full((6, 6), size))
