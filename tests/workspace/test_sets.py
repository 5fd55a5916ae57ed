"""Regions: proven inside and outside, against closed forms and samples."""

import dataclasses
import itertools
import re

import numpy as np
import pytest

import gsp
from gsp.proof.extremes import BOUNDED
from gsp.workspace.planes import plane_frame
from gsp.workspace.sets import dextrous, fixed_orientation, orientations, reachable
from gsp.workspace.sets.problem import bounded
from gsp.workspace.sets.tree import deciding
from gsp.workspace.sets.tree.verdicts import verdicts
from tests.reference.workspace_samples import reachable as found_by_samples
from tests.support import random_design, turn

PLANE = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
SIX_THREE = gsp.catalogue.design("workspace-6-3")
NO_TURN = gsp.PoseBox([0, 0, 0], [0, 0, 0])
ALL = gsp.PoseBox([0, 0, 0], [(-180, 180), (-90, 90), (-180, 180)], degrees=True)
RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])


def ball(radius):
    return 4.0 / 3.0 * np.pi * radius**3


def test_equal_shells_have_the_volume_of_one_shell():
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    low, high = fixed_orientation(design, resolution=0.5).volume
    assert low <= ball(2.0) - ball(1.0) <= high
    octant = gsp.Limits(position=[(0.0, None)] * 3)
    low, high = fixed_orientation(design, limits=octant, resolution=0.25).volume
    assert low <= (ball(2.0) - ball(1.0)) / 8.0 <= high
    assert high - low < 0.03 * high


def test_area_of_equal_shells():
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    low, high = reachable(design, plane=PLANE, rotations=NO_TURN).area
    assert low <= np.pi * 3.0 <= high
    assert high - low <= 0.04 * (high + low) / 2.0


def test_reachable_positions_of_one_common_leg():
    arm = np.repeat([[0.5, 0.0, 0.0]], 6, axis=0)
    design = gsp.Design(["D1"] * 6, np.zeros((6, 3)), arm, strokes=[(1.0, 2.0)] * 6)
    region = reachable(design, resolution=0.35)
    low, high = region.volume
    assert low <= ball(2.5) - ball(0.5) <= high
    rng = np.random.default_rng(0)
    points = rng.uniform(-2.6, 2.6, (200, 3))
    radius = np.linalg.norm(points, axis=1)
    codes = region.contains(points)
    inside = (radius > 0.5) & (radius < 2.5)
    assert (codes[inside] >= 0).all()
    assert (codes[~inside] <= 0).all()
    assert (codes != 0).mean() > 0.9


def test_dextrous_positions_of_legs_from_one_point():
    design = gsp.Design(["D1"] * 6, np.zeros((6, 3)), 0.5 * RING, strokes=[(1.0, 4.0)] * 6)
    region = dextrous(design, ALL, plane=PLANE, resolution=0.6)
    low, high = region.area
    assert low <= np.pi * (3.5**2 - 1.5**2) <= high
    assert low > 0.3 * high
    assert region.contains([[0, 0, 2.5], [0, 0, 1.4], [3.6, 0, 0]]).tolist() == [1, -1, -1]


def test_orientations_of_one_common_leg_are_those_of_a_zone_of_the_sphere():
    arm = np.repeat([[1.0, 0.0, 0.0]], 6, axis=0)
    design = gsp.Design(["D1"] * 6, np.zeros((6, 3)), arm, strokes=[(1.5, 2.5)] * 6)
    # l² = 4 + 1 + 4 cos φ, and cos φ is evenly distributed over the rotations.
    share = ((2.5**2 - 5) / 4 - (1.5**2 - 5) / 4) / 2
    low, high = orientations(design, [0.0, 0.0, 2.0]).volume
    assert low <= 8 * np.pi**2 * share <= high
    assert high - low < 0.13 * high


