"""A second, independent check of certificates, in ball arithmetic of any precision.

It shares no code with the search, and is written to be read on its own. The numbers are balls of
python-flint: each contains the exact real number, with all rounding errors. On a
box X with centre c and half-widths r, Taylor's theorem gives for a quantity or a matrix f

    f(x) = f(c) + Σ_k ±r_k f_k(c) + rest,    |rest| ≤ ½ Σ_kl r_k r_l |f_kl(X)|,

where automatic differentiation gives the first derivatives f_k at the centre and the second ones
f_kl on all of X. `matrices` has what follows for singular values and determinants. A box that is
too large for this is halved once more here, until it holds or the patience ends.
"""

from __future__ import annotations

from base64 import b64decode
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any
from zlib import decompress
from zlib import error as ZlibError

from gsp.checks import check_integer
from gsp.errors import MalformedFile
from gsp.proof.verification.claims import CHANGE, flaw, is_angle, pairs_of, states
from gsp.proof.verification.matrices import (
    Range,
    Rows,
    blame,
    control,
    most,
    rest_of,
    singular_values,
    volume,
)
from gsp.proof.verification.model import Evaluated, Model

# Precision of the balls.
BITS = 128
# Largest number of halvings of one box.
PATIENCE = 12
# What must be checked: PROVEN leaves are marked 6, open ones 7, halvings 0 … 5.
PROVEN, OPEN = 6, 7
# How near, in units of the pose, the pose that a certificate names is to the point that refutes.
NEAR = 1e-9
# What a record that is no certificate may raise.
MALFORMED = (
    ArithmeticError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    ValueError,
    ZlibError,
)
SPECTRAL = ("minimum_singular_value", "condition_number")


@dataclass(frozen=True)
class Verification:
    """The result of a check: whether a certificate holds, what was checked, what does not hold.

    Attributes
    ----------
    holds : bool
    checked, boxes : int
        Proven boxes that were checked, and that there are.
    share : float [1]
        Share of the volume in the boxes that were checked.
    reason : str
        What does not hold; "" if all does.
    """

    holds: bool
    checked: int
    boxes: int
    share: float
    reason: str

    def __bool__(self) -> bool:
        return self.holds


def verify(record: dict[str, Any], *, limit: int | None = None) -> Verification:
    """Check a certificate given as plain numbers.

    Parameters
    ----------
    record : dict
        See `gsp.Certificate.record`.
    limit : int or None
        Check only so many of the proven boxes, evenly spread.

    Returns
    -------
    Verification

    Raises
    ------
    MissingSoftware
        Without python-flint.
    MalformedFile
        If the record is no certificate.
    InvalidInput
        If the limit is no positive integer.
    """
    if limit is not None:
        check_integer("limit", limit)
    try:
        model = Model(record)
        with model.flint.ctx.workprec(BITS):
            return _verified(model, record, limit)
    except MALFORMED as error:
        raise MalformedFile(f"expected the record of a certificate, received: {error}") from error


