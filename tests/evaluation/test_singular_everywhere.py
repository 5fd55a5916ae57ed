"""λ where |det J|max is zero: 0/0 is NaN, and a given maximum makes it 0; counts in tables."""

import numpy as np
import pytest

import gsp

# Similar hexagons: det J = 0 in every pose.
FLAT = gsp.hexapod(2.0, np.pi / 3, 1.0, np.pi / 3, 1.5, name="flat")
POSE = gsp.Pose([[0.0, 0.0, 1.0], [0.0, 0.1, 1.2]])


@pytest.mark.parametrize("maximum", [None, "sample"])
def test_without_a_positive_maximum_it_is_undefined(maximum):
    frame = gsp.evaluate(FLAT, POSE, ["λ", "CTN"], length=1.0, maximum=maximum)
    assert frame["quality_index"].isna().all()
    assert (frame["control_number"] == 0.0).all()
    assert frame.attrs["undefined"] == 2
    table = gsp.rank([FLAT], POSE, ["λ", "CTN"], length=1.0, maximum=maximum)
    assert table.loc[0, ["singular", "undefined"]].tolist() == [1.0, 1.0]
    assert np.isnan(table.loc[0, "quality_index_mean"])


def test_with_a_positive_maximum_it_is_zero():
    assert (gsp.indices.quality_index(FLAT.at(POSE), maximum=2.0) == 0.0).all()
    frame = gsp.evaluate(FLAT, POSE, "λ", maximum=2.0)
    assert (frame["quality_index"] == 0.0).all()
    assert frame.attrs["undefined"] == 0
    table = gsp.rank([FLAT], POSE, "λ", maximum=2.0)
    assert table.loc[0, ["singular", "undefined"]].tolist() == [1.0, 0.0]
    assert gsp.prepare(FLAT, "λ", maximum=2.0).index(POSE[0]) == 0.0


def test_other_indices_count_no_undefined_pose():
    frame = gsp.evaluate(FLAT, POSE, "CTN", length=1.0)
    assert frame.attrs["undefined"] == 0
    assert np.isnan(gsp.indices.quality_index(FLAT.at(POSE))).all()
