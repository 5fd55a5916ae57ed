import numpy as np
import pytest

import gsp
from gsp.errors import InvalidDesign, InvalidInput
from gsp.planar import PlanarDesign, PlanarPose, mechanisms

SHAPES = [(), (1,), (3, 1, 2)]
NAMES = [m.name for m in mechanisms()]


def moved(pose, twist, h):
    """The pose after a small motion with velocity (v, ω) of the platform origin."""
    return PlanarPose(pose.position + h * twist[:2], pose.angle + h * twist[2])


def wrapped(difference):
    return (difference + np.pi) % (2 * np.pi) - np.pi


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("platform", mechanisms(), ids=NAMES)
def test_rows_are_central_differences(platform, shape, rng, make_design, make_pose):
    design, pose, h = make_design(platform.legs, rng), make_pose(shape, rng), 1e-6
    posture = design.at(pose)
    assert posture.joints.shape == (*shape, 3)
    assert posture.jacobian.shape == (*shape, 3, 3)
    for k, twist in enumerate(np.eye(3)):
        up, down = design.at(moved(pose, twist, h)), design.at(moved(pose, twist, -h))
        difference = up.joints - down.joints
        difference[..., posture.angular] = wrapped(difference[..., posture.angular])
        np.testing.assert_allclose(
            posture.jacobian[..., k], difference / (2 * h), atol=2e-8, rtol=2e-8
        )


@pytest.mark.parametrize("platform", mechanisms(), ids=NAMES)
def test_it_is_the_spatial_mechanism_in_a_plane(platform, rng, make_design, make_pose):
    planar, pose = make_design(platform.legs, rng), make_pose((7,), rng)

    def lifted(rows):
        return np.tile(np.column_stack((rows, np.zeros(len(rows)))), (2, 1))

    spatial = gsp.Design(
        platform.legs * 2,
        lifted(planar.base_points),
        lifted(planar.platform_points),
        lifted(planar.base_directions),
        lifted(planar.platform_directions),
    )
    ours, theirs = planar.at(pose), spatial.at(pose.spatial())
    sign = np.sign(ours.joints)  # the spatial angle is not oriented
    np.testing.assert_allclose(np.abs(ours.joints), theirs.joints[:, :3], atol=1e-13)
    rows = theirs.jacobian[:, :3][..., [0, 1, 5]]
    np.testing.assert_allclose(ours.jacobian * sign[..., None], rows, atol=1e-13)
    # The passive joints: the same squared rates in sum, slides and turns alike.
    t = ours.passive_rates(0.7)
    t_spatial = theirs.passive_rates(0.7)[..., [0, 1, 5]]
    for w in rng.normal(size=(5, 3)):
        ours_sum, theirs_sum = (t @ w) ** 2, (t_spatial @ w) ** 2
        np.testing.assert_allclose(2 * ours_sum.sum(-1), theirs_sum.sum(-1), rtol=1e-11)


def test_a_point_on_its_line_and_parallel_lines_have_rows():
    design = PlanarDesign(
        ["D2", "D3", "A1"],
        base_points=[[1, 0], [0, 0], [0, 0]],
        platform_points=[[0, 0], [2, 0], [1, 1]],
        base_directions=[[0, 1], [1, 0], [1, 0]],
        platform_directions=[[1, 0], [0, 1], [1, 0]],
    )
    posture = design.at(PlanarPose([0.0, 0.0], 0.0))
    np.testing.assert_array_equal(posture.joints, [0.0, 0.0, 0.0])
    np.testing.assert_allclose(posture.jacobian, [[0, 1, 1], [0, 1, 2], [0, 0, 1]])
    assert posture.undefined == ()


def test_coinciding_anchors_are_undefined_with_a_reason_and_change_no_others(rng):
    design = PlanarDesign(["D1"] * 3, [[0, 0], [4, 0], [2, 3]], [[0, 0], [1, 0], [0, 1]])
    pose = PlanarPose([[0.0, 0.0], [1.0, 1.0]], [0.0, 0.3])
    posture = design.at(pose)
    assert posture.defined.tolist() == [False, True]
    (gap,) = posture.undefined
    assert (gap.pose, gap.joint, gap.reason) == ((0,), "d1", "the anchor points coincide")
    np.testing.assert_array_equal(posture.jacobian[1], design.at(pose[1]).jacobian)


