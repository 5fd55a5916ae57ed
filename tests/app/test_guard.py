"""Foreign hosts, foreign origins and too large requests are refused."""

from __future__ import annotations

import asyncio
import json

import pytest

from gsp.app.guard import HEADERS, LARGEST_BODY, Guard, Policy, is_loopback


def sent(host="127.0.0.1:8080", hosts=("127.0.0.1",), kind="http", **headers):
    """Return what a request is answered with: the status, or what closes a WebSocket."""
    passed, answers = [], []

    async def app(scope, receive, send):
        passed.append(scope["type"])

    async def receive():
        return {"type": "websocket.connect"}

    async def send(message):
        answers.append(message)

    pairs = [(k.replace("_", "-").encode(), v.encode()) for k, v in headers.items()]
    scope = {"type": kind, "headers": [(b"host", host.encode()), *pairs]}
    asyncio.run(Guard(app, hosts)(scope, receive, send))
    if passed:
        return "passed"
    return answers[0].get("status", answers[0].get("code"))


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    ("host", "origin", "wanted"),
    [
        ("127.0.0.1:8080", None, True),
        ("localhost:8080", None, True),
        ("[::1]:8080", "http://[::1]:8080", True),
        ("LOCALHOST:8080", "http://localhost:8080", True),
        ("127.0.0.1:8080", "http://127.0.0.1:8080", True),
        ("127.0.0.1:8080", "http://127.0.0.1:8081", False),
        ("127.0.0.1:8080", "http://127.0.0.1", False),
        ("127.0.0.1:8080", "http://localhost:8080", False),
        ("127.0.0.1:8080", "http://evil.example", False),
        ("127.0.0.1:8080", "http://127.0.0.1:8080.evil.example", False),
        ("127.0.0.1:8080", "null", False),
        ("127.0.0.1:8080", "", False),
        ("evil.example", None, False),
        ("evil.example:8080", "http://evil.example:8080", False),
        ("127.0.0.1.evil.example", None, False),
        ("192.168.1.5:8080", None, False),
        ("", None, False),
        ("[::1", None, False),
    ],
)
def test_only_this_host_and_origin(kind, host, origin, wanted):
    headers = {} if origin is None else {"origin": origin}
    refused = 403 if kind == "http" else 1008
    assert sent(host, kind=kind, **headers) == ("passed" if wanted else refused)


def test_a_wildcard_has_addresses_and_no_names():
    """A name that points at this machine (DNS rebinding) is not an address."""
    assert sent("192.168.1.5:8080", hosts=["0.0.0.0"]) == "passed"
    assert sent("evil.example", hosts=["0.0.0.0"]) == 403


@pytest.mark.parametrize(
    ("site", "mode", "dest", "wanted"),
    [
        ("none", "navigate", "document", True),  # typed
        ("same-origin", "cors", "empty", True),
        ("cross-site", "navigate", "document", True),  # a link of another page
        ("cross-site", "navigate", "iframe", False),
        ("cross-site", "no-cors", "image", False),
        ("same-site", "no-cors", "image", False),  # another port of this machine
        ("same-site", "no-cors", "script", False),
    ],
)
def test_no_part_of_another_page(site, mode, dest, wanted):
    headers = {"sec_fetch_site": site, "sec_fetch_mode": mode, "sec_fetch_dest": dest}
    assert sent(**headers) == ("passed" if wanted else 403)


@pytest.mark.parametrize(
    "headers",
    [
        {"content_length": str(LARGEST_BODY + 1)},
        {"content_length": "many"},
        {"transfer_encoding": "chunked"},
    ],
    ids=["great", "no number", "not stated"],
)
def test_great_requests_are_refused(headers):
    assert sent(**headers) == 413
    assert sent(content_length=str(LARGEST_BODY)) == "passed"


def test_the_body_of_a_refused_request_is_read_and_the_answer_to_programs_is_json():
    """Else the program that sends it gets an error of the network, and no answer."""
    parts = [b"x" * 1_000_000] * 3
    answers = []

    async def receive():
        body = parts.pop()
        return {"type": "http.request", "body": body, "more_body": bool(parts)}

    async def send(message):
        assert not parts
        answers.append(message)

    headers = [(b"host", b"localhost"), (b"content-length", b"3000000")]
    scope = {"type": "http", "path": "/api/evaluate", "headers": headers}
    asyncio.run(Guard(None, ["localhost"])(scope, receive, send))
    assert answers[0]["status"] == 413
    assert (b"content-type", b"application/json") in answers[0]["headers"]
    found = json.loads(answers[1]["body"])
    assert found == {"error": f"body: expected at most {LARGEST_BODY} bytes"}


def test_a_server_that_ends_answers_what_it_cancels():
    """Else uvicorn prints a traceback for each request that was not done."""
    answers = []

    async def app(scope, receive, send):
        await asyncio.sleep(60.0)

    async def send(message):
        answers.append(message)

    async def cancelled():
        request = asyncio.create_task(Policy(app)({"type": "http"}, None, send))
        await asyncio.sleep(0.0)
        request.cancel()
        await request

    asyncio.run(cancelled())
    assert answers[0]["status"] == 503
    assert set(HEADERS) < set(answers[0]["headers"])
    assert answers[1]["body"] == b"the server ends\n"


def test_a_server_that_ends_at_its_start_tells_the_application():
    heard = []

    async def app(scope, receive, send):
        heard.append((await receive())["type"])

    async def receive():
        await asyncio.sleep(60.0)

    async def cancelled():
        lifespan = asyncio.create_task(Policy(app)({"type": "lifespan"}, receive, None))
        await asyncio.sleep(0.0)
        lifespan.cancel()
        await lifespan

    asyncio.run(cancelled())
    assert heard == ["lifespan.shutdown"]


@pytest.mark.parametrize(("host", "wanted"), [
    ("127.0.0.1", True), ("127.0.0.2", True), ("::1", True), ("localhost", True),
    ("0.0.0.0", False), ("::", False), ("192.168.1.2", False), ("pc", False),
])  # fmt: skip
def test_addresses_that_others_reach(host, wanted):
    assert is_loopback(host) is wanted
