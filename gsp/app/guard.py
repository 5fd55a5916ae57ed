"""Requests of other hosts and origins and too large ones are refused; answers have headers."""

from __future__ import annotations

import asyncio
import ipaddress
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from contextlib import suppress
from json import dumps
from typing import Any
from urllib.parse import urlsplit

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

LOCAL = ("localhost", "127.0.0.1", "::1")
WILDCARDS = ("0.0.0.0", "::", "")
# Bytes of the body of a request: several times those of a design file.
LARGEST_BODY = 1_500_000
# Bytes of a body that is refused, and seconds, that are read before the answer is sent.
MOST_DRAINED, SECONDS_TO_DRAIN = 64_000_000, 10.0
# Sent with every answer. Scripts, styles and pictures of pages come from this server alone, also
# where a name of a design would be taken for markup. Without a referrer to this server, forms would
# have no Origin.
HEADERS = (
    (
        b"content-security-policy",
        b"default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
        b"connect-src 'self' ws: wss:; frame-ancestors 'none'; base-uri 'self'; "
        b"form-action 'self'",
    ),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"same-origin"),
)


class Guard:
    """An ASGI application that refuses requests of other hosts and origins.

    Any page in the browser of a user can send requests to a server on the same machine, and open
    WebSockets to it, which browsers do not restrict. The Host has to be one of the server's names,
    so that a name that was pointed at this machine is refused (DNS rebinding), and the Origin, if
    there is one, has to be this server. Pictures and frames are requested without an Origin:
    Sec-Fetch-Site, which browsers send to trustworthy addresses such as 127.0.0.1, refuses them. A
    link of another page can be opened.

    Parameters
    ----------
    app : ASGI application
    hosts : iterable of str
        Names of the server, without port. If one is a wildcard ("0.0.0.0"), every IP address is a
        name of it.
    """

    def __init__(self, app: Application, hosts: Iterable[str]) -> None:
        self.app = app
        self.hosts = frozenset(host.lower().strip("[]") for host in (*hosts, *LOCAL))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        reason = self.refusal(scope)
        if not reason:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": reason})
        else:
            await _drain(receive)
            status = 413 if "body" in reason else 403
            # The interface of programs answers in JSON, as all of its errors are.
            json = scope.get("path", "").startswith("/api")
            await _answer(send, status, reason, json=json)

    def refusal(self, scope: Scope) -> str:
        """Return why a request is refused, or ""."""
        headers: dict[bytes, bytes] = dict(scope.get("headers", ()))
        host = headers.get(b"host", b"").decode("latin-1").lower()
        if not self._known(host):
            return "host: expected a name of this server"
        origin = headers.get(b"origin")
        if origin is not None and not _same(origin.decode("latin-1").lower(), host):
            return "origin: expected this server"
        if _embedded(headers):
            return "request: expected one of this server's pages, or a link that was opened"
        length = headers.get(b"content-length", b"0")
        if not length.isdigit() or int(length) > LARGEST_BODY:
            return f"body: expected at most {LARGEST_BODY} bytes"
        if b"transfer-encoding" in headers:
            return "body: expected a stated length"
        return ""

    def _known(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        if name in self.hosts - set(WILDCARDS):
            return True
        return bool(self.hosts & set(WILDCARDS)) and _is_address(name)


class Policy:
    """An ASGI application that sends `HEADERS` with the answers of another one.

    Middleware functions of FastAPI would hide from the application that a request was given up.
    A server that ends cancels what runs: requests are answered with status 503, and the
    application is told to end, also where it has just begun.
    """

    def __init__(self, app: Application) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, and its answer with the headers."""
        if scope["type"] != "http":
            lasting = scope["type"] == "lifespan"
            await self.app(scope, _until_the_end(receive) if lasting else receive, send)
            return
        begun = False

        async def with_headers(message: Message) -> None:
            nonlocal begun
            if message["type"] == "http.response.start":
                begun = True
                message["headers"] = [*message.get("headers", ()), *HEADERS]
            await send(message)

        try:
            await self.app(scope, receive, with_headers)
        except asyncio.CancelledError:
            if not begun:
                await _answer(with_headers, 503, "the server ends")


def _until_the_end(receive: Receive) -> Receive:
    """Return what receives messages, and "shutdown" where that is cancelled."""

    async def received() -> Message:
        try:
            return await receive()
        except asyncio.CancelledError:
            return {"type": "lifespan.shutdown"}

    return received


async def _drain(receive: Receive) -> None:
    """Read the body of a request that is refused, up to a size and a time.

    Programs send all of a body before they read the answer: a connection that is closed meanwhile
    is an error of the network for them, and the answer is lost.
    """
    size = 0
    with suppress(TimeoutError):
        async with asyncio.timeout(SECONDS_TO_DRAIN):
            while size <= MOST_DRAINED:
                message = await receive()
                size += len(message.get("body", b""))
                if message["type"] != "http.request" or not message.get("more_body", False):
                    return


async def _answer(send: Send, status: int, text: str, *, json: bool = False) -> None:
    """Answer a request with one line, or with the object {"error": text}."""
    kind = b"application/json" if json else b"text/plain; charset=utf-8"
    headers = [(b"content-type", kind)]
    body = dumps({"error": text}) if json else f"{text}\n"
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body.encode()})


def _same(origin: str, host: str) -> bool:
    """Whether an origin is http(s) on exactly this host and port."""
    scheme, _, rest = origin.partition("://")
    return scheme in ("http", "https") and rest == host


def _embedded(headers: dict[bytes, bytes]) -> bool:
    """Whether another page requests this as a part of itself, and not as the next page."""
    if headers.get(b"sec-fetch-site", b"none") in (b"none", b"same-origin"):
        return False
    next_page = (headers.get(b"sec-fetch-mode"), headers.get(b"sec-fetch-dest"))
    return next_page != (b"navigate", b"document")


def is_loopback(host: str) -> bool:
    """Return whether an address is reached from the same machine only."""
    return ipaddress.ip_address(host).is_loopback if _is_address(host) else host == "localhost"


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
