"""Feasibility: poses within the limits of a design, and reasons for the others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gsp.checks import check_type
from gsp.errors import InvalidInput, apart, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import EPS, Array, Mask
from gsp.limits.bounds import bounded_quantities
from gsp.limits.limits import Limits
from gsp.model.design import Design

# Poses evaluated at once; the arrays of a block stay within some ten megabytes.
POSES_PER_CHECK = 65536


@dataclass(frozen=True, eq=False)
class Feasibility(ReadOnly):
    """Whether poses are feasible, and what is violated where they are not.

    Attributes
    ----------
    names : tuple of str
        The bounded quantities: joints, cone angles, clearances, x, y, z, indices.
    low, high : (m,) arrays [unit of the quantity]
        Their bounds, ∓inf where there is none.
    values : (..., m) array [unit of the quantity]
        Their values; NaN where they are not defined.
    undefined : tuple of str
        Why each quantity has no value, where it has none; "" if that has more than one reason.
    kinds : tuple of str
        Their kinds: "joint", "position", "cone", "clearance" or "index".
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    values: Array
    undefined: tuple[str, ...]
    kinds: tuple[str, ...]

    @property
    def violated(self) -> NDArray[np.bool_]:
        """Which bounds are violated, shape (..., m, 2): least, greatest; both if undefined.

        A value that exceeds its bound by rounding alone is allowed.

        *Source: Workspace-3, eq. (3.1), for strokes; the other limits are ours*
        """
        slack = 16 * EPS
        below = ~(self.values >= self.low - slack * np.abs(np.nan_to_num(self.low, neginf=0.0)))
        above = ~(self.values <= self.high + slack * np.abs(np.nan_to_num(self.high, posinf=0.0)))
        return np.stack((below, above), axis=-1)

    @property
    def ok(self) -> Mask:
        """Whether a pose is feasible, shape (...).

        *Source: Workspace-3, eq. (3.1), for strokes; the other limits are ours*
        """
        return np.asarray(~self.violated.any(axis=(-2, -1)))

    @property
    def shares(self) -> dict[str, float]:
        """Share of the poses that violate a limit of each kind [1], NaN without poses.

        A pose may violate limits of several kinds. Joints that are undefined count as violated.

        *Source: ours*
        """
        violated = self.violated.any(axis=-1).reshape(-1, len(self.names))
        of_kind = np.array(self.kinds)
        return {
            kind: float(violated[:, of_kind == kind].any(axis=1).mean())
            if len(violated)
            else np.nan
            for kind in dict.fromkeys(self.kinds)
        }

    @property
    def reasons(self) -> NDArray[np.str_]:
        """Why a pose is not feasible, "" where it is, shape (...)."""
        violated = self.violated
        texts = np.zeros(self.values.shape[:-1], dtype=object)
        for where in np.ndindex(texts.shape):
            texts[where] = "; ".join(
                self._reason(self.values[where], i, side) for i, side in _bad(violated[where])
            )
        return texts.astype(np.str_)

    @property
    def reason(self) -> str:
        """Why a single pose is not feasible, "" if it is.

        Raises
        ------
        InvalidInput
            For a batch: see `reasons`.
        """
        if self.values.ndim != 1:
            raise InvalidInput(expected("feasibility", "a single pose", f"shape {self.ok.shape}"))
        return str(self.reasons[()])

    def _reason(self, values: Array, i: int, side: int) -> str:
        if np.isnan(values[i]):
            return ": ".join(filter(None, (f"{self.names[i]} is not defined", self.undefined[i])))
        bound = (self.low, self.high)[side][i]
        value, bound = apart(values[i], bound)
        return f"{self.names[i]} = {value} {'<>'[side]} {bound}"

    def __bool__(self) -> bool:
        return bool(self.ok.all())


def _bad(violated: NDArray[np.bool_]) -> list[tuple[int, int]]:
    found = {int(i): int(side) for i, side in np.argwhere(violated)}
    return sorted(found.items())


def feasible(design: Design, pose: Pose, limits: Limits | None = None) -> Feasibility:
    """Return which poses satisfy the limits of a design, with the reasons for the others.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...)
    limits : Limits or None
        Default: the strokes of the design.

    Returns
    -------
    Feasibility
        `ok` and `reasons` have the batch shape of the poses.

    Raises
    ------
    MissingParameter
        If nothing limits the design.
    InvalidInput
        If an argument has another type, or limits cross or do not fit the design.

    *Source: Workspace-3, eq. (3.1), for strokes; the other limits are ours*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> feasible(d, d.home, Limits(strokes=[[100, 140]] * 6)).reason
    'd1 = 143.909 > 140; d3 = 155.211 > 140'
    """
    check_type("pose", pose, Pose)
    bounds = bounded_quantities(design, limits, crossed=True, driven=True)
    flat = pose.reshape(pose.size)
    values = np.empty((pose.size, len(bounds.names)))
    for start in range(0, pose.size, POSES_PER_CHECK):
        part = slice(start, start + POSES_PER_CHECK)
        values[part] = bounds.quantities.values(flat.position[part], flat.rotation[part])
    shaped = values.reshape(*pose.shape, len(bounds.names))
    reasons = [row.constraint.undefined for row in design.rows]
    undefined = (*reasons, *[""] * (len(bounds.names) - len(reasons)))
    kinds = tuple(quantity.kind for quantity in bounds.named)
    return Feasibility(bounds.names, bounds.low, bounds.high, shaped, undefined, kinds)
