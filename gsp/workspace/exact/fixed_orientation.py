"""Fixed-orientation workspaces of SPS legs: each leg keeps the platform origin in a shell."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp.errors import InvalidDesign, InvalidInput, expected
from gsp.geometry.rotations import check_rotation
from gsp.limits.bounds import bounded_quantities
from gsp.limits.limits import Limits
from gsp.limits.quantities import BoundedQuantities
from gsp.model.design import Design, check_undriven
from gsp.workspace.exact.shells import Shells


def exact_shells(
    design: Design, rotation: ArrayLike | None = None, limits: Limits | None = None
) -> Shells:
    """Return the fixed-orientation workspace A[α, β, γ] of a design of SPS legs, exactly.

    Leg i keeps the platform origin between two spheres about a_i − R b_i.

    Parameters
    ----------
    design : Design
        All legs D1, with strokes.
    rotation : (3, 3) array_like or None [1]
        R; default the identity.
    limits : Limits or None
        Other strokes; no other kind of limit is accepted.

    Returns
    -------
    Shells

    Raises
    ------
    InvalidDesign
        If a leg is not SPS.
    MissingParameter
        If the legs have no strokes.
    InvalidInput
        On other limits, a leg without a greatest length, or arguments of other types or shapes.
    InvalidRotation
        If `rotation` is not a rotation matrix.

    Examples
    --------
    >>> import gsp
    >>> ring = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6)])
    >>> d = gsp.Design(["D1"] * 6, 2 * ring, ring, strokes=[[1.0, 2.0]] * 6)
    >>> exact_shells(d).volume().value > 0
    True

    *Source: Workspace-3, §3.1 (ii); the shells are ours*
    """
    bounds = stroke_bounds(design, limits)
    turn = np.eye(3) if rotation is None else check_rotation("rotation", rotation)
    if turn.ndim != 2:
        raise InvalidInput(expected("rotation", "a single rotation", f"shape {turn.shape}"))
    centres = design.base_points - design.platform_points @ turn.T
    return Shells(centres, np.maximum(bounds.low, 0.0), bounds.high)


def stroke_bounds(design: Design, limits: Limits | None) -> BoundedQuantities:
    """Return the strokes of a design of SPS legs, and raise if anything else bounds it."""
    check_undriven("design", design)
    if not design.between_points:
        other = sorted({leg.name for leg in design.legs if leg.cylindrical})
        wanted = "SPS legs (D1) alone; for others use a section with fixed orientation"
        raise InvalidDesign(expected("design", wanted, ", ".join(other)))
    bounds = bounded_quantities(design, limits)
    if len(bounds.names) > bounds.joints:
        raise InvalidInput(expected("limits", "strokes alone", bounds.names[bounds.joints]))
    if not np.isfinite(bounds.high).all():
        free = ", ".join(np.array(design.joint_names)[~np.isfinite(bounds.high)])
        wanted = "a greatest length of every leg (in the design, or by limits, --stroke)"
        where = f"of design {design.name!r}" if design.name else ""
        raise InvalidInput(expected("strokes", wanted, f"none of {free}", where))
    return bounds
