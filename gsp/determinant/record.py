"""The record of a maximum of |det J|, with the statistics of its search."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from gsp.determinant.domain import Neighbourhood, SearchRegion
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose, PoseBox
from gsp.version import __version__

Method = Literal["closed form", "search", "store"]

# Number of the method of searching. Stored maxima of other numbers are computed anew:
# 1 turned about the origins of the user's frames and could stop early; 2 marked suprema toward
# segments of zero length as attained.
METHOD = 3
# A value that agrees with its proven bound to this share is the maximum.
PROOF_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Maximum(ReadOnly):
    """The largest |det J| found over poses, and the record of its search.

    Attributes
    ----------
    value : float [unit^(3 − number of A1 rows)]
        |det J| at `pose`, zero for a design that is singular in every pose. It is the dimensional
        Jacobian's, in the unit of the design, also where a characteristic length is given.
    pose : Pose, batch shape (), or None
        Where; one of several if the design is symmetric. None if the design is singular in
        every pose.
    domain : PoseBox, Neighbourhood or None
        The poses that were searched; None for all poses.
    method : "closed form", "search" or "store"
    evaluations : int
        Of |det J| and its gradient; those of the original search for one from the store.
    seed : int or None
        Of the search; None for a closed form, or a `Generator` of the caller.
    starts, agreed, n_local_maxima : int
        Independent random starts of the search that ended at a local maximum, how many of them
        ended at this one, and how many different ones they found. Images under a symmetry of the
        design count as one. All are 0 where every start climbs toward a limit that no pose attains.
    singles : int
        Local maxima that one start only has found.
    bound : float [unit of the value]
        A value that |det J| cannot exceed, from `upper_bound`; inf where none is known.
    converged : bool
        Whether the gradient vanishes at the pose, and at least two starts ended there. If not,
        `value` is a lower bound, and another seed may find more.
    attained : bool
        Whether `value` is that of a pose. If not, it is the limit of |det J| toward infinite
        displacement, or toward a pose where a row is undefined, and `pose` is near to that limit.
    library : str
        The library that computed it, such as "gsp 0.1.0".
    """

    value: float
    pose: Pose | None
    domain: SearchRegion = None
    method: Method = "search"
    evaluations: int = 0
    seed: int | None = None
    starts: int = 0
    agreed: int = 0
    n_local_maxima: int = 0
    singles: int = 0
    bound: float = float("inf")
    converged: bool = True
    attained: bool = True
    library: str = f"gsp {__version__}"

    @property
    def proven(self) -> bool:
        """Whether the value reaches the proven bound: then no pose has a larger one."""
        return bool(self.value >= self.bound * (1.0 - PROOF_TOLERANCE))

    @property
    def expected_unseen(self) -> float:
        """Expected number of local maxima that no start has found; 0 if the value is proven.

        w (w + 1) / (n − w − 2) for w local maxima from n starts.

        Returns
        -------
        float [1]
            ≥ 0; inf if fewer than two starts ended at the largest one. None ends at a limit toward
            a pose where a row is undefined, because no slope vanishes there.

        *Source: Boender and Rinnooy Kan, Mathematical Programming 37, 1987*
        """
        if self.proven:
            return 0.0
        if self.agreed < 2:
            return float("inf")
        return _further_maxima(self.n_local_maxima, self.starts)

    @property
    def probability_new(self) -> float:
        """Estimated probability that one more start ends at a local maximum not found before.

        The share of starts that ended where no other one did.

        Returns
        -------
        float [1]
            In [0, 1]; 0 if the value is proven, 1 if no start ended at a local maximum.

        *Source: Good, Biometrika 40, 1953*
        """
        if self.proven:
            return 0.0
        if not self.starts:
            return 1.0
        return self.singles / self.starts

    def facts(self) -> dict[str, Any]:
        """Return the maximum as tables record it: plain numbers and texts."""
        return {
            "value": self.value,
            "method": self.method,
            "domain": region_facts(self.domain),
            "starts": self.starts,
            "agreed": self.agreed,
            "n_local_maxima": self.n_local_maxima,
            "expected_unseen": self.expected_unseen,
            "probability_new": self.probability_new,
            "evaluations": self.evaluations,
            "seed": self.seed,
            "bound": self.bound,
            "proven": self.proven,
            "converged": self.converged,
            "attained": self.attained,
            "library": self.library,
        }


def _further_maxima(found: int, starts: int) -> float:
    """Return the expected number of local maxima that were not found; inf for few starts.

    *Source: Boender and Rinnooy Kan, Mathematical Programming 37, 1987.*
    """
    rest = starts - found - 2
    return found * (found + 1) / rest if rest > 0 else float(np.inf)


def region_facts(region: SearchRegion) -> Any:
    """Return a region as plain numbers, or "all poses"."""
    if region is None:
        return "all poses"
    return region.facts() if isinstance(region, Neighbourhood) else box_facts(region)


def box_facts(box: PoseBox) -> dict[str, Any]:
    """Return a box as plain numbers: position, angles (in degrees) and order."""
    low, high = box.low.tolist(), box.high.tolist()
    pairs = [list(pair) for pair in zip(low, high, strict=True)]
    degrees = np.rad2deg(pairs[3:]).tolist()
    return {"position": pairs[:3], "angles_deg": degrees, "order": box.order}
