"""The side of a plane base on which a position is, such as that of the home pose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gsp.geometry.vectors import Array, cross, norm, perpendicular
from gsp.model.design import Design
from gsp.workspace.exact.fixed_orientation import exact_shells

if TYPE_CHECKING:
    from gsp.limits import Limits
    from gsp.workspace.volumes import Volume

# Base anchors are in one plane if their distances from it are this share of those in it. A normal
# that is as near to an axis is that axis.
LEVEL = 1e-9


@dataclass(frozen=True, kw_only=True)
class Side:
    """The part of space that counts, and how the line of the volume names it.

    Attributes
    ----------
    half_space : (4,) array [1, 1, 1, length] or None
        n and c: positions with n · p ≥ c, where n has length 1; None for all.
    name : str
        What the line of the volume says, such as "above z = 0".
    """

    half_space: Array | None = None
    name: str = "all positions"

    def volume(self, design: Design, rotation: Array, limits: Limits) -> Volume:
        """Return the volume on this side that SPS legs reach with one orientation.

        Parameters
        ----------
        design : Design
        rotation : (3, 3) array
        limits : Limits

        Returns
        -------
        Volume [length³]

        *Source: ours*
        """
        if self.half_space is None:
            return exact_shells(design, rotation, limits).volume()
        # Volumes between heights are exact, so the normal is turned to the z-axis.
        turn = _turned_up(self.half_space[:3])
        turned = design.replace(base_points=design.base_points @ turn.T)
        least = float(self.half_space[3])
        return exact_shells(turned, turn @ rotation, limits).volume((least, np.inf))


def side_of(design: Design, position: Array) -> Side:
    """Return the side of the plane of the base anchors on which a position is.

    Parameters
    ----------
    design : Design
    position : (3,) array [length]

    Returns
    -------
    Side
        All positions, where the base anchors are in no plane, or the position is in it.
    """
    points = design.base_points
    centre = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - centre)
    from_centre = position - centre
    above = float(from_centre @ axes[2])
    flat = sizes[2] <= LEVEL * sizes[0] < sizes[1]
    if not flat or abs(above) <= LEVEL * max(sizes[0], float(norm(from_centre))):
        return Side()
    normal = np.sign(above) * axes[2]
    k = int(np.abs(normal).argmax())
    if norm(np.delete(normal, k)) > LEVEL:
        least = float(normal @ centre)
        name = "on the side of the plane of the base"
        return Side(half_space=np.array([*normal, least]), name=name)
    normal = np.sign(normal[k]) * np.eye(3)[k]
    level = float(points[:, k].mean())
    word = "above" if normal[k] > 0.0 else "below"
    return Side(
        half_space=np.array([*normal, normal[k] * level]),
        name=f"{word} {'xyz'[k]} = {level:.6g}",
    )


def _turned_up(normal: Array) -> Array:
    """Return a rotation that turns a direction of length 1 to the z-axis."""
    if normal[2] == 1.0:
        return np.eye(3)
    across = perpendicular(normal)
    return np.stack((across, cross(normal, across), normal))
