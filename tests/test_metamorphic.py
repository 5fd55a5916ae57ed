"""Every quantity changes as its record states if the mechanism is described differently.

Generated: quantities × designs × changes. Where a record states "unchanged" or gives a rule, the
values agree to rounding for every design; where it states "changes", the values of some design do.
`make test` takes the first designs, `make check-long` all of them and random ones of the catalogue.
"""

from __future__ import annotations

from functools import cache
from itertools import chain, islice
from pathlib import Path

import numpy as np
import pytest

import gsp
from gsp.indices import INDICES
from tests import campaign
from tests.metamorphic import CHANGES as DESCRIPTIONS
from tests.metamorphic import FACTS, case, random_design, special_designs
from tests.quantities import NOT_STATED, QUANTITIES, expected, table, tolerance

PAGE = Path(__file__).parents[1] / "docs" / "conventions.md"
VISIBLE = 1e-3  # share of the largest value by which some value has to change

LEGS = (
    ["D1"] * 6,
    ["D1", "D2", "D3", "D4", "A1", "A1"],
    ["D1", "D2", "D3", "D4", "D4 A1", "A1", "D1"],
    ["D4 A1", "D1", "D1", "D1", "D1"],
    ["D1"] * 7,
    ["D2", "D2", "D3", "D3", "D3", "D3"],
    ["D4 A1"] * 3,
    ["D4"] * 6,
    ["D1"] * 8,
)


def designs():
    """General and special designs in turn, then mechanisms of the catalogue."""
    general = [random_design(legs, seed, "general") for seed, legs in enumerate(LEGS)]
    special = special_designs()
    # The octahedron and the collinear base come early: many equal triangles, and a singular set.
    early = [special[i] for i in (3, 4, 9, 2)]
    late = [design for design in special if all(design is not other for other in early)]
    catalogue = gsp.catalogue.mechanisms()
    mixed = [*general[:4], *early, *general[4:], *late]
    others = (random_design(m.name, seed) for seed, m in enumerate(catalogue))
    return list(islice(chain(mixed, others), campaign.count(7, len(mixed) + len(catalogue))))


CASES = [case(design) for design in designs()]


@cache
def described(number, k):
    """A case described differently; made once, as each quantity is of the same cases."""
    return DESCRIPTIONS[k].make(CASES[number], np.random.default_rng(number))


def with_rules(index):
    """The numbers of the cases that a quantity is defined for; of slow ones the first."""
    quantity = QUANTITIES[index]
    chosen = [i for i, given in enumerate(CASES) if quantity.applies(given.design)]
    return quantity, chosen[: quantity.most]


@pytest.mark.parametrize("index", range(len(QUANTITIES)), ids=[q.name for q in QUANTITIES])
def test_the_record_states_the_effect_of_each_change(index):
    quantity, cases = with_rules(index)
    assert cases
    seen = dict.fromkeys(FACTS, 0.0)
    stated = set()
    known = False
    for number in cases:
        given = CASES[number]
        value = quantity.of(given)
        known |= bool(np.isfinite(value).any())
        for k, description in enumerate(DESCRIPTIONS):
            if quantity.rules.get(description.fact) == NOT_STATED:
                continue
            other = described(number, k)
            there = quantity.of(other)
            where = f"{quantity.name}: {given.design.name}, {description.name}"
            wanted = expected(quantity, description.fact, value, given, other)
            if wanted is None:
                stated.add(description.fact)
                seen[description.fact] = max(seen[description.fact], difference(value, there))
            else:
                margin = tolerance(quantity, wanted, given, other)
                agree(there, wanted, margin, where)
    assert known
    for fact in stated:
        assert seen[fact] > VISIBLE, f"{quantity.name} is not changed by {fact}"


def agree(found, wanted, margin, where):
    """Values agree within a margin, and are undefined or infinite together."""
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted), err_msg=where)
    with np.errstate(invalid="ignore"):
        far = ~((np.abs(found - wanted) <= margin) | (found == wanted) | np.isnan(wanted))
    bounds = np.broadcast_to(margin, far.shape)[far]
    assert not far.any(), f"{where}: {found[far]} for {wanted[far]}, margin {bounds}"


def difference(value, there):
    """The largest change, as a share of the largest value; 0 where nothing is defined."""
    known = np.isfinite(value) & np.isfinite(there)
    if not value[known].any():
        return 0.0
    return float(np.abs(there[known] - value[known]).max() / np.abs(value[known]).max())


@pytest.mark.parametrize("index", INDICES.values(), ids=list(INDICES))
def test_facts_and_properties_agree(index):
    """Two of Nawratil's six properties, stated by name, follow from the facts."""
    facts, properties = index.invariance, index.properties
    still = facts.base_turn == facts.base_shift == "unchanged"
    assert properties.motion_invariant == still
    assert properties.similarity_invariant == (index.unit_power == "1")
    # The source names the plain CDN as an exception, which a turn does not change.
    along_axes = index.name in ("stiffness_x", "stiffness_y", "stiffness_z")
    assert (facts.base_turn == "changes") == along_axes


def test_the_table_of_the_page_is_that_of_the_records():
    assert table() in PAGE.read_text(encoding="utf-8"), f"docs/conventions.md needs\n{table()}"


def test_one_pose_and_many_are_the_same():
    """Batches of any shape: bit by bit."""
    for given in CASES:
        for index in INDICES.values():
            if index.missing(given.design, ("length", "ellipsoid", "maximum")):
                continue
            parameters = given.parameters(index.parameters)
            whole = index.function(given.posture, **parameters)
            square = index.function(given.design.at(given.pose.reshape(2, 2)), **parameters)
            single = [
                index.function(given.design.at(given.pose[i]), **parameters) for i in range(4)
            ]
            np.testing.assert_array_equal(square, whole.reshape(2, 2), err_msg=index.name)
            np.testing.assert_allclose(single, whole, rtol=1e-12, err_msg=index.name)
