"""Reports that pages request: computed in another process, so that sliders of all pages go on."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
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
# Priority of the process, which is lower than that of the server.
NICE = 10


def add_reports(app: FastAPI, default: Design) -> None:
    """Add the addresses of reports: /report, which waits for /report/page, by the query of a link.

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
        return HTMLResponse(note(what, f"0; url=/report/page?{request.url.query}"))

    @app.get("/report/page", include_in_schema=False)
    def page(request: Request) -> HTMLResponse:
        if not free.acquire(blocking=False):
            return HTMLResponse(note("Another report is computed first …", str(SECONDS_TO_ASK)))
        try:
            state = links.restored(dict(request.query_params), default)
            return HTMLResponse(beside(state))
        except GspError as error:
            return HTMLResponse(note(str(error)), 422)
        finally:
            free.release()


def beside(state: Session) -> str:
    """Return the report of a state, computed by another process.

    Raises
    ------
    GspError
        If it ends without a report.
    """
    context = multiprocessing.get_context("spawn")
    mine, other = context.Pipe(duplex=False)
    words = (state.design, state.pose, state.length)
    process = context.Process(target=send_report, args=(words, other), daemon=True)
    process.start()
    other.close()
    try:
        if not mine.poll(LONGEST_REPORT):
            raise GspError("The report was stopped, as it took too long.")
        done, text = mine.recv()
    except EOFError as error:
        raise GspError("The process of the report has ended without one.") from error
    finally:
        process.terminate()
        process.join()
    if not done:
        raise GspError(text)
    return str(text)


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


def note(text: str, refresh: str = "") -> str:
    """Return a page with one sentence, which opens an address (seconds; url=…) afterwards."""
    again = f'<meta http-equiv="refresh" content="{escape(refresh)}">' if refresh else ""
    return (
        f"<!doctype html><html lang=en><head><meta charset=utf-8>{again}<title>gsp: report</title>"
        "<meta name=viewport content='width=device-width, initial-scale=1'>"
        "<style>body{font:18px/1.5 system-ui,sans-serif;max-width:40rem;margin:20vh auto;"
        "padding:0 1rem;color:#1f2933}</style></head>"
        f"<body><p role=status>{escape(text)}</p></body></html>"
    )
