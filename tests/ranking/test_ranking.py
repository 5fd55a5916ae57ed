"""evaluate() and rank() against plain loops."""

import tracemalloc
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
import scipy.sparse

import gsp
from gsp.errors import InvalidInput, MissingParameter, UnknownIndex
from gsp.evaluation import request
from gsp.indices import INDICES
from gsp.ranking.tables import statistics
from tests import driven
from tests.support import random_design, random_pose

ELLIPSOID = gsp.Ellipsoid([0.5, 0.7, 0.4])
GIVEN = {"length": 0.8, "ellipsoid": ELLIPSOID, "maximum": 2.0}
CORE = [
    "condition_number",
    "condition_number_ellipsoid",
    "control_number",
    "quality_index",
    "manipulability",
    "minimum_singular_value",
]
STATISTICS = ("mean", "min", "q05", "median", "q95", "max")


def some_designs(n=4):
    rng = np.random.default_rng(0)
    names = ["D1^6", "D1 D2 D3 D4 A1^2", "D2^2 D3^4", "D4^3 A1^3"]
    return [
        random_design(rng, [leg.name for leg in gsp.catalogue.mechanism(m).legs], name=f"{m} {i}")
        for i, m in zip(range(n), names * n, strict=False)
    ]


def one_class():
    """Return four designs without angular actuators: their |det J| have one unit."""
    rng = np.random.default_rng(5)
    names = ["D1^6", "D1^3 D2^3", "D2^2 D3^4", "D4^3 D1^3"]
    return [
        random_design(rng, [leg.name for leg in gsp.catalogue.mechanism(m).legs], name=m)
        for m in names
    ]


def poses(shape=(50,), seed=1):
    return random_pose(np.random.default_rng(seed), shape)


def undefined_and_singular(design, pose):
    """The poses, with pose 3 undefined for leg 1 of the design."""
    positions = pose.position.copy()
    positions[3] -= design.at(pose).lines.d[3, 0]
    return gsp.Pose(positions, pose.rotation)


def plain(design, pose, name):
    """One pose after the other."""
    record = INDICES[name]
    given = {key: GIVEN[key] for key in record.parameters}
    flat = pose.reshape(pose.size)
    return np.array([float(record.function(design.at(flat[i]), **given)) for i in range(pose.size)])


def test_evaluate_is_the_plain_loop():
    for design in some_designs():
        frame = gsp.evaluate(design, poses(), CORE, **GIVEN)
        assert list(frame) == CORE
        for name in CORE:
            np.testing.assert_allclose(frame[name], plain(design, poses(), name), rtol=1e-9)


@pytest.mark.parametrize("design", some_designs(), ids=lambda d: d.name)
def test_one_undefined_pose_changes_no_other_row(design):
    one = gsp.evaluate(design, poses(), CORE, **GIVEN)
    two = gsp.evaluate(design, undefined_and_singular(some_designs()[0], poses()), CORE, **GIVEN)
    assert two.loc[3].isna().all() == (design.name == "D1^6 0")
    pd.testing.assert_frame_equal(one.drop(index=3), two.drop(index=3), check_exact=True)


def test_rows_are_numbered_like_the_batch():
    design = some_designs(1)[0]
    flat = gsp.evaluate(design, poses((24,)), CORE, **GIVEN)
    assert list(flat.index) == list(range(24))
    nested = gsp.evaluate(design, poses((24,)).reshape(4, 3, 2), CORE, **GIVEN)
    assert nested.index.names == ["pose_0", "pose_1", "pose_2"]
    assert nested.index[7] == tuple(map(int, np.unravel_index(7, (4, 3, 2))))
    np.testing.assert_array_equal(nested.to_numpy(), flat.to_numpy())
    one = gsp.evaluate(design, poses(()), CORE, **GIVEN)
    assert one.shape == (1, len(CORE))


def test_attrs():
    design = some_designs(1)[0].replace(unit="m")
    pose = undefined_and_singular(design, poses())
    frame = gsp.evaluate(design, pose, CORE, **GIVEN)
    assert frame.attrs["undefined"] == 1
    assert frame.isna().all(axis=1).sum() == 1
    assert (frame.attrs["length"], frame.attrs["maximum"], frame.attrs["unit"]) == (0.8, 2.0, "m")
    assert frame.attrs["ellipsoid"]["semi_axes"] == [0.5, 0.7, 0.4]
    assert frame.attrs["library"] == f"gsp {gsp.__version__}"
    table = gsp.rank(some_designs(), pose, CORE, by="control_number", **GIVEN)
    assert table.attrs["by"] == "control_number"
    assert table.attrs["indices"] == CORE
    assert table.attrs["poses"] == 50