def _verified(model: Model, record: dict[str, Any], limit: int | None) -> Verification:
    low, high = record["box"]["low"], record["box"]["high"]
    marks = list(decompress(b64decode(record["tree"])))
    leaves, complete = _leaves(marks, low, high)
    proven = [leaf for leaf in leaves if leaf[2] == PROVEN]
    reason = flaw(model, record)
    if not complete:
        reason = reason or "the tree of boxes does not cover the box"
    if record["status"] not in ("proven", "refuted", "undecided"):
        reason = reason or "the status is not one of a certificate"
    if record["status"] == "proven" and len(proven) < len(leaves):
        reason = reason or "boxes are open"
    if record["status"] == "refuted" and not reason:
        reason = _refutation(model.nominal(), record)
    some = proven
    if limit is not None and len(proven) > limit:
        some = [proven[i * len(proven) // limit] for i in range(limit)]
    checked, share = 0, 0.0
    for least, greatest, _, part in some:
        if reason:
            break
        checked, share = checked + 1, share + part
        if not _holds(model, least, greatest, PATIENCE):
            reason = f"the box {list(zip(least, greatest, strict=True))} could not be confirmed"
    return Verification(not reason, checked, len(proven), share, reason)


def _leaves(marks: list[int], low: list[float], high: list[float]) -> tuple[list[Any], bool]:
    """Replay the halvings: the boxes that are not halved, and whether the tree is complete."""
    leaves: list[Any] = []
    waiting = [(low, high, 1.0)]
    for mark in marks:
        if not waiting or mark > OPEN:
            return leaves, False
        least, greatest, share = waiting.pop()
        if mark in (PROVEN, OPEN):
            leaves.append((least, greatest, mark, share))
            continue
        middle = 0.5 * (least[mark] + greatest[mark])
        if not least[mark] <= middle <= greatest[mark]:
            return leaves, False
        first, second = list(greatest), list(least)
        first[mark] = second[mark] = middle
        waiting += [(second, greatest, 0.5 * share), (least, first, 0.5 * share)]
    return leaves, not waiting


def _holds(model: Model, low: list[float], high: list[float], patience: int) -> bool:
    """Whether a box satisfies what is claimed, halving it if need be."""
    parts = _check(model, low, high)
    if parts is None:
        return True
    widths = [part if b > a else -1.0 for part, a, b in zip(parts, low, high, strict=True)]
    if patience == 0 or max(widths) < 0.0:
        return False
    k = widths.index(max(widths))
    first, second = list(high), list(low)
    first[k] = second[k] = 0.5 * (low[k] + high[k])
    return _holds(model, low, first, patience - 1) and _holds(model, second, high, patience - 1)


def _check(model: Model, low: list[float], high: list[float]) -> list[float] | None:
    """None if the claims hold on a box, else what each coordinate contributes to one that fails."""
    missing = set(model.claims["bounds"])
    for name, (least, greatest, parts) in _ranges(model, low, high):
        missing.discard(name)
        lower, upper = _claimed(model, name)
        if not ((lower is None or least >= lower) and (upper is None or greatest <= upper)):
            return parts
    if missing:
        raise ValueError(f"bounds of {sorted(missing)}, which are not checked")
    return None


def _claimed(model: Model, name: str) -> tuple[Any, Any]:
    """Bounds that are claimed of a quantity; of angles, in [0, π], those of the cosine."""
    if name == "regular":
        return model.ball(0), None
    lower, upper = model.claims["bounds"][name]
    if not is_angle(name):
        return lower, upper
    pi = model.ball.pi()
    least = None if upper is None or upper >= pi else model.ball(2 if upper < 0 else upper)
    greatest = None if lower is None or lower <= 0 else model.ball(lower)
    return (
        None if least is None else model.ball(2) if upper < 0 else least.cos(),
        None if greatest is None else model.ball(-2) if lower > pi else greatest.cos(),
    )


def _ranges(model: Model, low: list[float], high: list[float]) -> Iterable[tuple[str, Range]]:
    """Yield bounds on a box of each quantity that something is claimed of."""
    ball, flint = model.ball, model.flint
    least, greatest = [ball(x) for x in low], [ball(x) for x in high]
    middle = [(x + y) / 2 for x, y in zip(least, greatest, strict=True)]
    half = [(y - x) / 2 for x, y in zip(least, greatest, strict=True)]
    whole = [m.union(x).union(y) for m, x, y in zip(middle, least, greatest, strict=True)]
    here, wide = model.evaluate(middle), model.evaluate(whole, second=True)
    names, pairs = list(model.claims["bounds"]), pairs_of(model)
    for name in names:
        if name in here.values:
            yield name, _scalar(model, name, here, wide, half)
        elif name in pairs:
            yield name, _clearance(model, pairs[name], here, wide, half)
    rows = Rows.of(flint, here.rows, wide.rows, half)
    if model.claims["regular"] or any(name in names for name in SPECTRAL):
        smallest, ratio = singular_values(rows)
        if model.claims["regular"]:
            positive = ball(1) if smallest[0] > 0 else ball(-1)
            yield "regular", (positive, ball(1), smallest[2])
        for name, found in zip(SPECTRAL, (smallest, ratio), strict=True):
            if name in names:
                yield name, found
    if "manipulability" in names:
        below, above, parts = volume(rows)
        angles = sum("A1" in leg["constraints"] for leg in model.legs)
        unit = ball(model.claims["length"]) ** (3 - angles)
        yield "manipulability", (unit * below, unit * above, parts)
    if "condition_number_ellipsoid" in names:
        seen = Rows.of(flint, here.ellipsoid, wide.ellipsoid, half)
        yield "condition_number_ellipsoid", singular_values(seen)[1]
    if "control_number" in names:
        yield "control_number", control(rows, Rows.of(flint, here.passive, wide.passive, half))


def _scalar(model: Model, name: str, here: Evaluated, wide: Evaluated, half: list[Any]) -> Range:
    """Bounds of a joint, a coordinate or the cosine of a cone, by the mean value theorem."""
    parts = [abs(h * g) for h, g in zip(half, here.values[name].slopes, strict=True)]
    rest = rest_of(half, [wide.values[name]])
    reach, value = sum(parts, model.ball(0)) + rest, here.values[name].value
    blamed = blame(parts, rest, half)
    if not (wide.values[name].value.is_finite() and _signed(model, name, wide)):
        return -model.ball("inf"), model.ball("inf"), blamed
    low, high = value - reach, value + reach
    if name.startswith("d"):
        # The distance of a D4 leg has a sign here.
        low, high = (
            (low, high)
            if low > 0
            else (-high, -low)
            if high < 0
            else (
                model.ball(0),
                most(low).max(most(high)),
            )
        )
    return low, high, blamed


def _signed(model: Model, name: str, wide: Evaluated) -> bool:
    """Whether the direction of a leg keeps its sign: CCC legs turn about where lines meet."""
    if "cone" not in name:
        return True
    i = int(name.split()[-1])
    if model.legs[i - 1]["constraints"].split()[0] not in ("D4", "A1"):
        return True
    return not wide.values[f"distance {i}"].value.contains(0)


def _clearance(
    model: Model, legs: tuple[int, int], here: Evaluated, wide: Evaluated, half: list[Any]
) -> Range:
    """Distance of two legs: at least the least n · (x − y) of their ends for a unit vector n."""
    ball, (i, j) = model.ball, legs
    feet = [[[float(c.value.mid()) for c in x] for x in here.feet[k]] for k in (i, j)]
    s, t, n = nearest(*feet)
    low, blamed = ball("inf"), [0.0] * 6
    for x, wide_x in zip(here.feet[i], wide.feet[i], strict=True):
        for y, wide_y in zip(here.feet[j], wide.feet[j], strict=True):
            gap = [a - b for a, b in zip(x, y, strict=True)]
            slopes = [
                sum((ball(c) * g.slopes[k] for c, g in zip(n, gap, strict=True)), ball(0))
                for k in range(6)
            ]
            parts = [abs(h * g) for h, g in zip(half, slopes, strict=True)]
            rest = rest_of(half, [a - b for a, b in zip(wide_x, wide_y, strict=True)])
            value = sum((ball(c) * g.value for c, g in zip(n, gap, strict=True)), ball(0))
            value = value - sum(parts, ball(0)) - rest
            low = low.min(value)
            blamed = [max(a, b) for a, b in zip(blamed, blame(parts, rest, half), strict=True)]
    size = sum((ball(c) * ball(c) for c in n), ball(0)).sqrt()
    one, other = (
        [a.value * (1 - ball(share)) + b.value * share for a, b in zip(*wide.feet[k], strict=True)]
        for k, share in ((i, s), (j, t))
    )
    high = sum(((a - b) ** 2 for a, b in zip(one, other, strict=True)), ball(0)).sqrt()
    return low / size if size > 0 else ball(0), high, blamed


def nearest(one: list[list[float]], other: list[list[float]]) -> tuple[float, float, list[float]]:
    """Shares of the nearest points on two segments, and the difference of the points.

    By alternation between the segments, which need not be exact.
    """
    s = t = 0.5

    def at(segment: list[list[float]], share: float) -> list[float]:
        return [a + share * (b - a) for a, b in zip(*segment, strict=True)]

    def foot(point: list[float], segment: list[list[float]]) -> float:
        along = [b - a for a, b in zip(*segment, strict=True)]
        square = sum(c * c for c in along)
        ahead = sum(c * (p - a) for c, p, a in zip(along, point, segment[0], strict=True))
        return min(max(ahead / square, 0.0), 1.0) if square > 0.0 else 0.0

    for _ in range(200):
        s = foot(at(other, t), one)
        t = foot(at(one, s), other)
    return s, t, [a - b for a, b in zip(at(one, s), at(other, t), strict=True)]


def _refutation(model: Model, record: dict[str, Any]) -> str:
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
            for name, found in _ranges(model, points[0], points[0])
            if _violates(model, name, found)
        ]
        if not violated:
            return "the point violates nothing"
        stated = any(states(model, record["reason"], name, found) for name, found in violated)
        return "" if stated else "what is violated is not the reason that is stated"
    if record["reason"] != CHANGE:
        return "what is violated is not the reason that is stated"
    signs = []
    for point in points:
        rows = model.evaluate([model.ball(x) for x in point]).rows
        signs.append(model.flint.arb_mat([[x.value for x in row] for row in rows]).det())
    one, other = signs
    changes = (one > 0 and other < 0) or (one < 0 and other > 0)
    if not (changes and model.claims["regular"]):
        return "det J does not change its sign between the two points"
    return _between(model, record)


def _violates(model: Model, name: str, found: Range) -> bool:
    lower, upper = _claimed(model, name)
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
    model.bends = 0
    for point, position, rotation in zip(points, positions, rotations, strict=True):
        angles = [model.constant(x) for x in point[3:]]
        turn = [float(x.value.mid()) for row in model.rotation(angles) for x in row]
        given = [*position, *(x for row in rotation for x in row)]
        scale = [1.0 + max(abs(x) for x in point[:3])] * 3 + [1.0] * 9
        pairs = zip([*point[:3], *turn], given, scale, strict=True)
        if any(abs(x - y) > NEAR * size for x, y, size in pairs):
            return False
    return True


def _between(model: Model, record: dict[str, Any]) -> str:
    """Return "" if the counterexample lies between the poses of the bracket."""
    ends, middle = record["bracket"], record["counterexample"]
    for name in ("position", "rotation"):
        one, other = (_flat(x) for x in ends[name])
        wide = max(abs(a - b) for a, b in zip(one, other, strict=True))
        for a, x in zip(one, _flat(middle[name]), strict=True):
            if not abs(x - a) <= 2.0 * wide + NEAR * (1.0 + abs(a)):
                return "the counterexample does not lie in the bracket"
    return ""


def _flat(x: Any) -> list[float]:
    return [y for row in x for y in row] if isinstance(x[0], list) else x
