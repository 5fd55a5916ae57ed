"""The result of a proof along a path."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.geometry.copies import changeable
from gsp.geometry.vectors import Array
from gsp.model.design import toml_from_design
from gsp.proof.recorded import Recorded, pose_record

PATH_FORMAT = "gsp path certificate 1"


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class PathCertificate(Recorded):
    """The result of a proof along a path; made by `gsp.certify_path`.

    The parameter is the time, where there are times. Otherwise it runs from 0 at the first node
    to n − 1 at the last.

    Attributes
    ----------
    status : "proven", "refuted" or "undecided"
        As in `gsp.Certificate`, for every pose of the curve.
    reason : str
        The requirement that is violated, if the path is refuted.
    bracket : (float, float) or None [time, or 1]
        Parameters between which the path is refuted: equal ones where a limit is violated; the
        ends of the interval where det J changes its sign.
    counterexample : Pose of shape (), or None
        The pose in the middle of `bracket`.
    points : tuple of float [1]
        The one or two ends of `bracket` as numbers of pieces plus shares of them.
    intervals : tuple of (low, high, "proven", "violated" or "open") [1]
        The whole path in intervals, in order, as numbers of pieces plus shares of them.
    parts : int
        Intervals that the search began with; the others are halves.
    n_boxes : int
        Intervals that were evaluated.
    claims : mapping
        The requirements, as plain numbers: see `docs/proofs.md`.
    path : mapping
        The pieces of the path, as plain numbers.
    design : Design
    """

    bracket: tuple[float, float] | None
    points: tuple[float, ...]
    intervals: tuple[tuple[float, float, str], ...]
    parts: int
    path: Mapping[str, Any]

    @property
    def proven(self) -> Array:
        """Intervals that are proven, in order and joined: (m, 2) array [time, or 1].

        *Source: ours; see `docs/proofs.md`*
        """
        return self._joined("proven")

    @property
    def violated(self) -> Array:
        """Intervals at all whose poses a limit is violated, joined: (m, 2) array [time, or 1].

        A lower bound of where the path fails. What is neither here nor proven is not decided.

        *Source: ours; see `docs/proofs.md`*
        """
        return self._joined("violated")

    @property
    def proven_share(self) -> float:
        """Share [1] of the parameter in proven intervals, in [0, 1].

        *Source: ours; see `docs/proofs.md`*
        """
        times = np.asarray(self.path["times"])
        if self.status == "proven":
            return 1.0
        return float(np.diff(self.proven, axis=1).sum() / (times[-1] - times[0]))

    def _joined(self, kind: str) -> Array:
        joined: list[list[float]] = []
        for low, high, mark in self.intervals:
            if mark == kind and joined and joined[-1][1] == low:
                joined[-1][1] = high
            elif mark == kind:
                joined.append([low, high])
        ends, times = np.array(joined).reshape(-1, 2), np.asarray(self.path["times"])
        return np.asarray(np.interp(ends, np.arange(len(times)), times))

    def record(self) -> dict[str, Any]:
        """Return the certificate as plain numbers and texts, as it is written."""
        return {
            "format": PATH_FORMAT,
            "status": self.status,
            "reason": self.reason,
            "claims": changeable(self.claims),
            "path": changeable(self.path),
            "counterexample": pose_record(self.counterexample),
            "bracket": None if self.bracket is None else list(self.bracket),
            "points": list(self.points),
            "parts": self.parts,
            "n_boxes": self.n_boxes,
            "design": toml_from_design(self.design),
            "intervals": [list(x) for x in self.intervals],
        }
