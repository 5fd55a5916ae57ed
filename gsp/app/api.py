"""The JSON interface beside the page: evaluate, rank, maximum."""

from __future__ import annotations

import threading
from dataclasses import replace
from html import escape
from typing import Annotated, Any

import numpy as np
from fastapi import FastAPI, HTTPException, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field
from starlette.exceptions import HTTPException as WrongRequest

from gsp.app.searches import Search, Searches
from gsp.app.state import choices, curves
from gsp.app.state.reading import IndexReading, read
from gsp.app.state.session import MOST_DEGREES, Session, started, with_length
from gsp.catalogue.placement import TEMPLATE
from gsp.determinant.maxima import known_maximum
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.indices import INDICES, index_name, index_names
from gsp.model.design import Design
from gsp.version import __version__

# A number is no text and no bool.
Finite = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Angle = Annotated[float, Field(ge=-MOST_DEGREES, le=MOST_DEGREES, strict=True)]
Three = tuple[Finite, Finite, Finite]
Angles = tuple[Angle, Angle, Angle]
Name = Annotated[str, Field(max_length=100)]
# One text, or a list of them.
Names = Annotated[
    list[Name],
    Field(max_length=50),
    BeforeValidator(lambda given: [given] if isinstance(given, str) else given),
]
# Rankings at the same time; further ones are refused, so that pages respond quickly.
MOST_RANKINGS = 2
# What a request needs.
NO_OBJECT = "body: expected a JSON object, sent with Content-Type: application/json"
# Methods of HTTP: a call with another one than its own is an error.
EVERY_METHOD = ["GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"]
# Faults of one request that its response names.
MOST_FAULTS = 5
# The client in whose name searches for programs run; none of them is cancelled.
PROGRAMS = "api"


class Asked(BaseModel):
    """A design, and a pose of it."""

    model_config = ConfigDict(extra="forbid")

    design: str = Field(
        description="Name of a published design or of a mechanism, or the text of a design file.",
        max_length=choices.LARGEST_FILE,
    )
    position: Three | None = Field(None, description="In the unit of the design; default: home.")
    rpy_deg: Angles = Field((0.0, 0.0, 0.0), description="Roll, pitch, yaw; with a position.")
    length: Finite | None = Field(None, description="Characteristic length; default: the design's.")


class Evaluate(Asked):
    """What /api/evaluate takes."""

    indices: Names = Field(default=["all"], description='List of names, or "all".')


class Rank(BaseModel):
    """What /api/rank takes."""

    model_config = ConfigDict(extra="forbid")

    index: str = Field("CTN", max_length=50)
    template: str = Field(TEMPLATE, max_length=100)
    position: Three | None = None
    rpy_deg: Angles = (0.0, 0.0, 0.0)
    length: Finite | None = None


class MaximumOf(BaseModel):
    """What /api/maximum takes."""

    model_config = ConfigDict(extra="forbid")

    design: str = Field(max_length=choices.LARGEST_FILE)


def _without_input(error: RequestValidationError) -> str:
    """Return what is wrong, without the values: a response cannot have NaN or lone surrogates."""
    found = error.errors()
    if any(len(e["loc"]) < 2 or e["type"] == "json_invalid" for e in found):
        return NO_OBJECT
    texts = [f"{'.'.join(map(str, e['loc'][1:]))[:100]}: {e['msg']}" for e in found[:MOST_FAULTS]]
    return "; ".join(texts).encode("utf-8", "backslashreplace").decode()


def make(searches: Searches) -> FastAPI:
    """Return the application of the interface, with its page at /api.

    Parameters
    ----------
    searches : Searches
        Those of the server: a maximum that a page has requested is not searched again.
    """
    # The usual page of FastAPI loads scripts from another host.
    app = FastAPI(
        title="gsp",
        version=__version__,
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/openapi.json",
    )
    rankings = threading.BoundedSemaphore(MOST_RANKINGS)

    @app.exception_handler(GspError)
    async def failed(request: Request, error: GspError) -> JSONResponse:
        return JSONResponse({"error": str(error)}, status_code=422)

    @app.exception_handler(RequestValidationError)
    async def malformed(request: Request, error: RequestValidationError) -> JSONResponse:
        reason = _without_input(error)
        status = 400 if reason == NO_OBJECT else 422
        return JSONResponse({"error": reason}, status_code=status)

    @app.exception_handler(WrongRequest)
    async def refused(request: Request, error: WrongRequest) -> JSONResponse:
        if error.status_code == 400:  # the body cannot be parsed
            return JSONResponse({"error": NO_OBJECT}, status_code=400)
        return JSONResponse({"error": error.detail}, error.status_code, error.headers)

    @app.get("/api", include_in_schema=False)
    def page() -> HTMLResponse:
        return HTMLResponse(overview(app.openapi()))

    @app.post("/api/evaluate")
    def evaluate(asked: Evaluate) -> dict[str, Any]:
        """Return joints, inverse Jacobian and indices of a design at a pose."""
        return _evaluated(asked)

    @app.post("/api/rank")
    def rank(asked: Rank) -> dict[str, Any]:
        """Rank the 195 mechanisms on a published template at a pose, best first."""
        return _ranked(asked, rankings)

    @app.post("/api/maximum")
    def maximum(asked: MaximumOf) -> dict[str, Any]:
        """Return the maximum of |det J|, or the progress of its search."""
        return _searched(searches.ask(_design(asked.design), PROGRAMS))

    known = list(app.openapi()["paths"])

    # The page of the tool answers all paths that have no other answer.
    @app.api_route("/api/{path:path}", methods=EVERY_METHOD, include_in_schema=False)
    def unknown(request: Request) -> None:
        path = request.url.path
        if path in known:
            raise HTTPException(405, f"{path}: expected POST", {"Allow": "POST"})
        raise HTTPException(404, f"path: expected one of {', '.join(known)}, received {path[:100]}")

    return app


