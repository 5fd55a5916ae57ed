"""A second, independent check of certificates, in ball arithmetic of any precision.

It shares no code with the search, and is written to be read on its own. The numbers are balls of
python-flint: each contains the exact real number, with all rounding errors. On a
box X with centre c and half-widths r, Taylor's theorem gives for a quantity or a matrix f

    f(x) = f(c) + Σ_k ±r_k f_k(c) + rest,    |rest| ≤ ½ Σ_kl r_k r_l |f_kl(X)|,

where automatic differentiation gives the first derivatives f_k at the centre and the second ones
f_kl on all of X. So, in the Frobenius norm, J(x) of six or more rows differs from J(c) by at most

    reach = sqrt(Σ_kl |⟨r_k J_k(c), r_l J_l(c)⟩|) + ½ Σ_kl r_k r_l ‖J_kl(X)‖,

and it is regular if σ_min(J(c)) > reach, which holds if JᵀJ − reach² I is positive definite. A box
that is too large for this is halved further here, up to a fixed number of times.
"""

from __future__ import annotations

from base64 import b64decode
from dataclasses import dataclass
from typing import Any
from zlib import decompress

import numpy as np

from gsp.proof.verification.balls import PAIRS, Number, Vector
from gsp.proof.verification.model import Model

# Precision of the balls.
BITS = 128
# Largest number of halvings of one box.
PATIENCE = 12
# What must be checked: PROVEN leaves are marked 6, open ones 7, halvings 0 … 5.
PROVEN, OPEN = 6, 7


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
    """
    model = Model(record)
    with model.flint.ctx.workprec(BITS):
        return _verified(model, record, limit)


def _verified(model: Model, record: dict[str, Any], limit: int | None) -> Verification:
    low, high = record["box"]["low"], record["box"]["high"]
    marks = list(decompress(b64decode(record["tree"])))
    leaves, complete = _leaves(marks, low, high)
    proven = [leaf for leaf in leaves if leaf[2] == PROVEN]
    reason = "" if complete else "the tree of boxes does not cover the box"
    if record["status"] == "proven" and len(proven) < len(leaves):
        reason = reason or "boxes are open"
    if record["status"] == "refuted" and not reason:
        reason = _refutation(model, record)
    some = proven
    if limit is not None and len(proven) > limit:
        some = [proven[i * len(proven) // limit] for i in range(limit)]
    checked, share = 0, 0.0
    for least, most, _, part in some:
        if reason:
            break
        checked, share = checked + 1, share + part
        if not _holds(model, least, most, PATIENCE):
            reason = f"the box {list(zip(least, most, strict=True))} could not be confirmed"
    return Verification(not reason, checked, len(proven), share, reason)


def _leaves(marks: list[int], low: list[float], high: list[float]) -> tuple[list[Any], bool]:
    """Replay the halvings: the boxes that are not halved, and whether the tree is complete."""
    leaves: list[Any] = []
    waiting = [(low, high, 1.0)]
    for mark in marks:
        if not waiting:
            return leaves, False
        least, most, share = waiting.pop()
        if mark in (PROVEN, OPEN):
            leaves.append((least, most, mark, share))
            continue
        middle = 0.5 * (least[mark] + most[mark])
        if not least[mark] <= middle <= most[mark]:
            return leaves, False
        first, second = list(most), list(least)
        first[mark] = second[mark] = middle
        waiting += [(second, most, 0.5 * share), (least, first, 0.5 * share)]
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
    """None if the claims hold by the mean value theorem, else what each coordinate contributes."""
    ball = model.ball
    least, most = [ball(x) for x in low], [ball(x) for x in high]
    middle = [(x + y) / 2 for x, y in zip(least, most, strict=True)]
    half = [(y - x) / 2 for x, y in zip(least, most, strict=True)]
    whole = [m.union(x).union(y) for m, x, y in zip(middle, least, most, strict=True)]
    rows, values = model.evaluate(middle)
    wide_rows, wide = model.evaluate(whole, second=True)
    bounds = dict(model.claims["bounds"])
    spectral = {name: bounds.pop(name, None) for name in SPECTRAL}
    for name, (lower, upper) in bounds.items():
        parts = [abs(h * g) for h, g in zip(half, values[name].slopes, strict=True)]
        rest = _rest(half, [wide[name]])
        reach, f = sum(parts, ball(0)) + rest, values[name].value
        if name.startswith("d"):
            f = abs(f)
        good = (lower is None or f - reach >= lower) and (upper is None or f + reach <= upper)
        if not (good and wide[name].value.is_finite() and _signed(model, name, wide)):
            return _blame(parts, rest, half)
    if not any(spectral.values()):
        return None
    return _check_spectrum(model, rows, wide_rows, half, spectral)


def _rest(half: list[Any], wide: Vector) -> Any:
    """½ Σ_kl r_k r_l ‖f_kl(X)‖ of some entries f."""
    rest = 0 * half[0]
    for i, (k, m) in enumerate(PAIRS):
        norm = sum((_most(x.bends[i]) ** 2 for x in wide), 0 * half[0]).sqrt()
        rest += half[k] * half[m] * norm / (2 if k == m else 1)
    return rest


def _most(x: Any) -> Any:
    """Return a number that no |element| of a ball exceeds."""
    return x.abs_upper() if hasattr(x, "abs_upper") else abs(x)


def _blame(parts: list[Any], rest: Any, half: list[Any]) -> list[float]:
    """Contributions of the coordinates to a bound that is too wide."""
    return [_size(p) + float(h) * _size(rest) for p, h in zip(parts, half, strict=True)]


SPECTRAL = ("minimum_singular_value", "condition_number")


def _size(x: Any) -> float:
    value = float(x.abs_upper()) if x.is_finite() else 1e300
    return min(value, 1e300)


def _signed(model: Model, name: str, values: dict[str, Number]) -> bool:
    """Whether the direction of a leg keeps its sign: CCC legs turn about where lines meet."""
    if "cone" not in name:
        return True
    i = int(name.split()[-1])
    if model.legs[i - 1]["constraints"].split()[0] not in ("D4", "A1"):
        return True
    return not values[f"distance {i}"].value.contains(0)


def _check_spectrum(
    model: Model, rows: list[Vector], wide: list[Vector], half: list[Any], claims: dict[str, Any]
) -> list[float] | None:
    ball, arb_mat = model.ball, model.flint.arb_mat
    entries = [x for row in rows for x in row]
    slopes = [[h * x.slopes[k] for x in entries] for k, h in enumerate(half)]
    parts = [
        sum(
            (abs(sum((x * y for x, y in zip(a, b, strict=True)), ball(0))) for b in slopes),
            ball(0),
        )
        for a in slopes
    ]
    rest = _rest(half, [x for row in wide for x in row])
    # What the entries at the centre are uncertain by (tolerances) is part of the variation.
    unsure = sum((x.value.rad() ** 2 for x in entries), ball(0)).sqrt()
    reach = _most(sum(parts, ball(0))).sqrt() + rest + unsure
    blame = _blame(parts, rest, half)
    if not reach.is_finite():
        return blame
    matrix = arb_mat([[x.value.mid() for x in row] for row in rows])
    sigma = np.linalg.svd(_midpoints(matrix), compute_uv=False)
    low, high = ball(float(sigma[-1]) * (1 - 1e-9)), ball(float(sigma[0]) * (1 + 1e-9))
    square, one = matrix.transpose() * matrix, arb_mat(6, 6, [int(i % 7 == 0) for i in range(36)])
    bounded = _definite(square - one * (low * low)) and _definite(one * (high * high) - square)
    if not bounded or not low - reach > 0:
        return blame
    _, _, right = np.linalg.svd(_midpoints(matrix))
    short = _stretch(model, matrix, right[-1]) + reach
    long = _stretch(model, matrix, right[0]) - reach
    least, ratio = [x or (None, None) for x in (claims[name] for name in SPECTRAL)]
    good = (
        (least[0] is None or low - reach >= least[0])
        and (least[1] is None or short <= least[1])
        and (ratio[0] is None or long >= ratio[0] * short)
        and (ratio[1] is None or high + reach <= ratio[1] * (low - reach))
    )
    return None if good else blame


def _midpoints(matrix: Any) -> Any:
    return np.array(
        [[float(matrix[i, j].mid()) for j in range(matrix.ncols())] for i in range(matrix.nrows())]
    )


def _definite(matrix: Any) -> bool:
    """Whether a symmetric matrix of balls is positive definite: all pivots are positive."""
    n = matrix.nrows()
    rows = [[matrix[i, j] for j in range(n)] for i in range(n)]
    for k in range(n):
        if not rows[k][k] > 0:
            return False
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return True


def _refutation(model: Model, record: dict[str, Any]) -> str:
    """Return "" if the points of a certificate refute what is claimed."""
    points = record["points"]
    box = record["box"]
    for point in points:
        if any(not a <= x <= b for a, x, b in zip(box["low"], point, box["high"], strict=True)):
            return "a point that refutes lies outside of the box"
    arb_mat, matrices = model.flint.arb_mat, []
    for point in points:
        rows, values = model.evaluate([model.ball(x) for x in point])
        matrices.append(arb_mat([[x.value for x in row] for row in rows]))
    if len(points) == 2:
        one, other = (matrix.det() for matrix in matrices)
        changes = (one > 0 and other < 0) or (one < 0 and other > 0)
        return "" if changes else "det J does not change its sign between the two points"
    return "" if _violated(model, matrices[0], values) else "the point violates nothing"


def _violated(model: Model, matrix: Any, values: dict[str, Number]) -> bool:
    """Whether some bound is violated at a point, in ball arithmetic."""
    for name, (lower, upper) in model.claims["bounds"].items():
        low, high = _range(model, name, matrix, values)
        if (lower is not None and high < lower) or (upper is not None and low > upper):
            return True
    return False


def _range(model: Model, name: str, matrix: Any, values: dict[str, Number]) -> tuple[Any, Any]:
    """Return a number below and one above a quantity at a point."""
    if name not in SPECTRAL:
        value = abs(values[name].value) if name.startswith("d") else values[name].value
        return value, value
    _, _, right = np.linalg.svd(_midpoints(matrix))
    short, long = (_stretch(model, matrix, right[k]) for k in (-1, 0))
    if name == "minimum_singular_value":
        return model.ball(0), short
    return (long / short if short > 0 else long), model.ball("inf")


def _stretch(model: Model, matrix: Any, direction: Any) -> Any:
    """|J x| / |x|: at least σ_min and at most σ_max, whatever x is."""
    x = model.flint.arb_mat([[model.ball(float(a))] for a in direction])
    image = matrix * x
    square = sum((image[i, 0] ** 2 for i in range(image.nrows())), model.ball(0))
    size = sum((x[i, 0] ** 2 for i in range(6)), model.ball(0))
    return (square / size).sqrt()
