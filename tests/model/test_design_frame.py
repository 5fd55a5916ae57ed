"""Designs as data frames: the same numbers back, and errors with column and row."""

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.errors import InvalidInput, UnknownName
from tests import campaign

KINDS = ("D1", "D2", "D3", "D4", "A1", "D4 A1")


def random_design(rng):
    legs = ["D1", *rng.choice(KINDS, size=rng.integers(5, 8))]
    n, rows = len(legs), sum(len(leg.split()) for leg in legs)
    strokes = np.sort(rng.random((rows, 2)), axis=1) if rng.random() < 0.7 else None
    if strokes is not None:
        strokes[rng.random((rows, 2)) < 0.2] = np.nan
    return gsp.Design(legs, *rng.normal(size=(4, n, 3)) * 10.0 ** rng.integers(-6, 6),
                      strokes=strokes)  # fmt: skip


def equal(first, second):
    assert [leg.name for leg in first.legs] == [leg.name for leg in second.legs]
    for name in ("base_points", "platform_points", "base_directions", "platform_directions"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))
    assert (first.strokes is None) == (second.strokes is None)
    if first.strokes is not None:
        np.testing.assert_array_equal(first.strokes, second.strokes)


def test_frames_give_the_same_numbers_back():
    rng = np.random.default_rng(17)
    for _ in range(campaign.count(200, 5000)):
        design = random_design(rng)
        equal(design, gsp.Design.from_frame(design.to_frame()))


@pytest.mark.parametrize("name", gsp.catalogue.design_names())
def test_published_designs_give_the_same_numbers_back(name):
    design = gsp.catalogue.design(name)
    again = gsp.Design.from_frame(
        design.to_frame(), unit=design.unit, name=design.name, source=design.source,
        characteristic_length=design.characteristic_length, ellipsoid=design.ellipsoid,
        home=design.home,
    )  # fmt: skip
    equal(design, again)
    assert (again.unit, again.name, again.home) == (design.unit, design.name, design.home)
    assert again.ellipsoid is design.ellipsoid


HEXAPOD = gsp.hexapod(2, 0.2, 1, 0.3, 1.5)
MIXED = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


def test_columns_are_those_that_are_needed():
    points = [f"{side}_{axis}" for side in ("base", "platform") for axis in "xyz"]
    assert list(HEXAPOD.to_frame()) == ["constraints", *points]
    strokes = HEXAPOD.replace(strokes=[[1, np.nan]] * 6).to_frame()
    assert strokes["stroke_low"].tolist() == [1] * 6
    assert strokes["stroke_high"].isna().all()
    shuffled = HEXAPOD.to_frame()[points[::-1]].set_index(pd.Index(list("abcdef")))
    equal(HEXAPOD, gsp.Design.from_frame(shuffled))


def changed(column, row, value, design=HEXAPOD):
    frame = design.to_frame().astype(object)
    frame.loc[row, column] = value
    return frame


WRONG = {
    "text": (changed("base_y", 3, "1.5"), "row 3, column 'base_y': expected a finite number"),
    "missing": (changed("base_y", 2, None), "row 2, column 'base_y'.*received nothing"),
    "infinite": (changed("platform_x", 1, np.inf), "row 1, column 'platform_x'"),
    "bool": (changed("platform_x", 1, True), "row 1, column 'platform_x'"),
    "leg": (changed("constraints", 4, "D9"), "row 4, column 'constraints': expected one of 'D1'"),
    "no text": (changed("constraints", 4, 1.5), "row 4, column 'constraints': expected a text"),
    "line": (changed("constraints", 0, "D2"), "row 0, column 'platform_dx'.*the platform"),
    "direction": (changed("base_dx", 3, None, MIXED), "row 3, column 'base_dx'"),
    "strokes": (HEXAPOD.to_frame().assign(stroke_low=2.0, stroke_high=[3, 3, 3, 3, 3, 1]),
                "row 5, column 'stroke_low': expected at most stroke_high"),
    "column": (HEXAPOD.to_frame().drop(columns="base_z"), "received none named 'base_z'"),
    "twice": (pd.concat([HEXAPOD.to_frame(), HEXAPOD.to_frame()], axis=1), "two of 'constraints'"),
    "few": (HEXAPOD.to_frame().head(5), "at least six constraints, received 5 rows"),
    "no frame": ([1.0], "a pandas.DataFrame"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_errors_name_column_and_row(case):
    frame, text = WRONG[case]
    with pytest.raises(InvalidInput, match=text):
        gsp.Design.from_frame(frame)


def test_unknown_columns_name_the_nearest():
    with pytest.raises(UnknownName, match="nearest: base_x"):
        gsp.Design.from_frame(HEXAPOD.to_frame().assign(base_xx=1.0))


@pytest.mark.parametrize(
    ("column", "message"),
    [
        ("stroke_low_2", "column 'stroke_low_2': expected nothing, as a leg D1 has one actuated"),
        ("stroke_high_2", "column 'stroke_high_2': expected nothing"),
        ("base_dx", "column 'base_dy': expected a number, as base_dx has one"),
        ("platform_dz", "column 'platform_dx': expected a number, as platform_dz has one"),
    ],
)
def test_numbers_that_a_leg_does_not_use_are_refused(column, message):
    with pytest.raises(InvalidInput, match=message):
        gsp.Design.from_frame(HEXAPOD.to_frame().assign(**{column: 1.0}))
    empty = HEXAPOD.to_frame().assign(**{column: np.nan})
    equal(gsp.Design.from_frame(empty), HEXAPOD)