@pytest.mark.parametrize("name", ["workspace-6-3", "toz-kucuk-2016-d1-d2-d3-d4-a1-2"])
def test_orientations_are_in_roll_pitch_yaw(name):
    design = gsp.catalogue.design(name)
    place, angles = design.home.position, np.array([0.05, 0.1, 0.5])
    joints = design.at(gsp.Pose.from_rpy(place, angles)).joints
    size = np.where(design.angular, 1.0, design.rms_radius)
    design = design.replace(strokes=joints[:, None] + 0.03 * size[:, None] * np.array([-1.0, 1.0]))
    region = orientations(design, place, budget=20000)
    assert region.contains(angles) == 1
    assert region.contains(angles[::-1]) == -1
    assert len(region.part_of(angles).codes)
    near = angles + np.random.default_rng(2).uniform(-0.04, 0.04, (100, 3))
    ok = gsp.feasible(design, gsp.Pose.from_rpy(place, near)).ok
    assert 10 < ok.sum() < 90
    codes = region.contains(near)
    assert not (ok & (codes == -1)).any()
    assert not (~ok & (codes == 1)).any()
    table = region.to_dataframe()
    for name, angle, (low, high) in zip(
        ("roll", "pitch", "yaw"), angles, region.extents[1].T, strict=True
    ):
        assert low < angle < high
        assert table[f"{name}_low"].min() == np.rad2deg(low)
        assert table[f"{name}_high"].max() == np.rad2deg(high)


@pytest.mark.parametrize("legs", [["D1"] * 6, ["D1", "D2", "D3", "D4", "A1", "D1", "D4 A1"]])
@pytest.mark.parametrize("limited", ["strokes", "cones", "clearance", "walls"])
def test_verdicts_hold_at_samples(legs, limited):
    rng = np.random.default_rng(5)
    decided = 0
    for _ in range(30):
        bare = random_design(rng, legs)
        p, angles = rng.uniform(-1, 1, 3) + [0, 0, 1.5], rng.uniform(-1, 1, 3)
        home = gsp.Pose.from_rpy(p, angles)
        joints = bare.at(home).joints
        shift = rng.choice([0.0, 0.3], len(joints))
        strokes = np.stack((joints * 0.8 + shift, joints * 1.2 + shift), axis=1)
        design = random_design_like(bare, strokes, home)
        limits = {
            "strokes": None,
            "cones": gsp.Limits(base_cone=rng.uniform(0.05, 0.5)),
            "clearance": gsp.Limits(leg_radius=rng.uniform(0.01, 0.2)),
            "walls": gsp.Limits(position=[None, None, (p[2] + rng.choice([-0.1, 0.1]), None)]),
        }[limited]
        problem = bounded(design, limits, domain=False)
        size = 10.0 ** rng.uniform(-2.5, -0.5, 6)
        low, high = np.concatenate((p, angles)) - size, np.concatenate((p, angles)) + size
        # The order of moving axes of "rpy" is yaw, pitch, roll.
        box = np.concatenate((low[:2:-1], high[:2:-1]))
        code = verdicts(problem, low[None, :3], high[None, :3], box[None])[0]
        share = rng.uniform(size=(60, 6))
        share[:30] = rng.integers(0, 2, (30, 6))
        poses = gsp.Pose.from_rpy(*np.split(low + share * (high - low), 2, axis=1))
        ok = gsp.feasible(design, poses, limits).ok
        assert not (code == 1 and not ok.all())
        assert not (code == -1 and ok.any())
        decided += code != 0
    assert decided > 3


def random_design_like(design, strokes, home):
    return gsp.Design(
        [leg.name for leg in design.legs],
        design.base_points,
        design.platform_points,
        design.base_directions,
        design.platform_directions,
        strokes=strokes,
        home=home,
    )


@pytest.mark.parametrize("wide", [0.1, 0.4])
def test_feasible_poses_are_never_outside_and_inside_points_have_a_pose(wide):
    rng = np.random.default_rng(7)
    bare = random_design(rng, ["D1"] * 6)
    home = gsp.Pose([0.0, 0.0, 1.4])
    strokes = bare.at(home).joints[:, None] * [1 - wide, 1 + wide]
    design = random_design_like(bare, strokes, home)
    region = reachable(design, budget=60_000)
    near = gsp.Pose(
        home.position + rng.uniform(-2, 2, (20000, 3)) * wide,
        turn(rng.uniform(-1, 1, (20000, 3)) * wide),
    )
    ok = gsp.feasible(design, near).ok
    assert ok.sum() > 10
    assert (region.contains(near.position[ok][:200]) >= 0).all()
    points = rng.uniform(*region.extents[1], (40, 3))
    inside = points[region.contains(points) == 1]
    assert found_by_samples(design, inside, *strokes.T, rng).all()


