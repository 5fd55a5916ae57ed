"""Travel of driven designs and their nearest poses: closed forms, scans, samples, differences."""

import numpy as np
import pytest

import gsp
from gsp import Crank, Pose
from gsp.kinematics.newton import reference
from gsp.kinematics.newton.centred import centred
from gsp.limits.legs import crank_bounds, reaches
from tests import campaign, driven

SIX = [name for name, design in driven.DESIGNS.items() if len(design.joint_names) == 6]
UP = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]


def test_straight_up_rails_are_left_behind_where_a_rod_is_at_right_angles():
    """Closed form: c² = Δy² + z² = ℓ² for rails along x."""
    design = driven.hexaglide()
    found = gsp.travel(design, design.home, UP)
    aside = design.home.position[1] + design.platform_points[:, 1] - design.base_points[:, 1]
    highest = np.sqrt(2.2**2 - aside**2)
    leg = int(highest.argmin())
    assert found.distance == pytest.approx(highest[leg] - design.home.position[2], abs=1e-8)
    assert found.limit == f"d{leg + 1}: the rod is perpendicular to the rail"
    assert design.at(found.pose).defined


def test_a_stroke_of_a_slider_is_the_closed_form():
    """Along the rails all carriages move as the platform."""
    design = driven.hexaglide()
    joints = design.at(design.home).joints
    strokes = np.stack((joints - 0.7, joints + 0.5), axis=1)
    strokes[3, 0] = joints[3] - 0.3
    forth = gsp.travel(design, design.home, [1, 0, 0, 0, 0, 0], strokes=strokes)
    assert forth.distance == pytest.approx(0.5, abs=1e-8)
    back = gsp.travel(design, design.home, [-1, 0, 0, 0, 0, 0], strokes=strokes)
    assert back.distance == pytest.approx(0.3, abs=1e-8)
    assert back.limit == f"d4 = {strokes[3, 0]:.6g}"


def test_the_angle_of_a_crank_ends_at_a_half_turn_if_it_has_a_bound():
    """Its angle at home is 2.75: upwards it increases to π, and is −π then."""
    design = driven.rotary()
    strokes = np.full((6, 2), np.nan)
    strokes[0] = [2.5, 9.0]
    found = gsp.travel(design, design.home, UP, strokes=strokes)
    assert found.limit == f"theta1 = {np.pi:.6g}"
    step = np.array([1e-6, -1e-6])[:, None] * UP
    beyond, before = design.at(found.pose.moved(step)).joints[:, 0]
    assert before == pytest.approx(np.pi, abs=1e-4)
    assert beyond == pytest.approx(-np.pi, abs=1e-4)
    strokes[0] = [-4.0, 4.0]
    assert gsp.travel(design, design.home, UP, strokes=strokes).distance > found.distance + 0.1
    np.testing.assert_array_equal(crank_bounds(np.array([[-4.0, 4.0]])), [[-np.inf, np.inf]])
    np.testing.assert_array_equal(crank_bounds(np.array([[-np.inf, 1.0]])), [[-np.pi, 1.0]])


def scanned(design, twist, strokes, most, number=4001):
    """First undefined leg, violated stroke or change of sign of det J on a fine grid."""
    share = np.linspace(0, most, number)
    posture = design.at(design.home.moved(share[:, None] * twist))
    bad = ~((posture.joints >= strokes[:, 0]) & (posture.joints <= strokes[:, 1])).all(axis=1)
    side = np.sign(np.linalg.det(np.nan_to_num(posture.jacobian)))
    bad |= side != side[0]
    return share[np.argmax(bad)] if bad.any() else most


@pytest.mark.parametrize("name", campaign.some(SIX, 4))
def test_it_ends_where_a_scan_finds_the_first_violation(name):
    design, rng = driven.DESIGNS[name], np.random.default_rng(len(name))
    joints = design.at(design.home).joints
    for width in (0.3, 50.0):
        strokes = np.stack((joints - width, joints + width), axis=1)
        twist = rng.normal(size=6) * np.repeat([design.rms_radius, 1.0], 3)
        found = gsp.travel(design, design.home, twist, strokes=strokes)
        rough = scanned(design, twist, strokes, 1.2 * found.distance)
        assert found.limit
        assert 0 <= rough - found.distance <= 1.2 * found.distance / 4000 + 1e-9
        posture = design.at(found.pose)
        joint = found.limit.partition(" = ")[0].partition(":")[0]
        if ":" in found.limit:
            end = np.abs(posture.drive_scales[design.joint_names.index(joint)])
            assert end < 1e-3 * design.rms_radius
        elif "=" in found.limit:
            i = design.joint_names.index(joint)
            assert np.abs(posture.joints[i] - strokes[i]).min() < 1e-5
        else:
            assert np.linalg.cond(posture.jacobian) > 1e4


