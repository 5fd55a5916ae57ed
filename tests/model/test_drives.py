"""Legs of fixed length that are driven at the base: values, rows, passive rates, singularities."""

import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp import Crank, Design, Pose, Slider
from gsp.errors import GspError, InvalidDesign, InvalidInput, MalformedFile
from gsp.model.design import design_from_toml, toml_from_design
from gsp.model.posture.derivatives import rows_and_derivatives
from tests import driven
from tests.screws import frame, prismatic, revolute

every = pytest.mark.parametrize("design", driven.DESIGNS.values(), ids=driven.DESIGNS)


def differences(function, pose, step):
    """Central differences of fourth order by the six unit twists, on a new last axis."""
    found = []
    for twist in np.eye(6):
        near = [function(pose.moved(k * step * twist)) for k in (-2, -1, 1, 2)]
        found.append((near[0] - 8 * near[1] + 8 * near[2] - near[3]) / (12 * step))
    return np.stack(found, axis=-1)


@every
def test_rows_are_the_derivatives_of_the_joint_values(design):
    poses = driven.near_home(design, 5)
    rows = differences(lambda pose: design.at(pose).joints, poses, 2e-4 * design.rms_radius)
    scale = np.abs(rows).max()
    assert np.abs(design.at(poses).jacobian - rows).max() < 1e-9 * scale


@every
def test_derivatives_of_rows(design):
    pose = driven.near_home(design, 1)[0]
    slopes = differences(lambda p: design.at(p).jacobian, pose, 3e-4 * design.rms_radius)
    rows, found = rows_and_derivatives(design.at(pose))
    assert np.abs(rows - design.at(pose).jacobian).max() < 1e-13 * np.abs(rows).max()
    assert np.abs(found - slopes).max() < 1e-7 * np.abs(slopes).max()


@every
def test_rods_keep_their_lengths_and_drives_their_branches(design):
    posture = design.at(driven.near_home(design, 20))
    anchors = posture.pose.position[:, None] + posture.lines.arm
    rows = {row.leg: i for i, row in enumerate(design.rows)}
    for leg, tip in driven.tips(design, posture).items():
        drive = design.drives[leg]
        rods = anchors[:, leg] - tip
        assert np.allclose(np.linalg.norm(rods, axis=-1), drive.rod, rtol=1e-13)
        assert np.allclose(posture.segments.base_feet[:, leg], tip, rtol=0, atol=1e-13 * drive.rod)
        assert (np.sign(posture.drive_scales[:, rows[leg]]) == drive.branch).all()


@every
def test_a_row_is_that_of_the_held_rod_over_the_scale(design):
    """With locked drives the rods are D1 legs between the tips and the platform."""
    pose = driven.near_home(design, 1)[0]
    posture = design.at(pose)
    points = design.base_points.copy()
    for leg, tip in driven.tips(design, posture).items():
        points[leg] = tip
    legs = ["D1" if leg.drive else leg for leg in design.legs]
    held = design.replace(legs=legs, base_points=points, strokes=None).at(pose)
    found = posture.drive_scales[:, None] * posture.jacobian
    assert np.allclose(found, held.jacobian, rtol=1e-12, atol=1e-13)


def screws_of(design, posture, leg):
    """Unit screws of a driven leg about the platform origin: the drive, then five passive turns."""
    tip = driven.tips(design, posture)[leg]
    high = posture.pose.position + posture.lines.arm[leg]
    u, e1, e2 = frame((high - tip) / np.linalg.norm(high - tip))
    s, origin = design.base_directions[leg], posture.pose.position
    slides = isinstance(design.drives[leg], Slider)
    drive = prismatic(s) if slides else revolute(s, design.base_points[leg], origin)
    turns = [revolute(x, tip, origin) for x in (e1, e2)]
    return np.array([drive, *turns, *(revolute(x, high, origin) for x in (u, e1, e2))]).T