def test_other_legs_and_cones_are_reached_too():
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    joints = design.at(design.home).joints
    strokes = np.stack((joints * 0.95, joints * 1.05), axis=1)
    x, y, z = design.home.position
    limits = gsp.Limits(
        strokes=strokes, base_cone=0.5, position=[(x - 10, x + 10), (y - 10, y + 10), (z, z + 10)]
    )
    angles = design.home.angles()
    near = gsp.PoseBox([0, 0, 0], [(a - 0.05, a + 0.05) for a in angles])
    region = reachable(design, limits, rotations=near, resolution=4.0, budget=30_000)
    rng = np.random.default_rng(3)
    poses = gsp.Pose.from_rpy(
        design.home.position + rng.uniform([-10, -10, 0], 10, (500, 3)),
        angles + rng.uniform(-0.05, 0.05, (500, 3)),
    )
    ok = gsp.feasible(design, poses, limits).ok
    assert ok.any()
    assert (region.contains(poses.position[ok][:50]) >= 0).all()
    assert region.volume[0] > 0.0


def test_position_limits_bound_the_region():
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    above = gsp.Limits(position=[None, None, (0.0, None)])
    low, high = reachable(design, above, plane=PLANE, rotations=NO_TURN).area
    assert low <= np.pi * 1.5 <= high
    # The walls are slanted in the axes of this plane.
    tilted = ([0, 0, 0], [[1.0, 0.0, 1.0], [1.0, 0.0, -1.0]])
    low, high = reachable(design, above, plane=tilted, rotations=NO_TURN).area
    assert low <= np.pi * 1.5 <= high


def test_estimates_are_within_their_errors_and_parts_are_apart():
    design = gsp.Design(
        ["D1"] * 6, [[0, 0, 0]] * 3 + [[3, 0, 0]] * 3, np.zeros((6, 3)), strokes=[(2.0, 2.2)] * 6
    )
    # Two thin shells cut the plane y = 0 in two quadrilaterals, mirrored in z.
    region = reachable(design, plane=PLANE, rotations=NO_TURN, resolution=0.02)
    assert len(region.parts) == 2
    home = region.part_of([1.5, 0.0, 1.4])
    assert home.area[1] == pytest.approx(region.area[1] / 2)
    grid = np.stack(np.meshgrid(np.linspace(0, 3, 1501), np.linspace(0, 3, 1501)), axis=-1)
    near, far = np.hypot(grid[..., 0], grid[..., 1]), np.hypot(grid[..., 0] - 3, grid[..., 1])
    truth = 2 * 9.0 * np.mean((near > 2) & (near < 2.2) & (far > 2) & (far < 2.2))
    estimate = region.estimate(400)
    assert abs(estimate.value - truth) < 4 * estimate.error + 0.002
    assert region.area[0] < truth < region.area[1]
    assert region.centroid == pytest.approx([1.5, 0, 0], abs=1e-2)


@pytest.mark.parametrize("unit", [1e-12, 1e-6, 1e6])
def test_parts_are_the_same_in_every_unit(unit):
    base = unit * np.array([[0, 0, 0]] * 3 + [[3, 0, 0]] * 3)
    design = gsp.Design(["D1"] * 6, base, np.zeros((6, 3)), strokes=[(2.0 * unit, 2.2 * unit)] * 6)
    region = reachable(design, plane=PLANE, rotations=NO_TURN, resolution=0.04 * unit)
    assert len(region.parts) == 2


def test_a_point_whose_shortest_leg_is_too_short_is_not_dextrous():
    """The range of lengths has its extreme inside the box of angles."""
    b = [-0.3413514915009115, 1.2640330921278184, 0.058116614244285936]
    design = gsp.Design(
        ["D1"] * 6,
        [[-0.3276214530059298, -0.03747181998598653, 0.06776885184855179]] * 6,
        [b] * 6,
        strokes=[(0.596787346134682, 3.5864709608303786)] * 6,
    )
    box = gsp.PoseBox(
        [0, 0, 0], [(-71.32372799, 80.90219365), (-72.16693203, 60.18146342),
                    (-36.06503482, 62.81275634)], degrees=True,
        order="approach-roll",
    )  # fmt: skip
    point = [-0.25951169, -0.46221815, 1.91110401]
    assert dextrous(design, box, resolution=3.0).contains(point) == -1


