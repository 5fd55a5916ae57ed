"""Mechanisms and their names."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gsp
from gsp.errors import InvalidInput
from gsp.model.mechanism import NAMES, Mechanism, read_mechanism

ALL = gsp.catalogue.mechanisms()
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def factors(mechanism):
    return [(n, k) for n, k in zip(NAMES, mechanism.counts, strict=True) if k]


def spellings(m):
    power = [(n, f"{k}" if k > 1 else "") for n, k in factors(m)]
    return {
        "canonical": m.name,
        "LaTeX": m.latex,
        "LaTeX with braces": "$"
        + "".join(f"{n[0]}_{{{n[1]}}}^{{{k or 1}}} " for n, k in power)
        + "$",
        "mathrm": " ".join(f"\\mathrm{{{n[0]}}}_{n[1]}" + (f"^{k}" if k else "") for n, k in power),
        "run together": "".join(n * k for n, k in factors(m)),
        "words": " ".join(m.constraints),
        "reversed words": " ".join(reversed(m.constraints)),
        "superscripts": "".join(n + k.translate(SUPERSCRIPTS) for n, k in power),
        "sub- and superscripts": "".join(
            n[0] + n[1].translate(SUBSCRIPTS) + k.translate(SUPERSCRIPTS) for n, k in power
        ),
        "small letters": m.name.lower(),
        "commas": ", ".join(m.constraints),
        "dots": "·".join(m.constraints),
    }


@pytest.mark.parametrize("kind", spellings(ALL[0]))
def test_names_round_trip(kind):
    for mechanism in ALL:
        text = spellings(mechanism)[kind]
        assert read_mechanism(text) == mechanism, text
        assert gsp.catalogue.mechanism(text) == mechanism


def test_canonical_names_differ():
    assert len({m.name for m in ALL}) == len({m.latex for m in ALL}) == 195


@given(st.permutations([n for n in NAMES for _ in range(2)]))
def test_order_of_constraints_does_not_matter(words):
    assert read_mechanism("".join(words)).counts == (2, 2, 2, 2, 2)
    assert Mechanism.of(words).counts == (2, 2, 2, 2, 2)


@pytest.mark.parametrize(
    "text",
    [
        "",
        " ",
        "D",
        "D5",
        "D1 D5^5",
        "E1",
        "D1^",
        "D1^2^3",
        "D12",
        "D1**6",
        "D1^-1",
        "1D",
        "D1 & D2",
        "D1^1e3",
        "D1^٣",
        "$$",
        "^6",
        "D1^6 x",
        "D1^99999999999",
        None,
        5,
        1j,
        b"D1^6",
        ["D1"],
        {},
        True,
    ],
    ids=repr,
)
def test_no_name(text):
    with pytest.raises(InvalidInput, match=r"(mechanism name|constraint): expected .* received"):
        read_mechanism(text)


def test_a_great_power_takes_little_work():
    assert read_mechanism("D1^999999999").counts[0] == 999_999_999


@pytest.mark.parametrize(
    "bad", [None, 5, (1, 1), (1,) * 6, (1, 1, 1, 1, -1), "11112", (1, 1, 1, 1, 1.5), (True,) * 5]
)
def test_bad_counts(bad):
    with pytest.raises(InvalidInput, match=r"mechanism.*: expected"):
        Mechanism(bad)


def test_counts_may_be_numpy_integers():
    assert Mechanism(np.array([1, 1, 1, 1, 2])) == Mechanism((1, 1, 1, 1, 2))
    assert all(type(n) is int for n in Mechanism(np.ones(5, dtype=int)).counts)


@pytest.mark.parametrize("bad", [None, "D1", 5, ["D5"], [None], [["D1"]]])
def test_of_raises_on_other_names(bad):
    with pytest.raises(InvalidInput, match=r"constraints?: expected"):
        Mechanism.of(bad)


def test_legs_carry_the_constraints():
    for mechanism in ALL:
        names = [c.name for leg in mechanism.legs for c in leg.constraints]
        assert sorted(names) == sorted(mechanism.constraints)
        assert Mechanism.of(names) == mechanism


def test_exchange_is_an_involution():
    for mechanism in ALL:
        assert mechanism.exchanged().exchanged() == mechanism
        assert mechanism.exchanged().group == mechanism.group