def test_rank_is_the_plain_summary():
    designs, pose = some_designs(), poses()
    pose = undefined_and_singular(designs[0], pose)
    table = gsp.rank(designs, pose, CORE, **GIVEN).set_index("design")
    for design in designs:
        row = table.loc[design.name]
        assert row["mechanism"] == design.mechanism.name
        assert row["class"] == design.mechanism.group
        assert row["n_legs"] == design.n_legs
        undefined = np.zeros(50, dtype=bool)
        for name in CORE:
            values = plain(design, pose, name)
            undefined |= np.isnan(values)
            known = np.sort(values[~np.isnan(values)])
            middle = (len(known) - 1) / 2
            assert row[f"{name}_mean"] == pytest.approx(known.mean(), rel=1e-9)
            for statistic, place in (("min", 0), ("q05", 0.05), ("q95", 0.95), ("max", 1)):
                value = known[round(place * (len(known) - 1))]
                assert row[f"{name}_{statistic}"] == pytest.approx(value, rel=1e-9)
            around = known[[int(np.floor(middle)), int(np.ceil(middle))]]
            assert np.isclose(row[f"{name}_median"], around, rtol=1e-9).any()
        assert row["undefined"] == undefined.mean() == (0.02 if design is designs[0] else 0.0)
        assert row["singular"] == 0.0


@pytest.mark.parametrize("by", CORE)
def test_direction_comes_from_the_record(by):
    table = gsp.rank(one_class(), poses(), CORE, by=by, **GIVEN)
    means = list(table[f"{by}_mean"])
    better = max if INDICES[by].better == "higher" else min
    assert all(better(a, b) == a for a, b in pairwise(means))
    assert list(table["rank"]) == [1, 2, 3, 4]


def ring(n=6):
    angle = np.arange(n) * 2 * np.pi / n
    return np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)


def special_designs():
    rng = np.random.default_rng(0)
    hexagon = gsp.Design(["D1"] * 6, ring(), ring(), name="singular")
    lines = np.tile([0.0, 0.0, 1.0], (6, 1))
    parallel = gsp.Design(["D4"] * 6, ring(), 2 * ring(), lines, lines, name="undefined")
    return [parallel, hexagon, random_design(rng, ["D1"] * 6, name="general")]


@pytest.mark.parametrize("by", CORE)
def test_singular_then_undefined_come_last(by):
    """At poses without rotation: one design is always singular and one never defined."""
    pose = gsp.Pose(np.random.default_rng(0).uniform(0.5, 1.5, (20, 3)))
    table = gsp.rank(special_designs(), pose, [by], **GIVEN)
    assert list(table["design"]) == ["general", "singular", "undefined"]
    assert list(table["rank"]) == [1, 2, 3]
    assert list(table["singular"]) == [0.0, 1.0, 0.0]
    assert list(table["undefined"]) == [0.0, 0.0, 1.0]
    worst = INDICES[by].worst
    assert (table.loc[1, [f"{by}_{s}" for s in STATISTICS]] == worst).all()
    assert table.loc[2, [f"{by}_{s}" for s in STATISTICS]].isna().all()


def test_some_singular_poses():
    """inf among the values makes the mean and the maximum inf and leaves the quantiles finite."""
    points = np.random.default_rng(0).uniform(-1, 1, (6, 3))
    design = gsp.Design(["D1"] * 6, points, points)
    angles = np.full((21, 3), 0.3)
    angles[0] = 0.0  # parallel legs
    pose, names = gsp.Pose.from_rpy([0, 0, 1], angles), ["condition_number", "control_number"]
    table = gsp.rank(design, pose, names, length=1.0)
    assert table.attrs["infinite_means"] == {"condition_number": 1}
    assert "infinite_means" not in gsp.rank(design, pose[1:], names, length=1.0).attrs
    row = table.iloc[0]
    assert row["singular"] == pytest.approx(1 / 21)
    assert np.isinf(row[["condition_number_mean", "condition_number_max"]].astype(float)).all()
    assert np.isfinite(row[["condition_number_median", "condition_number_q95"]].astype(float)).all()


