"""How far a platform moves, and the nearest allowed pose, against scans and closed forms."""

import numpy as np
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.geometry.vectors import unit

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")


def scanned(design, pose, twist, strokes, most, number=4001):
    """First violation of a stroke or change of sign of det J on a fine grid."""
    share = np.linspace(0, most, number)
    posture = design.at(pose.moved(share[:, None] * twist))
    bad = ((posture.joints < strokes[:, 0]) | (posture.joints > strokes[:, 1])).any(axis=1)
    side = np.sign(np.linalg.det(posture.jacobian))
    for row in design.rows:
        if row.constraint.name == "D4":
            normal = np.cross(posture.lines.t[:, row.leg], posture.lines.s[row.leg])
            side *= np.sign((posture.segments.direction[:, row.leg] * normal).sum(-1))
    bad |= side != side[0]
    return share[np.argmax(bad)] if bad.any() else most


@pytest.mark.parametrize("number", [0, 50, 110, 170])
def test_it_ends_where_a_scan_finds_the_first_violation(number):
    rng = np.random.default_rng(number)
    design = instantiate(mechanisms()[number], TEMPLATE)
    joints = design.at(design.home).joints
    width = np.where(design.angular, 0.3, 40.0)
    strokes = np.stack((joints - width, joints + width), axis=1)
    for _ in range(2):
        twist = rng.normal(size=6) * np.repeat([30.0, 0.3], 3)
        found = gsp.travel(design, design.home, twist, strokes=strokes)
        rough = scanned(design, design.home, twist, strokes, 1.2 * found.distance)
        assert found.limit
        assert 0 <= rough - found.distance <= 1.2 * found.distance / 4000 + 1e-9
        end = design.at(found.pose).joints
        if found.limit != "singular":
            joint = design.joint_names.index(found.limit.split(" = ")[0])
            assert np.abs(end[joint] - strokes[joint]).min() < 1e-5


def test_straight_up_along_one_leg_it_is_the_stroke():
    """A leg that is pulled along itself: closed form."""
    angles = np.deg2rad([[-10, 10, 110, 130, 230, 250], [-50, 50, 70, 170, 190, 290]])
    base, platform = np.stack((np.cos(angles), np.sin(angles), 0 * angles), axis=-1)
    design = gsp.Design(["D1"] * 6, 2 * base, platform)
    strokes = np.tile([0.0, 2.5], (6, 1))
    found = gsp.travel(design, gsp.Pose([0, 0, 1]), [0, 0, 1, 0, 0, 0], strokes=strokes)
    across = np.linalg.norm(2 * base[0] - platform[0])
    assert found.distance == pytest.approx(np.sqrt(2.5**2 - across**2) - 1, abs=1e-8)
    down = gsp.travel(design, gsp.Pose([0, 0, 1]), [0, 0, -1, 0, 0, 0], strokes=strokes)
    assert down.limit == "singular"  # all legs in one plane
    assert down.distance == pytest.approx(1.0, abs=1e-6)


def test_starts_on_and_beyond_limits():
    joints = TEMPLATE.at(TEMPLATE.home).joints
    tight = np.stack((joints, joints + 5), axis=1)
    assert gsp.travel(TEMPLATE, TEMPLATE.home, [0, 0, 1, 0, 0, 0], strokes=tight).distance > 0
    assert gsp.travel(TEMPLATE, TEMPLATE.home, [0, 0, -1, 0, 0, 0], strokes=tight).distance < 1e-5
    beyond = gsp.travel(TEMPLATE, TEMPLATE.home, [0, 0, 1, 0, 0, 0], strokes=tight + 1)
    assert beyond.distance == 0
    free = gsp.travel(TEMPLATE, TEMPLATE.home, [0, 0, 1, 0, 0, 0], farthest=0.5)
    assert (free.distance, free.limit) == (0.5, "")


