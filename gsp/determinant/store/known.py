"""Maxima through the store: look up, or claim, compute and store; wait for other processes."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from gsp.determinant.bounds import upper_bound
from gsp.determinant.canonical import Canonical
from gsp.determinant.domain import SearchRegion
from gsp.determinant.record import Maximum
from gsp.determinant.store.connection import MissingStore, StoreError, StoreWarning
from gsp.determinant.store.database import CLAIM_SECONDS, Store, open_store
from gsp.determinant.store.entries import entry_of, maximum_of
from gsp.determinant.store.validity import damage, remove_damaged, structured
from gsp.determinant.symmetry import representative, symmetries
from gsp.errors import GspError
from gsp.geometry.matrices import absolute_determinant
from gsp.geometry.pose import Pose
from gsp.model.design import Design

Compute = Callable[[Callable[[], object]], Maximum]


class MaximumInProgress(GspError, RuntimeError):
    """Another process is searching this maximum, and `wait` is not set."""


def through_store(
    design: Design,
    region: SearchRegion,
    form: Canonical,
    compute: Compute,
    *,
    wait: bool = True,
    read: bool = True,
) -> Maximum:
    """Return a maximum from the store, or else compute and store it.

    A store that fails gives a StoreWarning, and the computation continues without it.

    Parameters
    ----------
    design : Design
    region : PoseBox, Neighbourhood or None
    form : Canonical
        The canonical form of design and region.
    compute : function of a function
        Returns the maximum of the canonical design. It calls its argument from time to time, which
        renews the claim.
    wait : bool
        Wait while another process searches, or raise MaximumInProgress.
    read : bool
        Read the stored maximum; if false, compute it in any case, and store it if it is better.

    Returns
    -------
    Maximum
        Of the design, over the region.

    Raises
    ------
    MaximumInProgress
    """
    try:
        store = open_store()
        if store is not None and read:
            return _read_or_searched(store, form, design, region, compute, wait)
    except StoreError as error:
        _warn(error)
        store = None
    found = compute(lambda: None)
    if store is not None:
        offer(store, found, form)
    return carried(found, form, design, region)


def stored(design: Design, region: SearchRegion, form: Canonical) -> Maximum | None:
    """Return the stored maximum of a design, or None; nothing is claimed, computed or made.

    Parameters
    ----------
    design : Design
    region : PoseBox, Neighbourhood or None
    form : Canonical
        The canonical form of design and region.
    """
    try:
        store = open_store(make=False)
        entry = None if store is None else store.get(form.key)
    except MissingStore:
        return None
    except StoreError as error:
        _warn(error)
        return None
    if entry is None or entry["value"] is None:
        return None
    known = _checked(entry, form)
    return None if known is None else carried(known, form, design, region)


def carried(found: Maximum, form: Canonical, design: Design, region: SearchRegion) -> Maximum:
    """Return a maximum of the canonical design as one of the design that it belongs to.

    All maxima that are returned to callers, of searches and of the store, are made here. The
    value is computed anew from the design in canonical form, which loses no digits where the frames
    of the design lie far away.

    Parameters
    ----------
    found : Maximum
        Of a design with the same key.
    form : Canonical
        Of `design`.
    design : Design
    region : PoseBox, Neighbourhood or None

    Returns
    -------
    Maximum
    """
    bound = upper_bound(form.design) * form.scale(design)
    if found.pose is None:
        return replace(found, domain=region, bound=bound)
    value = float(absolute_determinant(form.design.at(found.pose).jacobian))
    images = symmetries(form.design) if region is None else ()
    poses = [s.image(found.pose.position, found.pose.rotation) for s in images]
    outer = [form.outward(Pose(*image)) for image in poses] or [form.outward(found.pose)]
    return replace(
        found,
        value=value * form.scale(design),
        pose=representative(outer, form.length),
        domain=region,
        bound=bound,
    )


def offer(store: Store, found: Maximum, form: Canonical) -> None:
    """Store a maximum of a canonical design if it is better; a store that fails gives a warning.

    Parameters
    ----------
    store : Store
    found : Maximum
        Of the canonical design.
    form : Canonical
    """

    def put() -> None:
        remove_damaged(store, form.key)
        store.put(entry_of(found, form))

    _quietly(put)


def _read_or_searched(
    store: Store,
    form: Canonical,
    design: Design,
    region: SearchRegion,
    compute: Compute,
    wait: bool,
) -> Maximum:
    pause = 0.02
    while True:
        entry = store.get(form.key)
        if entry is not None and entry["value"] is not None:
            known = _checked(entry, form)
            if known is not None:
                return carried(known, form, design, region)
            remove_damaged(store, form.key)
        if store.claim(form.key):
            return carried(_computed(store, form, compute), form, design, region)
        if not wait:
            raise MaximumInProgress(
                f"maximum of |det J| of {design.name or 'a design'}: processing, by "
                f"{(entry or {}).get('worker') or 'another process'}"
            )
        time.sleep(pause)
        pause = min(2.0 * pause, 0.5)


def _computed(store: Store, form: Canonical, compute: Compute) -> Maximum:
    renewed = time.monotonic()

    def renew() -> None:
        nonlocal renewed
        if time.monotonic() - renewed > CLAIM_SECONDS / 6.0:
            renewed = time.monotonic()
            _quietly(lambda: store.claim(form.key))

    try:
        found = compute(renew)
    except BaseException:
        _quietly(lambda: store.release(form.key))
        raise
    offer(store, found, form)
    return found


def _quietly(action: Callable[[], Any]) -> None:
    try:
        action()
    except StoreError as error:
        _warn(error)


def _warn(error: StoreError) -> None:
    warnings.warn(f"{error}; the computation continues without it", StoreWarning, stacklevel=6)


def _checked(entry: dict[str, Any], form: Canonical) -> Maximum | None:
    """Return the maximum of an entry for the canonical design, or None if a check fails."""
    if damage(entry):
        return None
    return maximum_of(structured(entry), form.design, form.region)