def test_drives_have_a_column_if_a_design_has_some(tmp_path):
    designs = [driven.rotary().replace(name="r"), driven.hexaglide(), driven.mixed()]
    plain = gsp.Design(["D1"] * 6, driven.BASE, driven.PLATFORM, unit="m", name="plain")
    pose = designs[0].home
    table = gsp.rank([*designs, plain], pose, ["CTN"], length=1.0, parts=tmp_path / "parts")
    assert list(table.columns[:6]) == ["rank", "design", "mechanism", "class", "n_legs", "drives"]
    words = dict(zip(table["n_legs"].astype(str) + table["design"], table["drives"], strict=True))
    assert words == {
        "6r": "6 cranks",
        "6unnamed": "6 sliders",
        "7unnamed (2)": "2 sliders, 2 cranks",
        "6plain": "",
    }
    assert "drives" not in gsp.rank(plain, pose, ["CTN"], length=1.0)


def test_ties_share_a_rank():
    design = some_designs(1)[0]
    copies = [design.replace(name=n) for n in "ab"] + [some_designs()[2]]
    table = gsp.rank(copies, poses(), ["manipulability"])
    assert sorted(table["rank"]) in ([1, 1, 3], [1, 2, 2])


def test_quantiles_are_observed_values():
    column = np.arange(101.0)
    assert statistics(column[None]) == [[50.0, 0.0, 5.0, 50.0, 95.0, 100.0]]
    spoiled = np.concatenate((column, [np.nan] * 7))
    assert statistics(spoiled[None]) == [[50.0, 0.0, 5.0, 50.0, 95.0, 100.0]]
    assert statistics(np.array([[1.0, np.inf]]))[0][0] == np.inf
    assert np.isnan(statistics(np.full((2, 3), np.nan))).all()
    assert np.isnan(statistics(np.empty((2, 0)))).all()


@pytest.mark.parametrize("n", [1, 2, 7, 8, 9, 127, 129, 1000])
def test_statistics_of_several_indices_at_once_are_those_of_each(n):
    """To the last bit, the mean too, which is summed in pairs."""
    rng = np.random.default_rng(n)
    columns = np.exp(3.0 * rng.normal(size=(5, n)))
    columns[1, 0], columns[2], columns[3, -1] = np.inf, np.nan, np.nan
    each = [statistics(column[None].copy())[0] for column in columns]
    assert np.array_equal(statistics(columns.copy()), each, equal_nan=True)
    assert np.array_equal(statistics(columns[::4].copy()), each[::4])
    assert np.array_equal(statistics(np.asfortranarray(columns[::4])), each[::4])
    assert [row[0] for row in each[::4]] == [column.mean() for column in columns[::4]]


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 10, 11, 20, 31, 500, 1001, 4097])
def test_quantiles_are_those_of_the_sorted_numbers(n):
    """Also with repeated and infinite numbers, which the partitions move."""
    rng = np.random.default_rng(n)
    for digits in (16, 2, 1, 0):
        column = rng.random(n).round(digits)
        column[rng.random(n) < 0.2] = np.inf
        known = np.sort(column)
        places = np.rint(np.multiply((0.05, 0.5, 0.95), n - 1)).astype(int)
        assert statistics(column[None].copy())[0][1:] == [known[0], *known[places], known[-1]]


@pytest.mark.parametrize("block", [1, 7, 50])
@pytest.mark.parametrize("workers", [1, 3])
def test_blocks_and_workers_give_the_same_bits(monkeypatch, block, workers):
    pose = undefined_and_singular(some_designs()[0], poses())
    whole = gsp.rank(some_designs(), pose, CORE, workers=1, **GIVEN)
    single = gsp.evaluate(some_designs()[1], pose, CORE, workers=1, **GIVEN)
    monkeypatch.setattr(request, "POSES_PER_BLOCK", block)
    pd.testing.assert_frame_equal(
        gsp.rank(some_designs(), pose, CORE, workers=workers, **GIVEN), whole, check_exact=True
    )
    pd.testing.assert_frame_equal(
        gsp.evaluate(some_designs()[1], pose, CORE, workers=workers, **GIVEN),
        single,
        check_exact=True,
    )


def test_progress_counts_blocks(monkeypatch):
    monkeypatch.setattr(request, "POSES_PER_BLOCK", 20)
    calls = []
    gsp.rank(one_class(), poses(), ["manipulability"], progress=lambda *a: calls.append(a))
    assert calls == [(i, 12) for i in range(1, 13)]


def test_an_error_in_progress_ends_the_work():
    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gsp.rank(one_class(), poses(), ["manipulability"], progress=stop, workers=2)


