"""Settings of all tests, and of the examples in the docstrings of `gsp`."""

import gc
import os
import shutil
import sys
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

from tests import campaign

pytest_plugins = ["tests.six_three"]

settings.register_profile("gsp", derandomize=True, deadline=None, max_examples=60)
settings.load_profile("gsp")

ROOT = Path(__file__).parent

# Maxima that tests, notebooks and examples compute do not go to the user's own store.
STORE = Path(tempfile.mkdtemp(prefix="gsp-tests-"))
os.environ["GSP_STORE"] = str(STORE / "maxima.sqlite")


@pytest.fixture(autouse=True)
def _figures_closed():
    """Close what a test or an example has drawn, also if it fails: the next one begins without."""
    yield
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot is not None:
        pyplot.close("all")


def pytest_addoption(parser):
    """Add the option that `make check-long` gives."""
    parser.addoption(
        "--campaign",
        choices=(campaign.SHORT, campaign.FULL),
        default=campaign.SHORT,
        help="the form of the campaigns: short (make test) or full (make check-long)",
    )


def pytest_configure(config):
    """Set the size of campaigns, before tests are collected."""
    campaign.choose(config.getoption("campaign"))


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collect tests without searches for garbage, and leave them out of the later searches.

    What is collected stays until the end: to search it again and again takes a fifth of the time.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()


def pytest_unconfigure():
    """Remove the store of this run."""
    shutil.rmtree(STORE, ignore_errors=True)
