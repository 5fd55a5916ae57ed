"""No variation that a search finds exceeds its bound, and most come near to it."""

from __future__ import annotations

import numpy as np
import pytest

from tests.campaign import count
from tests.proof.proofs import KINDS
from tests.proof.tightness import ratios


@pytest.mark.parametrize("kind", KINDS)
def test_variations_stay_within_their_bounds_and_come_near_to_them(kind):
    rng = np.random.default_rng([2, KINDS.index(kind)])
    every, of_joints = [], []
    for _ in range(count(2, 60)):
        found = ratios(kind, rng)
        every += [x for some in found.values() for x in some]
        of_joints += found["d"] + found["θ"]
    assert max(every) <= 1.0
    assert len(every) > 10
    # Their bounds have the exact derivative.
    assert np.median(of_joints) > 0.7
