"""The server of the browser tool: the page and the JSON interface, on one address."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable
from contextlib import suppress

import uvicorn
from fastapi import FastAPI, Request, Response
from fastapi.responses import HTMLResponse
from nicegui import ui

from gsp.app import api
from gsp.app.guard import WILDCARDS, Application, Guard, Policy, is_loopback
from gsp.app.page.layout import build
from gsp.app.reports import add_reports, note
from gsp.app.searches import Searches
from gsp.app.state.reading import compile_slow
from gsp.errors import GspError, InvalidInput, expected
from gsp.kinematics.forward_solution import forward
from gsp.model.design import Design, check_undriven

# Bytes of a message of a page, and seconds that open pages get when the server ends.
LARGEST_MESSAGE, SECONDS_TO_END = 1 << 20, 2
# Seconds for which the state of a page is kept without a connection; pages answer within less than
# half of it, so that one on a busy machine is not dropped.
SECONDS_TO_RECONNECT = 15.0
TITLE = "gsp · platform analysis"
NO_PAGE = "There is no page at this address."


def serve(design: Design, host: str, port: int, say: Callable[[str], object] = print) -> None:
    """Serve the browser tool until the process is interrupted.

    Parameters
    ----------
    design : Design
        What a page shows whose link names nothing else.
    host : str
        Address to listen at.
    port : int
    say : function of a text
        Called with the address, and with a warning if others can reach it.

    Raises
    ------
    InvalidInput
        If the address cannot be listened at.
    """
    check_undriven("design", design)
    listening = bound(host, port)
    searches = Searches()
    app = guarded(application(design, searches), host)
    threading.Thread(target=_prepare, args=(design,), daemon=True).start()
    shown = f"[{host}]" if ":" in host else host
    say(f"gsp app: http://{'localhost' if host in WILDCARDS else shown}:{port} (Ctrl-C ends it)")
    if not is_loopback(host):
        say("Everybody in the network can use it: there are no passwords.")
    config = uvicorn.Config(
        app,
        log_level="warning",
        ws_max_size=LARGEST_MESSAGE,
        timeout_graceful_shutdown=SECONDS_TO_END,
    )
    try:
        uvicorn.Server(config).run(sockets=[listening])
    finally:
        searches.close()


def bound(host: str, port: int) -> socket.socket:
    """Return a socket at an address.

    Raises
    ------
    InvalidInput
        If another program has the port, or this machine has no such address.
    """
    found = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        found.bind((host, port))
    except (OSError, UnicodeError) as error:
        found.close()
        why = getattr(error, "strerror", None) or str(error)
        wanted = "a free port, and an address of this machine"
        raise InvalidInput(
            expected("--port, --host", wanted, f"{port} at {host}: {why}")
        ) from error
    return found


def application(design: Design, searches: Searches) -> FastAPI:
    """Return the application: page and interface. It can be made once in a process."""
    app = api.make(searches)
    add_reports(app, design)
    app.add_middleware(Policy)
    ui.run_with(
        app,
        root=page(design, searches),
        title=TITLE,
        reconnect_timeout=SECONDS_TO_RECONNECT,
        tailwind=False,
        show_welcome_message=False,
        language="en-US",
    )
    return app


def page(design: Design, searches: Searches) -> Callable[[Request], Response | None]:
    """Return the function that builds a page for each client; NiceGUI calls it for all paths."""

    def root(request: Request) -> Response | None:
        if request.url.path not in ("", "/"):
            return HTMLResponse(note(NO_PAGE, title="gsp: no such page", link="Open the tool"), 404)
        build(design, searches, request.query_params.multi_items())
        return None

    return root


def guarded(app: Application, host: str) -> Guard:
    """Return the application behind the check of hosts and origins."""
    return Guard(app, [host])


def _prepare(design: Design) -> None:
    """Compile slow indices and forward kinematics, or load them, before a page needs them."""
    with suppress(GspError):
        compile_slow()
        if design.home is not None and len(design.joint_names) == 6:
            forward(design, design.at(design.home).joints, design.home)
