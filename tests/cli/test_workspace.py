import re
from itertools import product

import numpy as np
import pandas as pd
import pytest
import trimesh
from typer.testing import CliRunner

import gsp
from gsp import catalogue
from gsp.cli.app import app
from gsp.errors import GspError
from gsp.geometry.rotations import angles_from_rotation
from gsp.workspace.sets.tree import growing
from tests import campaign

NAME = "workspace-6-3"


def run(*arguments):
    return CliRunner().invoke(app, ["workspace", *map(str, arguments)])


def test_fixed_orientation_prints_the_exact_volume_and_corners(tmp_path):
    out = tmp_path / "arcs.csv"
    result = run(NAME, "--angles", "0 0 -30", "--theta", 15, "--out", out)
    assert result.exit_code == 0
    assert "48.2832" in result.stdout
    assert "- 1 - 1 - 1" in result.stdout
    assert "-0.000000" not in result.stdout
    assert str(out) in result.stdout
    table = pd.read_csv(out)
    assert set(table["label"]) >= {"- 1 - - - -", "0 - - - - -"}


def test_an_interval_selects_the_dextrous_volume():
    result = run(NAME, "--angles", "0 0 -5:5", "--resolution", 1.0)
    assert result.exit_code == 0
    assert "proven" in result.stdout


def volumes(line):
    words = line.split()
    return float(words[2]), float(words[4].rstrip(","))


def test_volumes_are_those_of_the_side_of_the_home_pose():
    one = run(NAME, "--angles", "0 0 -30").stdout.splitlines()[0]
    all_ = run(NAME, "--angles", "0 0 -30", "--both").stdout.splitlines()[0]
    assert "above z = 0, the side of the home pose" in one
    assert "both sides of the base" in all_
    assert 2 * float(one.split()[1]) == pytest.approx(float(all_.split()[1]))


def turned(design, turn, shift, path):
    """Write a design of SPS legs whose base axes are turned and moved; return the file."""
    home = design.home
    moved = design.replace(
        name="turned",
        base_points=design.base_points @ turn.T + shift,
        home=gsp.Pose(turn @ home.position + shift, turn @ home.rotation),
    )
    moved.write(path, overwrite=True)
    return path


@pytest.mark.parametrize("seed", range(4))
def test_the_side_of_the_home_pose_does_not_depend_on_the_axes_of_the_base(seed, tmp_path):
    """Axes exchanged, turned over, tilted by random angles, and a base far from the origin."""
    rng = np.random.default_rng(seed)
    turn = (np.eye(3)[[1, 2, 0]], np.diag([1.0, -1.0, -1.0]))[seed] if seed < 2 else None
    turn = gsp.Pose.from_quaternion([0, 0, 0], rng.normal(size=4)).rotation if seed > 1 else turn
    shift = rng.normal(0.0, 3.0, 3)
    path = turned(gsp.catalogue.design(NAME), turn, shift, tmp_path / "a.toml")
    angles = np.rad2deg(angles_from_rotation(turn, "approach-roll"))
    given = ("--angles", " ".join(f"{angle:.17g}" for angle in angles))
    one = run(path, *given).stdout.splitlines()[0]
    all_ = run(path, *given, "--both").stdout.splitlines()[0]
    plain = run(NAME, "--angles", "0 0 0").stdout.splitlines()[0]
    assert float(one.split()[1]) == pytest.approx(float(plain.split()[1]), rel=1e-8)
    assert 2 * float(one.split()[1]) == pytest.approx(float(all_.split()[1]), rel=1e-8)
    assert "home pose" in one
    if seed == 2:
        region = ("--region", "space", "--resolution", 3.0)
        low, high = volumes(run(path, *given, *region).stdout.splitlines()[0])
        assert low < float(one.split()[1]) < high


@pytest.mark.parametrize("kept", [(1.0, 1.0, 1.0), (0.0, 1.0, 0.0)])
def test_a_base_that_is_not_plane_has_no_sides(kept, tmp_path):
    """One anchor above the others, or all on a line."""
    design = gsp.catalogue.design(NAME)
    points = (design.base_points + np.diag([0.5, 0, 0, 0, 0, 0])[:, [1, 2, 0]]) * kept
    path = tmp_path / "a.toml"
    design.replace(name="bent", base_points=points).write(path)
    assert "; all positions" in run(path, "--angles", "0 0 0").stdout.splitlines()[0]


