"""Capsules, of which links are made, and mass properties of links."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm, perpendicular, unit


@dataclass(frozen=True, eq=False)
class Capsule:
    """A rod with round ends, in the frame of its link [unit of the design, kg]."""

    start: Array
    end: Array
    radius: float
    mass: float

    @property
    def length(self) -> float:
        """Distance of the centres of its round ends."""
        return float(norm(self.end - self.start))

    @property
    def centre(self) -> Array:
        """Its middle, which is its centre of mass, shape (3,) [unit of the design]."""
        return np.asarray(0.5 * (self.start + self.end))

    @property
    def inertia(self) -> Array:
        """Inertia about its middle, shape (3, 3) [kg · unit²], of uniform density.

        A cylinder of length h and radius r, and two half balls of the same radius, whose centres of
        mass are 3r/8 beyond its ends.
        """
        h, r = self.length, self.radius
        ball = self.mass * 4.0 * r / (3.0 * h + 4.0 * r)
        rod = self.mass - ball
        axial = rod * r**2 / 2.0 + ball * 2.0 * r**2 / 5.0
        across = rod * (h**2 / 12.0 + r**2 / 4.0)
        across += ball * (2.0 * r**2 / 5.0 + h**2 / 4.0 + 3.0 * h * r / 8.0)
        z = self._axis
        return np.asarray(across * np.eye(3) + (axial - across) * np.outer(z, z))

    @property
    def _axis(self) -> Array:
        return unit(self.end - self.start) if self.length else np.array([0.0, 0.0, 1.0])

    @property
    def frame(self) -> Pose:
        """Frame in its middle, with z along it."""
        z = self._axis
        x = perpendicular(-z)
        return Pose(self.centre, np.stack((x, cross(z, x), z), axis=-1))


@dataclass(frozen=True, eq=False, kw_only=True)
class Body:
    """Mass properties of a link, in the frame of the link.

    Attributes
    ----------
    mass : float [kg]
    centre : (3,) array [unit of the design]
        Centre of mass.
    inertia : (3, 3) array [kg · unit²]
        About the centre of mass.
    """

    mass: float
    centre: Array
    inertia: Array

    @classmethod
    def of(cls, parts: Sequence[Capsule]) -> Body:
        """Return the mass properties of capsules taken together.

        Parameters
        ----------
        parts : sequence of Capsule, not empty

        Returns
        -------
        Body
        """
        masses = np.array([part.mass for part in parts])
        centre = masses @ np.array([part.centre for part in parts]) / masses.sum()
        inertia = np.zeros((3, 3))
        for part in parts:  # Steiner's theorem
            arm = part.centre - centre
            inertia += part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return cls(mass=float(masses.sum()), centre=centre, inertia=inertia)