@every
def test_rows_and_passive_rates_are_those_of_the_joint_screws(design):
    posture = design.at(driven.near_home(design, 1)[0])
    rows = {row.leg: i for i, row in enumerate(design.rows)}
    squares = np.zeros((6, 6))
    for leg in driven.tips(design, posture):
        rates = np.linalg.inv(screws_of(design, posture, leg))
        expected = posture.jacobian[rows[leg]]
        assert np.allclose(rates[0], expected, rtol=1e-10, atol=1e-11 * np.abs(expected).max())
        # The rod's turns about itself do not move its direction.
        for row in (*rates[1:3], *rates[4:6]):
            squares += np.outer(row, row)
    if not any(leg.drive is None for leg in design.legs):
        found = posture.passive_rates(None)
        assert np.allclose(found.T @ found, squares, rtol=1e-10, atol=1e-11 * np.abs(squares).max())


@every
@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_units(design, factor):
    pose = driven.near_home(design, 1)[0]
    posture, other = design.at(pose), design.scaled(factor).at(pose.scaled(factor))
    angles = design.angular
    assert np.allclose(other.joints, np.where(angles, 1, factor) * posture.joints, rtol=1e-10)
    names = ("condition_number", "control_number", "local_conditioning")
    for name in names:
        index = gsp.indices.INDICES[name].function
        assert np.isclose(index(other, length=0.7 * factor), index(posture, length=0.7), rtol=1e-9)
    power = design.determinant_power
    if design.determinant_has_unit:
        one, two = gsp.indices.manipulability(posture), gsp.indices.manipulability(other)
        assert np.isclose(two, one * factor**power, rtol=1e-8)


@every
def test_moved_and_mirrored_frames(design):
    """Joint values do not depend on the frames; a mirror image turns cranks the other way."""
    pose = driven.near_home(design, 1)[0]
    joints = design.at(pose).joints
    for hand in (np.eye(3), np.diag([1.0, -1.0, 1.0])):
        turn = Rotation.from_rotvec([0.3, -0.7, 0.5]).as_matrix() @ hand
        shift = np.array([5.0, -3.0, 2.0])
        sign = np.linalg.det(hand)
        legs = [
            Crank(arm=turn @ leg.drive.arm, rod=leg.drive.rod, branch=int(sign) * leg.drive.branch)
            if isinstance(leg.drive, Crank)
            else leg
            for leg in design.legs
        ]
        moved = design.replace(
            legs=legs,
            base_points=design.base_points @ turn.T + shift,
            base_directions=design.base_directions @ turn.T,
            platform_points=design.platform_points @ hand,
            platform_directions=design.platform_directions @ hand,
            home=None,
        )
        found = moved.at(Pose(turn @ pose.position + shift, turn @ pose.rotation @ hand)).joints
        cranks = np.array([isinstance(design.drives[row.leg], Crank) for row in design.rows])
        expected = np.where(cranks, sign, 1.0) * joints
        assert np.allclose(found, expected, rtol=0, atol=1e-12 * np.abs(joints).max())


@every
def test_batches_have_the_bits_of_single_poses(design):
    poses = driven.near_home(design, 70)
    many = design.at(poses)
    for i in (0, 69):
        one = design.at(poses[i])
        assert (one.joints == many.joints[i]).all()
        assert (one.jacobian == many.jacobian[i]).all()


def test_public_inverse_kinematics_of_a_rotary_platform():
    """Formulas of rspkins.c (J. Lane, machinekit-files), by half angles and without a Crank."""
    design = gsp.catalogue.design("lane-rotary")
    beta = np.deg2rad([180.0, 0.0, 300.0, 120.0, 60.0, 240.0])
    horn, rod = 1.25, 5.0
    rng = np.random.default_rng(2)
    position, turns = rng.uniform(-0.5, 0.5, (50, 3)), rng.uniform(-0.2, 0.2, (50, 2))
    for (x, y, z), (a, b) in zip(position, turns, strict=True):
        pose = Pose.from_rpy([x, y, z + 4.845], [a, b, 0.0])
        d = pose.position + design.platform_points @ pose.rotation.T - design.base_points
        size = (d * d).sum(axis=1) - rod**2 + horn**2
        up, along = 2 * horn * d[:, 2], 2 * horn * (np.cos(beta) * d[:, 0] + np.sin(beta) * d[:, 1])
        angles = np.arcsin(size / np.hypot(up, along)) - np.arctan2(along, up)
        assert np.allclose(design.at(pose).joints, angles, rtol=0, atol=1e-13)