def test_tilts_are_intervals_of_two_angles_and_are_drawn_and_written(tmp_path):
    picture, out = tmp_path / "a.png", tmp_path / "a.stl"
    given = ("--resolution", 2.0)
    tilted = run(NAME, "--tilt", 5, *given, "--plot", picture, "--out", out)
    assert tilted.exit_code == 0, tilted.exception
    line = tilted.stdout.splitlines()[0]
    assert line == run(NAME, "--angles", "-5:5 -5:5 0", *given).stdout.splitlines()[0]
    low, high = volumes(line)
    assert 0 < low < high
    assert "above z = 0, the side of the home pose" in line
    assert picture.stat().st_size > 1000
    assert out.stat().st_size > 1000


def test_a_region_in_a_plane_holds_the_exact_area_and_is_drawn_and_written(tmp_path):
    picture, out = tmp_path / "a.svg", tmp_path / "a.csv"
    given = ("--angles", "0 0 -30", "--region", "plane", "--theta", 15, "--resolution", 0.6)
    result = run(NAME, *given, "--plot", picture, "--out", out)
    assert result.exit_code == 0, result.exception
    low, high = volumes(result.stdout)
    turn = np.deg2rad([15, -30])
    design = gsp.catalogue.design(NAME)
    c, s = np.cos(turn[1]), np.sin(turn[1])
    feet = design.base_points - design.platform_points @ np.array(
        [[c, s, 0], [-s, c, 0], [0, 0, 1]]
    )
    points = np.random.default_rng(5).uniform((-6, 0), (6, 15), (200_000, 2))
    space = np.stack(
        (*np.outer(np.array([np.cos(turn[0]), np.sin(turn[0])]), points[:, 0]), points[:, 1])
    )
    lengths = np.linalg.norm(space.T[:, None] - feet, axis=2)
    area = 180.0 * ((lengths >= 8) & (lengths <= 15)).all(axis=1).mean()
    assert low < area < high
    assert high < 1.3 * low
    assert "above z = 0, the side of the home pose" in result.stdout
    table = pd.read_csv(out)  # heights count from the base, though the plane is that of the home
    assert table["v_low"].min() >= 0.0
    assert table["v_high"].max() > design.home.position[2]
    text = picture.read_text(encoding="utf-8")
    assert "vertical plane at 15°" in text
    assert "area between" in text


def test_some_of_a_range_is_more_than_one_orientation_and_all_of_it_is_less():
    def area(*angles):
        given = ("--region", "plane", "--resolution", 0.6, "--angles", *angles)
        line = run(NAME, *given).stdout.splitlines()[0]
        return (*volumes(line), line)

    some, one, every = area("0 0 0:20", "--some"), area("0 0 10"), area("0 0 0:20")
    assert every[1] < one[0]
    assert one[1] < some[1]
    assert "some of the angles 0° 0° 0°…20°" in some[2]
    assert "all of the angles" in every[2]


def test_a_resolution_that_is_not_reached_is_said(monkeypatch):
    given = ("--region", "plane", "--angles", "0 0 0", "--resolution")
    assert run(NAME, *given, 0.1).stderr == ""
    advice = "of up to 1.731; a finer --resolution would help"
    said = run(NAME, *given, 2).stderr
    assert said.startswith("gsp: the area is known within ±"), said
    assert advice in said
    for limit in (("--require", "CTN >= 0.1"), ("--cone", 20, "--radius", 0.3)):
        said = run(NAME, *given, 4, *limit).stderr
        start = "gsp: nothing is proven inside, and the area is known within ±100 % only: undecided"
        assert said.startswith(start), said
        assert "a finer --resolution would help" in said
    monkeypatch.setitem(gsp.workspace.fixed_orientation.__kwdefaults__, "budget", 200_000)
    line = run(NAME, *given, 1e-300).stderr
    assert line.startswith("gsp: --resolution: 1e-300 is not reached: the budget ended"), line
    upper = gsp.Limits(position=[None, None, (0.0, None)])
    plane = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    reached = gsp.workspace.fixed_orientation(
        catalogue.design(NAME), limits=upper, plane=plane, resolution=1e-300
    ).resolution
    assert 0.0 < reached < 1.0
    assert line.split()[-1] == f"{reached:.4g}"


