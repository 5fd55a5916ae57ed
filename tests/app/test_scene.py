"""The scene: assembly modes, the region of positions, films, recorded motions."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.app.page.panels.modes import unable, words
from gsp.app.scene.drawing import drawing, film, merit_colour, placement
from gsp.app.scene.modes import ghosts, modes_of, taken
from gsp.app.scene.region import region_of, surface
from gsp.app.state import motion, recording
from gsp.app.state.reading import read
from gsp.app.state.recording import Recording, from_table
from gsp.app.state.session import started, with_strokes

SIX_THREE = "workspace-6-3"
MIXED = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"


def state_of(name, pose=None):
    return started(gsp.catalogue.design(name), pose)


# --- assembly modes ---


def test_modes_are_those_of_the_library_and_one_is_the_present_pose():
    state = state_of(SIX_THREE)
    found = modes_of(state)
    joints = state.design.at(state.pose).joints
    wanted = gsp.assembly_modes(state.design, joints)
    assert found.positions == pytest.approx(wanted.poses.position)
    here = found.present(state)
    assert found.positions[here] == pytest.approx(state.pose.position)
    assert found.belong_to(state)
    assert not found.belong_to(motion.nudged(state, "z", 1))
    other = (here + 1) % len(found.sides)
    jumped = taken(state, found, other)
    assert jumped.design.at(jumped.pose).joints == pytest.approx(joints)
    assert found.belong_to(jumped)
    assert found.present(jumped) == other
    assert jumped.message == f"assembly mode {other + 1} of 8"
    # A pose that is no mode of them is at none.
    assert found.present(motion.nudged(state, "yaw", 1)) is None


@pytest.mark.parametrize(
    ("base", "platform"), [(0.0, 0.0), (2e4, 0.0), (0.0, 2e3), (3.0, 1e4)], ids=str
)
def test_what_is_drawn_is_right_in_shifted_frames(base, platform):
    """To a ten thousandth of the size, in the numbers of single precision of a graphics card."""
    plain = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    base, platform = base * np.array([1.0, -2.0, 0.5]), platform * np.array([0.3, 1.0, -0.6])
    turned = np.asarray(gsp.Pose.from_rpy([0, 0, 0], [0.2, -0.1, 0.4]).rotation)
    design = plain.replace(
        base_points=plain.base_points + base,
        platform_points=plain.platform_points + platform,
        home=gsp.Pose(plain.home.position + base - turned @ platform, turned),
    )
    state = motion.nudged(started(design), "x", 1)
    shown = drawing(state)
    place = placement(state, read(state), "#FFFFFF")
    # "origin" and the size are numbers of the page in double precision.
    origin = np.array(shown["origin"])
    feet = np.array(place["feet"]).reshape(6, 2, 3)
    segments = design.at(state.pose).segments
    assert feet[:, 0] + origin == pytest.approx(segments.base_feet, abs=1e-4)
    assert feet[:, 1] + origin == pytest.approx(segments.platform_feet, abs=1e-4)
    assert np.abs(np.float32(feet) - feet).max() < 1e-4
    rotation = np.array(place["rotation"]).reshape(3, 3)
    corners = np.array([leg["platform"] for leg in shown["legs"]]) @ rotation.T
    assert corners + place["position"] == pytest.approx(feet[:, 1], abs=2e-4)
    before = placement(started(design), read(started(design)), "#FFFFFF")
    moved = np.subtract(place["position"], before["position"])
    assert moved == pytest.approx(state.pose.position - design.home.position, abs=1e-4)


def test_ghosts_are_the_other_modes():
    state = state_of(SIX_THREE)
    found = modes_of(state)
    drawn = ghosts(state, found)
    here = found.present(state)
    assert [one["name"] for one in drawn] == [str(i + 1) for i in range(8) if i != here]
    for one in drawn:
        number = int(one["name"]) - 1
        pose = gsp.Pose(found.positions[number], found.rotations[number])
        assert one["same"] == (found.sides[number] == found.sides[here])
        lengths = [np.linalg.norm(np.subtract(foot[3:], foot[:3])) for foot in one["feet"]]
        assert lengths == pytest.approx(state.design.at(pose).joints, rel=1e-3)


def test_modes_of_undefined_joints_give_a_reason():
    flat = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    onto = gsp.Pose(flat.base_points[0] - flat.platform_points[0])
    with pytest.raises(gsp.GspError, match="joints: expected defined values"):
        modes_of(started(flat, onto))


def test_what_there_is_of_modes_is_stated_in_sentences():
    ring = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3.0])
    design = gsp.Design(["D1"] * 6, 2.0 * ring, ring, home=gsp.Pose([0.0, 0.0, 1.5]))
    found = words(modes_of(started(design)))
    assert found.startswith("No mode is listed. The platform can move with locked actuators")
    assert words(modes_of(state_of(SIX_THREE))).startswith("8 modes. In the scene")
    assert unable(started(design)) == ""
    seven = gsp.Design(["D1"] * 7, [*(2.0 * ring), ring[1]], [*ring, ring[3]], home=design.home)
    assert unable(started(seven)) == "For designs with six actuators only; this one has 7."


# --- region of positions ---


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (10.0, -5.0, 20.0)])
def test_region_agrees_with_the_exact_volume(turn):
    design = gsp.catalogue.design(SIX_THREE)
    pose = gsp.Pose.from_rpy(design.home.position, turn, degrees=True)
    found = region_of(started(design, pose))
    wanted = gsp.workspace.exact_shells(design, pose.rotation, gsp.Limits()).volume((0.0, np.inf))
    assert abs(found.volume - wanted.value) < found.volume_error < 0.02 * wanted.value
    assert not found.cut


@pytest.mark.parametrize("share", [0.03, 0.1, 0.2])
def test_the_volume_of_a_region_has_its_error(share):
    """Short strokes have a region with sharp edges, of which the grid cuts off a part."""
    rng = np.random.default_rng(round(100 * share))
    for _ in range(2):
        design = gsp.hexapod(
            rng.uniform(1.0, 2.0), rng.uniform(0.1, 0.6), rng.uniform(0.5, 1.2),
            rng.uniform(0.1, 0.6), rng.uniform(1.0, 2.0),
        )  # fmt: skip
        joints = design.at(design.home).joints
        strokes = joints[:, None] * [1.0 - share, 1.0 + share]
        design = design.replace(strokes=strokes)
        found = region_of(started(design))
        shells = gsp.workspace.exact_shells(design, design.home.rotation, gsp.Limits())
        wanted = shells.volume((0.0, np.inf)).value
        assert abs(found.volume - wanted) < found.volume_error < 0.06 * wanted


@pytest.mark.parametrize(("name", "low", "high"), [(SIX_THREE, 8.0, 15.0), (MIXED, 60.0, 200.0)])
def test_region_is_bounded_by_the_strokes(name, low, high):
    """Its corners are where a joint is at a limit; a little outward nothing is feasible."""
    state = with_strokes(state_of(name), low, high)
    found = region_of(state)
    here = state.design.at(gsp.Pose(found.vertices, state.pose.rotation)).joints
    distances = here[:, ~state.design.angular]
    left = np.minimum(distances - low, high - distances).min(axis=1) / (high - low)
    assert np.median(np.abs(left)) < 2e-3
    assert np.abs(left).max() < 0.1  # at edges, which the grid cuts off
    edges = np.sort(found.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, faces = np.unique(edges, axis=0, return_counts=True)
    assert (faces % 2 == 0).all()  # closed


def test_region_without_limits_or_poses_gives_a_reason():
    with pytest.raises(gsp.GspError, match="limits of the joints"):
        region_of(state_of("lee-2000-3-3"))
    with pytest.raises(gsp.GspError, match="feasible positions at the present rotation"):
        region_of(with_strokes(state_of(SIX_THREE), 1.0, 2.0))


def test_a_region_that_nothing_bounds_is_cut_off():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    strokes = np.full((6, 2), [1.0, np.inf])
    assert region_of(started(design.replace(strokes=strokes))).cut


def test_surface_of_a_ball():
    x = np.stack(np.meshgrid(*[np.linspace(-1.5, 1.5, 31)] * 3, indexing="ij"), axis=-1)
    vertices, faces = surface(1.0 - np.linalg.norm(x, axis=-1))
    vertices = vertices * 0.1 - 1.5
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(1.0, abs=0.01)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    assert (np.einsum("ij,ij->i", normals, a + b + c) > 0.0).all()  # seen from outside
    area = np.linalg.norm(normals, axis=1).sum() / 2.0
    assert area == pytest.approx(4.0 * np.pi, rel=0.01)


# --- recorded motions ---


def recorded(state, count=5):
    motion_ = Recording(design=state.design)
    for i in range(count):
        motion_ = motion_.with_sample(0.5 * i, state.pose.moved([0.1 * i, 0, 0, 0, 0, 0.05 * i]))
    return motion_


def test_a_motion_is_interpolated_and_sampled():
    state = state_of("lee-2000-3-3")
    found = recorded(state)
    assert found.seconds == 2.0
    half = found.pose(0.25)
    assert half.position == pytest.approx(state.pose.position + [0.05, 0.0, 0.0])
    assert motion.axis_and_angle(half)[1] == pytest.approx(np.rad2deg(0.025))
    assert found.pose(9.0).position == pytest.approx(found.poses[-1].position)
    assert found.with_sample(1.0, state.pose) is found  # not later
    frames = found.frames()
    assert frames.shape == (41,)
    assert frames.position[-1] == pytest.approx(found.poses[-1].position)
    values = gsp.indices.control_number(state.design.at(frames), state.length)
    colours = [one["colour"] for one in film(state, frames, "control_number")]
    assert colours == [merit_colour(value) for value in values]  # its best value is 1
    assert len(set(colours)) > 5
    grey = film(state, frames, "quality_index")  # without a maximum
    assert {one["colour"] for one in grey} == {merit_colour(np.nan)}


def test_a_motion_reads_back_from_its_table():
    state = state_of("toz-kucuk-2016-d3-6")
    found = recorded(state)
    again = from_table(state, found.table(), "own.csv")
    assert again.times == found.times
    for one, other in zip(again.poses, found.poses, strict=True):
        assert one.position == pytest.approx(other.position, rel=1e-12)
        assert one.rotation == pytest.approx(other.rotation, abs=1e-12)


def test_a_log_of_joints_is_tracked():
    state = state_of(SIX_THREE)
    path = [state.pose.moved([0.05 * i, 0, 0.02 * i, 0, 0, 0.01 * i]) for i in range(6)]
    rows = [state.design.at(pose).joints for pose in path]
    text = ",".join(state.design.joint_names) + "\n"
    text += "\n".join(",".join(map(repr, row.tolist())) for row in rows)
    found = from_table(state, text, "log.csv")
    assert found.times == pytest.approx(0.1 * np.arange(6))
    assert found.poses[-1].position == pytest.approx(path[-1].position)


HEAD = "x,y,z,angle_1,angle_2,angle_3\n"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "2 to 2000 rows"),
        (HEAD + "0,0,1,0,0,0\n", "2 to 2000 rows"),
        ("a,b\n1,2\n3,4\n", "columns x, y, z"),
        (HEAD + "0,0,1,0,0,0\n0,0,one,0,0,0\n", "row 2, column 'z': expected a finite number"),
        (HEAD + "0,0,1,0,0,0\n0,0,inf,0,0,0\n", "row 2, column 'z'"),
        (HEAD + "0,0,1,0,0,0\n0,0\n", "row 2, column 'z'"),
        (HEAD + "0,0,1,0,0,0\n0,0,1e9,0,0,0\n", "positions within"),
        ("time," + HEAD + "1,0,0,1,0,0,0\n1,0,0,1,0,0,0\n", "increasing times"),
        ("d1,d2,d3,d4,d5,d6\n1,1,1,1,1,1\n9,9,9,9,9,1\n", "lead on from the present pose"),
        (HEAD + "0,0,1,0,0,0\n" * (recording.MOST_SAMPLES + 1), "2 to 2000 rows"),
        ("x" * (recording.LARGEST_TABLE + 1), "at most 400000 letters"),
        (HEAD + "0,0,1,0,0," + "1" * 140_000 + "\n0,0,1,0,0,0\n", "commas between cells"),
        ("x," + HEAD + "9,0,0,1,0,0,0\n" * 2, "column 'x': expected one of its name"),
    ],
    ids=lambda value: str(value)[:24],
)
def test_tables_that_are_no_motion(text, why):
    with pytest.raises(gsp.GspError, match=why):
        from_table(state_of("lee-2000-3-3"), text, "bad.csv")
