"""Settings of all tests."""

import os
import shutil
import tempfile
from pathlib import Path

from hypothesis import settings

pytest_plugins = ["tests.six_three"]

settings.register_profile("gsp", derandomize=True, deadline=None, max_examples=60)
settings.load_profile("gsp")

# Maxima that tests, notebooks and examples compute do not go to the user's own store.
STORE = Path(tempfile.mkdtemp(prefix="gsp-tests-"))
os.environ["GSP_STORE"] = str(STORE / "maxima.sqlite")


def pytest_unconfigure():
    """Remove the store of this run."""
    shutil.rmtree(STORE, ignore_errors=True)
