"""Static balance of a platform: forces of its actuators and the wrench on it.

The power of the actuators f·q̇ is that of the wrench they exert, w·(v, ω), for every twist. With
q̇ = J (v, ω) this is w = Jᵀ f.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.matrices import defined_matrices, full_rank
from gsp.geometry.vectors import Array


def least_forces(jacobian: Array, wrench: Array) -> Array:
    """Return the solutions f of Jᵀ f = −w with the least Σ f², shape (..., n).

    They are unique if J is square. NaN where J is undefined or does not have full rank in double
    precision: then some wrenches have no balance, and others have many.

    Parameters
    ----------
    jacobian : (..., n, c) array [1]
    wrench : (..., c) array [force]
        The leading axes broadcast.
    """
    defined = defined_matrices(jacobian)
    u, s, vt = np.linalg.svd(np.where(defined[..., None, None], jacobian, 0.0), full_matrices=False)
    regular = defined & full_rank(s)
    inverse = 1.0 / np.where(regular[..., None], s, np.nan)
    along = (vt @ wrench[..., None])[..., 0] * inverse
    return np.asarray(-(u @ along[..., None])[..., 0])
