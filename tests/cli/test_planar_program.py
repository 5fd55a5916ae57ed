"""`gsp planar`: inputs and outputs of the planar program of `Workspace-A`."""

import numpy as np
import pandas as pd
import pytest

from gsp.planar import PlanarDesign

STROKES = [[0.8, 1.6], [0.9, 1.7], [0.7, 1.5]]
BASE = np.array([[0, 0], [2, 0], [1, 2.2]])
PLATFORM = np.array([[-0.5, -0.3], [0.5, -0.3], [0, 0.6]])


@pytest.fixture
def triangle(tmp_path):
    design = PlanarDesign(["D1"] * 3, BASE, PLATFORM, strokes=STROKES, name="triangle", unit="m")
    design.write(tmp_path / "triangle.toml")
    return "triangle.toml"


def test_joint_values_have_all_their_poses(gsp, triangle):
    """Each of them has the joint values, by own formulas; the one they are of is among them."""
    pose = np.array([0.9, 0.7]), 0.2

    def lengths(position, phi):
        turn = np.array([[np.cos(phi), -np.sin(phi)], [np.sin(phi), np.cos(phi)]])
        return np.linalg.norm(position + PLATFORM @ turn.T - BASE, axis=1)

    joints = lengths(*pose)
    words = " ".join(map(str, joints))
    result = gsp("planar", triangle, "--joints", words, "--out", "modes.csv")
    assert (result.status, result.err) == (0, "")
    table = pd.read_csv("modes.csv")
    assert f"triangle: {len(table)} assembly modes; position in m" in result.out
    assert len(table) % 2 == 0
    for row in table.itertuples():
        found = lengths(np.array([row.x, row.y]), np.deg2rad(row.angle))
        np.testing.assert_allclose(found, joints, atol=1e-9)
    apart = np.abs(table[["x", "y", "angle"]] - [*pose[0], np.rad2deg(pose[1])]).max(axis=1)
    assert apart.min() < 1e-7
    assert (
        "--rays: not used beside --joints"
        in gsp("planar", triangle, "--joints", words, "--rays", 9).error
    )
    assert "expected" in gsp("planar", triangle, "--joints", "1 2").error
    assert "--force" in gsp("planar", triangle, "--joints", words, "--out", "modes.csv").error
    assert "0 assembly modes" in gsp("planar", triangle, "--joints", "1 1 9").out
    assert "undefined: " in gsp("planar", triangle, "--joints", "1 1 -1").err


def feasible(points):
    """Whether some of many angles is feasible at each point (n, 2); written afresh."""
    phi = np.linspace(-np.pi, np.pi, 7001)
    ok = np.ones((len(points), len(phi)), dtype=bool)
    for a, b, (low, high) in zip(BASE, PLATFORM, STROKES, strict=True):
        arm = np.array(
            [np.cos(phi) * b[0] - np.sin(phi) * b[1], np.sin(phi) * b[0] + np.cos(phi) * b[1]]
        )
        length = np.hypot(*(points.T[:, :, None] + arm[:, None] - a[:, None, None]))
        ok &= (length >= low) & (length <= high)
    return ok.any(axis=1)


def table_of(out):
    """The rows of the table of bifurcation points: label, x, y, on the boundary."""
    rows = [line.split() for line in out.splitlines() if line.endswith(("  yes", "  no"))]
    return [(" ".join(row[1:4]), float(row[4]), float(row[5]), row[7] == "yes") for row in rows]


