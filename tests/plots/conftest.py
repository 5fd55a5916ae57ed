"""Figures are drawn without a screen."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def _no_screen():
    import matplotlib as mpl

    mpl.use("agg")