def test_starts_at_a_singular_drive_and_beyond_strokes():
    design = driven.hexaglide()
    found = gsp.travel(design, design.home, UP)
    end = gsp.travel(design, design.home.moved([0, 0, found.distance + 1e-6, 0, 0, 0]), UP)
    assert (end.distance, end.limit) == (0.0, found.limit)
    joints = design.at(design.home).joints
    strokes = np.stack((joints + 0.1, joints + 0.2), axis=1)
    beyond = gsp.travel(design, design.home, UP, strokes=strokes)
    assert (beyond.distance, beyond.limit) == (0.0, f"d1 = {strokes[0, 0]:.6g}")


@pytest.mark.parametrize(("name", "factor"), [("hexaglide", 1e-6), ("cranks", 1e6)])
def test_units_and_origins_change_nothing(name, factor):
    design = driven.DESIGNS[name]
    base, point = np.array([3.0, -2.0, 5.0]), np.array([0.2, 0.1, -0.3])
    home = design.home
    other = design.replace(
        base_points=design.base_points + base, home=Pose(home.position + base, home.rotation)
    )
    other = other.with_origin(point).scaled(factor)
    twist = np.array([0.3, 0.1, -0.4, 0.2, 0.3, -0.1])
    one = gsp.travel(design, home, [*twist[:3], 0, 0, 0])
    two = gsp.travel(other, other.home, [*(factor * twist[:3]), 0, 0, 0])
    assert two.limit == one.limit
    assert two.distance == pytest.approx(one.distance, abs=1e-7)
    joints = design.at(home).joints
    limits = np.stack((joints - 0.2, joints + 0.15), axis=1)
    far = home.moved(0.3 * twist)
    near = gsp.nearest(design, far, gsp.Limits(strokes=limits), starts=1)
    units = np.where(design.angular, 1.0, factor)[:, None]
    seen = Pose(factor * (far.position + base + far.rotation @ point), far.rotation)
    again = gsp.nearest(other, seen, gsp.Limits(strokes=limits * units), starts=1)
    assert again.distance == pytest.approx(near.distance, abs=1e-8)


@pytest.mark.parametrize("name", campaign.some(driven.DESIGNS, 3))
@pytest.mark.parametrize("width", [0.15, 9.0])
def test_the_nearest_pose_is_feasible_and_no_sample_is_nearer(name, width):
    design, rng = driven.DESIGNS[name], np.random.default_rng(7)
    joints = design.at(design.home).joints
    strokes = np.stack((joints - width, joints + width), axis=1)
    strokes = np.where(design.signed[:, None], strokes, np.maximum(strokes, 0.0))
    limits = gsp.Limits(strokes=strokes)
    size, centre = design.rms_radius, design.platform_points.mean(axis=0)
    away = design.home.moved(np.array([0.3, -0.5, 0.9, 0.3, 0.2, -0.4]) * np.repeat([size, 1.0], 3))
    found = gsp.nearest(design, away, limits, starts=2)
    inside = gsp.feasible(design, found.pose, limits)
    slack = np.stack((inside.low - inside.values, inside.values - inside.high))
    assert slack.max() < 1e-8
    assert found.distance > 0.0
    moved = design.with_origin(centre)
    middle = Pose(away.position + away.rotation @ centre, away.rotation)
    step = rng.normal(size=(4000, 6))
    shares = found.distance * rng.uniform(0.3, 0.999, (4000, 1))
    step *= shares / np.linalg.norm(step, axis=1, keepdims=True)
    # Others are just nearer than what was found.
    end = found.pose.position + found.pose.rotation @ centre - middle.position
    turn = gsp.geometry.log3(found.pose.rotation @ away.rotation.T)
    best = np.concatenate((end / size, turn))
    near = best + 10.0 ** rng.uniform(-5, -1, (4000, 1)) * rng.normal(size=(4000, 6))
    near *= np.minimum(1.0, 0.99999 * found.distance / np.linalg.norm(near, axis=1))[:, None]
    poses = middle.moved(np.concatenate((step, near)) * np.repeat([size, 1.0], 3))
    assert not gsp.feasible(moved, poses, limits).ok.any()
    assert gsp.nearest(design, design.home, limits).distance == 0


