"""What a ranking compares: units, lengths, sizes, strokes, feasible poses."""

import json

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.catalogue import design, instantiate, mechanism
from gsp.errors import InvalidInput, MissingParameter
from tests.support import random_design, random_pose

PRESS = design("toz-kucuk-2016-d3-6")
POSE = gsp.PoseBox.around(PRESS.home, [20, 20, 20, 0.2, 0.2, 0.2]).sample(300, rng=4)


def test_determinants_have_the_unit_of_the_design_with_any_length():
    """The largest |det J| of a table is a maximum that λ can be given."""
    for legs in (["D1"] * 6, ["D4 A1", "D4 A1", "D3", "D2"], ["D4 A1"] * 3):
        rng = np.random.default_rng(len(legs))
        one, pose = random_design(rng, legs, unit="m", name="x"), random_pose(rng, (40,))
        wanted = np.abs(np.linalg.det(one.at(pose).jacobian))
        for length in (None, 0.01, 0.8, 300.0, 1e6):
            frame = gsp.evaluate(one, pose, "manipulability", length=length)
            np.testing.assert_allclose(frame["manipulability"], wanted, rtol=1e-9)
            ratio = gsp.evaluate(one, pose, "λ", length=length, maximum=wanted.max())
            np.testing.assert_allclose(
                ratio["quality_index"], wanted / wanted.max(), rtol=1e-9, atol=1e-15
            )
        power = 3 - one.mechanism.counts[4]
        assert frame.attrs["units"] == {"manipulability": {3: "m^3", 1: "m", 0: "1"}[power]}


def test_names_symbols_and_all():
    frame = gsp.evaluate(PRESS, PRESS.home, ["CTN", "λ", "control_number"], maximum="sample")
    assert list(frame) == ["control_number", "quality_index"]
    assert list(gsp.evaluate(PRESS, PRESS.home, "CTN, CDN_CL")) == [
        "control_number",
        "condition_number",
    ]
    ellipsoid = gsp.Ellipsoid(50.0)
    every = gsp.evaluate(PRESS, PRESS.home, "all", ellipsoid=ellipsoid, maximum="sample")
    assert list(every) == list(gsp.indices.INDICES)
    assert gsp.rank(PRESS, POSE, "all", "ctn", ellipsoid=ellipsoid, maximum="sample").attrs[
        "by"
    ] == ("control_number")


def test_error_of_unlike_units_names_the_way_to_convert():
    metres = PRESS.scaled(1e-3).replace(unit="m", name="metres")
    with pytest.raises(InvalidInput, match=r"'mm' .* and 'm' \(metres\)") as refusal:
        gsp.rank([PRESS, metres], POSE, "CTN")
    assert "in_unit(design, unit)" in str(refusal.value)
    back = metres.scaled(1e3).replace(unit="mm", name="back")
    table = gsp.rank([PRESS, back], POSE, "CTN")
    np.testing.assert_allclose(*table["control_number_mean"], rtol=1e-12)
    assert table.attrs["unit"] == "mm"
    assert gsp.rank([PRESS, PRESS.replace(unit="")], POSE, "CTN").attrs["unit"] == "mm"


def test_determinants_of_unlike_units_do_not_decide():
    mixed = [instantiate(mechanism(name), PRESS) for name in ("D1^6", "D1^4 A1^2")]
    with pytest.raises(InvalidInput, match=r"manipulability in mm\^3, mm"):
        gsp.rank(mixed, POSE, "|det J|")
    table = gsp.rank(mixed, POSE, ["CTN", "|det J|"])
    assert table.attrs["units"]["manipulability"] == "mm^3, mm"
    assert gsp.rank(mixed[:1] * 2, POSE, "|det J|").attrs["units"]["manipulability"] == "mm^3"


def test_differences_are_recorded():
    small = PRESS.scaled(0.5).replace(name="small")
    table = gsp.rank([PRESS, small], POSE, "CDN_CL")
    assert table.attrs["sizes"] == [small.rms_radius, PRESS.rms_radius]
    assert table.attrs["lengths"] == {PRESS.name: 95.0, "small": 47.5}
    assert table.attrs["length"] is None
    assert "lengths" not in gsp.rank([PRESS, small], POSE, "CDN_CL", length=95.0).attrs


STROKES = np.array([[115.0, 160.0]] * 6)
SHORT = PRESS.replace(strokes=STROKES, name="short")


