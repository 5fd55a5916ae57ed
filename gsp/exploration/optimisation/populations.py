"""Populations of designs: differential evolution by scipy, and NSGA-II by pymoo."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.exploration.optimisation.evaluating import Evaluator
from gsp.exploration.optimisation.goals import NO_MERIT
from gsp.geometry.pose.intervals import sample_points
from gsp.geometry.vectors import Array
from gsp.installed import optional

# Least size of a population, and designs per parameter.
LEAST_POPULATION, DESIGNS_PER_PARAMETER = 20, 10
# Differential evolution combines four designs with another one.
SMALLEST_POPULATION = 5
# A population whose merits (logarithms) differ by less has converged.
SAME_MERIT = 1e-10


def population_size(dimension: int, evaluations: int) -> int:
    """Return the number of designs of a generation."""
    wanted = max(LEAST_POPULATION, DESIGNS_PER_PARAMETER * dimension)
    return max(min(wanted, evaluations), SMALLEST_POPULATION)


def evolve(evaluator: Evaluator, dimension: int, evaluations: int, seed: int) -> None:
    """Evaluate the designs of a differential evolution; those that violate bounds come last."""
    from scipy import optimize

    shares, size = evaluator.goals.shares, population_size(dimension, evaluations)

    def energies(x: Array) -> Array:
        rows = evaluator.evaluate(np.atleast_2d(x.T))
        found = []
        for row in rows:
            violation = evaluator.goals.violation(row)
            merit = float(shares @ evaluator.goals.merits(row)) if violation == 0.0 else 0.0
            found.append(-merit if violation == 0.0 else -2.0 * NO_MERIT * (1.0 + violation))
        return np.array(found)

    first = unit_sample(dimension, size, seed)
    search: Any = optimize.differential_evolution
    search(
        energies,
        [(0.0, 1.0)] * dimension,
        init=first,
        maxiter=max(evaluations // size - 1, 0),
        tol=0.0,
        atol=SAME_MERIT,
        rng=np.random.default_rng(seed),
        polish=False,
        updating="deferred",
        vectorized=True,
    )


def unit_sample(dimension: int, n: int, seed: int) -> Array:
    """Return a low-discrepancy sample of the unit cube, (n, d)."""
    return sample_points(np.zeros(dimension), np.ones(dimension), n, seed, "halton")


def spread(evaluator: Evaluator, dimension: int, evaluations: int, seed: int) -> None:
    """Evaluate the designs of NSGA-II, one objective for each that is wanted.

    Raises
    ------
    MissingSoftware
        If pymoo is not installed.
    """
    with optional("pymoo", "method='front'", "optimise"):
        from pymoo.algorithms.moo.nsga2 import NSGA2
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize

    goals, size = evaluator.goals, population_size(dimension, evaluations)

    class Designs(Problem):  # type: ignore[misc]
        """The merits of designs, with the violation of bounds as a constraint."""

        def _evaluate(self, x: Array, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
            rows = evaluator.evaluate(x)
            out["F"] = np.array([-goals.merits(row) for row in rows])
            out["G"] = np.array([[goals.violation(row)] for row in rows])

    problem = Designs(n_var=dimension, n_obj=len(goals.task.wanted), n_ieq_constr=1, xl=0.0, xu=1.0)
    first = unit_sample(dimension, size, seed)
    generations = max(evaluations // size, 1)
    minimize(
        problem,
        NSGA2(pop_size=size, sampling=first),
        ("n_gen", generations),
        seed=seed,
        verbose=False,
    )
