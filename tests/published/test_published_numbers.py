"""How a printed number is read and compared."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gsp.errors import InvalidInput
from gsp.published.numbers import compare, evaluate


@pytest.mark.parametrize(
    ("text", "computed", "rounding", "decimals", "agrees", "digits", "of"),
    [
        ("0.687", 0.68712, "rounded", None, True, 3, 3),
        ("0.687", 0.68749, "rounded", None, True, 3, 3),
        ("0.687", 0.68751, "rounded", None, False, 2, 3),
        ("0.687", 0.68799, "cut", None, True, 3, 3),
        ("0.687", 0.68699, "cut", None, False, 2, 3),
        ("-0.39", -0.3909, "cut", 3, True, 3, 3),
        ("-0.39", -0.3911, "cut", 3, False, 2, 3),
        ("-0.39", -0.3909, "rounded", None, True, 2, 2),
        ("-0.39", 0.3909, "cut", 3, False, 0, 3),
        ("126.31", 126.3096, "rounded", 3, True, 6, 6),
        ("126.31", 126.3086, "rounded", 3, False, 4, 6),
        ("9.99", 10.0, "rounded", None, False, 0, 3),
        ("0", 0.0004, "cut", 3, True, 1, 1),
        ("0", -0.0011, "cut", 3, False, 0, 1),
        ("195", 195.0, "rounded", None, True, 3, 3),
        ("−0.5", -0.51, "rounded", None, True, 1, 1),
        ("0.5", 1e300, "rounded", None, False, 0, 1),
        ("0.5", -1e300, "cut", None, False, 0, 1),
        ("0.5", 1e-300, "rounded", 40, False, 0, 40),
        ("1e3", 1000.4, "rounded", None, True, 4, 4),
        ("0.3", 0.1 + 0.2, "cut", None, True, 1, 1),
    ],
)
def test_digits_that_agree(text, computed, rounding, decimals, agrees, digits, of):
    found = compare(text, computed, rounding, decimals)
    assert (found.agrees, found.digits, found.of, found.readable) == (agrees, digits, of, True)


@given(st.decimals(-1000, 1000, places=3), st.floats(-0.49, 0.49))
def test_every_value_that_rounds_to_the_print_agrees(printed, fraction):
    value = float(printed) + fraction * 1e-3
    assert compare(str(printed), value).agrees
    assert not compare(str(printed), value + 1.2e-3).agrees
    assert not compare(str(printed), value - 1.2e-3).agrees


@pytest.mark.parametrize("text", ["z", "0.x3", "", "2*z", "nan", "inf"])
def test_what_is_not_a_number_is_unreadable(text):
    for rounding in ("rounded", "cut"):
        found = compare(text, 1.0, rounding)
        assert not found.readable
        assert not found.agrees


@pytest.mark.parametrize("computed", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("rounding", ["rounded", "cut", "exact"])
def test_a_value_that_is_not_finite_never_agrees(computed, rounding):
    found = compare("0.5", computed, rounding)
    assert not found.agrees
    assert found.digits == 0


def test_exact_means_twelve_digits():
    root = "sqrt(2*sqrt(5) - 4)"
    value = math.sqrt(2.0 * math.sqrt(5.0) - 4.0)
    assert compare(root, value, "exact").agrees
    assert not compare(root, value + 3e-12, "exact").agrees
    assert compare(root, value + 3e-12, "exact").digits == 11
    assert compare("2*t^2", 0.5, "exact", names={"t": 0.5}).agrees
    assert not compare("2*z^2", 0.5, "exact", names={"t": 0.5}).readable


def test_expressions():
    assert evaluate("-arctan(1)*180/pi") == pytest.approx(-45.0)
    assert evaluate("2^3 - arccos(0)*2/pi + arcsin(0) + sin(0) + cos(0)") == pytest.approx(8.0)
    assert evaluate("r*t", {"r": 2, "t": 3}) == 6.0


@pytest.mark.parametrize(
    "text",
    [
        "",
        "1 +",
        "x",
        "1/0",
        "sqrt(-1)",
        "__import__('os')",
        "(1).real",
        "[1]",
        "'a'",
        "f(1)",
        "1; 2",
    ],
)
def test_a_text_that_is_not_an_expression_is_an_error(text):
    with pytest.raises(InvalidInput, match="printed number"):
        evaluate(text)
