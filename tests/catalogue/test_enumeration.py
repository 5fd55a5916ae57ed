"""The 195 mechanisms: numbers, order, topology, names that are none of them."""

from collections import Counter
from itertools import product

import networkx as nx
import pandas as pd
import pytest

import gsp
from gsp import catalogue
from gsp.errors import UnknownMechanism
from gsp.model.mechanism import Mechanism

ALL = catalogue.mechanisms()
TABLE = catalogue.table()


def test_numbers():
    """*Source: TozKucuk2016, §1 and §2.*"""
    assert len(ALL) == len(set(ALL)) == 195
    assert Counter(m.group for m in ALL) == {"6D": 84, "5D1A": 56, "4D2A": 35, "3D3A": 20}
    assert [m.name for m in ALL if m.symmetric] == ["D1^6", "D2^6", "D3^6", "D4^6"]


def test_they_are_all_the_counts_there_are():
    """By brute force over all tuples of five counts."""
    every = {c for c in product(range(7), repeat=5) if sum(c) == 6 and c[4] <= 3}
    assert {m.counts for m in ALL} == every


def test_order():
    groups = [m.group for m in ALL]
    assert groups == sorted(groups, key=["6D", "5D1A", "4D2A", "3D3A"].index)
    for group in dict.fromkeys(groups):
        words = [m.constraints for m in ALL if m.group == group]
        assert words == sorted(words)
    assert (ALL[0].name, ALL[1].name, ALL[83].name, ALL[-1].name) == (
        "D1^6",
        "D1^5 D2",
        "D4^6",
        "D4^3 A1^3",
    )
    assert catalogue.mechanisms() is ALL


@pytest.mark.parametrize("mechanism", ALL, ids=str)
def test_topology(mechanism):
    d4, a1 = mechanism.counts[3:]
    graph = catalogue.kinematic_graph(mechanism)
    n = 6 - min(d4, a1)
    assert len(mechanism.legs) == n
    assert catalogue.mobility(graph) == 6
    assert catalogue.independent_loops(graph) == n - 1
    assert graph.number_of_edges() - graph.number_of_nodes() + 1 == n - 1
    assert graph.graph["idle"] == mechanism.counts[0]
    assert nx.is_connected(graph)
    assert sum(bool(joint["active"]) for *_, joint in graph.edges(data=True)) == n
    paths = nx.all_simple_paths(graph, "base", "platform")
    chains = ["".join(graph.edges[e]["kind"] for e in nx.utils.pairwise(p)) for p in paths]
    assert sorted(chains) == sorted(leg.chain for leg in mechanism.legs)
    assert {graph.edges[e]["freedoms"] for e in graph.edges} <= {1, 2, 3}


def test_classes_under_exchange():
    classes = {frozenset((m, m.exchanged())) for m in ALL}
    assert len(classes) == 119
    assert all(m.exchanged() in ALL for m in ALL)
    # D2 and D3 are exchanged: classes of one member have as many of both.
    assert sum(m.counts[1] == m.counts[2] for m in ALL) == 2 * 119 - 195


def test_table():
    assert list(TABLE["name"]) == [m.name for m in ALL]
    assert TABLE.shape[0] == 195
    assert {"name", "class", "legs", "n_legs", "symmetric", "mobility"} <= set(TABLE)
    counts = TABLE[[f"n_{c}" for c in ("D1", "D2", "D3", "D4", "A1")]]
    assert [tuple(row) for row in counts.to_numpy()] == [m.counts for m in ALL]
    assert list(TABLE["legs"]) == [", ".join(leg.name for leg in m.legs) for m in ALL]
    assert (TABLE["mobility"] == 6).all()
    assert TABLE["symmetric"].sum() == 4
    assert list(TABLE["exchanged"].map(catalogue.mechanism)) == [m.exchanged() for m in ALL]
    pd.testing.assert_frame_equal(catalogue.table(), TABLE)


@pytest.mark.parametrize(
    ("text", "nearest"),
    [
        ("D1^5", "D1^5 D2"),
        ("D1^7", "D1^6"),
        ("A1^6", "D1^3 A1^3"),
        ("D2^2 D3^3 A", "D2^2 D3^3 A1"),
        ("D1^2 D2 D4 A1^4", "D1^2 D2 D4 A1^2"),
        ("hexapod", None),
        ("", None),
        ("D7^6", "D2^6"),
    ],
)
def test_unknown_names(text, nearest):
    with pytest.raises(UnknownMechanism, match="unknown mechanism") as info:
        catalogue.mechanism(text)
    if nearest:
        assert "nearest" in str(info.value)
        assert set(info.value.nearest) <= set(TABLE["name"])
    assert isinstance(info.value, KeyError)
    assert isinstance(info.value, gsp.GspError)


@pytest.mark.parametrize("bad", [None, 5, 1j, ["D1"], {}, object], ids=repr)
def test_names_that_are_not_texts(bad):
    with pytest.raises(UnknownMechanism, match="expected a text"):
        catalogue.mechanism(bad)


def test_a_mechanism_names_itself():
    for one in catalogue.mechanisms()[::40]:
        assert catalogue.mechanism(one) == one
    with pytest.raises(UnknownMechanism, match="six constraints"):
        catalogue.mechanism(Mechanism.of(["D1"] * 7))
