"""The side of a plane base on which the home pose is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array, cross, norm, perpendicular
from gsp.model.design import Design

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
    """

    half_space: Array | None = None
    name: str = "all positions"

    def volume(self, design: Design, rotation: Array, limits: Limits) -> Volume:
        """Return the volume on this side that SPS legs reach with one orientation."""
        from gsp.workspace import exact_shells

        if self.half_space is None:
            return exact_shells(design, rotation, limits).volume()
        # Volumes between heights are exact, so the normal is turned to the z-axis.
        turn = _turned_up(self.half_space[:3])
        turned = design.replace(base_points=design.base_points @ turn.T)
        least = float(self.half_space[3])
        return exact_shells(turned, turn @ rotation, limits).volume((least, np.inf))


def side_of_home(design: Design, both: bool) -> Side:
    """Return the side of a plane base on which the home pose is; with `both` there is none.

    A plane platform has the same lengths of legs at mirror images in the plane of the base, which
    are assembled in another way. The plane is that of the base anchors, in any position.

    Raises
    ------
    InvalidInput
        For `both`, if all positions count anyway.
    """
    side = _side(design)
    if not both:
        return side
    if side.half_space is None:
        wanted = "a home pose on one side of a plane of the base anchors, else it has no effect"
        place = f"of design {brief(design.name)}" if design.name else ""
        got = "no home pose" if design.home is None else "no such side"
        raise InvalidInput(expected("--both", wanted, got, place))
    return Side(name="both sides of the base")


def _side(design: Design) -> Side:
    if design.home is None:
        return Side()
    points = design.base_points
    centre = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - centre)
    home = np.ravel(design.home.position) - centre
    above = float(home @ axes[2])
    flat = sizes[2] <= LEVEL * sizes[0] < sizes[1]
    if not flat or abs(above) <= LEVEL * max(sizes[0], float(norm(home))):
        return Side()
    normal = np.sign(above) * axes[2]
    k = int(np.abs(normal).argmax())
    if norm(np.delete(normal, k)) > LEVEL:
        least = float(normal @ centre)
        name = "on the side of the plane of the base on which the home pose is"
        return Side(half_space=np.array([*normal, least]), name=name)
    normal = np.sign(normal[k]) * np.eye(3)[k]
    level = float(points[:, k].mean())
    word = "above" if normal[k] > 0.0 else "below"
    return Side(
        half_space=np.array([*normal, normal[k] * level]),
        name=f"{word} {'xyz'[k]} = {level:.6g}, the side of the home pose",
    )


def _turned_up(normal: Array) -> Array:
    """Return a rotation that turns a direction of length 1 to the z-axis."""
    if normal[2] == 1.0:
        return np.eye(3)
    across = perpendicular(normal)
    return np.stack((across, cross(normal, across), normal))