def test_results_do_not_depend_on_the_number_of_threads():
    design = gsp.catalogue.design("workspace-6-3")
    one, two = (reachable(design, budget=20_000, workers=n) for n in (1, 2))
    assert np.array_equal(one.low, two.low)
    assert np.array_equal(one.codes, two.codes)


def test_the_resolution_is_that_of_the_largest_part_that_stays_undecided():
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    within = np.random.default_rng(3).uniform(-0.5, 0.5, (4000, 2))
    for resolution in (0.3, None):
        region = fixed_orientation(design, plane=PLANE, resolution=resolution)
        widest, longest = 0.0, 0.0
        open_ = region.codes == 0
        cells = (region.low[open_], region.high[open_], region.cuts[open_])
        for low, high, cut in zip(*cells, strict=True):
            delta = within * (high - low)
            left = (delta @ cut[:2] > cut[3]) & (delta @ cut[4:6] < cut[7])
            if left.any():
                longest = max(longest, float(np.ptp(delta[left], axis=0).max()))
                widest = max(widest, float((high - low).max()))
        assert longest <= region.resolution <= 1.05 * longest
        assert resolution is None or region.resolution <= widest <= resolution
        # The cuts decide most of the largest cells.
        assert resolution is not None or region.resolution < 0.8 * widest
    assert fixed_orientation(design, plane=PLANE, resolution=1e-300, budget=500).resolution > 1e-3
    # A domain that a limit alone bounds, all of it inside.
    whole = gsp.Limits(strokes=[(1.0, 9.0)] * 6, position=[(2, 3)] * 3)
    assert fixed_orientation(design, limits=whole).resolution == 0.0


def test_points_are_decided_by_the_proven_parts_of_cells_and_few_of_them_one_by_one():
    region = reachable(SIX_THREE, plane=PLANE, rotations=NO_TURN)
    points = np.random.default_rng(8).uniform(*region.domain, (4000, 2))
    decided = []

    def one_by_one(points):
        decided.append(len(points))
        return region._decide(points)

    codes = dataclasses.replace(region, _decide=one_by_one).contains(points)
    alone = region._decide(np.pad(points, ((0, 0), (0, 1))))
    known = alone != 0
    assert np.array_equal(codes[known], alone[known])
    # About the share of the domain that is not decided by the search.
    slab = np.diff(region.area)[0] / np.ptp(region.domain, axis=0).prod()
    assert sum(decided) < 1.5 * slab * len(points) + 10


def encloses(text, what, bounds):
    """Whether a text states two ends of four digits that enclose a bracket, and little more."""
    low, high = map(float, re.fullmatch(rf"{what} between (\S+) and (\S+)", text).groups())
    ends = np.array(bounds)
    return low <= ends[0] and ends[1] <= high and np.allclose((low, high), ends, rtol=1e-3, atol=0)


def test_a_region_is_drawn_and_listed():
    pytest.importorskip("matplotlib")
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    flat = reachable(design, plane=PLANE, rotations=NO_TURN, resolution=0.1)
    ax = flat.plot()
    assert ax.get_xlabel() == "x"
    assert {text.get_text() for text in ax.get_legend().get_texts()} == {
        "inside, proven",
        "outline",
        "undecided",
    }
    assert encloses(ax.get_title().split("\n")[-1], "area", flat.area)
    solid = fixed_orientation(design, resolution=0.6)
    volume, share = solid.plot().get_title().split("\n")[-2:]
    assert encloses(volume, "volume", solid.volume)
    # Of all that may be in the set, to the tenth of a per cent below.
    stated = float(re.fullmatch(r"drawn: what is proven inside, at least (.+) % of it", share)[1])
    assert 0.0 <= 100.0 * solid.volume[0] / solid.volume[1] - stated < 0.1
    assert stated > 50.0
    table = flat.to_dataframe()
    assert list(table) == ["u_low", "u_high", "v_low", "v_high", "status"]
    sizes = (table.u_high - table.u_low) * (table.v_high - table.v_low)
    # The inside parts of undecided cells count in the area.
    assert 0.8 * flat.area[0] < sizes[table.status == "inside"].sum() < flat.area[0]
    assert flat.area[1] < sizes.sum()