KINDS = {  # and how well the measure is known without a resolution, as the help states
    "area": (0.02, ("--region", "plane", "--angles", "0 0 0")),
    "volume of one orientation": (0.06, ("--region", "space", "--angles", "0 0 0")),
    "volume of all angles": (0.03, ("--tilt", 5)),
    "volume of some angles": (0.06, ("--tilt", 5, "--some")),
    "orientations": (0.06, ("--orientations", "--position", 0, 0, 8)),
}
VOLUMES = [kind for kind in KINDS if kind.startswith("volume")]
# Those of which the whole search takes long.
SLOW = ("volume of some angles", "orientations")


def _bracket(text):
    return map(float, re.search("between ([0-9.]+) and ([0-9.]+)", text).groups())


@pytest.mark.parametrize(
    ("kind", "levels"),
    campaign.some(
        [*product(KINDS, (3, 9)), *((kind, None) for kind in KINDS if kind not in SLOW)], 7
    ),
)
def test_a_measure_that_is_not_known_as_the_help_states_is_said(monkeypatch, kind, levels):
    aim, given = KINDS[kind]
    if levels is not None:
        monkeypatch.setattr(growing, "MOST_LEVELS", levels)
    result = run(NAME, *given)
    low, high = _bracket(result.stdout)
    known = (high - low) / (high + low)
    assert (known > aim) == (levels is not None)
    found = re.search("is known within ±([0-9.]+) % only: cells are not halved", result.stderr)
    assert (found is not None) == (known > aim)
    assert found is None or abs(float(found[1]) / (100.0 * known) - 1.0) < 0.02


def test_frames_far_from_the_platform_leave_an_area_unknown_and_said(monkeypatch, tmp_path):
    monkeypatch.setattr(growing, "MOST_LEVELS", 9)
    design = catalogue.design(NAME)
    far = design.replace(platform_points=design.platform_points + [1e4, 0.0, 0.0], home=None)
    far.write(tmp_path / "far.toml")
    line = run(tmp_path / "far.toml", "--region", "plane").stderr
    assert "the area is known within ±100 % only: cells are not halved more often with" in line


def test_a_limit_without_bounds_is_the_reason_that_nothing_is_known():
    result = run(NAME, "--region", "plane", "--angles", "0 0 0", "--require", "CDN >= 2")
    assert "of a limit no bound over cells is known" in result.stderr


@pytest.mark.parametrize(
    ("kind", "end"),
    campaign.some(
        [*((k, "stl") for k in VOLUMES), *((VOLUMES[0], end) for end in ("obj", "ply", "glb"))], 3
    ),
)
def test_a_surface_has_the_printed_share_of_the_volume(tmp_path, kind, end):
    out = tmp_path / f"a.{end}"
    text = run(NAME, *KINDS[kind][1], "--resolution", 1.2, "--out", out).stdout
    low, high = _bracket(text)
    share = float(re.search("at least ([0-9.]+) % of the volume", text).group(1))
    size = trimesh.load(out, force="mesh").volume
    assert size == pytest.approx(low, rel=1e-3)
    assert 0.0 < share <= 100.0 * size / high < share + 0.2


def test_a_region_that_is_proven_empty_is_not_drawn(tmp_path):
    picture = tmp_path / "a.png"
    far = ("--orientations", "--position", 0, 0, 800, "--resolution", 60, "--plot", picture)
    result = run(NAME, *far)
    assert result.exit_code == 0, result.exception
    assert "not written: the region is proven empty" in result.stdout.replace("\n", " ")
    assert not picture.exists()


