"""The equations of planar platforms with three legs, by elimination of the position.

With z = exp(iφ) the angle of the platform is a root of a polynomial, of degree six for three RPR
legs. The position follows from two equations that are linear in it.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import wrapped

# Greatest degree of the eliminant in cos φ and sin φ, from the degrees of its factors; below
# ELIMINANT_SAMPLES / 2, so that its Fourier coefficients are those of the samples.
ELIMINANT_DEGREE, ELIMINANT_SAMPLES = 4, 16
# Fourier coefficients below this share of the largest are zero; the largest below this share of
# the terms of the eliminant: it vanishes, and the platform moves with locked legs.
ZERO_COEFFICIENT = 1e-12
# Singular values of the linear equations below which they may be dependent at the exact root, as
# a fourfold one is found to 1e-4, and below which they are.
NEARLY_DEPENDENT, DEPENDENT_EQUATIONS = 1e-2, 1e-9
# How far from the unit circle a root may be that Newton's method is to make a real angle of:
# multiple ones are found to a root of the rounding.
CIRCLE_DISTANCE = 1e-3


class Equations:
    """The equations of three legs with signed distances, complex and in sizes of the design.

    Points and directions are complex, p the position of the platform origin. A leg D1 gives
    |p + z b − a|² = d², D2 and D3 give Re((p + z b − a) conj(n)) = d with the normal n of the line.
    """

    def __init__(self, design: PlanarDesign, joints: Array) -> None:
        self.size = design.rms_radius
        self.legs = design.legs
        self.base, self.platform = (
            complex_points(points) / self.size
            for points in (design.base_points, design.platform_points)
        )
        self.s, self.t = map(complex_points, (design.base_directions, design.platform_directions))
        self.angular = design.angular
        self.value = np.where(self.angular, joints, joints / self.size)
        # The frames have their origins in the anchors of a circle, so that its centre is fixed.
        self.circles = [i for i, leg in enumerate(self.legs) if not leg.cylindrical]
        self.first = self.circles[0] if self.circles else -1
        origin = max(self.first, 0)
        self.corner = self.base[origin], self.platform[origin]
        self.base, self.platform = self.base - self.corner[0], self.platform - self.corner[1]

    def rows(self, z: Array) -> tuple[Array, Array]:
        """Return the linear equations of the position, Re(p conj(n)) = k, of all legs but one D1.

        (m, q) arrays n and k for the m values of z.
        """
        normals, rights = [], []
        for i, leg in enumerate(self.legs):
            w = z * self.platform[i] - self.base[i]
            if i in self.circles and i != self.first:
                # Difference to the first circle, |p|² = d².
                normals.append(2.0 * w)
                rights.append(self.value[i] ** 2 - self.value[self.first] ** 2 - np.abs(w) ** 2)
            elif leg.one_line:
                normal = 1j * (z * self.t[i] if leg.platform_line else self.s[i] + 0.0 * z)
                normals.append(normal)
                rights.append(self.value[i] - (w * normal.conj()).real)
        return np.stack(normals, axis=-1), np.stack(rights, axis=-1)

    def eliminant(self, z: Array) -> tuple[Array, Array]:
        """Return a real function of the angle that is 0 at solutions, and the size of its terms."""
        n, k = self.rows(z)
        if self.first >= 0:
            determinant = (n[:, 0].conj() * n[:, 1]).imag
            p = 1j * (n[:, 0] * k[:, 1] - n[:, 1] * k[:, 0])
            terms = np.abs(p) ** 2, (self.value[self.first] * determinant) ** 2
            return terms[0] - terms[1], terms[0] + terms[1]
        total, size = np.zeros(z.shape), np.zeros(z.shape)
        for i in range(3):
            a, b = (i + 1) % 3, (i + 2) % 3
            term = k[:, i] * (n[:, a].conj() * n[:, b]).imag
            total, size = total + term, size + np.abs(term)
        return total, size

    def angles(self) -> tuple[Array, bool]:
        """Return the angles of the roots near the unit circle, and whether all angles are roots."""
        z = np.exp(2j * np.pi * np.arange(ELIMINANT_SAMPLES) / ELIMINANT_SAMPLES)
        values, sizes = self.eliminant(z)
        coefficients = np.fft.fft(values) / ELIMINANT_SAMPLES
        largest = np.abs(coefficients).max()
        if not largest > ZERO_COEFFICIENT * sizes.max():
            return np.empty(0), True
        ordered = coefficients[np.arange(ELIMINANT_DEGREE, -ELIMINANT_DEGREE - 1, -1)]
        kept = np.flatnonzero(np.abs(ordered) > ZERO_COEFFICIENT * largest)
        roots = np.roots(ordered[kept[0] : kept[-1] + 1])
        return np.angle(roots[np.abs(np.abs(roots) - 1.0) < CIRCLE_DISTANCE]), False

    def given_angle(self) -> Array:
        """Return the angle that an A1 leg gives."""
        i = int(np.flatnonzero(self.angular)[0])
        return np.array([wrapped(self.value[i] + np.angle(self.s[i]) - np.angle(self.t[i]))])

    def positions(self, angle: float) -> tuple[list[tuple[float, float]], bool]:
        """Return the positions at an angle [unit of the design], and whether they are a curve."""
        n, k, u, s, vt = self.solved(angle)
        if s[0] < NEARLY_DEPENDENT and len(self.circles) == 3:
            # All anchors of one body on those of the other: the angle is a fourfold root.
            angle = float(np.angle((self.platform.conj() * self.base).sum()))
            n, k, u, s, vt = self.solved(angle)
        if s[0] < DEPENDENT_EQUATIONS or (self.first < 0 and s[1] < DEPENDENT_EQUATIONS):
            return [], bool(np.abs(k).max() < DEPENDENT_EQUATIONS or self.first < 0)
        points = [np.linalg.lstsq(np.stack((n.real, n.imag), axis=-1), k, rcond=None)[0]]
        if s[1] < NEARLY_DEPENDENT and self.first >= 0:
            # One line, which meets the circle twice.
            foot = vt[0] * (u[:, 0] @ k) / s[0]
            half = max(self.value[self.first] ** 2 - foot @ foot, 0.0) ** 0.5
            points += [foot + half * vt[1], foot - half * vt[1]]
        z = np.exp(1j * np.array([angle]))
        moved = [complex(*point) + self.corner[0] - z[0] * self.corner[1] for point in points]
        return [(self.size * p.real, self.size * p.imag) for p in moved], False

    def solved(self, angle: float) -> tuple[Array, Array, Array, Array, Array]:
        """Return the linear equations at an angle, and the singular values and vectors of n."""
        n, k = (x[0] for x in self.rows(np.exp(1j * np.array([angle]))))
        u, s, vt = np.linalg.svd(np.stack((n.real, n.imag), axis=-1))
        return n, k, u, np.append(s, 0.0), vt  # of one equation the second value is 0


def complex_points(points: Array) -> Array:
    """Return points (n, 2) as complex numbers (n,)."""
    return np.asarray(points[:, 0] + 1j * points[:, 1])