def within(one, pose):
    joints = one.at(pose).joints
    return ((joints >= STROKES[:, 0]) & (joints <= STROKES[:, 1])).all(axis=-1)


def test_shares_within_strokes_are_counted_for_each_design():
    table = gsp.rank([SHORT, PRESS], POSE, "CTN").set_index("design")
    share = within(SHORT, POSE).mean()
    assert 0.05 < share < 0.95
    assert table.loc["short", "within_strokes"] == share
    assert np.isnan(table.loc[PRESS.name, "within_strokes"])
    assert table.loc["short", "control_number_mean"] == table.loc[PRESS.name, "control_number_mean"]
    assert "within_strokes" not in gsp.rank(PRESS, POSE, "CTN")


@pytest.mark.parametrize("workers", [1, 2])
def test_feasible_poses_only(workers, monkeypatch):
    monkeypatch.setattr("gsp.evaluation.request.POSES_PER_BLOCK", 70)
    given = {"indices": ["CTN", "λ"], "maximum": "sample", "workers": workers}
    table = gsp.rank(SHORT, POSE, limits=gsp.Limits(), **given)
    kept = POSE[np.flatnonzero(within(SHORT, POSE))]
    plain = gsp.rank(SHORT, kept, **given)
    columns = [c for c in plain if c not in ("within_strokes", "feasible")]
    pd.testing.assert_frame_equal(table[columns], plain[columns], check_exact=True)
    assert table["feasible"].tolist() == table["within_strokes"].tolist() == [len(kept) / 300]
    given["limits"] = gsp.Limits(strokes=[[1.0, 2.0]] * 6)
    nothing = gsp.rank(SHORT, POSE, **given).iloc[0]
    assert nothing["feasible"] == 0.0
    assert np.isnan([nothing["control_number_mean"], nothing["singular"]]).all()


def test_feasible_poses_need_limits():
    with pytest.raises(gsp.GspError, match="expected strokes or other limits"):
        gsp.rank([SHORT, PRESS], POSE, "CTN", limits=gsp.Limits())
    with pytest.raises(gsp.GspError, match="limits"):
        gsp.rank(SHORT, POSE, "CTN", limits=STROKES)


def test_rows_are_kept_in_a_folder(tmp_path):
    designs = [instantiate(mechanism(name), PRESS) for name in ("D1^6", "D2^6", "D3^6")]

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    given = {"indices": "CTN", "limits": gsp.Limits(indices=["CTN >= 0.05"]), "workers": 1}
    folder = tmp_path / "kept"
    with pytest.raises(KeyboardInterrupt):
        gsp.rank(designs, POSE, parts=folder, progress=stop, **given)
    assert len(list(folder.glob("part-*.json"))) == 1
    with pytest.raises(gsp.GspError, match="interrupted; resume it"):
        gsp.rank(designs, POSE, parts=folder, **given)
    other = {**given, "limits": gsp.Limits(indices=["CTN >= 0.06"])}
    with pytest.raises(gsp.GspError, match="another run"):
        gsp.rank(designs, POSE, parts=folder, resume=True, **other)
    calls = []
    table = gsp.rank(
        designs, POSE, parts=folder, resume=True, progress=lambda *c: calls.append(c), **given
    )
    assert calls == [(2, 3), (3, 3)]
    pd.testing.assert_frame_equal(table, gsp.rank(designs, POSE, **given), check_exact=True)
    assert not folder.exists()


def test_designs_of_one_name_have_distinct_names_in_the_table():
    twice = [PRESS.scaled(k).replace(unit="mm", name="press") for k in (1.0, 1.1, 1.2)]
    other = PRESS.replace(name="press (2)")
    table = gsp.rank([*twice, other], PRESS.home, "CTN")
    assert set(table["design"]) == {"press", "press (3)", "press (4)", "press (2)"}
    assert table.attrs["renamed"] == {"press (3)": "press", "press (4)": "press"}
    assert set(table.attrs["lengths"]) == set(table["design"])
    alone = gsp.rank(twice[1], PRESS.home, "CTN")["control_number_mean"].item()
    row = table.loc[table["design"] == "press (3)", "control_number_mean"]
    assert row.item() == alone
    unnamed = gsp.rank([PRESS.replace(name="")] * 2, PRESS.home, "CTN")
    assert unnamed["design"].tolist() == ["unnamed", "unnamed (2)"]
    assert "renamed" not in gsp.rank([PRESS, twice[0]], PRESS.home, "CTN").attrs