def test_public_inverse_kinematics_of_vertical_rails():
    """Formulas of modparakins.c (J. Lane, machinekit-files)."""
    design = gsp.catalogue.design("lane-modified-paradex")
    poses = driven.near_home(design, 50)
    high = poses.position[:, None] + design.platform_points @ np.swapaxes(poses.rotation, -1, -2)
    across = high[..., :2] - design.base_points[:, :2]
    travels = high[..., 2] - np.sqrt(2.953**2 - (across**2).sum(axis=-1))
    assert np.allclose(design.at(poses).joints, travels, rtol=0, atol=1e-13)


# --- undefined and singular ---


def around_dead_centres(kind):
    """A design, and poses along x where the drive of leg 1 reaches, is singular, does not reach."""
    others = dict(base_points=[[0, 0, 0], [2, 0, 0], [0, 2, 0], [-2, 0, 0], [0, -2, 0], [1, 1, 0]])
    others["platform_points"] = [
        [0, 0, 0], [1, 0.2, 0], [0, 1, 0.1], [-1, 0.3, 0], [0.2, -1, 0], [0.3, 0.3, 0.1],
    ]  # fmt: skip
    if kind == "slider":
        drive, axis = Slider(rod=3.0), [1, 0, 0]
        places = [[0.3, 0, z] for z in (2.5, 3.0, 3.5)]
    else:
        drive, axis = Crank(arm=[1, 0, 0], rod=2.0), [0, 1, 0]
        places = [[0.3, 0.2, 2.5], [0, 0, 3.0], [0, 0, 3.2]]
    return Design([drive, *["D1"] * 5], base_directions=[axis] * 6, **others), Pose(places)


@pytest.mark.parametrize("kind", ["slider", "crank"])
def test_out_of_reach_is_undefined_and_dead_centres_are_singular(kind):
    design, poses = around_dead_centres(kind)
    posture = design.at(poses)
    assert posture.defined.tolist() == [True, True, False]
    assert [(e.pose, e.joint) for e in posture.undefined] == [((2,), design.joint_names[0])]
    assert "reach" in posture.undefined[0].reason
    assert posture.drive_is_singular[:, 0].tolist() == [False, True, False]
    assert not posture.drive_is_singular[:, 1:].any()
    (drive,) = posture.singular_drives
    reason = {"slider": "perpendicular to the rail", "crank": "plane of the axis and the crank"}
    assert drive.pose == (1,)
    assert reason[kind] in drive.reason
    assert np.isposinf(posture.jacobian[1, 0]).all()
    assert np.isfinite(posture.jacobian[1, 1:]).all()
    expected = 0.3 if kind == "slider" else -np.pi / 2
    assert np.isclose(posture.joints[1, 0], expected, rtol=0, atol=1e-7)
    assert posture.singular().tolist() == [False, True, False]
    assert posture.drive_scales[1, 0] == 0.0


@pytest.mark.parametrize("kind", ["slider", "crank"])
def test_each_index_is_the_worst_where_a_drive_is_singular(kind):
    design, poses = around_dead_centres(kind)
    posture = design.at(poses)
    given = {"length": 1.0, "ellipsoid": gsp.Ellipsoid(1.0), "maximum": 1.0}
    for index in gsp.indices.INDICES.values():
        if index.name == "singularity_distance":
            continue
        own = {key: value for key, value in given.items() if key in index.parameters}
        values = index.function(posture, **own)
        assert np.isfinite(values[0]), index.name
        assert values[0] != index.worst, index.name
        assert values[1] == index.worst, index.name
        assert np.isnan(values[2]), index.name


def test_forces_where_a_drive_is_singular():
    design, poses = around_dead_centres("slider")
    posture = design.at(poses)
    for found in (posture.actuator_forces(np.ones(6)), posture.wrench(np.ones(6))):
        assert np.isfinite(found[0]).all()
        assert np.isnan(found[1:]).all()
    for matrix in (gsp.stiffness(design, poses, 2.0), gsp.statics.compliance(design, poses, 2.0)):
        assert np.isfinite(matrix[0]).all()
        assert np.isnan(matrix[1:]).all()


