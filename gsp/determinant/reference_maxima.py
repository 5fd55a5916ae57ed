"""The reference of λ: the maximum by which |det J| is divided, decided here only."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from gsp import arguments
from gsp.checks import is_a
from gsp.determinant.bounds import is_bounded
from gsp.determinant.canonical import Canonical, canonical
from gsp.determinant.domain import inside
from gsp.determinant.maxima import maximum, replace_cached
from gsp.determinant.record import Maximum
from gsp.determinant.search import climbed_from
from gsp.determinant.store import StoreError, carried, offer, open_store
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design, check_undriven
from gsp.progress import Progress

# λ above 1 by more than this is not rounding: the maximum is too low.
ABOVE_MAXIMUM = 1e-9
# The same where the maximum is a limit that no pose attains, which is known to 1e-6 only.
ABOVE_SUPREMUM = 1e-5


class MaximumWarning(UserWarning):
    """A maximum of |det J| was too low and has been replaced, or does not refer to some poses."""


def reference(design: Design, progress: Progress = None) -> Maximum:
    """Return the maximum of |det J| that normalises λ of a design if none is given.

    Parameters
    ----------
    design : Design
    progress : function (done, total), bool or None
        See `gsp.determinant.maximum`.

    Returns
    -------
    Maximum
        Over all poses, or over the default neighbourhood of the design's home pose.

    Raises
    ------
    MissingParameter
        If the design needs a home pose for that and has none.

    Examples
    --------
    >>> import gsp
    >>> round(reference(gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)).value, 6)
    1.299038
    """
    if is_a(design, Design) and design.home is None and not is_bounded(design.mechanism):
        raise MissingParameter(
            f"λ of {design.name or 'a design'}: expected a home pose of the design, or maximum=, "
            "received neither: with these legs |det J| has no bound over all poses, and without a "
            "home no domain is independent of the choice of frames"
        )
    return maximum(design, progress=progress)


@arguments.validated(
    found=arguments.kind(Maximum),
    design=check_undriven,
    pose=arguments.kind(Pose),
    quality=arguments.array(finite=False),
)
def mended(found: Maximum, design: Design, pose: Pose, quality: Array) -> Maximum:
    """Return a maximum, or a better one if |det J| at some of the poses exceeds it.

    A λ above 1 within the domain of the maximum means that the search did not find the largest one.
    Then a climb from the worst of these poses gives a better value, which replaces the stored one,
    with a MaximumWarning.

    Parameters
    ----------
    found : Maximum
        That of `reference`, or of `gsp.determinant.maximum`.
    design : Design
    pose : Pose, batch shape (...)
    quality : (...) array [1]
        |det J| at the poses divided by the value of `found`; NaN where undefined.

    Returns
    -------
    Maximum
        `found` itself if no pose exceeds it.

    Raises
    ------
    InvalidInput
        If there is not one λ per pose.
    """
    if np.shape(quality) != pose.shape:
        wanted, got = f"shape {pose.shape}, as the poses have", f"shape {np.shape(quality)}"
        raise InvalidInput(expected("quality", wanted, got))
    limit = 1.0 + (ABOVE_MAXIMUM if found.attained else ABOVE_SUPREMUM)
    above = np.asarray(quality > limit)
    if found.value == 0.0 or not above.any():
        return found
    above &= inside(found.domain, pose)
    if not above.any():
        return found
    worst = int(np.argmax(np.where(above, quality, -np.inf).ravel()))
    flat = pose.reshape(pose.size)
    form = canonical(design, found.domain)
    better = climbed_from(form, form.inward(flat[worst]))
    better = replace(
        better,
        seed=found.seed,
        starts=found.starts,
        agreed=1,
        n_local_maxima=found.n_local_maxima + 1,
        singles=found.singles + 1,
        evaluations=found.evaluations + better.evaluations,
        converged=False,
    )
    result = carried(better, form, design, found.domain)
    if not result.value > found.value:
        return found
    _keep(better, form)
    replace_cached(design, found, result)
    warnings.warn(
        f"λ of {design.name or 'a design'} would be {float(quality.ravel()[worst]):.6g} at "
        f"{flat[worst]!r}: the maximum of |det J| {found.value:.12g} was too low. It is replaced "
        f"by {result.value:.12g}, in the store as well, and λ is computed with that",
        MaximumWarning,
        stacklevel=3,
    )
    return result


def _keep(better: Maximum, form: Canonical) -> None:
    """Store a better maximum of a canonical design, or warn that it is not stored."""
    try:
        store = open_store()
        if store is not None:
            offer(store, better, form)
    except StoreError as error:
        # Shown at the caller of `mended`.
        warnings.warn(f"{error}; the better maximum is not stored", MaximumWarning, stacklevel=4)


@arguments.validated(found=arguments.kind(Maximum), pose=arguments.kind(Pose))
def outside(found: Maximum, pose: Pose) -> int:
    """Return the number of poses outside the domain of a maximum.

    λ may exceed 1 there.

    Parameters
    ----------
    found : Maximum
    pose : Pose, batch shape (...)

    Returns
    -------
    int

    Raises
    ------
    InvalidInput
        If `found` is not a Maximum, or `pose` is not a Pose.
    """
    return int(pose.size - inside(found.domain, pose).sum())