def test_a_mapping_of_maxima_keeps_the_names_of_the_designs():
    table = gsp.rank([PRESS, PRESS], PRESS.home, "λ", maximum={PRESS.name: 1e7})
    assert table["quality_index_mean"].nunique() == 1


def test_designs_without_a_unit_beside_others_are_recorded():
    without = PRESS.replace(unit="", name="without")
    assert gsp.rank([PRESS, without], PRESS.home, "CTN").attrs["unitless"] == ["without"]
    for same in ([PRESS, PRESS.replace(name="other")], [without, without.replace(name="other")]):
        assert "unitless" not in gsp.rank(same, PRESS.home, "CTN").attrs


def test_the_record_of_limits_is_that_of_their_values():
    """Two limits have one record if and only if their values are the same."""
    from gsp.ranking.restrictions import limits_record

    sphere = gsp.Ellipsoid((1.0, 2.0, 3.0))
    changes = {
        "strokes": [[1.0, 2.0]] * 6, "base_cone": 0.5, "platform_cone": [0.5] * 6,
        "base_axes": [[0, 0, 1]] * 6, "platform_axes": [[0, 1, 1]] * 6, "leg_radius": 2.0,
        "position": [(0, 1), None, (None, 3)], "indices": "CTN >= 0.1", "length": 3.0,
        "ellipsoid": sphere, "maximum": 7.0,
    }  # fmt: skip
    records = [limits_record(gsp.Limits(**{key: value})) for key, value in changes.items()]
    texts = [
        json.dumps(record, sort_keys=True)
        for record in [None, limits_record(gsp.Limits()), *records]
    ]
    assert len(set(texts)) == len(texts)
    tiny = [limits_record(gsp.Limits(leg_radius=x)) for x in (0.1, np.nextafter(0.1, 1))]
    assert tiny[0] != tiny[1]
    one, two = gsp.Limits(indices="CTN>=0.10"), gsp.Limits(indices=["control_number >= 0.1"])
    assert limits_record(one) == limits_record(two)
    with np.printoptions(precision=1, threshold=2):
        again = [limits_record(gsp.Limits(**{key: value})) for key, value in changes.items()]
    assert json.dumps(again) == json.dumps(records)


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_maxima_in_a_series_belong_to_the_designs_that_its_labels_name(order):
    other = gsp.catalogue.instantiate(gsp.catalogue.mechanism("D1^6"), PRESS)
    maxima = {PRESS.name: 4e6, other.name: 2e6}
    names = [list(maxima)[i] for i in order]
    series = pd.Series([maxima[name] for name in names], index=names)

    def means(maximum):
        table = gsp.rank([PRESS, other], PRESS.home, "λ", maximum=maximum)
        return table.set_index("design")["quality_index_mean"].to_dict()

    assert means(series) == means(maxima)
    assert means(pd.Series([4e6, 2e6])) == means([4e6, 2e6]) == means(maxima)
    with pytest.raises(MissingParameter, match=r"for design 'D1\^6'"):
        means(series.drop(other.name))
    with pytest.raises(InvalidInput, match="maximum: expected one number per label"):
        means(pd.concat([series, series]))


@pytest.mark.parametrize("every", ["all", ["all"], " ALL "], ids=repr)
def test_all_leaves_out_what_is_not_defined_for_the_number_of_actuators(every):
    rng = np.random.default_rng(0)
    eight = gsp.Design(["D1"] * 8, *rng.normal(size=(2, 8, 3)), name="eight")
    six = gsp.Design(["D1"] * 6, *rng.normal(size=(2, 6, 3)), name="six")
    ellipsoid = gsp.Ellipsoid([0.5, 0.5, 0.5])
    pose = gsp.Pose([[0.1, 0.2, 2.0], [0.0, 0.0, 2.0]])
    given = {"ellipsoid": ellipsoid, "length": 1.0, "maximum": 9.0}
    only_six = [name for name, index in gsp.indices.INDICES.items() if index.actuators == 6]
    assert only_six
    table = gsp.evaluate(eight, pose, every, **given)
    assert table.attrs["left_out"] == only_six
    assert set(table.columns) == set(gsp.indices.INDICES) - set(only_six)
    assert gsp.rank([six, eight], pose, every, "CTN", **given).attrs["left_out"] == only_six
    assert "left_out" not in gsp.evaluate(six, pose, every, **given).attrs
    with pytest.raises(MissingParameter, match="expected 6 actuators, received 8"):
        gsp.evaluate(eight, pose, only_six, **given)
