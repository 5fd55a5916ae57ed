"""Whether the points of a certificate refute what it claims."""

from __future__ import annotations

from typing import Any

from gsp.proof.verification.claims import CHANGE, states
from gsp.proof.verification.matrices import Range
from gsp.proof.verification.model import Model
from gsp.proof.verification.ranges import claimed, ranges

# How near, in units of the pose, the pose that a certificate names is to the point that refutes.
REFUTING_POSE_TOLERANCE = 1e-9


def refutation(model: Model, record: dict[str, Any]) -> str:
    """Return "" if the points of a certificate refute what is claimed."""
    points, box = record["points"], record["box"]
    if len(points) not in (1, 2):
        return "there is no point that refutes"
    for point in points:
        if any(not a <= x <= b for a, x, b in zip(box["low"], point, box["high"], strict=True)):
            return "a point that refutes lies outside of the box"
    named = record["counterexample"] if len(points) == 1 else record["bracket"]
    if not _is_pose(model, points, named):
        return "the pose of the certificate is not the point that refutes"
    if len(points) == 1:
        violated = [
            (name, found)
            for name, found in ranges(model, points[0], points[0])
            if violates(model, name, found)
        ]
        if not violated:
            return "the point violates nothing"
        stated = any(states(model, record["reason"], name, found) for name, found in violated)
        return "" if stated else "what is violated is not the reason that is stated"
    if record["reason"] != CHANGE:
        return "what is violated is not the reason that is stated"
    here = [(model, [model.ball(x) for x in point]) for point in points]
    return changes_sign(here) or _between(model, record)


def changes_sign(points: list[tuple[Model, list[Any]]]) -> str:
    """Return "" if det J, which is claimed not to vanish, changes its sign between two points."""
    signs = []
    for model, point in points:
        rows = model.evaluate(point).rows
        signs.append(model.flint.arb_mat([[x.value for x in row] for row in rows]).det())
    one, other = signs
    changes = (one > 0 and other < 0) or (one < 0 and other > 0)
    if changes and points[0][0].claims["regular"]:
        return ""
    return "det J does not change its sign between the two points"


def violates(model: Model, name: str, found: Range) -> bool:
    """Whether a quantity with bounds `found` is out of what is claimed."""
    lower, upper = claimed(model, name)
    if name == "regular":
        return False
    return bool(
        (lower is not None and found[1] < lower) or (upper is not None and found[0] > upper)
    )


def _is_pose(model: Model, points: list[list[float]], named: Any) -> bool:
    """Whether the poses that are named are at the points."""
    positions, rotations = named["position"], named["rotation"]
    if len(points) == 1:
        positions, rotations = [positions], [rotations]
    triples = zip(points, positions, rotations, strict=True)
    return all(is_at(model, *each) for each in triples)


def is_at(model: Model, point: list[Any], position: Any, rotation: Any) -> bool:
    """Whether a pose is the one at the coordinates of a point."""
    model.bends = 0
    place, turn = model.motion.platform([model.constant(x) for x in point])
    here = [float(x.value.mid()) for x in [*place, *(x for row in turn for x in row)]]
    given = [*position, *_flat(rotation)]
    scale = [1.0 + max(abs(x) for x in here[:3])] * 3 + [1.0] * 9
    return all(
        abs(x - y) <= REFUTING_POSE_TOLERANCE * size
        for x, y, size in zip(here, given, scale, strict=True)
    )


def _between(model: Model, record: dict[str, Any]) -> str:
    """Return "" if the counterexample lies between the poses of the bracket."""
    ends, middle = record["bracket"], record["counterexample"]
    for name in ("position", "rotation"):
        one, other = (_flat(x) for x in ends[name])
        wide = max(abs(a - b) for a, b in zip(one, other, strict=True))
        for a, x in zip(one, _flat(middle[name]), strict=True):
            if not abs(x - a) <= 2.0 * wide + REFUTING_POSE_TOLERANCE * (1.0 + abs(a)):
                return "the counterexample does not lie in the bracket"
    return ""


def _flat(x: Any) -> list[float]:
    return [y for row in x for y in row] if isinstance(x[0], list) else x