def test_short_cranks_of_narrow_strokes_without_a_home_pose():
    """General ones, far away: no search ends in the strokes but those from assembly modes."""
    rng = np.random.default_rng(31)
    base, platform = rng.uniform(-1.0, 1.0, (6, 3)), rng.uniform(-0.6, 0.6, (6, 3))
    known = Pose([0.1, -0.2, 1.2])
    axes = rng.normal(size=(6, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    arms = np.cross(axes, rng.normal(size=(6, 3)))
    arms *= 0.05 / np.linalg.norm(arms, axis=1, keepdims=True)
    rods = np.linalg.norm(known.position + platform - base - arms, axis=1)
    design = gsp.Design(
        [Crank(arm=arm, rod=rod) for arm, rod in zip(arms, rods, strict=True)],
        base_points=base,
        base_directions=axes,
        platform_points=platform,
    )
    joints = design.at(known).joints
    strokes = np.stack((joints - 0.05, joints + 0.05), axis=1)
    away = known.moved(np.random.default_rng(0).uniform(-1.0, 1.0, 6))
    found = gsp.nearest(design, away, gsp.Limits(strokes=strokes), starts=1)
    assert gsp.feasible(design, found.pose, gsp.Limits(strokes=strokes + [-1e-8, 1e-8])).ok


def test_a_stroke_beyond_a_half_turn_ends_there():
    """A crank in [2, 4] must be in [2, π], as feasibility has it."""
    design = driven.rotary()
    strokes = np.tile([-np.pi, np.pi], (6, 1))
    strokes[0] = [0.3, 4.0]
    found = gsp.nearest(design, design.home, gsp.Limits(strokes=strokes), starts=2)
    assert gsp.feasible(design, found.pose, gsp.Limits(strokes=strokes + [-1e-8, 1e-8])).ok


@pytest.mark.parametrize("name", ["mixed", "rotary", "sliders"])
def test_reaches_have_their_derivatives_and_vanish_with_the_scales(name):
    design = driven.DESIGNS[name]
    pose, step = design.home, 1e-6
    values, rows = reaches(design, pose.position, pose.rotation)
    around = [
        reaches(design, moved.position, moved.rotation)[0]
        for twist in np.eye(6)
        for moved in (pose.moved(step * twist), pose.moved(-step * twist))
    ]
    slopes = (np.array(around[::2]) - np.array(around[1::2])).T / (2 * step)
    np.testing.assert_allclose(rows, slopes, atol=1e-8)
    # ℓ² − c² is (scale ℓ)², and h² − C² is (scale ℓ x²)² / x².
    scales = design.at(pose).drive_scales
    expected = []
    for row, (leg, constraint) in enumerate(design.rows):
        if not constraint.driven:
            continue
        drive, s = design.drives[leg], design.base_directions[leg]
        scale = scales[row] * drive.rod
        expected.append(scale**2 / (2 * drive.rod))
        if isinstance(drive, Crank):
            square = np.sum(np.cross(s, drive.arm) ** 2)
            expected[-1] = scale**2 / (2 * drive.rod * square)
    np.testing.assert_allclose(values, expected, rtol=1e-9)


@pytest.mark.parametrize("name", ["mixed", "cranks", "hexaglide"])
def test_bounds_of_derivatives_on_steps_hold(name):
    """Second differences of rows and joint values along steps are below the bounds."""
    design = driven.DESIGNS[name]
    small, rng = centred(design), np.random.default_rng(2)
    start = small.pose_from(design.home.reshape(1))
    share, h = np.linspace(0.0, 1.0, 41), 1.0 / 40
    for length in (0.01, 0.05):
        move = length * rng.normal(size=(1, 6))
        rows, values = reference.jets_of(small, reference.patch_of(start, move))
        posture = small.design.at(start[0].moved(share[:, None] * move))
        rods = posture.jacobian * posture.drive_scales[..., None]
        second = np.linalg.norm(np.diff(rods, 2, axis=0), axis=-1).max(axis=0) / h**2
        first = np.linalg.norm(np.diff(rods, axis=0), axis=-1).max(axis=0) / h
        turn = np.abs(np.diff(posture.joints, 2, axis=0)).max(axis=0) / h**2
        for i, (row, value) in enumerate(zip(rows, values, strict=True)):
            assert second[i] <= row.second * (1 + 1e-6) + 1e-9
            assert first[i] <= row.first * (1 + 1e-6) + 1e-9
            if design.rows[i].constraint.driven:
                assert turn[i] <= value.second * (1 + 1e-6) + 1e-9
                assert np.isfinite(value.second) or length > 0.01
    # Where a drive becomes singular on the step they are infinite.
    far = np.array([[0.0, 0.0, 9.0, 0.0, 0.0, 0.0]])
    with np.errstate(all="ignore"):
        rows, _ = reference.jets_of(small, reference.patch_of(start, far))
    driven_rows = [row for row, (_, c) in zip(rows, design.rows, strict=True) if c.driven]
    assert not any(np.isfinite(row.second).any() for row in driven_rows)
