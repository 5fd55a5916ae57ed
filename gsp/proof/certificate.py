"""Certificates: the result of a proof over a box, with the boxes that prove it."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from typing import Any, Literal
from zlib import compress

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.geometry.copies import changeable
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.model.design import toml_from_design
from gsp.proof.branching.tree import leaves, proven_share
from gsp.proof.recorded import Recorded, pose_record
from gsp.variation.layout import OPEN, PROVEN

FORMAT = "gsp certificate 1"


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Certificate(Recorded):
    """The result of a proof over a box of poses; made by `gsp.certify`.

    Attributes
    ----------
    status : "proven", "refuted" or "undecided"
        Proven: the requirements hold at every pose of the box, in real arithmetic, for the numbers
        of the design as they are. Refuted: there is a pose in the box where one of them does not.
        Undecided: the budget is used up, or boxes too small to be halved remain.
    counterexample : Pose of shape (), or None
        A pose of the box that violates a limit by more than rounding; or, for regularity, a pose
        on the segment `bracket` as near to the singular one as double precision allows.
    reason : str
        The requirement that is violated there.
    bracket : Pose of shape (2,), or None
        Two poses where det J has opposite signs, which was checked beyond rounding. On the
        straight segment of coordinates between them is a pose that is singular or undefined.
    points : (k, 6) array [length, rad]
        Coordinates in `box` of the refutation: one point that violates a limit, or the two of the
        bracket; none otherwise.
    n_boxes : int
        Boxes that were evaluated.
    tree : (n,) int8 array
        The boxes in preorder: 0 … 5 is the coordinate of `box` that is halved, 6 a proven box,
        7 an open one.
    claims : mapping
        The requirements, as plain numbers: see `docs/proofs.md`.
    design : Design
    box : PoseBox
        As they were given.
    """

    bracket: Pose | None
    points: Array
    tree: NDArray[np.int8]
    box: PoseBox

    @property
    def proven_share(self) -> float:
        """Share [1] of the volume of the box in proven boxes, in [0, 1]; 1 only if all of it is.

        *Source: ours; see `docs/proofs.md`*
        """
        return proven_share(self.tree)

    @arguments.validated(kind=arguments.one_of("proven", "open"))
    def boxes(self, kind: Literal["proven", "open"]) -> tuple[Array, Array, Array]:
        """Return the proven or the open boxes.

        Parameters
        ----------
        kind : "proven" or "open"

        Returns
        -------
        low, high : (m, 6) arrays [length, rad]
            Ends of the intervals in the coordinates of `box`.
        share : (m,) array [1]
            Shares of the volume of `box`, in (0, 1].

        Raises
        ------
        InvalidInput
            On another word.

        *Source: ours; see `docs/proofs.md`*
        """
        low, high, marks, shares = leaves(self.tree, self.box.low, self.box.high)
        some = marks == (PROVEN if kind == "proven" else OPEN)
        return low[some], high[some], shares[some]

    def record(self) -> dict[str, Any]:
        """Return the certificate as plain numbers and texts, as it is written."""
        return {
            "format": FORMAT,
            "status": self.status,
            "reason": self.reason,
            "claims": changeable(self.claims),
            "box": {
                "low": self.box.low.tolist(),
                "high": self.box.high.tolist(),
                "order": self.box.order,
            },
            "counterexample": pose_record(self.counterexample),
            "bracket": pose_record(self.bracket),
            "points": self.points.tolist(),
            "n_boxes": self.n_boxes,
            "design": toml_from_design(self.design),
            "tree": b64encode(compress(self.tree.tobytes(), 9)).decode("ascii"),
        }
