"""Numbers that do not fit into memory are refused by the name of the option, before any work."""

import pytest

NAME = "toz-kucuk-2016-d3-6"
MANY = 10**15


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (("sweep", NAME, "--rotate", "z", "--steps", MANY), "--steps"),
        (("sweep", NAME, "--translate", "z", "--steps", 10**30), "--steps"),
        (("sweep", NAME, "--over", "xy", "--steps", 10**7), "--steps (squared, with --over)"),
        (("rank", NAME, "--samples", MANY), "--samples"),
        (("workspace", "workspace-6-3", "--rays", MANY), "--rays"),
        (("prove", "D1^6", "--poses", MANY), "--poses"),
    ],
)
def test_refused(gsp, words, option):
    number = words[-1] ** 2 if "squared" in option else words[-1]
    error = gsp(*words).error
    assert error.startswith(f"gsp: {option}: expected at most "), error
    assert error.endswith(f"GB of memory), received {number}"), error
