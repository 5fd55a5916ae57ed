"""Mechanisms on the anchor lines of a template; published designs."""

from itertools import pairwise

import numpy as np
import pytest

import gsp
from gsp import catalogue
from gsp.errors import InvalidDesign, InvalidInput, UnknownDesign
from tests.support import random_design

SIX = catalogue.design("toz-kucuk-2016-d3-6")
FIVE = catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
ALL = catalogue.mechanisms()


def positions(design, template):
    """The leg of the template on whose anchors each leg is placed."""
    found = []
    for point in design.platform_points:
        (place,) = np.flatnonzero((template.platform_points == point).all(axis=1))
        found.append(int(place))
    return found


@pytest.mark.parametrize("template", [SIX, FIVE], ids=["six legs", "five legs"])
@pytest.mark.parametrize("mechanism", ALL, ids=str)
def test_all_mechanisms(mechanism, template):
    legs = mechanism.legs
    if len(legs) > template.n_legs:
        with pytest.raises(InvalidDesign, match=f"template: expected at least {len(legs)} legs"):
            catalogue.instantiate(mechanism, template)
        return
    design = catalogue.instantiate(mechanism, template)
    assert design.mechanism == mechanism
    assert sorted(leg.name for leg in design.legs) == sorted(leg.name for leg in legs)
    assert (design.name, design.unit) == (mechanism.name, "mm")
    assert design.characteristic_length == template.characteristic_length
    places = positions(design, template)
    assert places == sorted(set(places))  # none twice
    gaps = np.diff([*places, places[0] + template.n_legs])
    assert gaps.max() - gaps.min() <= 1
    np.testing.assert_array_equal(design.base_points, template.base_points[places])
    posture = design.at(template.home)
    assert posture.undefined == ()
    assert np.isfinite(posture.jacobian).all()


@pytest.mark.parametrize("mechanism", ALL, ids=str)
def test_legs_of_a_kind_are_spread(mechanism):
    """Of two kinds, the one with at most half of the legs has no two of them side by side."""
    legs = [leg.name for leg in catalogue.instantiate(mechanism, SIX).legs]
    for kind in set(legs):
        if 2 * legs.count(kind) <= len(legs) and legs.count(kind) > 1 and len(set(legs)) == 2:
            at = [i for i, leg in enumerate(legs) if leg == kind]
            assert min(b - a for a, b in pairwise([*at, at[0] + len(legs)])) > 1


def test_lines_are_those_of_the_template():
    design = catalogue.instantiate(catalogue.mechanism("D3^6"), SIX)
    np.testing.assert_array_equal(design.base_directions, SIX.base_directions)
    design = catalogue.instantiate(catalogue.mechanism("D4^6"), SIX)
    # Where the template has no line, it is from the anchor to the origin.
    toward = -SIX.platform_points / np.linalg.norm(SIX.platform_points, axis=1)[:, None]
    np.testing.assert_allclose(design.platform_directions, toward, rtol=1e-15)


def test_an_anchor_at_the_origin_has_no_line():
    points = SIX.platform_points.copy()
    points[2] = 0.0
    template = SIX.replace(platform_points=points)
    with pytest.raises(InvalidDesign, match=r"template, platform line of leg 3 \(D2\): expected"):
        catalogue.instantiate(catalogue.mechanism("D2^6"), template)
    assert catalogue.instantiate(catalogue.mechanism("D1^6"), template).n_legs == 6


def test_more_legs_than_needed():
    rng = np.random.default_rng(0)
    template = random_design(rng, ["D4 A1"] * 11)
    for mechanism in ALL:
        places = positions(catalogue.instantiate(mechanism, template), template)
        gaps = np.diff([*places, places[0] + 11])
        assert gaps.max() - gaps.min() <= 1


@pytest.mark.parametrize("bad", [None, "D1^6", 5, SIX], ids=repr)
def test_a_mechanism_is_needed(bad):
    with pytest.raises(InvalidInput, match=r"mechanism: expected a gsp\.Mechanism"):
        catalogue.instantiate(bad, SIX)


@pytest.mark.parametrize("bad", [None, "toz-kucuk-2016-d3-6", 5, ALL[0]], ids=repr)
def test_a_template_is_needed(bad):
    with pytest.raises(InvalidInput, match=r"template: expected a gsp\.Design"):
        catalogue.instantiate(ALL[0], bad)


def test_published_designs():
    names = catalogue.design_names()
    assert list(names) == sorted(names)
    assert {"toz-kucuk-2016-d3-6", "toz-kucuk-2016-d1-d2-d3-d4-a1-2"} <= set(names)
    table = catalogue.designs()
    assert list(table["name"]) == list(names)
    assert table["source"].str.len().min() > 0
    for name in names:
        design = catalogue.design(name)
        assert design.name == name
    assert SIX.mechanism.name == "D3^6"
    assert FIVE.mechanism.name == "D1 D2 D3 D4 A1^2"


@pytest.mark.parametrize(
    "bad", ["toz-kucuk-2016-d3", "", None, 5, ["x"], np.zeros(2), "../designs/x"], ids=repr
)
def test_unknown_design(bad):
    with pytest.raises(UnknownDesign, match="unknown design"):
        catalogue.design(bad)


def test_error_of_an_unknown_design_names_the_nearest():
    with pytest.raises(gsp.GspError, match="nearest: toz-kucuk-2016-d3-6"):
        catalogue.design("toz-kucuk-2016-d3")
