"""Plane sections of workspaces: bifurcation points, labelled curves, ray ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.labels import Active, active_from_label
from gsp.limits.quantities import BoundedQuantities
from gsp.workspace.boundary.critical import Chart, Points, between
from gsp.workspace.boundary.maxima import why_not_maximal
from gsp.workspace.boundary.rays import RayEnds, on_ray

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class BifurcationPoint(ReadOnly):
    """A point where boundary curves meet.

    Attributes
    ----------
    label : str
        Which joints are at their least (0) and greatest (1) value.
    pose : Pose of batch shape (), a single pose
    joints : (m,) array [unit of the quantity]
        The bounded quantities there: joints first.
    """

    label: str
    pose: Pose
    joints: Array


@dataclass(frozen=True, eq=False)
class Curve(ReadOnly):
    """A curve on which the same constraints are active, from one end to the other.

    Attributes
    ----------
    label : str
    pose : Pose, batch shape (N,)
    weight : (N, n) array [1]
        Multipliers of the active constraints, Σ λ² = 1.
    maximal : (N,) bool array
        Where the curve is a local maximum along its outward normal, that is, a boundary of the
        points reached without a change of branch. Elsewhere it only connects bifurcation points.
    first, last : int or None
        Numbers of the bifurcation points at its ends.
    connecting : bool
        Whether it was followed as a connecting curve, not as a boundary.
    status : str
        How it ends: "complete" at bifurcation points, "closed" where it returns to its start,
        "border" where it leaves the half-space of a region, "lost" where it could not be followed
        farther, and "budget" where the budget ended it.
    active, held : tuples of (quantity, side)
        The independent constraints that the weights belong to; all that stay at their bounds.
    """

    label: str
    pose: Pose
    weight: Array
    maximal: Mask
    first: int | None
    last: int | None
    connecting: bool
    status: str
    active: Active
    held: Active

    @property
    def closed(self) -> bool:
        """Whether it returns to its start."""
        return self.status == "closed"

    @property
    def lost(self) -> bool:
        """Whether it could not be followed to an end."""
        return self.status == "lost"


@dataclass(frozen=True, eq=False)
class Section(ReadOnly):
    """A plane section of a workspace.

    Attributes
    ----------
    origin : (3,) array [length]
        The radiating point u0.
    axes : (2, 3) array [1]
        Orthonormal; a ray of angle φ has the direction cos φ axes[0] + sin φ axes[1].
    bifurcations : tuple of BifurcationPoint
    curves : tuple of Curve
    ends : RayEnds
        The ray ends that the curves were followed from.
    turns : (k, 3) array [1]
        Axes of the free turns.
    waiting : int
        Number of curves that leave known bifurcation points and are not followed, as `most` or
        `budget` was reached.
    stopped_by : str or None
        What ended the search before it was complete: "most" or "budget"; None if neither did.
    """

    origin: Array
    axes: Array
    bifurcations: tuple[BifurcationPoint, ...]
    curves: tuple[Curve, ...]
    ends: RayEnds
    turns: Array
    waiting: int = 0
    stopped_by: str | None = None

    @property
    def bounds(self) -> BoundedQuantities:
        """The bounded quantities."""
        return self.ends.bounds

    def find(self, text: str) -> tuple[int, ...]:
        """Return the numbers of the curves with a label, in any spelling.

        Parameters
        ----------
        text : str
            Such as "0 1 - - 1 0" or "[01−−10]".

        Returns
        -------
        tuple of int
            Numbers of curves.

        Raises
        ------
        InvalidInput
            If it is not a label of these joints.
        """
        wanted = active_from_label(text, self.bounds.joints)
        return tuple(i for i, curve in enumerate(self.curves) if curve.held == wanted)

    def table(self, order: str = "approach-roll") -> pd.DataFrame:
        """Return the points of all curves: one row per point, with its angles.

        Parameters
        ----------
        order : str
            The angle set: see `gsp.geometry.rotation_from_angles`.

        Returns
        -------
        pandas.DataFrame
            Columns curve, label, x, y, z [unit of the design], alpha, beta, gamma [degrees],
            maximal, connecting, first, last.

        Raises
        ------
        InvalidInput
            On an unknown order.
        """
        import pandas as pd

        names = ["curve", "label", *"xyz", "alpha", "beta", "gamma"]
        names += ["maximal", "connecting", "first", "last"]
        if not self.curves:
            # Columns of the types that they have with rows.
            kinds = [int, object, *[float] * 6, bool, bool, object, object]
            return pd.DataFrame(
                {n: np.zeros(0, dtype=k) for n, k in zip(names, kinds, strict=True)}
            )
        parts = []
        for number, curve in enumerate(self.curves):
            angles = curve.pose.angles(order, degrees=True)
            columns = dict(zip("xyz", curve.pose.position.T, strict=True))
            columns |= dict(zip(("alpha", "beta", "gamma"), angles.T, strict=True))
            part = pd.DataFrame(columns)
            part.insert(0, "curve", number)
            part.insert(1, "label", curve.label)
            part["maximal"], part["connecting"] = curve.maximal, curve.connecting
            part["first"], part["last"] = curve.first, curve.last
            parts.append(part)
        return pd.concat(parts, ignore_index=True)

    def bifurcation_table(self, order: str = "approach-roll") -> pd.DataFrame:
        """Return the bifurcation points: one row per point.

        Parameters
        ----------
        order : str
            The angle set: see `gsp.geometry.rotation_from_angles`.

        Returns
        -------
        pandas.DataFrame
            Columns label, x, y, z [unit of the design], alpha, beta, gamma [degrees], and the
            other bounded quantities by name.

        Raises
        ------
        InvalidInput
            On an unknown order.
        """
        import pandas as pd

        rows = [
            (b.label, *b.pose.position, *b.pose.angles(order, degrees=True), *b.joints)
            for b in self.bifurcations
        ]
        names = ("label", "x", "y", "z", "alpha", "beta", "gamma", *self.bounds.names)
        table = pd.DataFrame(rows, columns=list(names))
        # Bounds of the position have the names of coordinates.
        return table.loc[:, ~table.columns.duplicated()]

    def on_rays(self, angles: ArrayLike) -> pd.DataFrame:
        """Return where rays meet the curves, solved to rounding.

        Parameters
        ----------
        angles : (q,) array_like [rad]
            From axes[0] toward axes[1].

        Returns
        -------
        pandas.DataFrame
            One row per crossing: ray, angle, curve, label, distance, x, y, z, maximal (a local
            maximum along the ray), outer (the farthest of those on its ray). Crossings that could
            not be solved are marked by solved = False, and are never maximal.

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.
        """
        import pandas as pd

        phi = check_array("angles", angles, (None,))
        if phi.ndim != 1:
            raise InvalidInput(expected("angles", "shape (q,)", f"shape {phi.shape}"))
        rows = [row for i in range(len(self.curves)) for row in self._crossings(i, phi)]
        columns = ["ray", "angle", "curve", "label", "distance", "x", "y", "z", "solved", "maximal"]
        frame = pd.DataFrame(rows, columns=columns).sort_values(
            ["ray", "distance"], ignore_index=True
        )
        frame["maximal"] = frame["maximal"].astype(bool)  # a table without rows has objects
        farthest = frame[frame["maximal"]].groupby("ray")["distance"].transform("max")
        frame["outer"] = (frame["distance"] == farthest.reindex(frame.index)) & frame["maximal"]
        return frame

    def _crossings(self, number: int, phi: Array) -> list[tuple[object, ...]]:
        curve = self.curves[number]
        flat = (curve.pose.position - self.origin) @ self.axes.T
        heading = np.stack((np.cos(phi), np.sin(phi)), axis=-1)
        offset = np.outer(heading[:, 0], flat[:, 1]) - np.outer(heading[:, 1], flat[:, 0])
        ahead = heading @ flat.T > 0.0
        crosses = (offset[:, :-1] * offset[:, 1:] <= 0.0) & (ahead[:, :-1] | ahead[:, 1:])
        crosses &= offset[:, :-1] != 0.0
        ray, place = np.nonzero(crosses)
        if not len(ray):
            return []
        before, after = np.abs(offset[ray, place]), np.abs(offset[ray, place + 1])
        guess = between(
            Points(curve.pose.position, curve.pose.rotation, curve.weight),
            place,
            before / (before + after),
        )
        chart = Chart(self.bounds, np.eye(3), self.turns)
        direction = heading[ray] @ self.axes
        points, solved, jet = chart.solve(
            guess, curve.active, on_ray(chart, self.origin, direction)
        )
        reach = np.einsum("ij,ij->i", points.position - self.origin, direction)
        behind = solved & (reach <= 0.0)
        solved &= norm(points.position - guess.position) < self.bounds.scale
        why = why_not_maximal(chart, points, jet, curve.active, direction, solved)
        return [
            (
                int(ray[i]),
                phi[ray[i]],
                number,
                curve.label,
                reach[i],
                *points.position[i],
                bool(solved[i]),
                not why[i],
            )
            for i in np.flatnonzero(~behind)
        ]