def test_an_anchor_on_the_axis_of_a_crank_is_undefined():
    """Every angle has the same distance there."""
    design, _ = around_dead_centres("crank")
    posture = design.at(Pose([0.0, 3.0, 0.0]))
    assert "on the axis" in posture.undefined[0].reason
    reached = design.replace(legs=[Crank(arm=[3, 0, 0], rod=5.0), *design.legs[1:]])
    posture = reached.at(Pose([0.0, 4.0, 0.0]))
    assert posture.undefined[0].joint == "theta1"


@pytest.mark.parametrize("shift", [1e-3, 1e-6, 1e-9])
def test_rows_near_a_singular_drive_are_large_and_right(shift):
    """q = x − sqrt(ℓ² − z²), and dq/dz = z/(x − q): with ℓ = 3, z = 3 − shift."""
    design, _ = around_dead_centres("slider")
    z = 3.0 - shift
    root = np.sqrt((3.0 - z) * (3.0 + z))
    posture = design.at(Pose([0.3, 0.0, z]))
    assert np.isclose(posture.joints[0], 0.3 - root, rtol=0, atol=1e-12)
    expected = [1.0, 0.0, z / root, 0.0, 0.0, 0.0]
    assert np.allclose(posture.jacobian[0], expected, rtol=1e-6)
    assert not posture.drive_is_singular.any()


# --- records, files, errors ---


@every
def test_files_and_tables_give_the_same_numbers(design):
    pose = driven.near_home(design, 3)
    joints = design.at(pose).joints
    again = design_from_toml(toml_from_design(design), "text")
    frame_again = Design.from_frame(design.to_frame(), home=design.home, unit=design.unit)
    copy = pickle.loads(pickle.dumps(design))
    for other in (again, frame_again, copy, design.replace(name="x")):
        assert other.legs == design.legs
        assert (other.at(pose).joints == joints).all()


def test_drives_are_compared_by_value():
    assert Slider(rod=2) == Slider(rod=2.0, branch=1) != Slider(rod=2.0, branch=-1)
    assert Crank(arm=[1, 0, 0], rod=2) == Crank(arm=np.array([1.0, 0, 0]), rod=2.0)
    assert len({Crank(arm=[1, 0, 0], rod=2), Crank(arm=(1, 0, 0), rod=2.0)}) == 1


def test_half_a_turn_of_a_crank_is_counted_as_pi():
    """The tip is at (−1, 0, 0), √2 from the anchor; √2 and its square are rounded."""
    crank = Crank(arm=(1.0, 0.0, 0.0), rod=np.sqrt(2.0), branch=-1)
    design = gsp.Design([crank] * 6, np.zeros((6, 3)), [[0.0, 1.0, 0.0]] * 6, [[0.0, 0.0, 1.0]] * 6)
    for pose in (gsp.Pose(np.zeros(3)), gsp.Pose(np.zeros((3, 3)))):
        np.testing.assert_array_equal(design.at(pose).joints, np.pi)


@pytest.mark.parametrize("rod", [0.0, -1.0, np.nan, np.inf, "2", None, [1.0, 2.0]])
def test_rods_are_positive(rod):
    for make in (lambda: Slider(rod=rod), lambda: Crank(arm=[1, 0, 0], rod=rod)):
        with pytest.raises(InvalidInput, match="rod"):
            make()


@pytest.mark.parametrize("branch", [0, 2, 1.5, True, "1", None])
def test_branches_are_signs(branch):
    with pytest.raises(InvalidInput, match="branch"):
        Slider(rod=1.0, branch=branch)


@pytest.mark.parametrize("arm", [[1, 0], [1, 0, np.nan], "abc", np.eye(3), None])
def test_arms_are_three_numbers(arm):
    with pytest.raises(InvalidInput, match="arm"):
        Crank(arm=arm, rod=1.0)


