"""Symmetries of two bodies: motions and reflections that put their anchors in another order."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from gsp.geometry.congruence import Figure, congruent_orders, isometries
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, frozen


@dataclass(frozen=True, eq=False)
class Symmetry(ReadOnly):
    """A symmetry of base and platform together: an isometry g of the base and k of the platform.

    Both are motions or both are reflections. Leg i is as leg `legs[i]` is after it: at the pose
    g T k⁻¹ leg `legs[i]` has the values that leg i has at T. If it is exchanged, g moves the base
    onto the platform and k the platform onto the base; the pose is then k T⁻¹ g⁻¹.

    Attributes
    ----------
    legs : tuple of int
        Image of each leg.
    base, platform : (3, 4) arrays [1, unit]
        [Q | shift] of g and k.
    exchanged : bool
        Whether base and platform change places.
    """

    legs: tuple[int, ...]
    base: Array
    platform: Array
    exchanged: bool = False

    def __post_init__(self) -> None:
        for side in ("base", "platform"):
            object.__setattr__(self, side, frozen(getattr(self, side)))

    @property
    def reflected(self) -> bool:
        """Whether g and k are reflections.

        With Q of g, the velocity v of a twist becomes Q v, and ω becomes −Q ω: the rows of the
        Jacobian [u, r × u] become [Q u, −Q (r × u)], so det J changes its sign at most.
        """
        return bool(np.linalg.det(self.base[:, :3]) < 0.0)

    def image(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Return the equally good poses: g T k⁻¹ of T, or k T⁻¹ g⁻¹.

        Parameters
        ----------
        position : (..., 3) array [unit]
        rotation : (..., 3, 3) array [1]

        Returns
        -------
        position : (..., 3) array [unit]
        rotation : (..., 3, 3) array [1]

        *Source: ours; docs/exploration.md*
        """
        g, k = self.base, self.platform
        if self.exchanged:
            rotation = np.swapaxes(rotation, -1, -2)
            position = -np.einsum("...ij,...j->...i", rotation, position)
            g, k = k, g
        turned = g[:, :3] @ rotation @ k[:, :3].T
        moved = position @ g[:, :3].T + g[:, 3] - turned @ k[:, 3]
        return moved, turned


def symmetries_between(
    base: tuple[Figure, Figure],
    platform: tuple[Figure, Figure],
    tolerance: float,
    *,
    exchanged: bool = False,
) -> list[Symmetry]:
    """Return all symmetries that move two figures onto their images, in the order of `legs`.

    Parameters
    ----------
    base, platform : two Figures each
        The anchors and what they are moved onto: themselves, or each other for an exchange.
    tolerance : float [1]
        See `gsp.geometry.congruence.isometries`.
    exchanged : bool
        What the symmetries record.
    """
    return [
        Symmetry(order, g, k, exchanged)
        for order in congruent_orders((base, platform), tolerance)
        for g, k in product(
            isometries(*base, order, tolerance), isometries(*platform, order, tolerance)
        )
        if np.linalg.det(g[:, :3]) * np.linalg.det(k[:, :3]) > 0.0
    ]
