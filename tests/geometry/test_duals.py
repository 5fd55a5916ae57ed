"""Dual numbers against complex steps."""

import numpy as np
import pytest

from gsp.geometry import scalars
from gsp.geometry.duals import Dual

FORMULAS = {
    "sums": lambda x, y: x + y - (2.0 - x) + 3.0 - (y - 1.0) + (-x),
    "products": lambda x, y: x * y * 3.0 * x + 2.0 * y,
    "quotients": lambda x, y: x / y / 2.0 + 3.0 / x,
    "roots": lambda x, y: scalars.root(x * x + y),
    "arcs": lambda x, y: scalars.arc(x, y),
    "cases": lambda x, y: scalars.choose(scalars.less(x, y), x * y, 1.0 / y),
    "a constant in one case": lambda x, y: scalars.choose(scalars.less(y, x), 1.0, x * y),
    "arrays on the left": lambda x, y: np.array([1.0, 2.0, 3.0]) * x - np.ones(3) / y,
}


@pytest.mark.parametrize("name", FORMULAS)
def test_slopes_are_those_of_complex_steps(name):
    rng = np.random.default_rng(1)
    x, y = rng.uniform(0.5, 1.5, (2, 3))
    slopes = rng.normal(size=(2, 4, 3))
    found = FORMULAS[name](Dual(x, slopes[0]), Dual(y, slopes[1]))
    h = 1e-30
    for k in range(4):
        moved = FORMULAS[name](x + 1j * h * slopes[0, k], y + 1j * h * slopes[1, k])
        assert np.allclose(found.real, moved.real, rtol=1e-15)
        assert np.allclose(found.slope[k], moved.imag / h, rtol=1e-14)
