from pathlib import Path

import numpy as np
import pytest

from gsp.errors import InvalidInput, UnknownMechanism
from gsp.planar import PlanarMechanism, mechanism, mechanisms, table


def test_there_are_sixteen_and_each_is_found_by_its_name():
    names = [m.name for m in mechanisms()]
    assert len(set(names)) == len(names) == 16
    assert [m.group for m in mechanisms()].count("3D") == 10
    assert all(mechanism(name).name == name for name in names)
    assert max(m.counts[3] for m in mechanisms()) == 1


def test_each_moves_with_three_freedoms_and_exchange_gives_ten_classes():
    assert {m.mobility for m in mechanisms()} == {3}
    assert all(m.exchanged() in mechanisms() for m in mechanisms())
    # Four stay as they are: D1^3, D1 D2 D3, D1^2 A1 and D2 D3 A1; so (16 + 4) / 2 classes.
    assert len({frozenset((m.name, m.exchanged().name)) for m in mechanisms()}) == 10


@pytest.mark.parametrize("name", ["D1^2 A1^2", "D4 D1 D1", "D1 D1", "nonsense", "A1^3"])
def test_others_are_unknown(name):
    with pytest.raises(UnknownMechanism):
        mechanism(name)


def test_the_table_has_a_row_each():
    frame = table()
    assert frame.shape[0] == 16
    assert frame.loc[0, ["name", "chains"]].tolist() == ["D1^3", "3-RPR"]


def test_the_page_of_the_planar_platforms_has_the_table():
    page = (Path(__file__).parents[2] / "docs" / "planar.md").read_text(encoding="utf-8")
    for row in table().to_dict("records"):
        cells = (row["name"], row["class"], row["chains"], row["exchanged"])
        assert f"| {' | '.join(cells)} |" in page


@pytest.mark.parametrize("bad", [None, (1, 1, 1), (1, 1, 1, -1), (True, 1, 1, 0), (1, 1, 1, 0.0)])
def test_bad_counts(bad):
    with pytest.raises(InvalidInput, match=r"planar mechanism.*: expected"):
        PlanarMechanism(bad)


def test_counts_may_be_numpy_integers_as_in_space():
    same = PlanarMechanism(np.array([2, 0, 0, 1]))
    assert same == PlanarMechanism((2, 0, 0, 1))
    assert all(type(n) is int for n in same.counts)
    assert (same.name, same.n_angles) == ("D1^2 A1", 1)
