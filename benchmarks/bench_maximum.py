"""The search of |det J|max against scipy's differential evolution on a per-pose determinant.

Run `python -m pytest benchmarks/bench_maximum.py -s`; it prints times, their ratio, and values.
"""

from __future__ import annotations

import time

import numpy as np
from scipy.optimize import differential_evolution

from gsp.determinant import maximum
from gsp.families import lee
from gsp.geometry.pose import Pose
from gsp.indices import manipulability
from gsp.model.design import Design

DESIGNS = (
    lee.octahedral_3_3(1.0, 1.3),
    lee.separated_along_side(1.0, 2.0, 0.4),
    Design(["D1"] * 6, *np.random.default_rng(1).normal(size=(2, 6, 3)), name="general"),
)


def evolution(design: Design, seed: int) -> tuple[float, float]:
    """Time and value of scipy's search over six pose variables, one pose at a time."""
    reach = 3.0 * design.rms_radius

    def cost(x: np.ndarray) -> float:
        return -float(manipulability(design.at(Pose.from_rpy(x[:3], x[3:]))))

    bounds = [(-reach, reach)] * 3 + [(-np.pi, np.pi), (-np.pi / 2, np.pi / 2), (-np.pi, np.pi)]
    start = time.perf_counter()
    found = differential_evolution(cost, bounds, rng=seed, tol=1e-10, maxiter=100)
    return time.perf_counter() - start, -float(found.fun)


def ours(design: Design, seed: int) -> tuple[float, float]:
    """Time and value of the library's search."""
    start = time.perf_counter()
    found = maximum(design, seed=seed, store=False)
    return time.perf_counter() - start, found.value


def test_maximum_against_differential_evolution() -> None:
    for design in DESIGNS:
        here, value = np.mean([ours(design, seed) for seed in range(3)], axis=0)
        there, other = evolution(design, 0)
        print(
            f"\n{design.name}: {here:.2f} s against {there:.1f} s, ratio {there / here:.0f}; "
            f"value {value:.12g}, theirs {other - value:+.1e}"
        )
        assert value >= other * (1.0 - 1e-12)