def test_cones_clearances_and_bounds_of_indices_are_limits():
    bounds = ("--require", "CTN >= 0.01", "--require", "CDN_CL <= 50", "--length", 5)
    more = ("--cone", 8, "--radius", 0.5, *bounds)
    line = run(NAME, "--angles", "0 0 -1:1", "--resolution", 8.0, *more).stdout
    design, half = gsp.catalogue.design(NAME), np.deg2rad(8)
    limits = gsp.Limits(
        base_cone=half,
        platform_cone=half,
        leg_radius=0.5,
        indices=["CTN >= 0.01", "CDN_CL <= 50"],
        length=5.0,
        position=[None, None, (0, None)],
    )
    box = gsp.PoseBox([0, 0, 0], [0, 0, (-1, 1)], degrees=True, order="approach-roll")
    region = gsp.workspace.dextrous(design, box, limits, resolution=8.0)
    assert volumes(line) == pytest.approx(region.volume, rel=1e-3)
    wide = gsp.workspace.dextrous(design, box, gsp.Limits(position=limits.position), resolution=4.0)
    assert region.volume != wide.volume


def area(*arguments):
    """Return the printed bracket of an area or a volume."""
    words = run(*arguments).stdout.replace(",", " ").split()
    return float(words[2]), float(words[4])


def test_bounds_of_the_position_cut_a_region():
    """Both halves, x ≤ 0 and x ≥ 0, have the area of the whole, whose bracket is exact."""
    where = (NAME, "--region", "plane", "--angles", "0 0 -30")
    whole = area(*where)
    (a, b), (c, d) = area(*where, "--box", "-9:0 : :"), area(*where, "--box", "0: : :")
    assert a + c <= whole[1]
    assert whole[0] <= b + d
    assert b < 0.6 * whole[0]
    assert area(*where, "--box", "-1:1 : 3:4")[1] <= 2.0 + 1e-9


def test_strokes_that_do_not_bound_the_position_need_a_box(gsp, tmp_path):
    template = catalogue.design("toz-kucuk-2016-d3-6")
    design = catalogue.instantiate(catalogue.mechanism("D4^6"), template)
    joints = design.at(design.home).joints
    design.replace(strokes=np.stack([joints - 15.0, joints + 15.0], axis=-1)).write("d4.toml")
    words = ("workspace", "d4.toml", "--region", "space", "--angles", "0 0 0")
    assert "--box: expected bounds of x, y and z" in gsp(*words).error
    assert "received too few" in gsp(*words, "--box", "-1:1 -1:1 :").error
    x, y, z = design.home.position
    box = f"{x - 1}:{x + 1} {y - 1}:{y + 1} {z - 1}:{z + 1}"
    assert "between 7.999 and 8.001 mm³, proven" in gsp(*words, "--box", box).out


def test_curves_end_at_bounds_of_the_position(gsp):
    out = gsp("workspace", NAME, "--angles", "0 0 -30", "--box", "-1:1 : :", "--rays", 8).out
    points = [line.split() for line in out.split("curve")[0].splitlines() if " - " in line]
    across = [float(words[-6]) for words in points]
    assert max(np.abs(across)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("box", "message"),
    [
        ("1:2 3:4", "--box: expected three intervals low:high"),
        ("1 2 3", "--box: expected three intervals low:high"),
        ("nan:1 : :", "--box: expected three intervals low:high"),
        ("2:1 : :", "--box: expected intervals low:high with low ≤ high"),
    ],
)
def test_bad_boxes(gsp, box, message):
    assert message in gsp("workspace", NAME, "--region", "plane", "--box", box).error


def test_orientations_at_a_position(tmp_path):
    picture, out = tmp_path / "a.png", tmp_path / "a.csv"
    result = run(
        NAME,
        "--orientations",
        *("--position", 0, 0, 8, "--resolution", 15, "--plot", picture, "--out", out),
    )
    assert result.exit_code == 0, result.exception
    design = gsp.catalogue.design(NAME)
    region = gsp.workspace.orientations(design, [0, 0, 8], resolution=np.deg2rad(15))
    low, high = volumes(result.stdout)
    assert low == pytest.approx(region.volume[0] / (8 * np.pi**2), rel=1e-3)
    assert high == pytest.approx(region.volume[1] / (8 * np.pi**2), rel=1e-3)
    table = pd.read_csv(out)
    assert set(table["status"]) == {"inside", "undecided"}
    names = [f"{name}_{end}" for name in ("roll", "pitch", "yaw") for end in ("low", "high")]
    assert list(table)[:6] == names
    pitch = np.deg2rad(table[["pitch_low", "pitch_high"]])
    sides = np.deg2rad([table[f"{n}_high"] - table[f"{n}_low"] for n in ("roll", "yaw")])
    sizes = sides.prod(axis=0) * (np.sin(pitch["pitch_high"]) - np.sin(pitch["pitch_low"]))
    assert sizes[table["status"] == "inside"].sum() / (8 * np.pi**2) <= high
    assert sizes.sum() / (8 * np.pi**2) >= low
    assert picture.stat().st_size > 1000
    given = ("--orientations", "--position", 0, 0, 8, "--resolution", 15)
    said = run(NAME, *given, "--out", tmp_path / "a.stl").stdout.replace("\n", " ")
    share = float(re.search("at least ([0-9.]+) % of the orientations", said)[1])
    assert 0.0 <= 100.0 * region.volume[0] / region.volume[1] - share < 0.1


