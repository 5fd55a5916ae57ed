"""The size of campaigns follows the option --campaign."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.campaign import count, some

ROOT = Path(__file__).parents[1]


def test_campaigns_follow_the_option(pytestconfig):
    wanted = {"short": 3, "full": 30}[pytestconfig.getoption("campaign")]
    assert count(short=3, full=30) == wanted


def test_some_cases_are_spread_from_first_to_last(pytestconfig):
    full = pytestconfig.getoption("campaign") == "full"
    assert some("abcdefg", 3) == (list("abcdefg") if full else ["a", "d", "g"])
    assert some("abcdefg", 1) == (list("abcdefg") if full else ["a"])
    assert some("ab", 3) == ["a", "b"]


def test_option_reaches_the_tests():
    here = f"{Path(__file__).relative_to(ROOT)}::test_campaigns_follow_the_option"
    command = (sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", here)
    done = subprocess.run(
        [*command, "--campaign=full"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("sizes", [(0, 3), (5, 3)])
def test_a_short_form_is_shorter_and_not_empty(sizes):
    with pytest.raises(ValueError, match="short"):
        count(*sizes)
