"""Compiled code, made from the stages; importing a module of this package loads numba.

The first compilation of a process is logged: it takes up to a minute. Later processes read the
result from numba's cache. Every module that compiles imports this package, also for the log alone.
"""

from __future__ import annotations

import logging
from typing import Any

from numba.core import event

from gsp.progress import COMPILATION, compiling

LOG = logging.getLogger(COMPILATION)


class _First(event.Listener):
    """Logs the first compilation, and counts those that run; not what the cache holds."""

    logged = False

    def on_start(self, event: Any) -> None:
        compiling(1)
        if not self.logged:
            self.logged = True
            LOG.info("formulas are compiled, once for each installation: up to a minute")

    def on_end(self, event: Any) -> None:
        compiling(-1)


event.register("numba:compile", _First())