def test_a_kind_of_driven_leg_needs_the_numbers_of_a_drive():
    from gsp.model.legs import DRIVEN_LEGS

    for leg in (*DRIVEN_LEGS, "PSS", "RSS"):
        with pytest.raises(InvalidDesign, match=r"legs\[0\]"):
            Design([leg, *["D1"] * 5], driven.BASE, driven.PLATFORM, driven.TANGENTS)


def test_arms_are_not_along_the_axis():
    legs = [Crank(arm=[0, 0, 2], rod=2.0), *["D1"] * 5]
    axes = [[0, 0, 1]] * 6
    with pytest.raises(InvalidDesign, match=r"legs\[0\]: expected a crank whose arm"):
        Design(legs, driven.BASE, driven.PLATFORM, axes)
    with pytest.raises(InvalidDesign, match="direction"):
        Design(legs, driven.BASE, driven.PLATFORM)


def test_an_arm_may_have_a_part_along_the_axis():
    design = driven.rotary()
    tilted = [
        Crank(arm=np.array(leg.drive.arm) + 0.3 * s, rod=2.0)
        for leg, s in zip(design.legs, design.base_directions, strict=True)
    ]
    shifted = design.replace(base_points=design.base_points + 0.3 * design.base_directions)
    found = design.replace(legs=tilted).at(design.home).joints
    assert np.allclose(found, shifted.at(design.home).joints, rtol=0, atol=1e-14)


def test_travels_may_be_negative_and_distances_may_not():
    design = driven.mixed()
    strokes = np.full((8, 2), np.nan)
    strokes[0] = [-3.0, -1.0]
    assert design.replace(strokes=strokes).strokes[0, 0] == -3.0
    strokes[2] = [-3.0, -1.0]
    with pytest.raises(InvalidDesign, match=r"strokes\[2\]"):
        design.replace(strokes=strokes)


def test_designs_with_drives_cannot_be_exchanged_or_planar():
    with pytest.raises(InvalidDesign, match="driven at the base"):
        driven.rotary().exchanged()
    with pytest.raises(GspError):
        gsp.planar.PlanarDesign([Slider(rod=1.0)] * 3, np.eye(3)[:, :2], np.eye(3)[:, :2])


TEXT = """
[[legs]]
constraints = "{constraints}"
drive = {drive}
base_point = [1.0, 0.0, 0.0]
base_direction = [0.0, 0.0, 1.0]
platform_point = [1.0, 0.0, 0.0]
"""


@pytest.mark.parametrize(
    ("drive", "constraints", "message"),
    [
        ('{ kind = "screw", rod = 1.0 }', "D1", "line 4, key 'drive': .*'slider' or 'crank'"),
        ('"slider"', "D1", "line 4, key 'drive': .*a table"),
        ('{ kind = "slider" }', "D1", "line 4, key 'drive': .*'rod'"),
        ('{ kind = "crank", rod = 1.0 }', "D1", "line 4, key 'drive': .*'arm'"),
        ('{ kind = "slider", rod = -1.0 }', "D1", "line 4, key 'drive': rod"),
        ('{ kind = "slider", rod = true }', "D1", "line 4, key 'drive': .*real numbers"),
        ('{ kind = "slider", rod = 1.0, arm = [1, 0, 0] }', "D1", "key 'arm'"),
        ('{ kind = "slider", rod = 1.0 }', "D2", "line 4, key 'drive': .*only legs D1"),
    ],
)
def test_bad_files_name_line_and_key(drive, constraints, message):
    with pytest.raises(MalformedFile, match=message):
        design_from_toml(TEXT.format(drive=drive, constraints=constraints) * 6, "bad.toml")


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("drive", "screw", "row 2, column 'drive': expected 'slider' or 'crank'"),
        ("rod", np.nan, "row 2, column 'rod'"),
        ("branch", 2.0, "row 2, column 'branch'"),
        ("drive", "", "row 2, column 'rod': expected nothing"),
        ("constraints", "D2", "row 2, column 'drive': .*only legs D1"),
    ],
)
def test_bad_tables_name_row_and_column(column, value, message):
    frame = driven.rotary().to_frame()
    frame.loc[2, column] = value
    with pytest.raises(InvalidInput, match=message):
        Design.from_frame(frame)
