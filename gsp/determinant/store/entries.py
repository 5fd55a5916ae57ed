"""Entries of the store and of files of maxima: written from a maximum, and read with checks."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping
from typing import Any

from gsp.determinant.bounds import upper_bound
from gsp.determinant.canonical import Canonical
from gsp.determinant.domain import SearchRegion, inside
from gsp.determinant.record import METHOD, PROOF_TOLERANCE, Maximum
from gsp.determinant.search import always_singular, slope_at
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.matrices import absolute_determinant
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.version import __version__

# A stored value that differs by more from |det J| at the stored pose is rejected.
VALUE_TOLERANCE = 1e-6
# Slope of log |det J| above which a pose is not a maximum: searches end below 1e-6.
STATIONARY_SLOPE = 1e-4

# The names of the columns of the store are older than those of `Maximum`: "summits" is the number
# of local maxima. They stay, so that every version reads every store.
COUNTS = ("evaluations", "starts", "agreed", "summits", "singles")
FLAGS = ("converged", "attained")


def entry_of(maximum: Maximum, form: Canonical) -> dict[str, Any]:
    """Return a maximum of a canonical design as an entry of the store."""
    pose = maximum.pose
    return {
        "key": form.key,
        "value": maximum.value,
        "position": None if pose is None else json.dumps(pose.position.tolist()),
        "rotation": None if pose is None else json.dumps(pose.rotation.tolist()),
        "evaluations": maximum.evaluations,
        "seed": maximum.seed,
        "starts": maximum.starts,
        "agreed": maximum.agreed,
        "summits": maximum.n_local_maxima,
        "singles": maximum.singles,
        "converged": int(maximum.converged),
        "attained": int(maximum.attained),
        "version": METHOD,
        "design": json.dumps({"legs": form.legs, "rows": form.rows}),
        "domain": None if form.domain is None else json.dumps(form.domain),
        "library": f"gsp {__version__}",
        "found": time.time(),
    }


def maximum_of(entry: Mapping[str, Any], design: Design, region: SearchRegion) -> Maximum:
    """Return the maximum that an entry states for a canonical design, after all checks.

    Parameters
    ----------
    entry : mapping
        With the names of `entry_of`; position and rotation as lists of numbers, or both None.
    design : Design
        The canonical design.
    region : PoseBox, Neighbourhood or None
        Its canonical poses.

    Returns
    -------
    Maximum
        Its value is computed anew at the pose.

    Raises
    ------
    GspError
        If a number is missing or wrong, the pose is not in the region, |det J| at the pose differs
        from the value, or still rises there although the entry counts as converged, or no pose is
        given for a design that is not singular in every pose.
    KeyError
        If there is no value, position or rotation.
    """
    stored = _number("value", entry["value"])
    pose, actual = None, 0.0
    if entry["position"] is not None or entry["rotation"] is not None:
        pose = _pose(entry, region)
        actual = float(absolute_determinant(design.at(pose).jacobian))
    elif not always_singular(design, region):
        wanted = "a pose, as the design is not singular in every pose"
        raise InvalidInput(expected("position", wanted, None))
    if not abs(actual - stored) <= VALUE_TOLERANCE * max(abs(stored), abs(actual)):
        raise InvalidInput(expected("value", f"{actual!r}, which its pose has", stored))
    count = _counts(entry)
    flag = {name: bool(_count(name, entry.get(name), most=1)) for name in FLAGS}
    proven = actual >= upper_bound(design) * (1.0 - PROOF_TOLERANCE)
    if flag["converged"] and count["agreed"] < 2 and not proven:
        wanted = "0, as fewer than two starts ended at this maximum"
        raise InvalidInput(expected("converged", wanted, 1))
    if flag["converged"] and pose is not None and actual > 0.0:
        slope = slope_at(design, region, pose)
        if slope > STATIONARY_SLOPE:
            wanted = "0, as |det J| has a slope at the pose"
            raise InvalidInput(expected("converged", wanted, f"1 (slope {slope:.3g})"))
    seed = entry.get("seed")
    return Maximum(
        value=actual,
        pose=pose,
        method="store",
        seed=None if seed is None else _count("seed", seed),
        library=str(entry.get("library")),
        evaluations=count["evaluations"],
        starts=count["starts"],
        agreed=count["agreed"],
        n_local_maxima=count["summits"],
        singles=count["singles"],
        converged=flag["converged"],
        attained=flag["attained"],
    )


def _counts(entry: Mapping[str, Any]) -> dict[str, int]:
    """Return the numbers of an entry that a search counts, if one search can have counted them."""
    for name in COUNTS:
        if isinstance(entry.get(name), bool):
            raise InvalidInput(expected(name, "an integer ≥ 0", entry.get(name)))
    count = {name: _count(name, entry.get(name)) for name in COUNTS}
    if not count["evaluations"]:
        raise InvalidInput(expected("evaluations", "an integer ≥ 1", 0))
    if count["agreed"] and not count["summits"]:
        wanted = f"an integer ≥ 1, as {count['agreed']} starts ended at this maximum"
        raise InvalidInput(expected("summits", wanted, 0))
    for name, of, what in (("agreed", "starts", "starts"), ("singles", "summits", "local maxima")):
        if count[name] > count[of]:
            raise InvalidInput(expected(name, f"at most the {count[of]} {what}", count[name]))
    return count


def _pose(entry: Mapping[str, Any], region: SearchRegion) -> Pose:
    pose = Pose(entry["position"], entry["rotation"])
    if pose.shape:
        raise InvalidInput(expected("position", "a single pose", f"shape {pose.shape}"))
    if not inside(region, pose):
        raise InvalidInput(expected("position", "a pose in the domain", repr(pose)))
    return pose


def _number(name: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InvalidInput(expected(name, "a finite number", brief(value)))
    return number


def _count(name: str, value: Any, most: float = 2.0**63 - 1.0) -> int:
    # Files of comma-separated values hold the digits as text.
    number = _number(name, value)
    if not (number.is_integer() and 0.0 <= number <= most):
        wanted = "0 or 1" if most == 1 else "an integer ≥ 0"
        raise InvalidInput(expected(name, wanted, brief(value)))
    return int(value) if isinstance(value, int | str) else int(number)
