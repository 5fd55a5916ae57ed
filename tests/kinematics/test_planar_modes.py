"""All assembly modes of the planar platforms, against independent searches."""

import numpy as np
import pytest

import gsp
from gsp.kinematics import planar_forward, planar_modes
from gsp.planar import PlanarDesign, PlanarPose, mechanisms

RING = np.stack((np.cos(np.arange(3) * 2 * np.pi / 3), np.sin(np.arange(3) * 2 * np.pi / 3)), 1)


def random_design(names, rng, unit=1.0):
    return PlanarDesign(
        names,
        *(unit * rng.uniform(-1, 1, (3, 2)) for _ in range(2)),
        *(rng.normal(size=(3, 2)) for _ in range(2)),
    )


def apart(pose, other, size):
    turn = np.angle(np.exp(1j * (pose.angle - other.angle)))
    return np.hypot(*(pose.position - other.position).T) / size + np.abs(turn)


def crossings(design, joints, number=20_000):
    """Poses of three RPR legs: two circles meet in two points, the third distance changes sign.

    The platform point of leg 2 lies on the circle of leg 2, and on that of leg 1 displaced by the
    turned vector between both points: geometry of the coupler curve, without polynomials.
    """
    a, b, d = design.base_points, design.platform_points, joints
    angle = np.linspace(-np.pi, np.pi, number)
    turn = PlanarPose(np.zeros((number, 2)), angle).rotation
    centres = a[0] - turn @ b[0], a[1] - turn @ b[1]
    across = centres[1] - centres[0]
    length = np.hypot(*across.T)
    along = (d[0] ** 2 - d[1] ** 2 + length**2) / (2 * length)
    square = d[0] ** 2 - along**2
    found = []
    for side in (1.0, -1.0):
        with np.errstate(invalid="ignore"):
            height = side * np.sqrt(square)
        unit = across / length[:, None]
        normal = np.stack((-unit[:, 1], unit[:, 0]), axis=1)
        p = centres[0] + along[:, None] * unit + height[:, None] * normal
        rest = np.hypot(*(p + turn @ b[2] - a[2]).T) - d[2]
        cuts = np.flatnonzero(rest[1:] * rest[:-1] < 0)
        found += [(angle[i], *p[i]) for i in cuts]
    return np.array(sorted(found)).reshape(-1, 3)


@pytest.mark.parametrize("seed", range(12))
def test_three_rpr_legs_have_the_modes_of_their_coupler_curve(seed):
    rng = np.random.default_rng(seed)
    design = random_design(["D1"] * 3, rng)
    here = PlanarPose(rng.uniform(-0.4, 0.4, 2), rng.uniform(-3, 3))
    joints = design.at(here).joints
    modes = planar_modes(design, joints)
    expected = crossings(design, joints)
    assert modes.status == "found"
    assert len(modes.pose.angle) == len(expected)
    np.testing.assert_allclose(modes.pose.angle, expected[:, 0], atol=1e-3)
    np.testing.assert_allclose(modes.pose.position, expected[:, 1:], atol=2e-2)
    assert modes.residual.max() < 1e-12
    assert len(expected) % 2 == 0  # real roots of a real sextic


def test_six_modes_exist_and_are_found():
    """Among random platforms some have the greatest number, and none has more."""
    rng = np.random.default_rng(5)
    counts = np.zeros(7, dtype=int)
    for _ in range(40):
        design = random_design(["D1"] * 3, rng)
        joints = design.at(PlanarPose(rng.uniform(-0.4, 0.4, 2), rng.uniform(-3, 3))).joints
        modes = planar_modes(design, joints)
        counts[len(modes.side)] += 1
        # The sides of consecutive modes of one aspect differ: the signs add up to zero.
        assert modes.side.sum() == 0
    assert counts[6] > 0
    assert counts[2] + counts[4] + counts[6] == 40


@pytest.mark.parametrize("mechanism", mechanisms(), ids=str)
@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_the_known_pose_is_among_the_modes(mechanism, unit):
    rng = np.random.default_rng(9)
    names = list(mechanism.legs)
    for _ in range(3):
        design = random_design(names, rng, unit)
        here = PlanarPose(unit * rng.uniform(-0.5, 0.5, 2), rng.uniform(-3, 3))
        joints = design.at(here).joints
        modes = planar_modes(design, joints)
        assert modes.status == "found"
        assert apart(modes.pose, here, design.rms_radius).min() < 1e-8
        assert modes.residual.max() <= 1e-11
        again = design.at(modes.pose).joints
        difference = np.where(
            design.angular, np.angle(np.exp(1j * (again - joints))), (again - joints) / unit
        )
        assert np.abs(difference).max() < 1e-10
        moved = PlanarPose(here.position + 1e-3 * unit * rng.uniform(-1, 1, 2), here.angle + 1e-3)
        found = planar_forward(design, joints, moved)
        assert apart(found, here, design.rms_radius) < 1e-8