def test_defaults_are_the_indices_that_can_be_had():
    design = some_designs(1)[0]
    plain_frame = gsp.evaluate(design, poses())
    assert {"control_number", "manipulability"} <= set(plain_frame)
    assert not {"condition_number", "condition_number_ellipsoid", "quality_index"} & set(
        plain_frame
    )
    full = gsp.evaluate(design, poses(), **GIVEN)
    assert set(CORE) <= set(full)
    recorded = design.replace(characteristic_length=0.8, ellipsoid=ELLIPSOID)
    np.testing.assert_array_equal(
        gsp.evaluate(recorded, poses(), CORE[:3]).to_numpy(), full[CORE[:3]].to_numpy()
    )
    cylindrical = some_designs()[2]
    assert "control_number" not in gsp.evaluate(cylindrical, poses())
    one = gsp.evaluate(design, poses(), "manipulability")
    assert list(one) == ["manipulability"]
    assert list(gsp.evaluate(design, poses(), ["manipulability"] * 2)) == ["manipulability"]


def test_maximum_of_the_sample():
    designs = some_designs()
    frame = gsp.evaluate(designs[0], poses(), ["quality_index", "manipulability"], maximum="sample")
    assert frame["quality_index"].max() == 1.0
    ratio = frame["manipulability"] / frame["manipulability"].max()
    np.testing.assert_allclose(frame["quality_index"], ratio, rtol=1e-15)
    table = gsp.rank(designs, poses(), ["quality_index"], maximum="sample")
    assert (table["quality_index_max"] == 1.0).all()
    never = gsp.rank(
        special_designs()[:2], gsp.Pose([[0.1, 0.2, 1]]), ["quality_index"], maximum="sample"
    )
    assert never["quality_index_max"].isna().all()  # 0/0, and an undefined posture


def test_maximum_per_design():
    designs, pose = some_designs(), poses()
    most = [1.0, 2.0, 4.0, 8.0]
    tables = [
        gsp.rank(designs, pose, ["quality_index", "manipulability"], maximum=m).set_index("design")
        for m in (most, np.array(most), {d.name: m for d, m in zip(designs, most, strict=True)})
    ]
    for table in tables:
        for design, m in zip(designs, most, strict=True):
            row = table.loc[design.name]
            assert row["quality_index_mean"] == pytest.approx(row["manipulability_mean"] / m)