def test_a_section_of_other_limits_is_mapped_and_drawn(tmp_path):
    picture, out = tmp_path / "a.png", tmp_path / "a.csv"
    result = run(
        NAME,
        "--angles",
        "0 0 0",
        "--require",
        "manipulability >= 1000",
        "--rays",
        6,
        "--plot",
        picture,
        "--out",
        out,
    )
    assert result.exit_code == 0, result.exception
    assert "manipulability=0" in result.stdout
    assert picture.stat().st_size > 1000
    assert pd.read_csv(out)["maximal"].any()


def test_the_picture_states_plane_and_orientation(tmp_path):
    run(NAME, "--angles", "0 0 -30", "--theta", 15, "--plot", tmp_path / "a.svg")
    text = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert "vertical plane at 15°" in text
    assert "angles 0° 0° -30° (approach-roll)" in text


LIMITS = ("--stroke", 5, 12, "--cone", 60, "--radius", 0.1, "--require", "CTN  >= 0.01")
WORDS = "joints 5…12, cones of 60°, legs of radius 0.1, CTN >= 0.01"


@pytest.mark.parametrize(
    "what",
    [
        ("--region", "plane", "--resolution", 4),
        ("--angles", "0 0 -1:1", "--resolution", 8),
        ("--orientations", "--resolution", 60),
    ],
)
def test_output_and_picture_state_the_limits_that_options_give(what, tmp_path):
    result = run(NAME, *what, *LIMITS, "--plot", tmp_path / "a.svg")
    assert result.exit_code == 0, result.exception
    text = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert WORDS in text.replace("&gt;", ">")
    assert WORDS in result.stdout
    result = run(NAME, *what, "--plot", tmp_path / "b.svg")
    text = result.stdout + (tmp_path / "b.svg").read_text(encoding="utf-8")
    assert not any(word in text for word in ("joints 5", "cones of", "legs of", "CTN"))


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        (("--stroke", 5, 12), "joints 5…12"),
        (("--rays", 3, "--require", "manipulability  >= 1"), "manipulability >= 1"),
    ],
)
def test_the_picture_of_a_section_states_the_limits_that_options_give(limits, words, tmp_path):
    run(NAME, "--angles", "0 0 0", *limits, "--plot", tmp_path / "a.svg")
    text = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert words in text.replace("&gt;", ">")


