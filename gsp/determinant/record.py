"""What is known of a maximum of |det J|."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from gsp.geometry.pose import Pose, PoseBox
from gsp.version import __version__

Method = Literal["closed form", "search", "store"]

# A value that agrees with its proven bound to this share is the maximum.
PROOF = 1e-12


@dataclass(frozen=True, eq=False)
class Maximum:
    """A maximum of |det J| over poses, and how it was found.

    Attributes
    ----------
    value : float [unit^(3 − number of A1 rows)]
        |det J| at `pose`, zero for a design that is singular in every pose.
    pose : Pose or None
        Where; one of several if the design is symmetric. None if the design is singular in
        every pose.
    domain : PoseBox or None
        The poses that were searched; None for all poses.
    method : "closed form", "search" or "store"
    evaluations : int
        Of |det J| and its gradient; those of the original search for one from the store.
    seed : int or None
        Of the search; None for a closed form, or a `Generator` of the caller.
    starts, agreed, summits : int
        Independent starts of the search, how many of them ended at the maximum, and how many
        different local maxima the others found.
    bound : float
        What |det J| cannot exceed, from `upper_bound`; inf where no bound is known.
    converged : bool
        Whether the slope vanishes at the pose. If not, |det J| still rises toward a limit that
        no pose reaches, such as anchors that coincide, and `value` is a lower bound of it.
    library : str
        What computed it, such as "gsp 0.1.0".
    """

    value: float
    pose: Pose | None
    domain: PoseBox | None = None
    method: Method = "search"
    evaluations: int = 0
    seed: int | None = None
    starts: int = 0
    agreed: int = 0
    summits: int = 0
    bound: float = float("inf")
    converged: bool = True
    library: str = f"gsp {__version__}"

    @property
    def proven(self) -> bool:
        """Whether the value reaches the proven bound, so that it is the maximum without doubt."""
        return bool(self.value >= self.bound * (1.0 - PROOF))

    @property
    def unseen(self) -> float:
        """Expected number of local maxima that no start has found; 0 if the value is proven.

        w (w + 1) / (n − w − 2) for w local maxima from n starts (the estimate of Boender and
        Rinnooy Kan, Mathematical Programming 37, 1987).
        """
        if self.proven or not self.starts:
            return 0.0
        return expected_unseen(self.summits, self.starts)

    def facts(self) -> dict[str, Any]:
        """Return what tables state about it, as plain numbers and texts."""
        domain = self.domain
        return {
            "value": self.value,
            "method": self.method,
            "domain": "all poses" if domain is None else box_facts(domain),
            "starts": self.starts,
            "agreed": self.agreed,
            "summits": self.summits,
            "evaluations": self.evaluations,
            "seed": self.seed,
            "bound": self.bound,
            "proven": self.proven,
            "converged": self.converged,
            "library": self.library,
        }


def expected_unseen(summits: int, starts: int) -> float:
    """Boender and Rinnooy Kan's expected number of local maxima not found yet; inf at first."""
    rest = starts - summits - 2
    return summits * (summits + 1) / rest if rest > 0 else float(np.inf)


def box_facts(box: PoseBox) -> dict[str, Any]:
    """Return a box as plain numbers: position, angles (in degrees) and order."""
    low, high = box.low.tolist(), box.high.tolist()
    pairs = [list(pair) for pair in zip(low, high, strict=True)]
    degrees = np.rad2deg(pairs[3:]).tolist()
    return {"position": pairs[:3], "angles_deg": degrees, "order": box.order}
