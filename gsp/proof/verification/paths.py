"""The check of path certificates: the same bounds, on intervals of one parameter.

The parameter is the number of a piece plus its u in [0, 1]. The claims are about the pieces that
are recorded; they must meet, and pass through the nodes if there are any.
"""

from __future__ import annotations

from itertools import pairwise
from math import floor, isfinite, pi
from typing import Any

from gsp.proof.verification.claims import CHANGE_ON_PATH, flaw, is_number, states
from gsp.proof.verification.model import Model
from gsp.proof.verification.motions import Piece
from gsp.proof.verification.ranges import ranges
from gsp.proof.verification.refutation import changes_sign, is_at, violates

# How near the ends of pieces are to each other, relative to the greatest coefficient.
END_GAP = 4e-9
# How near a time that is stated is to that of a parameter, as a share of the whole time.
NEAR_TIME = 1e-9
MARKS = ("proven", "violated", "open")


def opened_path(model: Model, record: dict[str, Any]) -> tuple[list[Any], str]:
    """Return the intervals that something is claimed of, and what does not hold already.

    An interval is a model on its piece, its two ends, whether it is claimed to be violated, and its
    share of the parameter. Of a refuted path with tolerances only the refutation is checked.
    """
    path, intervals = record["path"], record["intervals"]
    reason = flaw(model, record) or _path_flaw(path)
    if reason:
        return [], reason
    models = [model.on(piece, span) for piece, span in pieces_of(model, path)]
    reason = _course(models, path) or _cover(record, len(models))
    if not reason and record["status"] == "refuted":
        reason = _refutation([one.nominal() for one in models], record)
    # Intervals that end where copies begin to violate a limit are not narrow enough here.
    some = record["status"] != "refuted" or not any(_numbers(record["claims"]["tolerances"]))
    leaves = []
    for low, high, mark in intervals if some and not reason else []:
        i, wrong = floor(low), mark == "violated"
        if mark != "open":
            here = models[i].nominal() if wrong else models[i]
            leaves.append((here, [low - i], [high - i], wrong, (high - low) / len(models)))
    return leaves, reason


def pieces_of(model: Model, path: dict[str, Any]) -> list[tuple[Piece, Any]]:
    """Return the pieces of a recorded path, each with its duration as a ball."""
    columns = [path[name] for name in ("position", "turn", "rotation", "slide", "margin")]
    spans = [model.ball(b) - model.ball(a) for a, b in pairwise(path["times"])]
    return [
        (Piece(model.flint, place, turn, rotation, slide, margin, path["slack"]), span)
        for place, turn, rotation, slide, margin, span in zip(*columns, spans, strict=True)
    ]


def _path_flaw(path: dict[str, Any]) -> str:
    """Return what is meaningless in a path, or ""."""
    times, n = path["times"], len(path["times"]) - 1
    if n < 1 or not all(map(is_number, times)) or not all(a < b for a, b in pairwise(times)):
        return "the times of the path do not increase"
    columns = [path[name] for name in ("position", "turn", "rotation", "slide", "margin")]
    if not all(len(column) == n for column in columns):
        return "there is not one piece between any two times"
    if not all(map(is_number, _numbers([*columns, path["slack"]]))):
        return "a coefficient of the path is not a number"
    if not all(x >= 0 for x in [*path["margin"], path["slack"]]):
        return "a margin of the path is below 0"
    return _form(path)


def _form(path: dict[str, Any]) -> str:
    """Return "" if each piece has the form of the motion that is stated."""
    motion, slides = path["motion"], any(_numbers(path["slide"]))
    if (path["nodes"] is None) != (motion == "path"):
        return "there are nodes of a path without, or none of one with nodes"
    if motion in ("spline", "path"):
        return "the path is not a spline" if slides else ""
    if motion not in ("straight", "screw"):
        return "the motion of the path is not known"
    for place, turn in zip(path["position"], path["turn"], strict=True):
        if len(place) != 2 or len(turn) != 2 or any(turn[0]):
            return "a piece of the path is neither straight nor a screw"
        if motion == "screw" and any(place[1]):
            return "a piece of the path is not a screw"
        if not sum(x * x for x in turn[1]) < pi * pi:
            return "a piece of the path does not turn through the smaller angle"
    return "a piece of the path is not straight" if motion == "straight" and slides else ""


