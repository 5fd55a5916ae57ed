"""Designs as the bounds take them."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import EPS, Array, norm
from gsp.model.design import Design

# Rounding of norms, outward.
NORM_OUTWARD = 1.0 + 4.0 * EPS


def geometry_of(design: Design, tolerances: Array | None = None) -> Array:
    """Return a, b, s, t, |a|, |b| and tolerances of each leg; directions that are missing are z.

    Parameters
    ----------
    design : Design
    tolerances : (n_legs, 4) array or None [length, length, rad, rad]
        Of a, b, s and t; None for zeros.

    Returns
    -------
    (n_legs, GEOMETRY) array
    """
    # Formulas of legs without a line do not read its direction; z keeps all numbers finite.
    z = np.array([0.0, 0.0, 1.0])
    s = np.where(np.isfinite(design.base_directions), design.base_directions, z)
    t = np.where(np.isfinite(design.platform_directions), design.platform_directions, z)
    a, b = design.base_points, design.platform_points
    sizes = np.stack((norm(a), norm(b)), axis=1) * NORM_OUTWARD
    near = np.zeros((design.n_legs, 4)) if tolerances is None else tolerances
    return np.concatenate((a, b, s, t, sizes, near), axis=1)