@pytest.mark.parametrize("mechanism", mechanisms()[::3], ids=str)
def test_random_starts_find_no_other_mode(mechanism):
    """Newton's method from many poses: whatever it reaches is in the list."""
    rng = np.random.default_rng(2)
    design = random_design(list(mechanism.legs), rng)
    joints = design.at(PlanarPose(rng.uniform(-0.5, 0.5, 2), 0.4)).joints
    modes = planar_modes(design, joints)
    x = np.column_stack((rng.uniform(-3, 3, (800, 2)), rng.uniform(-np.pi, np.pi, 800)))
    for _ in range(60):
        posture = design.at(PlanarPose(x[:, :2], x[:, 2]))
        error = posture.joints - joints
        error = np.where(design.angular, np.angle(np.exp(1j * error)), error)
        step = (np.linalg.pinv(np.nan_to_num(posture.jacobian)) @ error[..., None])[..., 0]
        x = x - step * (0.3 / np.maximum(0.3, np.linalg.norm(step, axis=1)))[:, None]
    done = np.abs(error).max(axis=1) < 1e-12
    reached = PlanarPose(x[done, :2], x[done, 2])
    assert done.sum() > 40
    near = [apart(modes.pose, reached[i], 1.0).min() for i in range(done.sum())]
    assert max(near) < 1e-6


def test_congruent_triangles_move_on_a_circle_with_the_status_moving():
    design = PlanarDesign(["D1"] * 3, RING, RING)
    found = planar_modes(design, [1.0, 1.0, 1.0])
    assert found.status == "moving"
    assert planar_modes(design, [1.0, 1.1, 1.2]).status == "found"


def test_symmetric_platforms_and_values_out_of_reach():
    design = PlanarDesign(["D1"] * 3, 2 * RING, RING)
    here = PlanarPose([0.0, 0.0], 0.5)
    found = planar_modes(design, design.at(here).joints)
    assert apart(found.pose, here, 1.0).min() < 1e-9
    assert apart(found.pose, PlanarPose([0.0, 0.0], -0.5), 1.0).min() < 1e-9
    assert found.status == "found"
    far = planar_modes(design, [0.1, 9.0, 9.0])
    assert far.pose.shape == (0,)
    for bad in ([np.nan, 1, 1], [-1, 1, 1], [np.inf, 1, 1]):
        assert planar_modes(design, bad).status == "undefined"
    for huge in (1e7, 1e100, 1e200):
        assert planar_modes(design, [huge, 2 * huge, 3 * huge]).status == "incomplete"
    with pytest.raises(gsp.GspError, match="side of the guess"):
        planar_forward(design, [0.1, 9.0, 9.0], here)


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.1])
def test_a_singular_guess_is_on_no_side(turn):
    """The lines of the legs meet in the centre, whichever way the frames are turned."""
    rotation = PlanarPose([0.0, 0.0], turn).rotation
    design = PlanarDesign(["D1"] * 3, 2 * RING @ rotation.T, RING @ rotation.T)
    joints = design.at(PlanarPose([0.1, 0.2], 0.3)).joints
    singular = PlanarPose([0.0, 0.0], 0.0)
    assert design.at(singular).singular()
    with pytest.raises(gsp.errors.InvalidInput, match="guess: expected a regular pose"):
        planar_forward(design, joints, singular)
    assert 0.0 not in planar_modes(design, joints).side
    # A leg of length zero has no line.
    with pytest.raises(gsp.errors.UndefinedPosture, match="d1"):
        planar_forward(design, joints, PlanarPose(RING[0] @ rotation.T, 0.0))


@pytest.mark.parametrize(
    ("design", "joints", "message"),
    [
        ("x", np.ones(3), "PlanarDesign"),
        (PlanarDesign(["D1"] * 3, RING, RING), np.ones(4), "joints"),
        (PlanarDesign(["D1"] * 3, RING, RING), np.ones((2, 3)), r"shape \(3,\)"),
        (PlanarDesign(["A1", "A1", "D1"], RING, RING, RING, RING), np.ones(3), "at most one"),
    ],
)
def test_bad_input(design, joints, message):
    with pytest.raises(gsp.GspError, match=message):
        planar_modes(design, joints)