def _course(models: list[Model], path: dict[str, Any]) -> str:
    """Return "" if pieces meet, and pass through the nodes."""
    size = max(abs(x) for x in _numbers(path["position"]))
    ends = [[_place(model, u) for u in (0.0, 1.0)] for model in models]
    for (_, last), (first, _) in pairwise(ends):
        scale = [size] * 3 + [1.0] * 9
        if not all(abs(a - b) <= END_GAP * s for a, b, s in zip(last, first, scale, strict=True)):
            return "two pieces of the path do not meet"
    nodes = path["nodes"]
    if nodes is None:
        return ""
    if not len(nodes["position"]) == len(nodes["rotation"]) == len(models) + 1:
        return "the nodes of the path are not the ends of its pieces"
    for i, model in enumerate(models):
        for k in (0, 1):
            if not is_at(model, [float(k)], nodes["position"][i + k], nodes["rotation"][i + k]):
                return f"the path does not pass through node {i + k}"
    return ""


def _place(model: Model, u: float) -> list[float]:
    model.bends = 0
    place, turn = model.motion.platform([model.constant(u)])
    return [float(x.value.mid()) for x in [*place, *(x for row in turn for x in row)]]


def _cover(record: dict[str, Any], n: int) -> str:
    """Return "" if the intervals cover the path, as the status and their number state."""
    end, status = 0.0, record["status"]
    for low, high, mark in record["intervals"]:
        if mark not in MARKS or low != end or not low < high <= floor(low) + 1.0:
            return "the intervals do not cover the path"
        end = high
    if end != n:
        return "the intervals do not cover the path"
    if status not in ("proven", "refuted", "undecided"):
        return "the status is not one of a certificate"
    marks = [mark for *_, mark in record["intervals"]]
    if status == "proven" and set(marks) != {"proven"}:
        return "intervals are open"
    # Halving gives as many intervals less one as there are halvings, for each part.
    most = 2 * len(marks) - record["parts"]
    least = most - marks.count("open")
    known = is_number(record["n_boxes"]) and least <= record["n_boxes"] <= most
    return "" if known else "n_boxes is not that of the intervals"


def _refutation(models: list[Model], record: dict[str, Any]) -> str:
    """Return "" if the points of a certificate refute what is claimed."""
    points, path, bracket = record["points"], record["path"], record["bracket"]
    if len(points) not in (1, 2):
        return "there is no point that refutes"
    if not all(0.0 <= x <= len(models) for x in points):
        return "a point that refutes lies outside of the path"
    times = path["times"]
    width = times[-1] - times[0]
    for x, time in zip((points[0], points[-1]), bracket, strict=True):
        i, u = _split(x, len(models))
        at = (1.0 - u) * times[i] + u * times[i + 1]
        if not (isfinite(time) and abs(at - time) <= NEAR_TIME * width):
            return "the bracket is not at the points that refute"
    i, u = _split(sum(points) / len(points), len(models))
    named = record["counterexample"]
    if not is_at(models[i], [u], named["position"], named["rotation"]):
        return "the pose of the certificate is not the point that refutes"
    if len(points) == 1:
        found = [
            (name, some)
            for name, some in ranges(models[i], [u], [u])
            if violates(models[i], name, some)
        ]
        if any(states(models[i], record["reason"], name, some) for name, some in found):
            return ""
        return "the point does not violate what is stated"
    if record["reason"] != CHANGE_ON_PATH:
        return "what is violated is not the reason that is stated"
    ends = [_split(x, len(models)) for x in points]
    here = [(models[i], [models[i].ball(u)]) for i, u in ends]
    return changes_sign(here)


def _split(x: float, n: int) -> tuple[int, float]:
    i = min(floor(x), n - 1)
    return i, x - i


def _numbers(values: Any) -> list[Any]:
    return [y for x in values for y in _numbers(x)] if isinstance(values, list) else [values]