@pytest.mark.parametrize("platform", mechanisms(), ids=NAMES)
def test_exchanging_base_and_platform(platform, rng, make_design, make_pose):
    design, pose = make_design(platform.legs, rng), make_pose((4,), rng)
    here, there = design.at(pose), design.exchanged().at(pose.inverse())
    signs = np.where(here.angular, -1.0, 1.0)
    np.testing.assert_allclose(there.joints * signs, here.joints, atol=1e-12)


def test_poses_compose_and_invert(make_pose, rng):
    pose = make_pose((5,), rng)
    back = pose.compose(pose.inverse())
    np.testing.assert_allclose(back.position, 0.0, atol=1e-13)
    np.testing.assert_allclose(back.angle, 0.0, atol=1e-13)
    spatial = pose.spatial()
    np.testing.assert_allclose(spatial.rotation[:, :2, :2], pose.rotation, atol=1e-15)
    assert len(pose[1:3]) == 2
    assert pose.reshape(5, 1).shape == (5, 1)


def test_a_scaled_design_has_scaled_distances(rng, make_design, make_pose):
    design, pose = make_design(("D1", "D2", "D3", "A1"), rng), make_pose((3,), rng)
    scaled = design.scaled(1000.0).at(PlanarPose(1000 * pose.position, pose.angle))
    factors = np.where(scaled.angular, 1.0, 1000.0)
    np.testing.assert_allclose(scaled.joints, design.at(pose).joints * factors, rtol=1e-12)


BAD = [
    (dict(legs=["D1", "D1"]), InvalidDesign, "at least three"),
    (dict(legs=["D1", "D1", "D4"]), InvalidDesign, r"legs\[2\]"),
    (dict(base_points=[[0, 0, 0]] * 3), InvalidInput, "base_points"),
    (dict(base_points=[[0, np.nan]] * 3), InvalidInput, "finite"),
    (dict(legs=["D1", "D3", "D1"]), InvalidDesign, r"base_directions\[1\]"),
    (dict(strokes=[[2, 1]] * 3), InvalidDesign, "least"),
    (dict(home=3), InvalidDesign, "home"),
    (dict(characteristic_length=-1), InvalidInput, "characteristic_length"),
]


@pytest.mark.parametrize(("change", "error", "says"), BAD)
def test_bad_designs_are_errors(change, error, says):
    good = dict(legs=["D1"] * 3, base_points=np.eye(3, 2), platform_points=2 * np.eye(3, 2))
    with pytest.raises(error, match=says):
        PlanarDesign(**{**good, **change})


def test_a_planar_design_requires_a_planar_pose():
    design = PlanarDesign(["D1"] * 3, np.eye(3, 2), 2 * np.eye(3, 2))
    with pytest.raises(InvalidInput, match="PlanarPose"):
        design.at(gsp.Pose([0, 0, 0]))


def test_planar_designs_and_postures_raise_the_errors_of_spatial_ones():
    points = np.eye(3)[:, :2]
    plain = {"base_points": 3.0 * points, "platform_points": points}
    for wrong in ({"unit": 5}, {"name": None}, {"home": gsp.Pose([0, 0, 1])}, {"ellipsoid": 1.0}):
        with pytest.raises(gsp.errors.InvalidInput):
            PlanarDesign(["D1"] * 3, **{**plain, **wrong})
    lines = PlanarDesign(["D3"] * 3, **plain, base_directions=points + 1.0)
    angles = PlanarDesign(
        ["D1", "D1", "A1"], **plain, base_directions=points + 1.0, platform_directions=points + 2.0
    )
    pose = PlanarPose([0.3, 0.2], 0.1)
    with pytest.raises(gsp.errors.MissingParameter, match="length"):
        lines.at(pose).passive_rates(None)
    with pytest.raises(gsp.errors.MissingParameter, match="length"):
        angles.at(pose).weighted(None)
    assert lines.joint_units == ("",) * 3
    assert angles.joint_units == ("", "", "rad")
