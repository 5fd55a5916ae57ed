"""How the damping of steps follows from the decrease that they brought."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, Mask

# Damping as a share of the largest norm of a column of the derivatives: the first one after a step
# that is refused, the last one of a search, and the least one, below which it is none.
FIRST_DAMPING, LAST_DAMPING, LEAST_DAMPING = 1e-4, 1e6, 1e-10
# A step is taken if its decrease is more than this share of the predicted one.
ACCEPTED = 1e-3
# Shares below and above which the damping grows and shrinks, and by which factors. Equal ones would
# return to a damping that was refused after each step.
POOR, GOOD = 0.25, 0.75
GROWTH, SHRINKAGE = 4.0, 3.0
# Larger components of a step, in sizes of the design and in rad, are refused: the residuals are far
# from linear there.
MOST_STEP = 1.0


def accepted(decrease: Array, predicted: Array, largest: Array) -> Mask:
    """Return which steps are taken: those that are short and descend about as predicted."""
    return np.asarray((decrease > ACCEPTED * predicted) & (largest <= MOST_STEP))


def next_damping(damping: Array, decrease: Array, predicted: Array, largest: Array) -> Array:
    """Return the damping after a step, as a share.

    Parameters
    ----------
    damping, decrease, predicted, largest : (...) arrays
        Damping of the step, by how much the cost decreased and was predicted to, and the largest
        component of the step [sizes of the design, rad].
    """
    poor = ~(decrease >= POOR * predicted) | (largest > MOST_STEP)
    good = (decrease >= GOOD * predicted) & ~poor
    less = damping / SHRINKAGE
    less = np.where(less >= LEAST_DAMPING, less, 0.0)
    more = np.maximum(FIRST_DAMPING, damping * GROWTH)
    return np.where(poor, more, np.where(good, less, damping))