def test_the_table_of_labelled_curves_has_their_points(tmp_path):
    options = ("--region", "plane", "--angles", "0 0 0", "--resolution", 2)
    run(NAME, *options, "--curves", "--out", tmp_path / "a.csv")
    table = pd.read_csv(tmp_path / "a.csv")
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    upper = [0.0, 0.0, 1.0, 0.0]
    region = gsp.workspace.fixed_orientation(
        catalogue.design(NAME), plane=(np.zeros(3), axes), half_space=upper, resolution=2.0
    )
    found = gsp.workspace.boundary_curves(region)
    points = np.concatenate([curve.pose.position for curve in found.section.curves])
    np.testing.assert_allclose(table[["x", "y", "z"]], points, atol=1e-9)
    np.testing.assert_array_equal(table["boundary"], np.concatenate(found.outer))
    assert table["boundary"].any()
    run(NAME, *options, "--out", tmp_path / "b.csv")
    assert "status" in pd.read_csv(tmp_path / "b.csv")  # cells, without --curves


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((NAME, "--angles", "0 0"), "three angles"),
        ((NAME, "--angles", "0 0 9:1"), "low ≤ high"),
        ((NAME, "--out", "a.txt"), "csv"),
        ((NAME, "--stroke", 9, 9), "--stroke: expected LOW < HIGH, received 9 9"),
        ((NAME, "--stroke", 9, 8), "--stroke: expected LOW < HIGH, received 9 8"),
        ((NAME, "--region", "plane", "--stroke", 9, 8), "--stroke: expected LOW ≤ HIGH"),
        ((NAME, "--stroke", 0, 1e200), "--stroke"),
        ((NAME, "--angles", "0 0 0", "--theta", "inf"), "--theta"),
        ((NAME, "--angles", "0 0 0", "--position", "nan", 0, 0), "--position"),
        ((NAME, "--order", "q"), "order"),
        ((NAME, "--position", 0, 0, 50), "feasible orientation"),
        (("toz-kucuk-2016-d3-6",), "strokes or other limits"),
        ((NAME, "--angles", "0 0 -5:5", "--rays", 3), "--rays: not used beside"),
        ((NAME, "--tilt", 20, "--angles", "0 0 0"), "--angles: not used beside --tilt"),
        ((NAME, "--tilt", 90), "--tilt"),
        ((NAME, "--some"), "--some: expected an interval of angles"),
        ((NAME, "--angles", "0 0 3", "--some"), "--some: expected an interval of angles"),
        ((NAME, "--region", "plane", "--seed", 3), "--seed: not used beside a region"),
        ((NAME, "--region", "space", "--theta", 3), "--theta: not used beside a region in space"),
        ((NAME, "--region", "space", "--orientations"), "--region: not used beside"),
        ((NAME, "--region", "plane", "--out", "a.stl"), ".dxf"),
        ((NAME, "--curves"), "--region plane, received no --region"),
        ((NAME, "--curves", "--region", "space"), "--region plane, received a region in space"),
        (
            (NAME, "--curves", "--region", "plane", "--angles", "0 0 0:5"),
            "(--angles), received an interval of angles",
        ),
        ((NAME, "--cone", 100), "--cone"),
        ((NAME, "--radius", -1), "--radius"),
        ((NAME, "--both"), "--both: not used beside"),
        ((NAME, "--orientations", "--theta", 3), "--theta: not used beside --orientations"),
        ((NAME, "--orientations", "--out", "a.dxf"), ".stl"),
        ((NAME, "--require", "CTN >"), "CTN"),
        ((NAME, "--require", "CDN_CL <= 9"), "expected length="),
        ((NAME, "--length", 0), "--length: expected a positive number"),
    ],
)
def test_bad_input_is_an_error(arguments, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*arguments)
    assert isinstance(result.exception, GspError)
    assert message in str(result.exception)


def test_a_workspace_without_a_point_has_no_volume():
    result = run(NAME, "--angles", "0 0 -1:1", "--stroke", 1, 2)
    assert result.exit_code == 0
    assert "Volume  between 0 and 0, proven" in result.stdout


def test_existing_files_are_kept(tmp_path):
    out = tmp_path / "arcs.csv"
    out.write_text("mine")
    result = run(NAME, "--angles", "0 0 0", "--out", out)
    assert isinstance(result.exception, GspError)
    assert out.read_text() == "mine"


def test_a_limit_of_the_quality_index_finds_its_maximum():
    result = run(NAME, "--angles", "0 0 0", "--require", "λ >= 0.01", "--rays", 1)
    assert result.exit_code == 0, result.exception


FLAT = ("--region", "plane")


