"""|det J| of redundant designs in any unit, against 50 digits: rows of angles and of distances."""

import mpmath as mp
import numpy as np
import pytest

import gsp
from gsp.determinant.search.rounds import _determinant
from gsp.geometry.matrices import log_and_inverse
from tests.metamorphic import case, changed, random_design

LEGS = (
    ["D1"] * 8,
    ["D1"] * 5 + ["A1"] * 2,
    ["D4 A1"] + ["D1"] * 5,
    ["D4 A1"] * 4,
    ["D1", "D2", "D3", "D4", "D4 A1", "A1", "D1"],
)


def volume(rows):
    with mp.workdps(50):
        matrix = mp.matrix(rows.tolist())
        return float(mp.sqrt(mp.det(matrix.T * matrix)))


@pytest.mark.parametrize("unit", [1e-12, 1e-6, 1.0, 1e6, 1e12])
def test_no_unit_costs_digits(unit):
    for seed, legs in enumerate(LEGS):
        given = case(random_design(legs, seed, "redundant"), poses=2)
        design, pose = changed(given.design, factor=unit), given.pose.scaled(unit)
        wanted = [volume(rows) for rows in design.at(pose).jacobian]
        found = gsp.indices.manipulability(design.at(pose))
        np.testing.assert_allclose(found, wanted, rtol=1e-12)
        assert _determinant(design, pose[0]) == found[0]
        for backend in ("numpy", "compiled"):
            table = gsp.evaluate(design, pose, "|det J|", backend=backend, workers=1)
            np.testing.assert_allclose(table["manipulability"], wanted, rtol=1e-12)


def logarithm_and_inverse(rows):
    with mp.workdps(400):
        matrix = mp.matrix(rows.tolist())
        square = matrix.T * matrix
        inverse = mp.inverse(square) * matrix.T
        return float(mp.log(mp.det(square)) / 2), np.array(inverse.tolist(), dtype=float)


@pytest.mark.parametrize("unit", [1e-30, 1e-9, 1.0, 1e12, 1e30])
def test_no_unit_costs_digits_of_the_inverse_that_slopes_are_made_of(unit):
    for seed, legs in enumerate(LEGS):
        given = case(random_design(legs, seed, "redundant"), poses=1)
        design, pose = changed(given.design, factor=unit), given.pose.scaled(unit)
        rows = design.at(pose).jacobian[0]
        value, inverse = log_and_inverse(rows)
        wanted, exact = logarithm_and_inverse(rows)
        assert value == pytest.approx(wanted, abs=1e-12)
        # The slope of the logarithm is the sum of its entries times changes of those of the rows,
        # which are as large as the force and the moment of each row.
        sizes = [np.abs(rows[:, part]).max(axis=1) for part in (slice(0, 3), slice(3, 6))]
        assert (np.abs(inverse - exact) * np.repeat(sizes, 3, axis=0)).max() < 1e-12


@pytest.mark.parametrize("unit", [1e-9, 1e-3, 1.0, 1e12])
def test_a_search_settles_in_every_unit(unit):
    design = changed(random_design(LEGS[1], 3, "redundant"), factor=unit)
    found = gsp.determinant.maximum(design, store=False, progress=False)
    assert found.converged
    assert found.agreed >= 2


@pytest.mark.parametrize("legs", [*LEGS, ["D1"] * 6, ["D4 A1"] * 3], ids="-".join)
def test_a_determinant_with_a_unit_scales_with_it(legs):
    given = case(random_design(legs, 3, "redundant"), poses=1)
    design, pose = given.design, given.pose
    one, other = design.at(pose), changed(design, factor=3.0).at(pose.scaled(3.0))
    ratio = gsp.indices.manipulability(other) / gsp.indices.manipulability(one)
    scales = np.isclose(ratio, 3.0**design.determinant_power, rtol=1e-9).all()
    assert design.determinant_has_unit == scales


def test_singular_and_undefined_rows():
    rows = np.zeros((3, 8, 6))
    rows[1] = np.nan
    rows[2, :6] = np.eye(6)
    np.testing.assert_array_equal(gsp.geometry.matrices.absolute_determinant(rows), [0, np.nan, 1])
