"""A second, independent check of certificates, in ball arithmetic of any precision.

It shares no code with the search, and is written to be read on its own. The numbers are balls of
python-flint: each contains the exact real number, with all rounding errors. On a
box X with centre c and half-widths r, Taylor's theorem gives for a quantity or a matrix f

    f(x) = f(c) + Σ_k ±r_k f_k(c) + rest,    |rest| ≤ ½ Σ_kl r_k r_l |f_kl(X)|,

where automatic differentiation gives the first derivatives f_k at the centre and the second ones
f_kl on all of X. `matrices` has what follows for singular values and determinants. A box that is
too large for this is halved once more here, until it is confirmed, at most MOST_HALVINGS times.
"""

from __future__ import annotations

from base64 import b64decode
from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from time import monotonic
from typing import Any
from zlib import decompress
from zlib import error as ZlibError

from gsp.checks import check_integer, check_positive
from gsp.errors import MalformedFile, form_of
from gsp.progress import Progress, meter
from gsp.proof.verification.claims import box_flaw, flaw, is_number
from gsp.proof.verification.model import Model
from gsp.proof.verification.paths import opened_path
from gsp.proof.verification.ranges import claimed, ranges
from gsp.proof.verification.refutation import refutation, violates

# Precision of the balls.
CHECK_BITS = 128
# Largest number of halvings of one box.
MOST_HALVINGS = 12
# What must be checked: PROVEN leaves are marked 6, open ones 7, halvings 0 … 5.
PROVEN, OPEN = 6, 7
# Steps through the boxes, as a share of their number, that spread any first part of them evenly.
GOLDEN = 0.6180339887498949
# What a record that is not a certificate may raise.
MALFORMED = (
    ArithmeticError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    ValueError,
    ZlibError,
)


@dataclass(frozen=True)
class Verification:
    """The result of a check: whether a certificate holds, what was checked, what does not hold.

    Attributes
    ----------
    holds : bool
    checked, boxes : int
        Proven boxes that were checked, and that there are; 0 of a refuted certificate, of which the
        refutation is checked.
    share : float [1]
        Share of the volume in the boxes that were checked.
    reason : str
        What does not hold; "" if all does that was checked.
    """

    holds: bool
    checked: int
    boxes: int
    share: float
    reason: str

    @property
    def complete(self) -> bool:
        """Whether every proven box was checked."""
        return self.checked == self.boxes

    def __bool__(self) -> bool:
        return self.holds


def verify(
    record: dict[str, Any],
    *,
    limit: int | None = None,
    seconds: float | None = None,
    progress: Progress = None,
) -> Verification:
    """Check a certificate given as plain numbers.

    Parameters
    ----------
    record : dict
        See `gsp.Certificate.record`.
    limit : int or None
        Check only so many of the proven boxes, evenly spread.
    seconds : float or None [s]
        Check boxes for so long only. An interrupt (Ctrl-C) ends the check in the same way.
    progress : function (done, total), bool or None
        Called with the number of boxes that were checked: see `gsp.evaluate`.

    Returns
    -------
    Verification
        A check that ended early holds if all does that was checked, at least one box. The proven
        boxes of a refuted certificate are not checked.

    Raises
    ------
    MissingSoftware
        Without python-flint.
    MalformedFile
        If the record is not a certificate.
    InvalidInput
        If the limit is not a positive integer, or the time is not a positive number.
    """
    if limit is not None:
        check_integer("limit", limit)
    end = inf if seconds is None else monotonic() + check_positive("seconds", seconds)
    model = _guarded(Model, record)
    with model.flint.ctx.workprec(CHECK_BITS), meter(progress, "verify") as report:
        opened = opened_path if "path" in record else _opened
        proven, reason = _guarded(opened, model, record)
        some = _spread(proven, limit)
        checked, share = 0, 0.0
        try:
            for here, least, greatest, wrong, part in some if not reason else []:
                if not _guarded(_holds, here, least, greatest, wrong, MOST_HALVINGS, end):
                    box = list(zip(least, greatest, strict=True))
                    reason = f"the box {box} could not be confirmed"
                    break
                checked, share = checked + 1, share + part
                report(checked, len(some))
        except (TimeoutError, KeyboardInterrupt):
            reason = "" if checked else "the check ended before a box was confirmed"
    return Verification(not reason, checked, len(proven), share, reason)


