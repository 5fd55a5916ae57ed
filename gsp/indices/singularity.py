"""SD: a proven distance from the nearest singular posture."""

from __future__ import annotations

import numpy as np

from gsp import arguments
from gsp.geometry.vectors import Array
from gsp.indices.record import Index, Invariance, Properties
from gsp.indices.requirements import require_posture
from gsp.model.design import check_undriven
from gsp.model.posture import Posture


def singularity_distance(posture: Posture, length: float) -> Array:
    """Proven lower bound of the distance to the nearest singular or undefined pose.

    The distance of two poses is sqrt(|p − p′|² + (L θ)²), with the angle θ between them. No pose
    nearer than the value is singular. The value is a lower bound: it follows from one ball of
    poses around the pose, does not depend on the axes, and is some tenths of the distance.
    `gsp.singularity_distance` divides the ball, for a larger lower bound, and has an upper one.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float [unit of the design]
        Characteristic length L > 0.

    Returns
    -------
    (...) array [unit of the design]
        In [0, ∞); 0 when singular, or so nearly that nothing is proven; NaN where undefined.

    Raises
    ------
    InvalidInput
        If `length` is not a positive number.
    InvalidDesign
        For legs that are driven at the base.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> bool(5 < gsp.indices.singularity_distance(d.at(d.home), 95.0))
    True

    *Source: ours; see `docs/proofs.md`.*
    """
    # Imported here, as tracing the bounds takes time that other indices do not need.
    from gsp.variation.free import free_radii

    require_posture(posture)
    check_undriven("design of the posture", posture.design)
    scale = arguments.size("length", length)
    pose = posture.pose.reshape(posture.pose.size)
    radii = free_radii(posture.design, pose.position, pose.rotation, scale)
    return np.where(posture.defined, radii.reshape(posture.shape), np.nan)


SINGULARITY_DISTANCE = Index(
    name="singularity_distance",
    symbol="SD",
    function=singularity_distance,
    better="higher",
    best=np.inf,
    worst=0.0,
    parameters=("length",),
    needs=("length",),
    length_for="",
    unit_power="length",
    source="ours",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=True,
        motion_invariant=True,
        similarity_invariant=False,
        # A bound of a distance of poses, not a distance that is seen.
        geometric=False,
        real_time=True,
    ),
    # Its bounds contain the distances of the anchors from the platform origin.
    invariance=Invariance(platform_shift="changes", exchange="changes", slide="changes"),
    routine=False,
    slow=True,
)