def test_the_program_prints_what_its_source_prints(gsp, triangle, tmp_path):
    given = ("--guess", 1.0, 0.8, "--rays", 12, "--boundary", "b.csv", "--out", "c.csv")
    result = gsp("planar", triangle, *given, "--plot", "a.png")
    assert "joints 1.20000 1.30000 1.10000" in result.out  # (A.1): means of the limits
    points = table_of(result.out)
    first = result.out.splitlines()[0]
    origin = np.array([float(x) for x in first[first.index("(") + 1 : first.index(")")].split(",")])
    for _, x, y, last in points:
        away = np.array([x, y]) - origin
        farther = np.hypot(*away) + np.geomspace(2e-3, 3.0, 60)
        beyond = origin + farther[:, None] * away / np.hypot(*away)
        assert feasible(beyond).any() != last
    assert {last for *_, last in points} == {True, False}
    on = {label for label, *_, last in points if last and "-" not in label}
    line = next(x for x in result.out.splitlines() if x.startswith("Labels on the boundary"))
    assert set(line.partition(": ")[2].split(", ")) == on
    boundary = pd.read_csv(tmp_path / "b.csv")
    assert list(boundary["ray"]) == list(range(12))
    assert boundary["angle_deg"].to_numpy() == pytest.approx(30.0 * np.arange(12))
    ray = np.deg2rad(boundary["angle_deg"].to_numpy())
    out = np.stack((np.cos(ray), np.sin(ray)), axis=1)
    place = boundary[["x", "y"]].to_numpy()
    assert feasible(place - 1e-3 * out).all()
    assert not feasible(place + 1e-3 * out).any()
    assert list(pd.read_csv(tmp_path / "c.csv").columns)[:5] == [
        "curve",
        "label",
        "x",
        "y",
        "angle_deg",
    ]
    assert (tmp_path / "a.png").stat().st_size > 1000


def test_a_fixed_angle_and_a_given_radiating_point(gsp):
    given = ("--stroke", 0.3, 0.9, "--position", 0, 0, "--angle", 0, "--rays", 6)
    result = gsp("planar", "lee-2000-planar", *given)
    assert result.status == 0
    assert result.out.startswith("Radiating point  (0, 0)\n")
    assert "Labels" not in result.out
    points = table_of(result.out)
    assert len(points) == 6  # of three circles of radius 0.9 and three of 0.3, three-fold symmetric
    turns = np.deg2rad([180.0, 300.0, 60.0])
    centres = 0.5 * np.stack((np.cos(turns), np.sin(turns)), axis=1)
    for label, x, y, last in points:
        assert last
        for mark, centre in zip(label.split(), centres, strict=True):
            if mark != "-":
                limit = {"0": 0.3, "1": 0.9}[mark]
                assert np.hypot(*(centre - (x, y))) == pytest.approx(limit, abs=1e-6)


def test_all_components_at_a_fixed_angle_from_a_point_of_a_small_one(gsp, tmp_path):
    given = ("--stroke", 0.3, 0.9, "--angle", 20, "--rays", 8)
    result = gsp("planar", "lee-2000-planar", *given, "--boundary", "b.csv", "--out", "c.csv")
    assert result.status == 0
    last = next(x for x in result.out.splitlines() if x.startswith("2 components"))
    assert last.endswith("; the radiating point is in component 1")
    boundary = pd.read_csv(tmp_path / "b.csv")
    assert set(boundary["component"]) == {0}
    arms = np.array([[0.0, 3**-0.5], [-0.5, -(12**-0.5)], [0.5, -(12**-0.5)]])
    base = np.array([[-0.5, 3**-0.5], [-0.25, -0.7216878364870323], [0.75, 0.144337567297406]])
    c, s = np.cos(np.deg2rad(20)), np.sin(np.deg2rad(20))
    centres = base - arms @ np.array([[c, s], [-s, c]])
    for x, y in boundary[["x", "y"]].to_numpy():
        way = np.linspace(1.0, 3.0, 4001)[:, None, None] * [x, y]
        lengths = np.linalg.norm(way - centres, axis=-1)
        ok = ((lengths > 0.3 - 1e-9) & (lengths < 0.9 + 1e-9)).all(axis=1)
        assert ok[0]
        assert not ok[1:].any()
    curves = pd.read_csv(tmp_path / "c.csv")
    assert set(curves["component"]) == {0, 1}
    assert curves["maximal"].all()


