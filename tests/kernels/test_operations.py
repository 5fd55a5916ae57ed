"""Counts of operations, against counts by hand and by numbers that count."""

import math

import numpy as np
import pytest

from gsp.geometry.ellipsoid import ellipsoid_frame
from gsp.kernels import stages
from gsp.kernels.formulas.spectrum import solved_row
from gsp.kernels.operations import Operations, evaluation, operations
from gsp.kernels.problems import CONTROL_PROBLEM, ELLIPSOID_PROBLEM, HOMOGENEOUS_PROBLEM
from gsp.model.legs import LEG


class Counted:
    """A float that counts what is done with it and its like."""

    counts = np.zeros(5)

    def __init__(self, value):
        self.value = value

    def made(self, value, column):
        self.counts[column] += 1
        return Counted(value)

    def __add__(self, other):
        return self.made(self.value + other.value, 0)

    def __sub__(self, other):
        return self.made(self.value - other.value, 0)

    def __mul__(self, other):
        return self.made(self.value * other.value, 1)

    def __truediv__(self, other):
        return self.made(self.value / other.value, 2)

    def sqrt(self):
        return self.made(math.sqrt(self.value), 3)


def counted(formula, *sizes):
    Counted.counts[:] = 0.0
    formula(*([Counted(1.0 + i) for i in range(size)] for size in sizes))
    return Operations(*Counted.counts.tolist())


def test_counts_by_hand():
    assert operations(stages.REACH_STAGE) == Operations(sums=2, products=3, roots=1)
    assert operations(stages.HOMOGENEOUS_ROW) == Operations(products=3)
    assert operations(stages.SOLVED_ROW) == Operations(sums=15, products=21)


def test_counts_by_numbers_that_count():
    """Where no term occurs twice, the graph has as many operations as the formula."""
    assert operations(stages.SOLVED_ROW) == counted(solved_row, 6, 21, 6)
    assert operations(stages.ELLIPSOID_FRAME) == counted(ellipsoid_frame, 9, 3, 9)


def test_parts_add_up():
    """Each problem is solved by itself, and a Laguerre step costs what its stage does."""
    legs = [LEG["D1"]] * 5 + [LEG["D4 A1"]]
    parts = [
        evaluation(legs, p, 5.0).total
        for p in (0, HOMOGENEOUS_PROBLEM, ELLIPSOID_PROBLEM, CONTROL_PROBLEM)
    ]
    everything = evaluation(
        legs, HOMOGENEOUS_PROBLEM | ELLIPSOID_PROBLEM | CONTROL_PROBLEM, 5.0
    ).total
    assert everything == pytest.approx(sum(parts) - 3 * parts[0])
    more = evaluation(legs, HOMOGENEOUS_PROBLEM, 6.0).total
    assert more - parts[1] == operations(stages.LAGUERRE).total