def test_indices_over_a_region_have_mean_worst_proof_global_and_share(tmp_path):
    """One orientation of the 6–3 in the plane y = 0, beside own rows at points of a grid."""
    design = gsp.catalogue.design(NAME)
    x, z = (v.ravel() for v in np.meshgrid(np.linspace(-7, 7, 281), np.linspace(0.01, 15, 301)))
    foot = np.stack((x, 0.0 * x, z), axis=1)[:, None] + design.platform_points
    d = foot - design.base_points
    length = np.linalg.norm(d, axis=2)
    ok = ((length >= 8) & (length <= 15)).all(axis=1)
    u = (d / length[..., None])[ok]
    arm = np.broadcast_to(design.platform_points, u.shape)
    own = np.linalg.cond(np.concatenate((u, np.cross(arm, u)), axis=2))
    picture, out = tmp_path / "a.svg", tmp_path / "a.csv"
    given = (*FLAT, "--angles", "0 0 0", "--resolution", 0.5, "--length", 1, "--seed", 3)
    most = f"{np.quantile(own, 0.4):.5g}"
    shown = ("--index", f"CDN_CL <= {most}", "--samples", 4000, "--plot", picture, "--out", out)
    result = run(NAME, *given, *shown)
    assert result.exit_code == 0, result.exception
    row = next(line for line in result.stdout.splitlines() if line.startswith("CDN_CL")).split()
    mean, error, worst, proven, reciprocal, its_error = (float(row[k]) for k in (2, 4, 5, 7, 8, 10))
    assert abs(mean - own.mean()) < 4.5 * error
    assert abs(reciprocal - (1 / own).mean()) < 4.5 * its_error
    # No point of the grid is beyond the bound, and what is found comes near to the worst.
    assert 0.85 * own.max() < worst <= proven
    assert own.max() <= proven < 1.1 * own.max()
    share = re.search(rf"with CDN_CL <= {most}: (\S+) ± (\S+)", result.stdout)
    assert abs(float(share[1]) - (own <= float(most)).mean()) < 4.5 * float(share[2])
    assert 0.1 < float(share[1]) < 0.9
    table = pd.read_csv(out)
    assert len(table) == 4000
    assert list(table)[:4] == ["x", "y", "z", "angle_1"]
    # The search for the bound finds worse poses than those that are drawn.
    assert table["condition_number"].max() <= worst * (1 + 1e-3)
    assert "in each cell, 4000 poses" in picture.read_text(encoding="utf-8")


def test_an_index_of_any_orientation_has_no_proof_and_of_an_empty_region_nothing():
    given = ("--index", "σ_min", "--length", 1, "--samples", 50, "--resolution", 2)
    result = run(NAME, *FLAT, *given)
    assert result.exit_code == 0, result.exception
    row = next(line for line in result.stdout.splitlines() if line.startswith("σ_min"))
    assert " – " in row
    empty = run(NAME, *FLAT, "--stroke", 0.01, 0.02, *given)
    assert "no indices: the region is proven empty" in empty.stdout


def test_small_designs_are_printed_with_their_digits(tmp_path):
    small = gsp.catalogue.design(NAME).scaled(1e-9)
    small.write(tmp_path / "small.toml")
    result = run(tmp_path / "small.toml", "--angles", "0 0 -30", "--theta", 15)
    assert result.exit_code == 0, result.exception
    assert "e-09" in result.stdout
    assert "0.000000 " not in result.stdout.replace("0.000000e+00", "")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--angles", "5:-5 0 0"), "--angles: expected intervals low:high with low ≤ high"),
        (("--stroke", 3, 1, "--angles", "0 0 0"), "--stroke: expected LOW < HIGH, received 3 1"),
        (("--angles", "0 0 0", "--length", 2), "--length: not used beside limits without"),
        (("--angles", "0 0 0", "--order", "foo"), "--order: expected rpy"),
        (("--angles", "0 0 -5:5", "--resolution", -1), "--resolution: expected a positive"),
        ((*FLAT, "--index", "CTN >= x"), '--index: expected texts such as "CTN >= 0.1"'),
        ((*FLAT, "--index", "CDN_CL"), "expected --length"),
        ((*FLAT, "--index", "CTN", "--length", 2), "--length: not used beside --index"),
        ((*FLAT, "--samples", 9), "--samples: not used beside a workspace without --index"),
        ((*FLAT, "--curves", "--index", "CTN"), "--index: expected --region"),
        (("--index", "CTN"), "--index: expected --region, an interval of angles, or --orient"),
        (("--require", "CTN >= x"), '--require: expected texts such as "CTN >= 0.1"'),
        (("--require", "CTN >= 0.1", "--require=CTN > y"), "--require: expected texts"),
        (("--require", "FOO >= 1"), "--require: unknown index 'FOO'"),
        ((*FLAT, "--index", "FOO >= 1"), "--index: unknown index 'FOO'"),
    ],
)
def test_messages_name_the_option(gsp, arguments, message):
    assert message in gsp("workspace", NAME, *arguments).error