def test_rays_start_in_the_largest_component_where_no_middle_pose_is_known(gsp, tmp_path):
    """Lengths of 1, 5 and 5 from three points on a line, all to one point, are impossible."""
    strokes, anchors = [[0, 2], [1, 9], [1, 9]], [[0, 0], [1, 0], [-1, 0]]
    design = PlanarDesign(["D1"] * 3, anchors, np.zeros((3, 2)), strokes=strokes, name="far")
    design.write(tmp_path / "far.toml")
    assert "--position states" in gsp("planar", "far.toml").error
    assert "--position states" in gsp("planar", "far.toml", "--angle", 0, "--guess", 0, 1).error
    result = gsp("planar", "far.toml", "--angle", 0, "--rays", 4)
    assert result.status == 0
    assert result.out.startswith("Radiating point in the largest component")
    assert result.out.endswith(
        "2 components, area 6.283185; the radiating point is in component 0\n"
    )


def test_without_middle_lengths_rays_start_in_the_largest_component(gsp, tmp_path):
    """Two legs have no greatest length: the disc of the first without two discs of radius 1/2."""
    strokes, anchors = [[0, 1], [0.5, np.nan], [0.5, np.nan]], [[0, 0], [1, 0], [-1, 0]]
    design = PlanarDesign(["D1"] * 3, anchors, np.zeros((3, 2)), strokes=strokes, name="open")
    design.write(tmp_path / "open.toml")
    assert "received open ones of d2, d3; --position states" in gsp("planar", "open.toml").error
    result = gsp("planar", "open.toml", "--angle", 0, "--rays", 4)
    assert result.out.endswith(
        "1 component, area 2.440059; the radiating point is in component 0\n"
    )
    # The lens of circles of radii 1 and r at the distance 1.
    r = 0.5
    lens = r**2 * np.arccos(r / 2) + np.arccos(1 - r**2 / 2) - 0.5 * r * np.sqrt((2 - r) * (2 + r))
    assert np.pi - 2 * lens == pytest.approx(2.440059, abs=1e-6)


def test_an_angle_without_a_workspace_is_named(gsp):
    """Half a turn crosses the legs of this platform, which has equal triangles."""
    error = gsp("planar", "lee-2000-planar", "--stroke", 0.3, 0.4, "--angle", 180).error
    assert error.startswith("gsp: --angle: expected an angle at which the workspace has an inter")
    assert error.endswith("received 180°, where it has none")


def test_the_home_pose_is_stated_only_within_the_strokes(gsp):
    at_home = ("planar", "lee-2000-planar", "--position", 0, 0, "--rays", 2, "--no-connecting")
    # Each leg has the length 0.5 at home.
    within, beyond = (gsp(*at_home, "--stroke", low, 0.9).out for low in (0.3, 0.8))
    assert within.startswith("Radiating point  (0, 0), angle 0°, joints 0.500000 0.500000 0.500000")
    assert beyond.startswith("Radiating point  (0, 0)\n")


@pytest.mark.parametrize("command", ["show", "jacobian"])
def test_other_commands_name_this_one_for_planar_designs(gsp, triangle, command):
    for design in (triangle, "lee-2000-planar"):
        assert "see `gsp planar`" in gsp(command, design).error


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (("nowhere",), "unknown planar design 'nowhere'"),
        (("lee-2000-planar",), "expected strokes"),
        (("lee-2000-planar", "--stroke", 9, 1), "--stroke: expected LOW < HIGH, received 9 1"),
        (("lee-2000-planar", "--stroke", 1, 1), "--stroke: expected LOW < HIGH, received 1 1"),
        (("lee-2000-planar", "--stroke", 0.3, "nan"), "--stroke"),
        (("lee-2000-planar", "--stroke", -2, -1), "--stroke: expected 0 ≤ LOW"),
        (("lee-2000-planar", "--angle", "inf"), "--angle"),
        (("lee-2000-planar", "--guess", 0, 0, "--position", 0, 0), "--guess: not used beside"),
        (("lee-2000-planar", "--out", "a.txt"), ".csv"),
        (("lee-2000-planar", "--plot", "a.txt"), "--plot"),
        (("workspace-6-3",), "unknown planar design"),
    ],
)
def test_bad_input_is_one_line(gsp, given, message):
    assert message in gsp("planar", *given).error
