"""Maps of indices are drawn with the values, the cells and the units of the map."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

import gsp
from gsp.errors import InvalidInput
from gsp.plots.workspace import index_map
from tests.plots.ink import assert_ink, overlaps

COUNTS = (5, 4, 3, 3, 2, 1)
NAMES = ["control_number", "manipulability"]


@pytest.fixture(scope="module")
def mapped(platform):
    box = gsp.PoseBox([(-6, 6), (-6, 6), (5, 11)], [(-20, 20), (-10, 10), 5], degrees=True)
    design = platform.replace(unit="mm")
    return gsp.workspace.index_map(design, box, COUNTS, NAMES, length=7.5)


def drawn(ax):
    """The values of the cells, (n, m), and their corners, (n + 1, m + 1, 2)."""
    (mesh,) = ax.collections
    return np.ma.filled(mesh.get_array(), np.nan).T, np.swapaxes(mesh.get_coordinates(), 0, 1)


def bar(ax):
    return next(other for other in ax.figure.axes if other is not ax)


def test_a_slice_has_the_values_of_its_nodes_within_their_cells(mapped):
    ax = index_map(mapped, "CTN", ("x", "z"), at={"y": 2, "roll": 1, "pitch": 0})
    values, corners = drawn(ax)
    expected = mapped.values["control_number"][:, 2, :, 1, 0, 0]
    assert 0 < np.isnan(expected).sum() < expected.size
    np.testing.assert_array_equal(values, expected)
    place = mapped.pose.position[:, 2, :, 1, 0, 0][..., [0, 2]]
    assert (corners[:-1, :-1] <= place).all()
    assert (place <= corners[1:, 1:]).all()
    np.testing.assert_allclose(corners[:, 0, 0], [-6.0, -4.5, -1.5, 1.5, 4.5, 6.0])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [mm]", "z [mm]")
    assert bar(ax).get_ylabel() == "CTN"
    title = f"{mapped.design.name}; y = 2, pitch = -10°, yaw = 5°"
    assert ax.get_title(loc="left") == title
    assert not overlaps(ax)
    assert_ink(ax.figure)


@pytest.mark.parametrize("value", ["worst", "mean"])
def test_a_cell_shows_the_worst_or_the_mean_of_its_poses(mapped, value):
    ax = index_map(mapped, "manipulability", ("roll", "x"), value=value)
    values, corners = drawn(ax)
    table, weight = mapped.values["manipulability"], mapped.weight
    for i in range(3):
        for j in range(5):
            known = table[j, :, :, i][mapped.feasible[j, :, :, i]]
            share = weight[j, :, :, i][mapped.feasible[j, :, :, i]]
            if known.size:
                one = known.min() if value == "worst" else np.average(known, weights=share)
                assert values[i, j] == pytest.approx(one, rel=1e-12)
            else:
                assert np.isnan(values[i, j])
    np.testing.assert_allclose(corners[:, 0, 0], [-20.0, -10.0, 10.0, 20.0])
    assert ax.get_xlabel() == "roll [°]"
    assert "[mm" in bar(ax).get_ylabel()
    assert type(ax.collections[0].norm).__name__ == "LogNorm"
    assert ax.get_title(loc="left").endswith(f"{value} over y, z, pitch")
    assert_ink(ax.figure)


def test_the_worst_of_an_index_of_which_less_is_better_is_the_greatest(platform):
    box = gsp.PoseBox([(-2, 2), (-2, 2), (7, 9)], [0, 0, 0])
    found = gsp.workspace.index_map(platform, box, (3, 3, 3, 1, 1, 1), ["CDN_CL"], length=7.5)
    values, _ = drawn(index_map(found))
    np.testing.assert_array_equal(values, found.values["condition_number"].max(axis=(2, 3, 4, 5)))


def test_feasible_cells_without_a_value_are_hatched_and_infeasible_ones_white(mapped):
    table = mapped.values["control_number"].copy()
    table[2] = np.nan
    ax = index_map(replace(mapped, values={"control_number": table}), over=("x", "y"))
    hatched = [patch.get_xy()[:4].mean(axis=0) for patch in ax.patches]
    feasible = mapped.feasible[2].any(axis=(1, 2, 3, 4))
    assert len(hatched) == feasible.sum() > 0
    np.testing.assert_allclose([x for x, _ in hatched], 0.0, atol=1e-12)
    assert all(patch.get_hatch() for patch in ax.patches)
    entries = [text.get_text() for text in ax.get_legend().get_texts()]
    assert entries == ["feasible, index undefined", "infeasible"]
    assert not overlaps(ax)


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0.25, "constant: 0.25"),
        (np.nan, "CTN is undefined at every pose"),
        (np.inf, "CTN is infinite at every pose"),
    ],
)
def test_a_constant_and_an_undefined_index_are_stated(mapped, number, text):
    table = np.where(mapped.feasible, number, np.nan)
    ax = index_map(replace(mapped, values={"control_number": table}))
    assert [note.get_text() for note in ax.texts] == [text]
    assert len(ax.get_yticks()) > 1
    assert len(ax.figure.axes) == 1
    assert_ink(ax.figure)


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"index": "CDN_CL"}, "indices"),
        ({"index": ["CTN"]}, "index"),
        ({"over": ("x", "x")}, "two of x, y, z, roll, pitch"),
        ({"over": ("x", "yaw")}, "two of x, y, z, roll, pitch"),
        ({"over": "xyz"}, "over"),
        ({"over": 3}, "over"),
        ({"at": {"x": 1}}, "some of z, roll, pitch, yaw"),
        ({"at": {"z": 3}}, "an integer below 3"),
        ({"at": {"z": 0.5}}, "at"),
        ({"at": [1]}, "at"),
        ({"value": "best"}, "value"),
        ({"mapped": 1}, "mapped"),
        ({"worst": 1}, "as Region.worst returns it"),
        ({"worst": gsp.workspace.Worst(value=1.0, bound=1.0, pose=None, closed=True)}, "None for"),
    ],
)
def test_wrong_arguments(mapped, options, match):
    with pytest.raises(InvalidInput, match=match):
        index_map(**{"mapped": mapped, **options})


def test_a_map_along_a_line_is_refused(platform):
    box = gsp.PoseBox([(-2, 2), 0, 8], [0, 0, 0])
    line = gsp.workspace.index_map(platform, box, (3, 1, 1, 1, 1, 1), ["CTN"], length=7.5)
    with pytest.raises(InvalidInput, match="two coordinates, received x"):
        index_map(line)


@pytest.fixture(scope="module")
def sampled(platform):
    plane = ([0, 0.5, 0], [[1, 0.2, 0], [0, 0, 1]])
    box = gsp.PoseBox([0, 0, 0], [(-20, 20), (-10, 10), 5], degrees=True)
    design = platform.replace(unit="mm")
    region = gsp.workspace.reachable(design, plane=plane, rotations=box, resolution=2.0)
    return region.index_sample(NAMES, 2000, length=7.5)


@pytest.mark.parametrize("value", ["worst", "mean"])
@pytest.mark.parametrize("index", NAMES)
def test_cells_of_a_sample_have_the_values_of_the_poses_within(sampled, value, index):
    ax = index_map(sampled, index, value=value)
    values, corners = drawn(ax)
    problem = sampled.region.problem
    place = (sampled.pose.position - problem.origin) @ problem.frame[:2].T
    counted = 0
    for i, j in np.ndindex(values.shape):
        low, high = corners[i, j], corners[i + 1, j + 1]
        inside = ((place >= low) & (place < high)).all(axis=1)
        known = sampled.values[index][inside]
        counted += known.size
        if known.size:
            one = known.min() if value == "worst" else known.mean()
            assert values[i, j] == pytest.approx(one, rel=1e-12)
        else:
            assert np.isnan(values[i, j])
    assert counted >= 1990  # those on the last edges count in the last cells
    assert 40 <= np.isfinite(values).sum() <= 200
    assert ax.get_xlabel().startswith("along (0.981")
    assert ax.get_ylabel() == "z [mm]"
    assert ax.get_title() == ax.get_title().strip()
    assert "in each cell, 2000 poses" in ax.get_title()
    assert not overlaps(ax)
    assert_ink(ax.figure)


def test_cells_of_a_sample_end_at_the_outline_which_the_legend_explains(sampled):
    ax = index_map(sampled, NAMES[0])
    path = ax.collections[0].get_clip_path().get_fully_transformed_path()
    places = np.random.default_rng(4).uniform(*sampled.region.extents[1], (500, 2))
    shown = path.contains_points(ax.transData.transform(places))
    # But for undecided bays that are narrower than the line of the outline.
    inside = sampled.region.polygons().inside
    off = shapely.distance(inside, shapely.points(places[shown]))
    assert off.max() < 0.01 * np.ptp(places, axis=0).max()
    assert shown[shapely.contains_xy(inside, places)].all()
    entries = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "outline of what is proven inside" in entries
    # Cells at the ends of the region have no pose: some places inside are in one of them.
    values, corners = drawn(ax)
    inner = places[shapely.contains_xy(inside, places)]
    ends = corners[:, 0, 0], corners[0, :, 1]
    cells = [np.searchsorted(e, x) - 1 for e, x in zip(ends, inner.T, strict=True)]
    assert np.isnan(values[tuple(cells)]).any()
    assert "no pose was drawn" in entries


@pytest.mark.parametrize("index", NAMES)
def test_the_worst_pose_is_marked_and_its_value_is_in_the_legend(sampled, index):
    values = sampled.values[index]
    k = np.nanargmin(values)
    problem = sampled.region.problem
    for found, number, pose in (
        (None, values[k], sampled.pose[k]),
        (
            gsp.workspace.Worst(
                value=0.5 * values[k], bound=0.0, pose=(other := sampled.pose[0]), closed=False
            ),
            0.5 * values[k],
            other,
        ),
        (
            gsp.workspace.Worst(value=2.0 * values[k], bound=0.0, pose=other, closed=False),
            values[k],
            sampled.pose[k],
        ),
    ):
        ax = index_map(sampled, index, worst=found)
        entries = [text.get_text() for text in ax.get_legend().get_texts()]
        assert f"worst found: {number:.4g}" in entries
        (mark,) = ax.lines
        place = (pose.position - problem.origin) @ problem.frame[:2].T
        np.testing.assert_allclose(mark.get_xydata()[0], place, atol=1e-12)
    assert not index_map(sampled, index, value="mean").lines


def test_samples_are_drawn_over_other_coordinates(sampled):
    ax = index_map(sampled, over=("v", "roll"))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("z [mm]", "roll [°]")
    assert not ax.patches
    for options in ({"over": ("u", "yaw")}, {"over": ("u", "u")}, {"over": 3}, {"at": {"x": 1}}):
        with pytest.raises(InvalidInput, match=r"two of u, v, roll, pitch, rec|None for a sample"):
            index_map(sampled, **options)


def test_undefined_values_of_a_sample_are_hatched(sampled):
    table = np.where(sampled.pose.position[:, 2] > 8.0, np.nan, sampled.values[NAMES[0]])
    ax = index_map(replace(sampled, values={NAMES[0]: table}))
    hatched = [patch for patch in ax.patches if patch.get_hatch()]
    assert len(hatched) > 5
    assert ax.get_legend().get_texts()[0].get_text() == "feasible, index undefined"
    assert not overlaps(ax)
