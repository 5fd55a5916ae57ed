"""The JSON interface has the values of the library, and answers invalid requests with a message."""

from __future__ import annotations

import asyncio
import json

import numpy as np
import pytest

import gsp
from gsp.app.searches import Searches

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
httpx = pytest.importorskip("httpx")

from gsp.app import api  # noqa: E402

TOZ = "toz-kucuk-2016-d3-6"


@pytest.fixture(scope="module")
def app():
    return api.make(Searches())


def sent(app, method, path, *, content=None, kind="application/json"):
    """Return the answer of a request."""

    async def run():
        transport = httpx.ASGITransport(app=app)
        async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:
            headers = {"Content-Type": kind} if kind else {}
            return await client.request(method, path, content=content, headers=headers)

    return asyncio.run(run())


def asked(app, path, body=None):
    """Return the status and the answer of a request; not json=, which refuses NaN itself."""
    method, content = ("GET", None) if body is None else ("POST", json.dumps(body))
    answer = sent(app, method, path, content=content)
    return answer.status_code, answer.json() if answer.text.startswith("{") else answer.text


def test_evaluate(app):
    body = {"design": TOZ, "position": [12, -3, 140], "rpy_deg": [1, 2, 3], "indices": ["all"]}
    status, found = asked(app, "/api/evaluate", body)
    assert status == 200
    design = gsp.catalogue.design(TOZ)
    posture = design.at(gsp.Pose.from_rpy([12, -3, 140], [1, 2, 3], degrees=True))
    assert np.array(found["jacobian"]) == pytest.approx(posture.jacobian, rel=1e-15)
    assert [j["value"] for j in found["joints"]] == pytest.approx(posture.joints, rel=1e-15)
    wanted = gsp.indices.control_number(posture, 95.0)
    assert found["indices"]["control_number"]["value"] == pytest.approx(float(wanted))
    assert list(found["indices"]) == list(gsp.indices.INDICES)
    assert found["indices"]["condition_number_ellipsoid"]["value"] is None


def test_evaluate_the_text_of_a_file(app, tmp_path):
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    design.write(tmp_path / "own.toml")
    text = (tmp_path / "own.toml").read_text()
    status, found = asked(app, "/api/evaluate", {"design": text, "indices": ["|det J|"]})
    assert status == 200
    wanted = np.linalg.det(design.at(design.home).jacobian)
    assert found["determinant"] == pytest.approx(wanted)
    # Its path is not read.
    status, found = asked(app, "/api/evaluate", {"design": str(tmp_path / "own.toml")})
    assert (status, "unknown design" in found["error"]) == (422, True)


def test_rank_and_maximum(app):
    status, found = asked(app, "/api/rank", {"index": "CTN"})
    values = [one["value"] for one in found["ranking"]]
    assert (status, len(values), values == sorted(values, reverse=True)) == (200, 195, True)
    status, found = asked(app, "/api/maximum", {"design": "lee-2000-3-3"})
    assert (status, found["status"]) == (200, "known")
    assert found["maximum"]["value"] == pytest.approx(0.75 * 3**0.5)


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("evaluate", {}),
        ("evaluate", {"design": "nobody"}),
        ("evaluate", {"design": TOZ, "indices": ["nothing"]}),
        ("evaluate", {"design": TOZ, "position": [1, 2]}),
        ("evaluate", {"design": TOZ, "position": [1e300, 2, 3]}),
        ("evaluate", {"design": TOZ, "length": -1}),
        ("evaluate", {"design": "[[legs]]\n"}),
        ("evaluate", {"design": TOZ, "file": "/etc/passwd"}),
        ("rank", {"index": "λ"}),
        ("rank", {"template": "nobody"}),
        ("evaluate", {"design": TOZ, "position": [np.nan, 0, 0]}),
        ("evaluate", {"design": TOZ, "position": "\ud800"}),
        ("evaluate", {"design": "\ud800"}),
        ("evaluate", {"design": TOZ, "\ud800": 1}),
        ("evaluate", {"design": ".".join("a" * 50_000) + " = 1\n"}),
        ("evaluate", {"design": TOZ, "length": True}),
        ("evaluate", {"design": TOZ, "position": ["1", "2", "3"]}),
        ("evaluate", {"design": TOZ, "position": [1, 2, 3], "rpy_deg": [0, 0, 3601.0]}),
        ("maximum", {"design": "x\n" * 200_000}),
    ],
    ids=lambda value: str(value)[:60],
)
def test_what_cannot_be_used(app, path, body):
    status, found = asked(app, f"/api/{path}", body)
    # A name with half of a character cannot be read.
    assert status == (400 if "\ud800" in body else 422)
    assert found["error"]


def test_its_page_needs_nothing_from_elsewhere(app):
    status, text = asked(app, "/api")
    assert status == 200
    assert all(path in text for path in ("/api/evaluate", "/api/rank", "/api/maximum"))
    assert "http" not in text
    status, schema = asked(app, "/api/openapi.json")
    assert (status, set(schema["paths"])) == (
        200,
        {"/api/evaluate", "/api/rank", "/api/maximum"},
    )


@pytest.mark.parametrize(("path", "status"), [("evaluate", 405), ("nothing", 404), ("", 404)])
@pytest.mark.parametrize("method", ["GET", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"])
def test_other_paths_and_methods_are_errors(app, method, path, status):
    answer = sent(app, method, f"/api/{path}")
    assert (answer.status_code, bool(answer.json()["error"])) == (status, True)


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (b"", "application/json"), (b"[]", "application/json"), (b"{", "application/json"),
        (b"[" * 100_000, "application/json"), (b"\xff\xfe", "application/json"),
        (b'{"design": "lee-2000-3-3"}', "text/plain"), (b'{"design": "lee-2000-3-3"}', None),
    ],
)  # fmt: skip
def test_a_body_that_is_no_json_object(app, content, kind):
    answer = sent(app, "POST", "/api/maximum", content=content, kind=kind)
    assert (answer.status_code, answer.json()) == (400, {"error": api.NO_OBJECT})


def test_all_indices_as_a_text_and_infinite_ones(app):
    body = {"design": "lee-2000-3-3", "position": [0, 0, 0], "indices": "all"}
    _, found = asked(app, "/api/evaluate", body)
    assert found["singular"]
    assert found["indices"]["condition_number_plain"]["reason"] == "infinite"
