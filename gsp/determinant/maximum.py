"""The maximum of |det J| of a design: closed form, store, or search."""

from __future__ import annotations

from collections.abc import Callable
from weakref import WeakKeyDictionary

import numpy as np

from gsp.determinant.bounds import upper_bound
from gsp.determinant.domain import Domain, check_domain
from gsp.determinant.hexagons import central_pose
from gsp.determinant.known import through_store
from gsp.determinant.record import PROOF, Maximum
from gsp.determinant.search import search
from gsp.errors import InvalidInput, expected
from gsp.geometry.matrices import absolute_determinant
from gsp.geometry.pose import PoseBox
from gsp.model.design import Design
from gsp.progress import Report


def maximum(
    design: Design,
    domain: Domain = None,
    seed: int | np.random.Generator | None = None,
    *,
    store: bool = True,
    wait: bool = True,
    progress: Report = None,
) -> Maximum:
    """Find the maximum of |det J| over poses, or of sqrt(det JᵀJ) for a redundant design.

    Parameters
    ----------
    design : Design
    domain : PoseBox, "all" or None
        The poses that count. None stands for all poses, and for `default_box(design)` if the
        design has D2 or D4 rows; "all" is refused if |det J| is unbounded over all poses.
    seed : int, numpy Generator or None
        Asks for a search with these random starts, whose result goes to the store if it is
        better. Without one a closed form is taken where it is proven, then what the store knows,
        and else a search with the seed 0.
    store : bool
        Whether to use the store of known maxima (see `gsp.determinant.store`).
    wait : bool
        Whether to wait while another process that shares the store searches this maximum.
    progress : function (done, total) or None
        Called after each round of starts.

    Returns
    -------
    Maximum

    Raises
    ------
    InvalidInput
        On a wrong type, a box without width, or "all" without a bound.
    MaximumInProgress
        If another process is searching it and `wait` is not set.
    UnboundedDeterminant
        If the domain holds poses where the lines of a D4 leg are parallel.

    Examples
    --------
    >>> import gsp
    >>> best = maximum(gsp.families.lee.octahedral_3_3(a=1.0, b=2.0))
    >>> best.method, round(best.value, 12), best.pose.position.round(9) + 0.0
    ('closed form', 1.299038105677, array([0., 0., 1.]))

    *Source: Lee2000, eqs. (1), (21), (59), (68), and chapter 9, which searches numerically. The
    bound that proves a closed form, the maximum over all six pose variables, and that of other
    legs than UPS over a stated domain are ours.*
    """
    if not isinstance(design, Design):
        raise InvalidInput(expected("design", "a gsp.Design", type(design).__name__))
    if seed is not None and not isinstance(seed, np.random.Generator):
        if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
            raise InvalidInput(expected("seed", "an integer ≥ 0, a Generator or None", repr(seed)))
        seed = int(seed)
    box = check_domain(design, domain)
    known = _closed_form(design, box) if seed is None else None
    if known is not None:
        return known

    def compute(renew: Callable[[], object]) -> Maximum:
        return search(design, box, seed, _both(progress, renew))

    if not store:
        return compute(lambda: None)
    if seed is not None or domain is not None:
        return through_store(design, box, compute, wait=wait, ask=seed is None)
    if design not in _FOUND:
        _FOUND[design] = through_store(design, box, compute, wait=wait)
    return _FOUND[design]


# What this process has found for a design as it is, so that nothing is looked up twice.
_FOUND: WeakKeyDictionary[Design, Maximum] = WeakKeyDictionary()


def _both(progress: Report, renew: Callable[[], object]) -> Callable[[int, int], None]:
    def tell(done: int, total: int) -> None:
        renew()
        if progress is not None:
            progress(done, total)

    return tell


def _closed_form(design: Design, box: PoseBox | None) -> Maximum | None:
    """Return the central pose of Lee's platforms where it reaches the proven bound."""
    pose = central_pose(design) if box is None else None
    if pose is None:
        return None
    value, bound = float(absolute_determinant(design.at(pose).jacobian)), upper_bound(design)
    found = Maximum(value, pose, method="closed form", evaluations=1, bound=bound)
    return found if value >= bound * (1.0 - PROOF) else None
