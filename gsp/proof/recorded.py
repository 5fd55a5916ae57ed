"""What results of proofs have in common: they are recorded as plain numbers and checked again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

from gsp import arguments
from gsp.files.writing import write_text
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.progress import Progress

if TYPE_CHECKING:
    from gsp.proof.verification import Verification

Status = Literal["proven", "refuted", "undecided"]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Recorded(ReadOnly):
    """The result of a proof, with the pieces that prove it: boxes, or intervals of a path.

    Attributes
    ----------
    status : "proven", "refuted" or "undecided"
    reason : str
        The requirement that is violated, if the claim is refuted.
    counterexample : Pose of shape (), or None
    n_boxes : int
        Boxes, or intervals, that were evaluated.
    claims : mapping
        The requirements, as plain numbers.
    design : Design
    """

    status: Status
    reason: str
    counterexample: Pose | None
    n_boxes: int
    claims: Mapping[str, Any]
    design: Design

    @property
    def proven_share(self) -> float:
        """Share of the poses in proven pieces, in [0, 1]."""
        raise NotImplementedError

    def record(self) -> dict[str, Any]:
        """Return the certificate as plain numbers and texts, as it is written."""
        raise NotImplementedError

    @arguments.validated(limit=arguments.optional(arguments.integer(1)))
    def verify(
        self,
        *,
        limit: int | None = None,
        seconds: float | None = None,
        progress: Progress = None,
    ) -> Verification:
        """Check the certificate again, by code that is independent of the search.

        Ball arithmetic of python-flint, an extra: `pip install "gsp-mechanisms[verify]"`. Of a box
        the proven boxes and the refutation are checked; of a path the proven and the violated
        intervals and the pose that refutes, of a refuted path with tolerances the pose alone.

        Parameters
        ----------
        limit : int or None
            Check only so many of the boxes or intervals, evenly spread; the result states the
            number.
        seconds : float or None [s]
            Check them for so long only. An interrupt (Ctrl-C) ends the check in the same way.
        progress : function (done, total), bool or None
            Called with the number of boxes or intervals that were checked: see `gsp.evaluate`.

        Returns
        -------
        Verification
            True if all that was checked holds; otherwise `reason` states what does not.

        Raises
        ------
        InvalidInput
            If `limit` is not an integer ≥ 1, or `seconds` is not > 0.
        MissingSoftware
            Without python-flint.
        """
        from gsp.proof.verification import verify

        return verify(self.record(), limit=limit, seconds=seconds, progress=progress)

    @arguments.validated(path=arguments.path, overwrite=arguments.flag)
    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the certificate as JSON, which `gsp.proof.read_certificate` reads.

        Parameters
        ----------
        path : str or path
        overwrite : bool
            Whether a file that exists is replaced.

        Raises
        ------
        UnwritableOutput
            If the file exists and `overwrite` is not set, or the folder cannot be written.
        """
        write_text(path, json.dumps(self.record(), indent=1) + "\n", overwrite=overwrite)

    def __repr__(self) -> str:
        share = "" if self.status == "proven" else f", proven_share={self.proven_share:.6g}"
        return f"{type(self).__name__}({self.status!r}{share}, n_boxes={self.n_boxes})"


def pose_record(pose: Pose | None) -> dict[str, Any] | None:
    """Return poses as plain numbers."""
    if pose is None:
        return None
    return {"position": pose.position.tolist(), "rotation": pose.rotation.tolist()}
