"""Three-vectors and the checks of numbers."""

from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gsp.checks import check_array, check_integer, check_positive, check_rng, check_text
from gsp.errors import InvalidInput
from gsp.geometry.vectors import (
    cross,
    dot,
    frozen,
    nearest_to_origin,
    norm,
    perpendicular,
    skew,
    unit,
)

vectors = arrays(float, 3, elements=st.floats(-1e100, 1e100))


@given(vectors, vectors)
def test_products_are_those_of_numpy(x, y):
    np.testing.assert_array_equal(cross(x, y), np.cross(x, y))
    np.testing.assert_allclose(dot(x, y), x @ y, rtol=1e-14, atol=4e-16 * norm(x) * norm(y))
    np.testing.assert_allclose(
        skew(x) @ y, np.cross(x, y), rtol=1e-14, atol=4e-16 * norm(x) * norm(y)
    )


@given(arrays(float, 3, elements=st.floats(-1e100, 1e100).filter(lambda x: abs(x) > 1e-100)))
def test_unit(x):
    u = unit(x)
    assert norm(u) == pytest.approx(1.0, abs=1e-15)
    np.testing.assert_array_equal(unit(u), u)
    np.testing.assert_allclose(u * norm(x), x, rtol=1e-15)


def test_unit_of_zero_is_nan_in_that_element_only():
    result = unit(np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 4.0]]))
    assert np.isnan(result[0]).all()
    np.testing.assert_array_equal(result[1], [0.6, 0.0, 0.8])


def test_vectors_across_others_are_perpendicular_unit_vectors():
    x = np.concatenate((np.eye(3), -np.eye(3), np.random.default_rng(1).normal(size=(20, 3))))
    across = perpendicular(1e9 * x)
    np.testing.assert_allclose(dot(across, across), 1.0, atol=1e-15)
    np.testing.assert_allclose(dot(across, unit(x)), 0.0, atol=1e-15)
    np.testing.assert_array_equal(perpendicular(1e9 * x[7]), across[7])
    assert np.isnan(perpendicular(np.zeros(3))).all()


def test_points_of_lines_nearest_to_the_origin():
    point, line = np.random.default_rng(2).normal(size=(2, 20, 3))
    direction = unit(line)
    nearest = nearest_to_origin(direction, np.cross(point, direction))
    np.testing.assert_allclose(dot(nearest, direction), 0.0, atol=1e-14)
    np.testing.assert_allclose(np.cross(nearest - point, direction), 0.0, atol=1e-14)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_leading_axes(shape):
    x, y = np.random.default_rng(0).standard_normal((2, *shape, 3))
    assert dot(x, y).shape == norm(x).shape == shape
    assert cross(x, y).shape == unit(x).shape == perpendicular(x).shape == (*shape, 3)
    assert skew(x).shape == (*shape, 3, 3)


def test_frozen_is_a_read_only_copy():
    source = np.zeros(3)
    copy = frozen(source)
    source[0] = 1.0
    assert copy[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        copy[0] = 1.0


@pytest.mark.parametrize(
    "value",
    [
        [1, 2, 3],
        (1.0, 2.0, 3.0),
        np.array([1, 2, 3], dtype=np.int8),
        np.float32([1, 2, 3]),
        [Fraction(1), Decimal(2), mpmath.mpf(3)],
        np.array([1, 2.0, 3], dtype=object),
        range(1, 4),
        np.ma.array([1.0, 2.0, 3.0]),
    ],
)
def test_check_array_takes_real_numbers(value):
    array = check_array("x", value, (3,))
    assert array.dtype == np.float64
    np.testing.assert_array_equal(array, [1, 2, 3])


NO_NUMBERS = [
    None, "abc", "1", b"1", 1j, True, object(), {}, {1, 2, 3}, ["1", "2", "3"], [1, None, 3],
    [1j, 2, 3], [True, False, True], [[1, 2], [3]], [10**400, 0, 0], np.array([1j, 2, 3]),
    np.array(["1", "2", "3"]), np.array([1, "2", 3], dtype=object), np.datetime64("2020-01-01"),
    np.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0]), iter([1, 2, 3]),
]  # fmt: skip


