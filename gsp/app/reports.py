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
from secrets import token_urlsafe
from urllib.parse import urlencode

from fastapi import FastAPI, Request
from fastapi.responses import HTMLResponse, RedirectResponse, Response

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
# Finished reports that are kept, to be read again and saved, and the word of their key in a query.
MOST_KEPT, KEY = 8, "report"


class Unwanted(GspError):
    """The page that requested a report was closed."""


def add_reports(app: FastAPI, default: Design) -> None:
    """Add /report, which takes the query of a link: GET is a page that waits for POST.

    POST computes the report, and leads to it by a key in the query. Requests by POST have an
    Origin, so pages of others cannot start a report (see `Guard`).

    Parameters
    ----------
    app : FastAPI
    default : Design
        Of queries that name none.
    """
    free = threading.BoundedSemaphore(MOST_REPORTS)
    kept: dict[str, str] = {}

    @app.get("/report", include_in_schema=False)
    def waiting(request: Request) -> HTMLResponse:
        query, key = split(request)
        if key in kept:
            return HTMLResponse(kept[key])
        try:
            name = links.restored(links.parsed(query), default).design.name
        except GspError as error:
            return HTMLResponse(note(f"The link cannot be used: {error}"), 422)
        what = f"The report of {shortened(name or 'the design')} is computed, which takes seconds …"
        return HTMLResponse(note(what, 0))

    @app.post("/report", include_in_schema=False)
    async def computed(request: Request) -> Response:
        if not free.acquire(blocking=False):
            return HTMLResponse(note("Another report is computed first …", SECONDS_TO_ASK), BUSY)
        try:
            query, _ = split(request)
            page = await beside(
                links.restored(links.parsed(query), default), request.is_disconnected
            )
        except GspError as error:
            return HTMLResponse(note(str(error)), 422)
        finally:
            free.release()
        key = token_urlsafe()
        kept[key] = page
        for old in list(kept)[:-MOST_KEPT]:
            del kept[old]
        return RedirectResponse(f"?{urlencode([*query, (KEY, key)])}", 303)


def split(request: Request) -> tuple[list[tuple[str, str]], str]:
    """Return the query of a link, and the key of a finished report in it, "" for none."""
    pairs = request.query_params.multi_items()
    return [pair for pair in pairs if pair[0] != KEY], request.query_params.get(KEY, "")


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
    threading.Thread(target=end_with_server, daemon=True).start()
    if hasattr(os, "nice"):
        os.nice(NICE)
    import matplotlib as mpl

    mpl.use("svg")
    design, pose, length = words
    try:
        pipe.send((True, report(design, pose, length=length, progress=False)))
    except GspError as error:
        pipe.send((False, str(error)))


def end_with_server() -> None:
    """Wait until the process that started this one has ended, and end this one."""
    server = multiprocessing.parent_process()
    if server is not None:
        server.join()
        os._exit(1)


def note(
    text: str, seconds: int | None = None, *, title: str = "gsp: report", link: str = ""
) -> str:
    """Return a page with one sentence.

    Parameters
    ----------
    text, title : str
    seconds : int or None
        After which it requests the report by POST; None for never.
    link : str
        Text of a link to the tool, "" for none.
    """
    after = f"<p><a href='/'>{escape(link)}</a></p>" if link else ""
    form = (
        "<form method=post><noscript><button>Compute it</button></noscript></form>"
        f"<script>setTimeout(() => document.forms[0].submit(), {1000 * (seconds or 0)})</script>"
    )
    return (
        "<!doctype html><html lang=en><head><meta charset=utf-8>"
        f"<title>{escape(title)}</title>"
        "<meta name=viewport content='width=device-width, initial-scale=1'>"
        "<style>body{font:18px/1.5 system-ui,sans-serif;max-width:40rem;margin:20vh auto;"
        "padding:0 1rem;color:#1f2933}</style></head>"
        f"<body><p role=status>{escape(text)}</p>{after}{'' if seconds is None else form}"
        "</body></html>"
    )
