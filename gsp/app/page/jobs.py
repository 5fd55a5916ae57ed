"""Work that takes longer than a step of a slider: in threads, a few at the same time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from nicegui import run

# Jobs of all clients at the same time; others wait, so that pages respond quickly.
MOST_JOBS = 2

P = ParamSpec("P")
R = TypeVar("R")
_free: dict[asyncio.AbstractEventLoop, asyncio.Semaphore] = {}


async def job(function: Callable[P, R], *words: P.args, **named: P.kwargs) -> R | None:
    """Return the value of a function, computed beside the page; None when the server ends.

    Compiled code releases the lock of the interpreter, so sliders of all clients go on meanwhile.
    """
    loop = asyncio.get_running_loop()
    async with _free.setdefault(loop, asyncio.Semaphore(MOST_JOBS)):
        return await run.io_bound(function, *words, **named)
