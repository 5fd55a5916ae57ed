"""Acceptance of steps of Newton's method, and the length of the next one: formulas on scalars.

A step leads from the rows A to the rows B of the dimensionless Jacobian, along a path J(s),
0 ≤ s ≤ 1. With |J_i″| ≤ S_i for its rows J_i,

    J(s) = A + s (B − A) + E(s),    |E_i(s)| ≤ s (1 − s) S_i / 2.

On the first half A⁻¹ J(s) differs from I by at most `reach` (Frobenius norm), with c_i the norms of
the columns of A⁻¹:

    reach = ‖A⁻¹ (B − A)‖ / 2 + Σ c_i S_i / 8,

and on the second half B⁻¹ J(s) does so with B⁻¹. Where both are below 1, no J(s) is singular. (With
more than six rows the same holds for pseudo-inverses, and J(s) has rank 6.) The bounds S_i are
those of `gsp.variation`; they are infinite if a leg may become undefined on the path.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from gsp.geometry.scalars import choose, less
from gsp.geometry.vectors import EPS

# Largest `reach` of a step that is taken. What is missing to 1 covers the rounding of the inverses:
# 1e-15 × condition, which is below 1e-7 × 100 at postures that are not singular.
PROVEN_SHARE = 0.9
# `reach` at which the length of the next step aims.
AIMED_REACH = 0.7
# Greatest growth of a step after one that is taken; least and greatest cut after one that is not.
STEP_GROWTH, LEAST_CUT, GREATEST_CUT = 4.0, 0.5, 0.0625
LARGEST_STEP = 0.5  # of the design's size, and rad
SMALLEST_SHARE = 2.0**-30
# A search that stops where 1/‖J⁻¹‖ is below this counts as singular: steps that are proven to stay
# regular approach a singularity by a factor each, and never reach it.
NEAR_SINGULAR = 1e-3
# Newton–Kantorovich: a solution is isolated where (residual / σ_min²) × curvature < 1/2. Rows bend
# by about 1 / (length of the leg / size of the design); this allows for legs of 1/50 of the size.
ISOLATION_BOUND = 0.01
# Share of the first-order decrease of the errors that a step must achieve.
DECREASE_SHARE = 0.25

CONVERGED, NOT_CONVERGED, SINGULAR, UNDEFINED = range(1, 5)


class Step(NamedTuple):
    """The quantities of a trial step: scalars.

    Attributes
    ----------
    fresh : 1 if the trial is the guess itself, else 0
    undefined : number of undefined legs at its end
    reach : the larger of the two above
    share : of the Newton step that it is
    here, there : norms of the joint errors at its start and end
    """

    fresh: Any
    undefined: Any
    reach: Any
    share: Any
    here: Any
    there: Any


def taken(step: Step) -> Any:
    """Return 1.0 if a step is taken, else 0.0: proven regular, and with smaller errors."""
    better = choose(less(step.there, (1.0 - DECREASE_SHARE * step.share) * step.here), 1.0, 0.0)
    regular = choose(less(step.reach, PROVEN_SHARE), better, 0.0)
    known = choose(less(step.undefined, 0.5), regular, 0.0)
    return choose(less(0.5, step.fresh), 1.0, known)


def next_share(step: Step, took: Any, sizes: tuple[Any, Any, Any]) -> Any:
    """Return the share of the next Newton step that is tried.

    Parameters
    ----------
    step : Step
    took : scalar
        Of `taken`.
    sizes : three scalars
        Length of the Newton step at the start, length of that at the end, and the larger of the
        translation and of the angle of the latter.
    """
    old, new, largest = sizes
    allowed = choose(less(LARGEST_STEP, largest), LARGEST_STEP / largest, 1.0)
    aimed = AIMED_REACH / step.reach  # infinite where nothing moves
    growth = choose(less(aimed, STEP_GROWTH), aimed, STEP_GROWTH)
    steady = growth * step.share * old / new
    steady = choose(less(steady, allowed), steady, allowed)
    onward = choose(less(0.5, step.fresh), allowed, steady)
    cut = choose(less(aimed, LEAST_CUT), aimed, LEAST_CUT)
    # Comparisons of NaN are false: an unknown reach gives the greatest cut.
    cut = choose(less(GREATEST_CUT, cut), cut, GREATEST_CUT)
    return choose(less(0.5, took), onward, cut * step.share)


def stopped(inverse: Any) -> Any:
    """Return how a search ends that gets no further, from ‖J⁻¹‖² (Frobenius)."""
    near = less(1.0, NEAR_SINGULAR * NEAR_SINGULAR * inverse)
    return choose(near, float(SINGULAR), float(NOT_CONVERGED))


def ending(
    step: Step, took: Any, error: tuple[Any, Any], inverse: Any, share: Any, tolerance: Any
) -> Any:
    """Return how a search ends at its present posture; 0.0 if it continues.

    Parameters
    ----------
    step, took : Step, scalar
    error : two scalars
        Largest joint error and norm of the errors.
    inverse : scalar
        ‖J⁻¹‖² (Frobenius), at least 1/σ_min².
    share : scalar
        Of the next step.
    tolerance : scalar
    """
    largest, size = error
    met = less(largest, tolerance * (1.0 + 2.0 * EPS))
    isolated = choose(less(size * inverse, ISOLATION_BOUND), float(CONVERGED), float(SINGULAR))
    stuck = choose(less(share, SMALLEST_SHARE), stopped(inverse), 0.0)
    onward = choose(met, isolated, stuck)
    onward = choose(less(EPS * inverse, ISOLATION_BOUND), onward, float(SINGULAR))
    known = choose(less(step.undefined, 0.5), onward, float(UNDEFINED))
    return choose(less(0.5, step.fresh), known, onward)
