"""Reports that pages request: computed in another process, so that sliders of all pages go on."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Awaitable, Callable
from html import escape
from multiprocessing.connection import Connection

from fastapi import FastAPI, Request
from fastapi.responses import HTMLResponse

from gsp.app.report import report
from gsp.app.state import links
from gsp.app.state.choices import shortened
from gsp.app.state.session import Session
from gsp.errors import GspError
from gsp.geometry.pose import Pose
from gsp.model.design import Design

# Reports that are computed at the same time; pages of further ones ask again.
MOST_REPORTS = 1
# Seconds until a page asks again, and the longest time for one report.
SECONDS_TO_ASK, LONGEST_REPORT = 3, 600.0
# Seconds between two looks at the process, and at whether its page is still open.
LOOK = 0.2
# Priority of the process, which is lower than that of the server.
NICE = 10
# The status of an answer while another report is computed.
BUSY = 429


class Unwanted(GspError):
    """The page that requested a report was closed."""


def add_reports(app: FastAPI, default: Design) -> None:
    """Add /report, which takes the query of a link: GET is a page that waits for POST, the report.

    Requests by POST have an Origin, so pages of others cannot start a report (see `Guard`).

    Parameters
    ----------
    app : FastAPI
    default : Design
        Of queries that name none.
    """
    free = threading.BoundedSemaphore(MOST_REPORTS)

    @app.get("/report", include_in_schema=False)
    def waiting(request: Request) -> HTMLResponse:
        try:
            name = links.restored(dict(request.query_params), default).design.name
        except GspError as error:
            return HTMLResponse(note(f"The link cannot be used: {error}"), 422)
        what = f"The report of {shortened(name or 'the design')} is computed, which takes seconds …"
        return HTMLResponse(note(what, 0))

    @app.post("/report", include_in_schema=False)
    async def computed(request: Request) -> HTMLResponse:
        if not free.acquire(blocking=False):
            return HTMLResponse(note("Another report is computed first …", SECONDS_TO_ASK), BUSY)
        try:
            state = links.restored(dict(request.query_params), default)
            return HTMLResponse(await beside(state, request.is_disconnected))
        except GspError as error:
            return HTMLResponse(note(str(error)), 422)
        finally:
            free.release()


async def beside(state: Session, gone: Callable[[], Awaitable[bool]]) -> str:
    """Return the report of a state, computed by another process.

    Parameters
    ----------
    state : Session
    gone : coroutine function
        Whether nobody waits for the report any longer.

    Raises
    ------
    Unwanted
        If nobody waits; the process is stopped.
    GspError
        If the process ends without a report.
    """
    context = multiprocessing.get_context("spawn")
    mine, other = context.Pipe(duplex=False)
    words = (state.design, state.pose, state.length)
    process = context.Process(target=send_report, args=(words, other), daemon=True)
    process.start()
    other.close()
    try:
        await _written(mine, gone)
        done, text = await asyncio.to_thread(mine.recv)
    except EOFError as error:
        raise GspError("The process of the report has ended without one.") from error
    finally:
        process.terminate()
        process.join()
        mine.close()
    if not done:
        raise GspError(text)
    return str(text)


async def _written(pipe: Connection, gone: Callable[[], Awaitable[bool]]) -> None:
    """Wait until a process writes to a pipe, or ends."""
    last = time.monotonic() + LONGEST_REPORT
    while not pipe.poll():
        if await gone():
            raise Unwanted("The page of the report was closed.")
        if time.monotonic() > last:
            raise GspError("The report was stopped, as it took too long.")
        await asyncio.sleep(LOOK)


def send_report(words: tuple[Design, Pose, float | None], pipe: Connection) -> None:
    """Compute a report and send (True, page) or (False, reason); the main function of a process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the server
    if hasattr(os, "nice"):
        os.nice(NICE)
    import matplotlib as mpl

    mpl.use("svg")
    design, pose, length = words
    try:
        pipe.send((True, report(design, pose, length=length, progress=False)))
    except GspError as error:
        pipe.send((False, str(error)))
    except BrokenPipeError:
        pass  # the server was killed


def note(text: str, seconds: int | None = None) -> str:
    """Return a page with one sentence; after some seconds it requests the report by POST."""
    form = (
        "<form method=post><noscript><button>Compute it</button></noscript></form>"
        f"<script>setTimeout(() => document.forms[0].submit(), {1000 * (seconds or 0)})</script>"
    )
    return (
        "<!doctype html><html lang=en><head><meta charset=utf-8><title>gsp: report</title>"
        "<meta name=viewport content='width=device-width, initial-scale=1'>"
        "<style>body{font:18px/1.5 system-ui,sans-serif;max-width:40rem;margin:20vh auto;"
        "padding:0 1rem;color:#1f2933}</style></head>"
        f"<body><p role=status>{escape(text)}</p>{'' if seconds is None else form}</body></html>"
    )