def _evaluated(asked: Evaluate) -> dict[str, Any]:
    names = index_names(asked.indices)
    state = _state(asked)
    if any(INDICES[name].share_of for name in names):
        state = replace(state, maximum=known_maximum(state.design))
    reading = read(state, slow=any(INDICES[name].slow for name in names))
    return {
        "design": state.design.name,
        "unit": state.design.unit,
        "position": state.pose.position.tolist(),
        "rotation": state.pose.rotation.tolist(),
        "joints": [
            {"name": j.name, "value": _number(j.value), "unit": j.unit, "reason": j.reason}
            for j in reading.joints
        ],
        "jacobian": [[_number(x) for x in row] for row in reading.jacobian.tolist()],
        "determinant": _number(reading.determinant),
        "singular": reading.singular,
        "indices": {name: _index(reading.index(name)) for name in names},
    }


def _index(one: IndexReading) -> dict[str, Any]:
    reason = one.reason or ("infinite" if np.isinf(one.value) else "")
    return {"value": _number(one.value), "unit": one.unit, "reason": reason}


def _ranked(asked: Rank, rankings: threading.Semaphore) -> dict[str, Any]:
    template = choices.named_template(asked.template)
    state = _at(template, asked.position, asked.rpy_deg, asked.length)
    if not rankings.acquire(blocking=False):
        raise HTTPException(429, "too many rankings at once; try again")
    try:
        found = curves.ranking(state, index_name(asked.index), template)
    finally:
        rankings.release()
    return {
        "index": index_name(asked.index),
        "ranking": [
            {"mechanism": r.name, "class": r.group, "value": _number(r.value), "reason": r.reason}
            for r in found
        ],
    }


def _searched(search: Search) -> dict[str, Any]:
    found = search.maximum
    return {
        "status": search.status,
        "done": search.done,
        "total": search.total,
        "reason": search.reason,
        "maximum": None if found is None else _facts(found.facts()),
    }


def overview(schema: dict[str, Any]) -> str:
    """Return a page that lists the calls of a schema; it needs nothing from elsewhere."""
    parts = []
    for path, ways in schema["paths"].items():
        for way, call in ways.items():
            body = call.get("requestBody", {}).get("content", {}).get("application/json", {})
            name = body.get("schema", {}).get("$ref", "").rpartition("/")[2]
            fields = schema["components"]["schemas"].get(name, {}).get("properties", {})
            items = "".join(
                f"<li><code>{escape(field)}</code> {escape(facts.get('description', ''))}</li>"
                for field, facts in fields.items()
            )
            about = escape(call.get("description", ""))
            parts.append(f"<h2>{way.upper()} {escape(path)}</h2><p>{about}</p><ul>{items}</ul>")
    return (
        "<!doctype html><html lang=en><head><meta charset=utf-8><title>gsp: JSON interface</title>"
        "<style>body{font:16px/1.5 system-ui,sans-serif;max-width:46rem;margin:2rem auto;"
        "padding:0 1rem}</style></head><body><h1>JSON interface of gsp</h1><p>Requests and answers "
        'are JSON. <a href="/api/openapi.json">OpenAPI description</a></p>'
        f"{''.join(parts)}</body></html>"
    )


def _state(asked: Asked) -> Session:
    return _at(_design(asked.design), asked.position, asked.rpy_deg, asked.length)


def _at(design: Design, position: Three | None, rpy_deg: Angles, length: float | None) -> Session:
    pose = None if position is None else Pose.from_rpy(position, rpy_deg, degrees=True)
    if pose is None and design.home is None:
        raise InvalidInput(expected("position", "three numbers", "none, and no home pose"))
    state = started(design, pose)
    return state if length is None else with_length(state, length)


def _design(text: str) -> Design:
    """Return the design of a name, or of the text of a file; files of the server are not read."""
    return choices.from_file(text, "design") if "\n" in text else choices.named(text)


def _number(value: float) -> float | None:
    """Return a number, None where there is none: JSON has no NaN and no infinity."""
    return float(value) if np.isfinite(value) else None


def _facts(facts: dict[str, Any]) -> dict[str, Any]:
    return {k: _number(v) if isinstance(v, float) else v for k, v in facts.items()}