def test_the_nearest_pose_is_allowed_and_no_sample_is_nearer():
    joints = TEMPLATE.at(TEMPLATE.home).joints
    strokes = np.stack((joints - 30, joints + 5), axis=1)
    limits = gsp.Limits(strokes=strokes)
    rng = np.random.default_rng(3)
    size = TEMPLATE.rms_radius
    away = TEMPLATE.home.moved([12, -8, 30, 0.1, 0.05, -0.1])
    found = gsp.nearest(TEMPLATE, away, limits, starts=3)
    end = TEMPLATE.at(found.pose).joints
    assert (end <= strokes[:, 1] + 1e-6).all()
    assert (end >= strokes[:, 0] - 1e-6).all()
    assert np.isclose(end, strokes[:, 1], atol=1e-5).any()
    # Random steps about the centre of the anchors that are shorter lead to no allowed pose.
    centred = TEMPLATE.with_origin(TEMPLATE.platform_points.mean(axis=0))
    middle = gsp.Pose(
        away.position + away.rotation @ TEMPLATE.platform_points.mean(axis=0), away.rotation
    )
    step = rng.normal(size=(20_000, 6))
    step *= (found.distance * rng.uniform(0.5, 0.999, (20_000, 1))) / np.linalg.norm(
        step, axis=1, keepdims=True
    )
    poses = middle.moved(step * np.repeat([size, 1.0], 3))
    assert not gsp.feasible(centred, poses, limits).ok.any()
    assert gsp.nearest(TEMPLATE, TEMPLATE.home, limits).distance == 0


def test_another_origin_changes_no_joint():
    point = np.array([3.0, -40.0, 25.0])
    other = TEMPLATE.with_origin(point)
    home = TEMPLATE.home
    seen = gsp.Pose(home.position + home.rotation @ point, home.rotation)
    np.testing.assert_allclose(other.at(seen).joints, TEMPLATE.at(home).joints, rtol=1e-13)
    np.testing.assert_allclose(other.home.position, seen.position, rtol=1e-14)
    about = gsp.geometry.jacobian_at(TEMPLATE.at(home).jacobian, home.rotation @ point)
    np.testing.assert_allclose(other.at(seen).jacobian, about, atol=1e-11)
    again = other.with_origin(-point)
    np.testing.assert_allclose(again.platform_points, TEMPLATE.platform_points, atol=1e-12)


@pytest.mark.parametrize("away", [0.0, 1e3, 1e6])
@pytest.mark.parametrize("turning", [False, True])
def test_the_platform_origin_may_be_far_from_the_anchors(away, turning):
    """A translation ends at the same place; with a turn, where a scan finds the first violation."""
    far = np.array([away, -2.0 * away, 0.5 * away])
    design = TEMPLATE.with_origin(far)
    twist = np.array([3.0, -2.0, 9.0, 0.02, 0.01, -0.03]) * np.repeat([1.0, turning], 3)
    strokes = np.array([[100.0, 200.0]] * 6)
    found = gsp.travel(design, design.home, twist, strokes=strokes)
    if not turning:
        near = gsp.travel(TEMPLATE, TEMPLATE.home, twist, strokes=strokes)
        assert found.limit == near.limit
        assert found.distance == pytest.approx(near.distance, rel=1e-9)
    rough = scanned(design, design.home, twist, strokes, 1.2 * found.distance)
    assert 0 <= rough - found.distance <= 1.2 * found.distance / 4000 * (1 + 1e-6)


def length_of_curve(design, pose, twist, most, number=20_001):
    """Length of the curve of the centre of the platform anchors, from chords."""
    poses = pose.moved(np.linspace(0.0, most, number)[:, None] * twist)
    points = poses.position + poses.rotation @ design.platform_points.mean(axis=0)
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