@pytest.mark.parametrize("value", NO_NUMBERS, ids=lambda value: type(value).__name__)
def test_check_array_raises_for_what_is_not_a_number(value):
    with pytest.raises(InvalidInput, match=r"^x: expected (real numbers|finite).*, received"):
        check_array("x", value, (3,))


@pytest.mark.parametrize(
    ("value", "shape", "wanted"),
    [
        (1.0, (3,), r"\(\.\.\., 3\)"),
        ([1, 2], (3,), r"\(\.\.\., 3\)"),
        ([], (3,), r"\(\.\.\., 3\)"),
        ([[1, 2]], (2, 3), r"\(\.\.\., 2, 3\)"),
        ([1, 2, 3], (None, 3), r"\(\.\.\., n, 3\)"),
    ],
)
def test_error_of_check_array_states_the_shape(value, shape, wanted):
    with pytest.raises(InvalidInput, match=f"x: expected shape {wanted}, received shape"):
        check_array("x", value, shape)


@pytest.mark.parametrize("value", [1.0, [1, 2], [[1, 2, 3]], [[1, 2, 3]] * 2, np.zeros((2, 2, 3))])
def test_an_array_of_as_many_axes_as_its_shape_is_no_batch(value):
    assert check_array("x", [1, 2, 3], (3,), axes=1).shape == (3,)
    with pytest.raises(InvalidInput, match=r"x: expected shape \(3,\), received shape"):
        check_array("x", value, (3,), axes=1)
    with pytest.raises(InvalidInput, match=r"x: expected shape \(n, 3\), received shape \(3,\)"):
        check_array("x", [1, 2, 3], (None, 3), axes=2)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_error_of_check_array_states_where_it_is_not_finite(bad):
    with pytest.raises(InvalidInput, match=r"x \(at index \[1, 2\]\): expected finite numbers"):
        check_array("x", [[0, 0, 0], [0, 0, bad]], (3,))
    assert check_array("x", [0, 0, bad], (3,), finite=False).shape == (3,)


@pytest.mark.parametrize("value", [1, 1.5, np.float32(2.0), np.array(3.0), Fraction(1, 3), 1e-300])
def test_check_positive(value):
    assert check_positive("x", value) == float(value)


@pytest.mark.parametrize(
    "value",
    [*NO_NUMBERS, 0, 0.0, -1.0, np.nan, np.inf, [1.0], [], np.ones(3), 5e-324],
    ids=lambda value: type(value).__name__,
)
def test_check_positive_raises(value):
    with pytest.raises(InvalidInput, match="x: expected a positive number"):
        check_positive("x", value)


def test_check_integer():
    assert [check_integer("n", n) for n in (1, np.int64(5), np.array(7))] == [1, 5, 7]
    assert check_integer("n", 0, least=0) == 0


@pytest.mark.parametrize("value", [0, -1, 1.0, "1", None, True, [1], np.ones(2)], ids=repr)
def test_check_integer_raises(value):
    with pytest.raises(InvalidInput, match="n: expected an integer ≥ 1, received"):
        check_integer("n", value)
    with pytest.raises(InvalidInput, match="n: expected an integer ≤ 9223372036854775807"):
        check_integer("n", 10**400)


def test_check_rng():
    generator = np.random.default_rng(0)
    assert check_rng("rng", generator) is generator
    assert check_rng("rng", 5).random() == check_rng("rng", np.int32(5)).random()


@pytest.mark.parametrize("value", [None, 1.0, "0", True, [1, 2], np.random], ids=repr)
def test_check_rng_raises(value):
    with pytest.raises(InvalidInput, match=r"rng: expected a seed .* received"):
        check_rng("rng", value)


def test_a_seed_out_of_range_names_the_range():
    with pytest.raises(InvalidInput, match="rng: expected an integer ≥ 0, received -1"):
        check_rng("rng", -1)
    with pytest.raises(InvalidInput, match="rng: expected an integer ≤"):
        check_rng("rng", 10**30)


@pytest.mark.parametrize("value", [None, 1, b"mm", ["mm"], "\ud800"], ids=repr)
def test_check_text_raises(value):
    with pytest.raises(InvalidInput, match="unit: expected a text"):
        check_text("unit", value)