def test_pictures_have_the_style_of_the_library_and_units():
    plt = pytest.importorskip("matplotlib.pyplot")
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6, unit="mm")
    flat = reachable(design, plane=PLANE, rotations=NO_TURN, resolution=0.5)
    solid = fixed_orientation(design, resolution=0.8)
    with plt.rc_context({"figure.facecolor": "pink", "font.size": 17.0}):
        for region, unit in ((flat, "mm²"), (solid, "mm³")):
            ax = region.plot()
            assert ax.figure.get_facecolor() == (1.0, 1.0, 1.0, 1.0)
            assert ax.title.get_fontsize() == 9.0
            assert [line for line in ax.get_title().split("\n") if line.endswith(" " + unit)]
        assert plt.rcParams["font.size"] == 17.0


def test_nothing_is_reached_by_strokes_that_are_too_short():
    design = gsp.Design(["D1"] * 6, 5 * RING, RING, strokes=[(0.1, 0.2)] * 6)
    region = reachable(design)
    assert region.empty
    assert region.volume == (0.0, 0.0)
    assert region.parts == ()
    with pytest.raises(gsp.GspError, match="a cell or more"):
        region.plot()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"limits": [(1, 2)] * 6}, "limits"),
        ({"plane": [0, 0, 0]}, "plane"),
        ({"plane": ([0, 0, 0], [[1, 0, 0], [2, 0, 0]])}, r"plane\[1\]"),
        ({"rotations": [0, 0, 0]}, "rotations"),
        ({"resolution": 0.0}, "resolution"),
        ({"budget": 0}, "budget"),
        ({"workers": 0}, "workers"),
    ],
    ids=["limits", "plane", "axes", "rotations", "resolution", "budget", "workers"],
)
def test_bad_arguments_are_named(given, message):
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
    with pytest.raises(gsp.GspError, match=message):
        reachable(design, **given)


def test_positions_have_to_be_bounded():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.raises(gsp.GspError, match="position"):
        reachable(design, gsp.Limits(base_cone=0.3))


