"""Maxima through the store: look up, or claim, compute and store; wait for others who compute."""

from __future__ import annotations

import json
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from gsp.determinant.bounds import upper_bound
from gsp.determinant.canonical import Canonical, canonical
from gsp.determinant.record import Maximum
from gsp.determinant.store import CLAIM, Store, StoreError, StoreWarning, entry_of, open_store
from gsp.errors import GspError
from gsp.geometry.matrices import absolute_determinant
from gsp.geometry.pose import Pose, PoseBox
from gsp.model.design import Design

Compute = Callable[[Callable[[], object]], Maximum]

# A stored value that differs by more from |det J| at the stored pose is not believed.
BELIEVED = 1e-6


class MaximumInProgress(GspError, RuntimeError):
    """Another process is searching this maximum, and waiting for it was not wanted."""


def through_store(
    design: Design, box: PoseBox | None, compute: Compute, *, wait: bool = True, ask: bool = True
) -> Maximum:
    """Return a maximum from the store, or else compute and store it.

    Parameters
    ----------
    design : Design
    box : PoseBox or None
    compute : function of a function
        Finds the maximum, and now and then calls what it is given, which renews the claim.
    wait : bool
        Wait while another process searches, or raise MaximumInProgress.
    ask : bool
        Look the maximum up; else compute it anyway, and store it if it is better.

    A store that fails gives a StoreWarning, and computing goes on without it.
    """
    try:
        store = open_store()
        if store is None:
            return compute(lambda: None)
        form = canonical(design, box)
        if ask:
            return _asked(store, form, design, box, compute, wait)
    except StoreError as error:
        _warn(error)
        return compute(lambda: None)
    found = compute(lambda: None)
    _offer(store, found, form, design)
    return found


def _asked(
    store: Store, form: Canonical, design: Design, box: PoseBox | None, compute: Compute, wait: bool
) -> Maximum:
    pause = 0.02
    while True:
        entry = store.get(form.key)
        if entry is not None and entry["value"] is not None:
            known = _believed(entry, form, design, box)
            if known is not None:
                return known
            store.remove(form.key)
        if store.claim(form.key):
            return _computed(store, form, design, compute)
        if not wait:
            raise MaximumInProgress(
                f"maximum of |det J| of {design.name or 'a design'}: processing, by "
                f"{(entry or {}).get('worker') or 'another process'}"
            )
        time.sleep(pause)
        pause = min(2.0 * pause, 0.5)


def _computed(store: Store, form: Canonical, design: Design, compute: Compute) -> Maximum:
    renewed = time.monotonic()

    def renew() -> None:
        nonlocal renewed
        if time.monotonic() - renewed > CLAIM / 6.0:
            renewed = time.monotonic()
            _quietly(lambda: store.claim(form.key))

    try:
        found = compute(renew)
    except BaseException:
        _quietly(lambda: store.release(form.key))
        raise
    _offer(store, found, form, design)
    return found


def _offer(store: Store, found: Maximum, form: Canonical, design: Design) -> None:
    _quietly(lambda: store.put(entry_of(found, form)))


def _quietly(action: Callable[[], Any]) -> None:
    try:
        action()
    except StoreError as error:
        _warn(error)


def _warn(error: StoreError) -> None:
    warnings.warn(f"{error}; computing goes on without it", StoreWarning, stacklevel=5)


def _believed(
    entry: dict[str, Any], form: Canonical, design: Design, box: PoseBox | None
) -> Maximum | None:
    """Return the maximum of an entry, its value computed anew at its pose, if the two agree."""
    stored = float(entry["value"]) * form.scale(design)
    if entry["position"] is None:
        pose, value = None, 0.0
    else:
        try:
            pose = form.outward(Pose(json.loads(entry["position"]), json.loads(entry["rotation"])))
        except (GspError, ValueError, TypeError):
            return None
        value = float(absolute_determinant(design.at(pose).jacobian))
    if not np.isfinite(stored) or abs(value - stored) > BELIEVED * max(abs(stored), abs(value)):
        return None
    return Maximum(
        value, pose, box, "store", int(entry["evaluations"]), entry["seed"], int(entry["starts"]),
        int(entry["agreed"]), int(entry["summits"]), upper_bound(design),
        bool(entry["converged"]), str(entry["library"]),
    )  # fmt: skip
