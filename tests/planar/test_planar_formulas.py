"""The planar formulas on other kinds of numbers: complex steps, and 50 digits."""

import cmath

import mpmath
import numpy as np
import pytest

from gsp.model.formulas import placement
from gsp.planar import PLANAR_CONSTRAINTS

LEGS = pytest.mark.parametrize("leg", PLANAR_CONSTRAINTS, ids=lambda leg: leg.name)


def case(seed):
    """Position, angle, a, b, s, t as floats."""
    rng = np.random.default_rng(seed)
    turns = rng.uniform(-np.pi, np.pi, size=3)
    s, t = ([float(np.cos(x)), float(np.sin(x))] for x in turns[1:])
    p, a, b = (rng.normal(size=2).tolist() for _ in range(3))
    return p, float(turns[0]), a, b, s, t


def segment(leg, p, cosine, sine, a, b, s, t):
    scale = abs(p[0]) + abs(p[1]) + abs(a[0]) + abs(b[0]) + 1.0
    return leg.segment(placement(p, [cosine, -sine, sine, cosine], (a, b), (s, t), scale))


@LEGS
@pytest.mark.parametrize("seed", range(4))
def test_rows_are_complex_step_derivatives_of_values(leg, seed):
    p, phi, a, b, s, t = case(seed)
    row = leg.row(segment(leg, p, np.cos(phi).item(), np.sin(phi).item(), a, b, s, t), 1.0)
    step = 1e-150j
    for k, twist in enumerate(np.eye(3)):
        moved = [x + step * v for x, v in zip(p, twist, strict=False)]
        turned = phi + step * twist[2]
        seen = segment(leg, moved, cmath.cos(turned), cmath.sin(turned), a, b, s, t)
        assert complex(leg.measure(seen)).imag / step.imag == pytest.approx(row[k], abs=1e-13)


@LEGS
@pytest.mark.parametrize("seed", range(4))
def test_values_rows_and_passive_rates_are_those_of_50_digits(leg, seed):
    def everything(number, cos, sin, angle):
        p, a, b, s, t = (list(map(number, vector)) for vector in vectors)
        seen = segment(leg, p, cos(angle), sin(angle), a, b, s, t)
        rates = leg.passive(seen, number(0.7))
        rows = [leg.row(seen, number(1.0)), *(rate.row for rate in rates)]
        return [float(x) for x in (leg.measure(seen), *(x for row in rows for x in row))]

    p, phi, *others = case(seed)
    vectors = (p, *others)
    ours = everything(float, lambda x: float(np.cos(x)), lambda x: float(np.sin(x)), phi)
    with mpmath.workdps(50):
        theirs = everything(mpmath.mpf, mpmath.cos, mpmath.sin, mpmath.mpf(phi))
    np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-13)
