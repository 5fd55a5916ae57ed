"""Ends of what is proven stay on their side when they are printed with few digits."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from gsp.rounding import SHORT_WITHIN, rounded_down, rounded_up


@pytest.mark.parametrize("digits", [1, 2, 4, 6])
def test_directions_and_steps(digits):
    rng = np.random.default_rng(digits)
    for value in (rng.normal(size=200) * 10.0 ** rng.integers(-300, 300, 200)).tolist():
        low, high = (Fraction(f"{f(value, digits):.{digits}g}") for f in (rounded_down, rounded_up))
        exact, slack = Fraction(value), abs(Fraction(value)) * Fraction(SHORT_WITHIN)
        assert low <= exact + slack
        assert exact - slack <= high
        step = Fraction(10) ** (int(np.floor(np.log10(abs(value)))) + 1 - digits)
        assert 0 <= high - low <= step


def test_what_is_a_short_number_stays_as_it_is():
    for value in (0.0, 6.5, -6.5, 0.1 + 0.2, 1e-300, 7.0, np.inf, -np.inf):
        near = float(f"{value:.3g}")
        assert rounded_down(value, 3) == rounded_up(value, 3) == near
    assert np.isnan(rounded_down(np.nan, 3))
