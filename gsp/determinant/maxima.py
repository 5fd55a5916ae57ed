"""The maximum of |det J| of a design: closed form, store, or search."""

from __future__ import annotations

from collections.abc import Callable
from weakref import WeakKeyDictionary

import numpy as np

from gsp import arguments
from gsp.checks import check_integer
from gsp.determinant.canonical import canonical
from gsp.determinant.domain import Domain, SearchRegion, check_domain
from gsp.determinant.hexagons import central_pose
from gsp.determinant.record import PROOF_TOLERANCE, Maximum
from gsp.determinant.search import search
from gsp.determinant.store import carried, through_store
from gsp.determinant.store.known import stored
from gsp.errors import InvalidInput, expected
from gsp.geometry.matrices import absolute_determinant
from gsp.model.design import Design
from gsp.progress import Progress, Report, check_progress, meter


@arguments.validated(store=arguments.flag, wait=arguments.flag)
def maximum(
    design: Design,
    domain: Domain = None,
    seed: int | np.random.Generator | None = None,
    *,
    store: bool = True,
    wait: bool = True,
    progress: Progress = None,
) -> Maximum:
    """Return the largest |det J| found over poses, or sqrt(det JᵀJ) for a redundant design.

    It is the largest of the local maxima found by many starts. That no pose has a larger one is
    proven only where `Maximum.proven` is true. The value does not depend on the frames of base and
    platform, on the order of the legs (up to seven), on mirror images, or on which body is called
    the base, where the search converged. A value with `Maximum.converged` false is a lower bound
    that may differ between these descriptions: by 0.6 % for congruent coplanar hexagons. The unit
    is the unit of length to the power 3 − number of A1 rows.

    Parameters
    ----------
    design : Design
    domain : PoseBox, Neighbourhood, "all" or None
        The poses that count. None stands for all poses where |det J| is bounded over them for
        these legs (`is_bounded`), and else for `default_neighbourhood(design)`, which needs a home
        pose. "all" is an error where there is no bound. A PoseBox refers to the frames of the
        design, and so does the maximum over it.
    seed : int, numpy Generator or None
        With a seed, the maximum is searched with these random starts, and stored if it is better.
        None takes a proven closed form, else the stored maximum, else a search with the seed 0.
    store : bool
        Whether to use the store of known maxima (see `gsp.determinant.Store`).
    wait : bool
        Whether to wait while another process that shares the store searches this maximum.
    progress : function (done, total), bool or None
        Called after each round of starts. By default a bar is drawn where standard error is a
        terminal, unless the search is short; False draws none.

    Returns
    -------
    Maximum
        The one who searches and those who read the store later get the same bits for a design.

    Raises
    ------
    InvalidInput
        On a wrong type, a box without width, or "all" without a bound.
    MissingParameter
        If the design needs a home pose for its default domain and has none.
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
        seed = check_integer("seed", seed, 0)
    check_progress(progress)
    region = check_domain(design, domain)
    usual = seed is None and domain is None
    if usual and store and design in _FOUND:
        return _FOUND[design]
    known = _closed_form(design, region) if seed is None else None
    if known is None:
        with meter(progress, f"maximum of |det J| of {design.name or 'a design'}") as report:
            known = _searched(design, region, seed, store, wait, report)
    if usual and store:
        _FOUND[design] = known
    return known


def known_maximum(design: Design) -> Maximum | None:
    """Return the maximum of a design over its default domain if no search is needed, else None.

    Parameters
    ----------
    design : Design

    Returns
    -------
    Maximum or None
        That of `maximum`: of this process, by closed form, or from the store.

    Raises
    ------
    InvalidInput
        If `design` is not a Design.
    MissingParameter, UnboundedDeterminant
        As `maximum`.
    """
    if not isinstance(design, Design):
        raise InvalidInput(expected("design", "a gsp.Design", type(design).__name__))
    if design in _FOUND:
        return _FOUND[design]
    region = check_domain(design, None)
    found = _closed_form(design, region)
    if found is None:
        found = stored(design, region, canonical(design, region))
    if found is not None:
        _FOUND[design] = found
    return found


# The maxima that this process has found, by design, so that nothing is looked up twice.
_FOUND: WeakKeyDictionary[Design, Maximum] = WeakKeyDictionary()


def replace_cached(design: Design, old: Maximum, new: Maximum) -> None:
    """Replace a maximum that is cached in this process by a better one."""
    if _FOUND.get(design) is old:
        _FOUND[design] = new


def _searched(
    design: Design,
    region: SearchRegion,
    seed: int | np.random.Generator | None,
    store: bool,
    wait: bool,
    report: Report,
) -> Maximum:
    form = canonical(design, region)

    def compute(renew: Callable[[], object]) -> Maximum:
        return search(form, seed, _both(report, renew))

    if not store:
        return carried(compute(lambda: None), form, design, region)
    return through_store(design, region, form, compute, wait=wait, read=seed is None)


def _both(report: Report, renew: Callable[[], object]) -> Callable[[int, int], None]:
    def called(done: int, total: int) -> None:
        renew()
        report(done, total)

    return called


def _closed_form(design: Design, region: SearchRegion) -> Maximum | None:
    """Return the central pose of Lee's platforms where it reaches the proven bound."""
    if region is not None or central_pose(design) is None:
        return None
    form = canonical(design)
    pose = central_pose(form.design)
    if pose is None:
        return None
    value = float(absolute_determinant(form.design.at(pose).jacobian))
    found = Maximum(value=value, pose=pose, method="closed form", evaluations=1)
    result = carried(found, form, design, region)
    return result if result.value >= result.bound * (1.0 - PROOF_TOLERANCE) else None