def test_both_sides_of_a_design_without_a_home_pose_are_refused(gsp):
    catalogue.design(NAME).replace(home=None, name="lost").write("a.toml")
    for words in (("--angles", "0 0 0"), ("--region", "space")):
        error = gsp("workspace", "a.toml", *words, "--both").error
        assert "--both (of design 'lost'): expected a home pose on one side" in error


def test_a_leg_without_a_stroke_is_named_with_its_design(gsp, tmp_path):
    strokes = [*[[8.0, 15.0]] * 5, [8.0, np.nan]]
    catalogue.design(NAME).replace(name="five", strokes=strokes).write(tmp_path / "a.toml")
    error = gsp("workspace", "a.toml", "--angles", "0 0 0").error
    assert "--stroke" in error
    assert "received none of d6" in error
    assert "of design 'five'" in error


def test_no_table_of_an_empty_plane_is_written(gsp, tmp_path):
    moved = turned(catalogue.design(NAME), np.eye(3), np.full(3, 100.0), tmp_path / "far.toml")
    result = gsp("workspace", moved, "--angles", "0 0 0", "--out", "a.csv")
    assert result.status == 0
    assert "nothing is written; see --position" in result.err
    assert not (tmp_path / "a.csv").exists()


def test_a_surface_without_an_inside_cell_is_an_error_with_advice(gsp):
    given = ("--angles", "0 0 -5:5", "--resolution", 8, "--out", "x.stl")
    error = gsp("workspace", NAME, *given).error
    assert "x.stl: expected a region with a part that is proven inside, as with a finer" in error


def test_a_design_without_a_home_pose_is_told_which_option_it_needs(tmp_path):
    path = tmp_path / "lost.toml"
    catalogue.design(NAME).replace(home=None, name="lost").write(path)
    for arguments, option in (((), "--position"), (("--orientations",), "--position"),
                              (("--region", "plane", "--cone", 20), "--cone")):  # fmt: skip
        with pytest.raises(GspError, match=f"{option}: expected .* home pose"):
            CliRunner().invoke(app, ["workspace", str(path), *map(str, arguments)],
                               catch_exceptions=False)  # fmt: skip


def test_an_empty_region_has_neither_curves_nor_a_file(tmp_path):
    many = [NAME, "--region", "plane", "--angles", "0 0 0", "--stroke", 1, 2]
    result = run(*many, "--curves")
    assert result.exit_code == 0
    assert "no curves: the region is proven empty" in result.stdout
    result = run(*many, "--out", tmp_path / "a.svg")
    assert "a region with a cell or more, received an empty one" in str(result.exception)


def test_curves_inside_of_a_region_are_printed_on_demand(tmp_path):
    many = (NAME, "--region", "plane", "--curves", "--resolution", 2)
    outside, inside = (
        run(*many, *more) for more in ((), ("--interior", "--plot", tmp_path / "a.png"))
    )
    assert outside.exit_code == inside.exit_code == 0
    assert "inside" not in outside.stdout
    assert "[- 0 0 0 0 -]  " in inside.stdout
    assert any(line.endswith(" inside") for line in inside.stdout.splitlines())
    assert (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--interior"], "--interior: expected --curves"),
        (["--curves"], "--curves: expected --region plane"),
        (["--region", "space", "--curves"], "--curves: expected --region plane"),
        (
            ["--region", "plane", "--curves", "--some", "--angles", "0 0 -9:9"],
            "--curves: expected any orientation, or one",
        ),
    ],
)
def test_curves_that_a_region_does_not_have_are_refused(options, words):
    assert words in str(run(NAME, *options).exception)


def test_coordinates_of_a_turned_plane_do_not_count_from_rounding():
    plane = (1e-16 * np.ones(3), [[0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    region = gsp.workspace.fixed_orientation(catalogue.design(NAME), plane=plane, resolution=4.0)
    assert region.plot().get_xlabel() == "along (0.8, 0.6, 0)"