@pytest.mark.parametrize("away", [1e4, 1e7])
def test_the_default_is_a_short_way_about_a_far_origin(away):
    """The centre starts at rest, so ten of its speeds would be a turn by 10 rad."""
    size, w = TEMPLATE.rms_radius, np.array([0.1, 1.0, 0.3])
    design = TEMPLATE.with_origin(size * away * np.array([0.6, 0.2, 0.5]))
    arm = design.home.rotation @ design.platform_points.mean(axis=0)
    twist = np.array([*-np.cross(w, arm), *w])
    found = gsp.travel(design, design.home, twist)
    way = length_of_curve(design, design.home, twist, found.farthest)
    assert 80 * size < way < 100 * size
    assert found.limit == "singular"
    assert found.distance < found.farthest
    given = gsp.travel(design, design.home, twist, farthest=1e-6)
    assert (given.distance, given.limit, given.farthest) == (1e-6, "", 1e-6)


def test_the_default_of_ordinary_origins_is_ten_sizes_or_radians():
    size, rng = TEMPLATE.rms_radius, np.random.default_rng(8)
    joints = TEMPLATE.at(TEMPLATE.home).joints
    for away in (0.0, 6.0):
        point = TEMPLATE.platform_points.mean(axis=0) - away * size * unit(rng.normal(size=3))
        design = TEMPLATE.with_origin(point)
        twist = rng.normal(size=6) * np.repeat([size, 1.0], 3)
        arm = design.home.rotation @ design.platform_points.mean(axis=0)
        speed = np.linalg.norm(twist[:3] + np.cross(twist[3:], arm)) / size
        strokes = np.stack((joints - 0.02 * size, joints + 0.02 * size), axis=1)
        found = gsp.travel(design, design.home, twist, strokes=strokes)
        fastest = max(speed, np.linalg.norm(twist[3:]))
        assert found.farthest == pytest.approx(10.0 / fastest, rel=1e-12)


@pytest.mark.parametrize("factor", [1e-100, 1e-30, 1e30, 1e98])
def test_the_length_of_the_direction_only_scales_the_distance(factor):
    twist, strokes = np.array([3.0, -2.0, 9.0, 0.02, 0.01, -0.03]), [[100, 200]] * 6
    one = gsp.travel(TEMPLATE, TEMPLATE.home, twist, strokes=strokes)
    other = gsp.travel(TEMPLATE, TEMPLATE.home, twist * factor, strokes=strokes)
    assert other.limit == one.limit != ""
    assert other.distance * factor == pytest.approx(one.distance, rel=1e-9)
    np.testing.assert_allclose(other.pose.position, one.pose.position, rtol=1e-9)


def test_a_singular_posture_is_missed_by_less_than_is_stated():
    """A turn about the axis of a symmetric hexapod: singular at a right angle (Fichter)."""
    angles = np.deg2rad([[-8, 8, 112, 128, 232, 248], [-52, 52, 68, 172, 188, 292]])
    base, platform = np.stack((np.cos(angles), np.sin(angles), 0 * angles), axis=-1)
    design = gsp.Design(["D1"] * 6, 2 * base, platform)
    found = gsp.travel(design, gsp.Pose([0, 0, 1.3]), [0, 0, 0, 0, 0, 1])
    assert found.limit == "singular"
    assert 0.0 < np.pi / 2 - found.distance < 1e-6


@pytest.mark.parametrize(
    ("direction", "options", "message"),
    [
        (np.zeros(6), {}, "direction: expected six numbers, not all zero"),
        (np.array([1e-300, 0, 0, 0, 0, 0]), {}, "direction: .* between 1e-100 and 1e100"),
        (np.full(6, 1e308), {}, "direction: .* between 1e-100 and 1e100"),
        (np.ones(3), {}, "direction"),
        (np.ones(6), {"strokes": [[2, 1]] * 6}, "strokes"),
        (np.ones(6), {"farthest": 0}, "farthest"),
    ],
)
def test_bad_input(direction, options, message):
    with pytest.raises(gsp.GspError, match=message):
        gsp.travel(TEMPLATE, TEMPLATE.home, direction, **options)
    with pytest.raises(gsp.GspError, match="point"):
        TEMPLATE.with_origin([1.0, 2.0])