def _guarded(function: Callable[..., Any], *given: Any) -> Any:
    try:
        return function(*given)
    except MALFORMED as error:
        what = f"expected the record of a certificate, received {form_of(error)}"
        raise MalformedFile(what) from error


def _opened(model: Model, record: dict[str, Any]) -> tuple[list[Any], str]:
    """Return the boxes that are claimed to be proven, and what does not hold already.

    A box is the model, its low and high ends, whether it is claimed to be violated, which is so of
    paths alone, and its share of the volume.
    """
    low, high = record["box"]["low"], record["box"]["high"]
    marks = list(decompress(b64decode(record["tree"])))
    leaves, complete = _leaves(marks, low, high)
    proven = [(model, a, b, False, share) for a, b, mark, share in leaves if mark == PROVEN]
    reason = box_flaw(record["box"]) or flaw(model, record)
    if not complete:
        reason = reason or "the tree of boxes does not cover the box"
    if record["status"] not in ("proven", "refuted", "undecided"):
        reason = reason or "the status is not one of a certificate"
    if record["status"] == "proven" and len(proven) < len(leaves):
        reason = reason or "boxes are open"
    # Halvings and proven boxes were evaluated, open ones were or were not.
    least = len(marks) - marks.count(OPEN)
    if not (is_number(record["n_boxes"]) and least <= record["n_boxes"] <= len(marks)):
        reason = reason or "n_boxes is not that of the tree"
    if record["status"] == "refuted":
        # What refutes is all that is claimed then, whatever was proven on the way.
        return [], reason or refutation(model.nominal(), record)
    return proven, reason


def _spread(boxes: list[Any], limit: int | None) -> list[Any]:
    """Return the boxes to check, in an order whose first parts are spread over all of them."""
    if limit is not None and len(boxes) > limit:
        boxes = [boxes[i * len(boxes) // limit] for i in range(limit)]
    order = sorted(range(len(boxes)), key=lambda i: i * GOLDEN % 1.0)
    return [boxes[i] for i in order]


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


def _holds(
    model: Model, low: list[float], high: list[float], wrong: bool, left: int, end: float
) -> bool:
    """Whether a box satisfies, or violates, what is claimed; it is halved if need be."""
    if monotonic() > end:
        raise TimeoutError
    parts = (_wrong if wrong else _check)(model, low, high)
    if parts is None:
        return True
    widths = [part if b > a else -1.0 for part, a, b in zip(parts, low, high, strict=True)]
    if left == 0 or max(widths) < 0.0:
        return False
    k = widths.index(max(widths))
    first, second = list(high), list(low)
    first[k] = second[k] = 0.5 * (low[k] + high[k])
    halves = (low, first), (second, high)
    return all(_holds(model, *half, wrong, left - 1, end) for half in halves)


def _check(model: Model, low: list[float], high: list[float]) -> list[float] | None:
    """None if the claims hold on a box, else what each coordinate contributes to one that fails."""
    missing = set(model.claims["bounds"])
    for name, (least, greatest, parts) in ranges(model, low, high):
        missing.discard(name)
        lower, upper = claimed(model, name)
        if not ((lower is None or least >= lower) and (upper is None or greatest <= upper)):
            return parts
    if missing:
        raise MalformedFile(f"bounds of {sorted(missing)}, which are not checked")
    return None


def _wrong(model: Model, low: list[float], high: list[float]) -> list[float] | None:
    """None if one claim fails at all points of an interval, else what is to be halved."""
    found = [violates(model, name, some) for name, some in ranges(model, low, high)]
    return None if any(found) else [1.0]