def test_position_limits_bound_slanted_planes_too():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    limits = gsp.Limits(strokes=[(1.0, 1e4)] * 6, position=[(-1, 1), (-1, 1), (-1, 1)])
    slanted = ([0, 0, 0], [[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    low, high = reachable(design, limits, plane=slanted, rotations=NO_TURN, budget=3000).area
    assert low <= 4 * np.sqrt(2.0) <= high


def test_texts_beside_the_axes_of_orientations_do_not_overlap():
    region = orientations(SIX_THREE, [0, 0, 8], resolution=0.4)
    ax = region.plot()
    labels = [axis.get_label_text() for axis in (ax.xaxis, ax.yaxis, ax.zaxis)]
    assert labels == ["roll [°]", "pitch [°]", "yaw [°]"]
    convention, share = ax.get_title().split("\n")[-2:]
    assert convention == "R = Rz(yaw) Ry(pitch) Rx(roll)"
    bounds = np.array(region.volume) / (8.0 * np.pi**2)
    assert encloses(f"share {share.removesuffix(' of all orientations')}", "share", bounds)
    ax.figure.canvas.draw()
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        low, high = sorted(axis.get_view_interval())
        texts = [t.label1 for t in axis.get_major_ticks() if low <= t.get_loc() <= high]
        boxes = [text.get_window_extent() for text in texts if text.get_text()]
        assert len(boxes) >= 2
        for one, other in itertools.pairwise(boxes):
            assert not one.overlaps(other)


@pytest.mark.parametrize("size", [1e-308, 1e-160, 1e160, 1e308])
def test_lengths_of_the_directions_of_a_plane_do_not_matter(size):
    start, frame = plane_frame([1.0, 2.0, 3.0], [[1.0, 0.5, 0.0], [0.0, 1.0, 0.3]])
    axes = np.array([[1.0, 0.5, 0.0], [0.0, 1.0, 0.3]])
    for given in (size * axes, axes * [[size], [1.0]], axes * [[1.0], [size]]):
        same, turned = plane_frame([1.0, 2.0, 3.0], given)
        np.testing.assert_allclose(turned, frame, rtol=0, atol=1e-15)
        np.testing.assert_array_equal(same, start)
    with pytest.raises(gsp.GspError, match="independent"):
        plane_frame([0.0, 0.0, 0.0], [[size, 0.0, 0.0], [-size, 0.0, 0.0]])
    with pytest.raises(gsp.GspError, match="1e"):
        plane_frame([1e150, 0.0, 0.0], axes)


def test_points_far_outside_of_a_region_are_outside_without_a_warning():
    region = fixed_orientation(SIX_THREE, resolution=4.0)
    far = [[1e20, 0.0, 0.0], [0.0, -1e160, 0.0], [1e308, 1e308, 1e308]]
    assert list(region.contains(far)) == [-1, -1, -1]
    with pytest.raises(gsp.GspError, match="1e"):
        orientations(SIX_THREE, [1e308, 0.0, 8.0])


def test_an_inclined_half_space_bounds_positions():
    """Cells agree with poses and n · p ≥ c, in space and in a plane; both sides make the whole."""
    n, c, level = np.array([0.3, -0.5, 0.8]), 6.0, np.eye(3)
    sides = [[*n, c], [*-n, -c]]
    plane = ([0.5, 0.2, 0.0], [[1, 0.3, 0.1], [0, 0.2, 1]])
    whole, one, other = (
        fixed_orientation(SIX_THREE, level, plane=plane, half_space=side, resolution=1.0).bracket
        for side in (None, *sides)
    )
    assert one[0] + other[0] <= whole[1]
    assert one[1] + other[1] >= whole[0]
    assert max(one[1], other[1]) < whole[0]
    rng = np.random.default_rng(3)
    region = fixed_orientation(SIX_THREE, level, half_space=sides[0], resolution=4.0)
    points = rng.uniform([-6, -6, 4], [6, 6, 13], (300, 3))
    codes = region.contains(points)
    kept = gsp.feasible(SIX_THREE, gsp.Pose(points, np.eye(3))).ok & (points @ n >= c)
    np.testing.assert_array_equal(codes[codes != 0] == 1, kept[codes != 0])
    assert 50 < kept.sum() < gsp.feasible(SIX_THREE, gsp.Pose(points, np.eye(3))).ok.sum()
    assert (codes != 0).mean() > 0.9
    assert (region.poses(50, rng=rng).position @ n >= c - 1e-12).all()


@pytest.mark.parametrize("bad", [[0, 0, 0, 1], [1, 0, 0], "up", [[0, 0, 1, 0]], [0, 0, np.nan, 1]])
def test_a_half_space_is_a_normal_and_a_number(bad):
    with pytest.raises(gsp.errors.InvalidInput, match="half_space"):
        fixed_orientation(SIX_THREE, half_space=bad)


HEXAPOD = gsp.hexapod(2, 20, 1, 30, 1.5, degrees=True, strokes=(1.2, 2.6))
MAXIMUM = 2.0 * float(gsp.indices.manipulability(HEXAPOD.at(HEXAPOD.home)))
LEVEL = ([0.0, 0.0, 1.5], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@pytest.mark.parametrize("name", BOUNDED)
def test_thresholds_of_all_indices_with_bounds_prove_cells(name):
    axes = gsp.Ellipsoid([1.0, 1.0, 1.0])
    index = gsp.indices.INDICES[name]
    given = {"length": 1.0, "ellipsoid": axes, "maximum": MAXIMUM}
    design = HEXAPOD.replace(characteristic_length=1.0, ellipsoid=axes)
    rng = np.random.default_rng(0)
    points = np.column_stack((rng.uniform(-1.2, 1.2, (400, 2)), np.full(400, 1.5)))
    pose = gsp.Pose(points)
    values = gsp.evaluate(design, pose, [name], maximum=MAXIMUM)[name].to_numpy()
    middle = float(np.median(values))
    sign = ">=" if index.better == "higher" else "<="
    limits = gsp.Limits(indices=f"{name} {sign} {middle!r}", **given)
    region = fixed_orientation(HEXAPOD, limits=limits, plane=LEVEL, resolution=0.1)
    codes = region.contains(points)
    good = values >= middle if sign == ">=" else values <= middle
    joints = HEXAPOD.at(pose).joints
    feasible = good & ((joints >= 1.2) & (joints <= 2.6)).all(axis=1)
    assert (codes[feasible] >= 0).all()
    assert (codes[~feasible] <= 0).all()
    assert (codes[feasible] == 1).mean() > 0.5


def test_a_threshold_of_a_share_is_that_of_the_whole():
    share = gsp.Limits(indices="λ >= 0.25", maximum=MAXIMUM)
    whole = gsp.Limits(indices=f"|det J| >= {0.25 * MAXIMUM!r}")
    one, two = (
        fixed_orientation(HEXAPOD, limits=limits, plane=LEVEL, resolution=0.2)
        for limits in (share, whole)
    )
    assert one.area == pytest.approx(two.area, rel=1e-12)
    assert one.area[0] > 0.0
    assert one.worst("λ", maximum=MAXIMUM).value >= 0.25


def unbounded(question, limits):
    turns = gsp.PoseBox([0, 0, 0], [(-0.1, 0.1)] * 3)
    return {
        "fixed": lambda: fixed_orientation(HEXAPOD, limits=limits, plane=LEVEL),
        "dextrous": lambda: dextrous(HEXAPOD, turns, limits, plane=LEVEL),
        "reachable": lambda: reachable(HEXAPOD, limits, plane=LEVEL, rotations=turns),
        "orientations": lambda: orientations(HEXAPOD, [0, 0, 1.5], limits, budget=50_000),
    }[question]()


@pytest.mark.parametrize("question", ["fixed", "dextrous", "reachable", "orientations"])
def test_limits_without_bounds_leave_open_what_the_others_allow(question):
    # One that all poses meet: the other limits decide what is outside, and nothing is inside.
    limits = gsp.Limits(indices="σ_t >= 0")
    region, other = unbounded(question, limits), unbounded(question, None)
    size = "volume" if question == "orientations" else "area"
    assert getattr(region, size)[0] == 0.0
    assert getattr(region, size)[1] == pytest.approx(getattr(other, size)[1], rel=0.1)
    assert region.nodes <= 2 * other.nodes
    middles = 0.5 * (other.low + other.high)
    codes, known = region.contains(middles), other.contains(middles)
    assert (codes <= 0).all()
    assert (codes[known == 1] == 0).all()


def test_more_is_proven_inside_with_rotations_that_are_climbed(monkeypatch):
    """With the middles of rotation cells alone it is a quarter, for legs other than SPS."""
    rng = np.random.default_rng(3)
    a, b = rng.uniform(-1, 1, (6, 3)), rng.uniform(-0.6, 0.6, (6, 3))
    u, v = rng.standard_normal((2, 6, 3))
    home = gsp.Pose([0.1, 0.0, 1.5])
    bare = gsp.Design(["D1", "D1", "D2", "D3", "D4", "A1"], a, b, u, v, home=home)
    joints = bare.at(home).joints
    wide = np.where(bare.angular, 0.3, 0.3 * np.abs(joints))
    strokes = np.stack((joints - wide, joints + wide), axis=1)
    limits = gsp.Limits(strokes=strokes, position=[(-2, 2), (-2, 2), (-0.5, 3.5)])
    plane = (home.position, [[1, 0, 0], [0, 0, 1]])

    def region():
        return gsp.workspace.reachable(bare, limits, plane=plane, budget=500_000, progress=False)

    found = region()
    nobody = np.zeros(0, dtype=np.intp)
    monkeypatch.setattr(deciding, "witnessed", lambda *_: nobody)
    assert found.area[0] > 2.0 * region().area[0] > 0.0
    inside = found.codes == 1
    middles = 0.5 * (found.low + found.high)[inside]
    points = found.problem.outward(np.pad(middles, ((0, 0), (0, 1))))[:5]
    assert found_by_samples(bare, points, *strokes.T, rng, starts=2000).all()
