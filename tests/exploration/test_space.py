"""Spaces of designs: samples, tables, resumption, and bad input."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import qmc

import gsp
from gsp.errors import InvalidInput
from gsp.evaluation.parts import Parts
from gsp.exploration import explore

FIXED = {"base_radius": 2.0, "base_angle": 0.3, "height": 1.5}
SPACE = gsp.Space(
    gsp.hexapod, {"platform_radius": (0.5, 1.5), "platform_angle": (0.1, 1.0)}, fixed=FIXED
)
BOX = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (1.4, 1.6)], [(-0.1, 0.1)] * 3)
TASK = gsp.Task(poses=BOX, wanted={"mean CTN": 1.0, "worst CDN_CL": 2.0}, samples=30, length=0.8)
TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")


def same(one, other):
    pd.testing.assert_frame_equal(one, other, check_exact=True)
    assert one.attrs == other.attrs


def mixed(platform_radius, legs, turned):
    """A placement on anchors of another size: two kinds of parameters that are not numbers."""
    points = TEMPLATE.platform_points * platform_radius
    template = TEMPLATE.replace(platform_points=points[::-1] if turned else points)
    return gsp.catalogue.place(legs, template)


MIXED = gsp.Space(
    mixed, {"platform_radius": (0.8, 1.2)},
    {"legs": ["D1-D1-D1-D1-D1-D1", "D1-D2-D1-D2-D1-D2", "D3-D3-D3-D3-D3-D3"],
     "turned": [False, True]},
)  # fmt: skip


@pytest.mark.parametrize(("method", "kind"), [("halton", qmc.Halton), ("sobol", qmc.Sobol)])
def test_samples_are_those_of_scipy(method, kind):
    points = kind(d=2, rng=np.random.default_rng(3)).random(8)
    sample = SPACE.sample(8, seed=3, method=method)
    assert list(sample) == ["platform_radius", "platform_angle"]
    np.testing.assert_allclose(sample["platform_radius"], 0.5 + points[:, 0], rtol=1e-15)
    np.testing.assert_allclose(sample["platform_angle"], 0.1 + 0.9 * points[:, 1], rtol=1e-15)


def test_choices_are_equally_frequent():
    sample = MIXED.sample(512, seed=0, method="sobol")
    assert sample.groupby("turned").size().tolist() == [256, 256]
    assert sample.groupby("legs").size().between(168, 173).all()
    assert {type(value) for value in sample["turned"].tolist()} == {bool}


def test_rows_are_the_designs_of_the_parameters():
    table = explore(SPACE, TASK, 6, seed=2)
    sample = SPACE.sample(6, seed=2)
    pd.testing.assert_frame_equal(table[list(sample)], sample)
    for i, row in sample.iterrows():
        design = gsp.hexapod(**FIXED, **row)
        values = gsp.evaluate(design, BOX.sample(30, rng=0), ["CTN", "CDN_CL"], length=0.8)
        assert table["control_number_mean"][i] == pytest.approx(values["control_number"].mean())
        assert table["condition_number_max"][i] == values["condition_number"].max()
    assert sorted(table["rank"]) == list(range(1, 7))
    assert table["score"].idxmax() == table["rank"].idxmin()
    attrs = table.attrs
    assert attrs["space"]["make"] == "gsp.families.circular.hexapod"
    assert attrs["space"]["ranges"] == {"platform_radius": [0.5, 1.5], "platform_angle": [0.1, 1.0]}
    assert (attrs["seed"], attrs["method"], attrs["poses"]) == (2, "halton", 30)
    assert attrs["call"] == "gsp.exploration.explore(space, task, 6, seed=2, method='halton')"


def test_the_table_is_that_of_assess():
    sample = SPACE.sample(5, seed=1)
    designs = [
        gsp.hexapod(**FIXED, **row).replace(name=f"hexapod {i}") for i, row in sample.iterrows()
    ]
    other = gsp.exploration.assess(designs, TASK).set_index("design").sort_index()
    table = explore(SPACE, TASK, 5, seed=1).set_index("design").sort_index()
    pd.testing.assert_frame_equal(table[other.columns], other, check_exact=True)


def test_mechanisms_and_placements_are_parameters():
    box = gsp.PoseBox.around(TEMPLATE.home, [5, 5, 5, 0.03, 0.03, 0.03])
    task = gsp.Task(poses=box, wanted="worst CTN", samples=20)
    table = explore(MIXED, task, 12, seed=5)
    wanted = {"D1-D1-D1-D1-D1-D1": "D1^6", "D1-D2-D1-D2-D1-D2": "D1^3 D2^3",
              "D3-D3-D3-D3-D3-D3": "D3^6"}  # fmt: skip
    assert table["mechanism"].tolist() == [wanted[legs] for legs in table["legs"]]
    assert set(table["mechanism"]) == set(wanted.values())


def test_parameters_without_a_design_have_the_reason():
    space = gsp.Space(
        gsp.hexapod, {"platform_radius": (-1.0, 1.0)}, fixed={**FIXED, "platform_angle": 0.5}
    )
    table = explore(space, TASK, 8, seed=0)
    bad = table["platform_radius"] < 0.0
    assert 0 < bad.sum() < 8
    assert table.loc[bad, "error"].str.contains("platform_radius: expected").all()
    assert table.loc[bad, ["score", "rank", "control_number_mean"]].isna().all(axis=None)
    assert (table.loc[~bad, "error"] == "").all()
    assert table.loc[~bad, "score"].notna().all()
    empty = gsp.Space(
        gsp.hexapod, {"platform_radius": (-2.0, -1.0)}, fixed={**FIXED, "platform_angle": 0.5}
    )
    with pytest.raises(InvalidInput, match="none; the first error: platform_radius: expected"):
        explore(empty, TASK, 4)


@pytest.mark.parametrize("kept", [2, 6])
def test_an_interrupted_exploration_resumes_to_the_same_bits(kept, tmp_path, monkeypatch):
    task = gsp.Task(poses=BOX, wanted=["mean CTN", "proven worst CTN"], samples=20)
    given = {"seed": 4, "budget": 20}
    whole = explore(SPACE, task, 5, **given)
    assert (whole["control_number_proven"] <= whole["control_number_min"]).all()
    out, write, stored = tmp_path / "t.parquet", Parts.write_row, []

    def stop(parts, number, row):
        if len(stored) == kept:
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    monkeypatch.setattr(Parts, "write_row", stop)
    with pytest.raises(KeyboardInterrupt):
        explore(SPACE, task, 5, out=out, workers=1, **given)
    monkeypatch.undo()
    with pytest.raises(InvalidInput, match="those of another run"):
        explore(SPACE, task, 5, out=out, resume=True, seed=5, budget=20)
    same(explore(SPACE, task, 5, out=out, resume=True, **given), whole)
    same(pd.read_parquet(out), whole)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "space: expected at least one range or choice, received none"),
        ({"ranges": {"a": (1.0, 1.0)}}, "two numbers, low < high"),
        ({"ranges": {"a": (2.0, 1.0)}}, "two numbers, low < high"),
        ({"ranges": {"a": (0.0, np.inf)}}, r"space\.ranges\['a'\].*: expected finite"),
        ({"ranges": {"a": [[0, 1], [0, 1]]}}, "two numbers, low < high"),
        ({"ranges": {"a": 3.0}}, r"space\.ranges\['a'\]: expected"),
        ({"ranges": [("a", 0, 1)]}, r"space\.ranges: expected a mapping"),
        ({"ranges": {"not a name": (0, 1)}}, "names of arguments as keys"),
        ({"choices": {"a": []}}, r"space\.choices\['a'\]: expected different"),
        ({"choices": {"a": "abc"}}, r"space\.choices\['a'\]: expected different"),
        ({"choices": {"a": ["x", "x"]}}, r"space\.choices\['a'\]: expected different"),
        ({"choices": {"a": [None, 1]}}, r"space\.choices\['a'\]: expected different"),
        ({"ranges": {"a": (0, 1)}, "fixed": {"a": 3}}, "each parameter once, received twice 'a'"),
        ({"ranges": {"base_radius": (1, 2)}}, r"space\.make: expected a function that takes"),
        ({"ranges": {"nobody": (1, 2)}}, r"space\.make: expected a function that takes"),
        ({"make": 3, "ranges": {"a": (0, 1)}}, r"space\.make: expected a function"),
    ],
)
def test_bad_spaces(given, message):
    with pytest.raises(InvalidInput, match=message):
        gsp.Space(**{"make": gsp.hexapod, **given})


def test_bad_calls():
    with pytest.raises(
        InvalidInput, match=r"Space\.design: expected platform_radius, platform_angle"
    ):
        SPACE.design(platform_radius=1.0)
    with pytest.raises(InvalidInput, match="what make returns: expected"):
        gsp.Space(lambda a: a, {"a": (0, 1)}).design(a=0.5)
    for bad in (
        {"n": 0},
        {"n": 2**40},
        {"n": 2.5},
        {"n": 4, "seed": -1},
        {"n": 4, "method": "grid"},
    ):
        with pytest.raises(InvalidInput):
            explore(SPACE, TASK, **bad)
    with pytest.raises(InvalidInput, match=r"space: expected a gsp\.Space"):
        explore(gsp.hexapod, TASK, 4)
    with pytest.raises(InvalidInput, match="task: expected a gsp"):
        explore(SPACE, BOX, 4)
