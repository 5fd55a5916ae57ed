"""Compiled functions as plain Python, for tests of a single one.

Numba would compile it, with all that it calls, for this test alone: seconds, where the calls take
less. What is compiled as a whole is held by the tests of the results.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager

import pytest


@contextmanager
def interpreted(*packages):
    """Call the functions that the modules of packages name without compiling them."""
    from numba.core.registry import CPUDispatcher

    with pytest.MonkeyPatch.context() as patch:
        for module in [m for name, m in sys.modules.items() if name.startswith(packages)]:
            for name, value in list(vars(module).items()):
                if isinstance(value, CPUDispatcher):
                    patch.setattr(module, name, value.py_func)
        yield