BAD = {
    "design": ({"designs": [None]}, InvalidInput, r"design: expected a gsp\.Design"),
    "designs": ({"designs": [some_designs(1)[0], "x"]}, InvalidInput, r"designs\[1\]: exp"),
    "no designs": ({"designs": []}, InvalidInput, "designs: expected at least one design"),
    "none": ({"designs": None}, InvalidInput, r"designs: expected a gsp\.Design or"),
    "name": ({"designs": "toz-kucuk-2016-d3-6"}, InvalidInput, r"expected a gsp\.Design"),
    "pose": ({"pose": [0, 0, 1]}, InvalidInput, r"pose: expected a gsp\.Pose"),
    "no poses": ({"pose": gsp.Pose(np.zeros((0, 3)))}, InvalidInput, "pose: expected at least one"),
    "index": ({"indices": ["condition_numbr"]}, UnknownIndex, "nearest: condition_number"),
    "index symbol": ({"indices": ["CTM"]}, UnknownIndex, "nearest: CTN"),
    "index none": ({"indices": [None]}, UnknownIndex, "unknown index 'None'"),
    "index list": ({"indices": [["control_number"]]}, UnknownIndex, "unknown index"),
    "index number": ({"indices": 5}, InvalidInput, "indices: expected names of indices"),
    "indices that cannot be iterated": (
        {"indices": scipy.sparse.eye(3)},
        InvalidInput,
        "indices: expected names of indices",
    ),
    "no index": ({"indices": []}, InvalidInput, "indices: expected at least one name"),
    "length needed": (
        {"indices": ["condition_number"]}, MissingParameter, "condition_number: expected length=",
    ),
    "length for legs": ({"indices": ["control_number"]}, MissingParameter, "design 'D1 D2 D3 D4"),
    "ellipsoid needed": (
        {"indices": ["condition_number_ellipsoid"]}, MissingParameter, "expected ellipsoid=",
    ),
    "length": ({"length": -1}, InvalidInput, "length: expected a positive number, received -1"),
    "length text": ({"length": "long"}, InvalidInput, "length: expected a positive number"),
    "ellipsoid": ({"ellipsoid": (1, 2, 3)}, InvalidInput, r"ellipsoid: expected a gsp\.Ellipsoid"),
    "maximum": ({"maximum": 0}, InvalidInput, "maximum: expected a positive number"),
    "maximum text": ({"maximum": "most"}, InvalidInput, "maximum: expected a number or \"sample\""),
    "maximum nan": ({"maximum": np.nan}, InvalidInput, "maximum: expected a positive number"),
    "maxima": ({"maximum": [1.0]}, InvalidInput, "expected one per design, 4 in all, received 1"),
    "maximum map": ({"maximum": {"x": 1.0}}, MissingParameter, "for design 'D1.6 0'.: expected"),
    "workers": ({"workers": 0}, InvalidInput, "workers: expected an integer ≥ 1"),
    "workers float": ({"workers": 2.0}, InvalidInput, "workers: expected an integer ≥ 1"),
    "progress": ({"progress": "bar"}, InvalidInput, "progress: expected a function"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name):
    given, kind, message = BAD[name]
    given = {"designs": some_designs(), "pose": poses(), "indices": ["manipulability"], **given}
    with pytest.raises(kind, match=message):
        gsp.rank(**given)
    if "designs" not in BAD[name][0] and name not in ("maxima", "maximum map"):
        designs = given.pop("designs")
        with pytest.raises(kind, match=message):
            gsp.evaluate(designs[1], **given)


@pytest.mark.parametrize("by", ["control_number", "x", None, ["manipulability"], 5])
def test_bad_by(by):
    if by is None:
        assert (
            gsp.rank(one_class(), poses(), ["manipulability"], by).attrs["by"] == "manipulability"
        )
        return
    with pytest.raises((InvalidInput, UnknownIndex)):
        gsp.rank(some_designs(), poses(), ["manipulability"], by)


def test_an_index_that_is_not_routine_is_computed_if_it_decides():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    table = gsp.rank(design, design.home, by="rigidity_rate")
    assert table.attrs["by"] == "rigidity_rate"
    assert "condition_number" in table.attrs["indices"]
    with pytest.raises(MissingParameter, match="length"):
        gsp.rank(design.replace(characteristic_length=None), design.home, by="CDN_CL")


@pytest.mark.parametrize(
    "given",
    [
        {"indices": ["quality_index", "typo"]},
        {"by": "typo"},
        {"backend": "typo"},
    ],
    ids=str,
)
def test_mistakes_are_reported_before_the_computation(monkeypatch, given):
    """Looking for a maximum of |det J| takes seconds; a wrong name must not wait for it."""

    def search(design):
        raise AssertionError("the search has begun")

    monkeypatch.setattr(gsp.determinant, "maximum", search)
    with pytest.raises(gsp.GspError, match="typo"):
        gsp.rank(some_designs(), poses(), **{"indices": ["quality_index"], **given})


def peak_memory(n_designs):
    (design,) = some_designs(1)
    designs = [design.replace(name=f"design {i}") for i in range(n_designs)]
    tracemalloc.start()
    try:
        gsp.rank(
            designs, poses((4000,)), ["manipulability", "condition_number"], length=1.0, workers=1
        )
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_memory_does_not_grow_with_the_designs():
    """Two designs of so many poses are evaluated at once."""
    peak_memory(1)
    assert peak_memory(16) < 1.1 * peak_memory(4)


def test_the_whole_catalogue():
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    designs = [gsp.catalogue.instantiate(m, template) for m in gsp.catalogue.mechanisms()]
    box = gsp.PoseBox.around(template.home, [20, 20, 20, 0.2, 0.2, 0.2])
    ellipsoid = gsp.Ellipsoid([100.0, 100.0, 30.0])
    pose = box.sample(8, rng=0)
    table = gsp.rank(designs, pose, by="control_number", ellipsoid=ellipsoid, maximum="sample")
    assert len(table) == table["mechanism"].nunique() == 195
    assert table["rank"].is_monotonic_increasing
    assert (table["rank"].iloc[0], table["undefined"].max()) == (1, 0.0)
    known = table[~table["control_number_mean"].isna()]
    assert known["control_number_mean"].is_monotonic_decreasing
    assert table["control_number_max"].between(0.0, 1.0).all()
    assert (table["condition_number_min"] >= 1.0).all()
    assert (table["quality_index_max"].isin([1.0, 0.0])).all()
