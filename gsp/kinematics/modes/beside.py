"""Solutions that are so near to each other that paths to them end at a single pose.

Near joint values of a singular pose some solutions differ along the motion v that is hardly
controlled. On the curve of poses on which all equations but one combination of them hold, that one
is an analytic function r(t) of the step t along v, and the solutions are its zeros: two beside a
fold, three beside a cusp.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.equations import (
    Complex,
    Layout,
    extended_residuals,
    linear,
)

# Least share of the second smallest singular value where one motion only is hardly controlled.
SECOND_SHARE = 1e-5
# Solutions nearer to each other than this share of the size of the pose are one multiple solution,
# as the rounding of joint values of a singular pose has this effect.
LEAST_GAP = 3e-7
# Radii of the circles on which r is sampled, as shares of the size of the pose, the numbers of
# samples and of coefficients that count, and the share of the radius in which zeros are taken;
# they are all within another share of it if there are no zeros between.
RADII, SAMPLES, DEGREE, INNER, OUTER = (4e-3, 4e-4, 4e-5), 32, 8, 0.25, 0.9
# Coefficients beyond the last that counts, as a share of the largest one, at most.
TAIL_SHARE = 1e-6
# The last coefficients, which rounding makes; zeros are the same within this many times by how much
# these and the coefficients beyond move them.
NOISE_TERMS, ERROR_FACTOR = 4, 10.0
# What is left of r at a zero at most: a share of the largest coefficient, and times its rounding.
REST_SHARE, REST_FACTOR = 1e-8, 100.0
# Newton steps to the middle and along the curve, and shares of singular values that are left out.
MIDDLE_STEPS, ALONG_STEPS, MIDDLE_RCOND = 6, 8, 1e-4
# A step along the curve after which the next one is that of rounding, as a share of the size.
SETTLED_STEP = 1e-8
# Change of r' by which it cannot vanish, as a share of r'.
SINGLE_SHARE = 0.5
# Imaginary part of a pose that is taken for real at the middle, as a share of its size.
REAL_MIDDLE = 1e-3


class Beside(NamedTuple):
    """Solutions beside a pose.

    Attributes
    ----------
    poses : (m, 7) complex array
        Real ones have no imaginary part.
    numbers : (m,) int array
        How many solutions each stands for.
    middle : (7,) complex array
    reach : float
        Within this distance of the middle there are no others.
    """

    poses: Complex
    numbers: NDArray[np.int64]
    middle: Complex
    reach: float

    def has(self, poses: Complex) -> NDArray[np.bool_]:
        """Return which of other poses (n, 7) are within reach."""
        return within(poses, self.middle, self.reach)


def within(poses: Complex, middle: Complex, reach: float) -> NDArray[np.bool_]:
    """Return whether poses (n, 7), or those with −x, are within a distance of a pose, (n,)."""
    signs = np.where((poses[:, :4] @ middle[:4].conj()).real < 0.0, -1.0, 1.0)[:, None]
    apart = np.hstack((signs * poses[:, :4], poses[:, 4:])) - middle
    return np.asarray(np.abs(apart).max(axis=1, initial=0.0) < reach)


def size(pose: Complex) -> float:
    """Return the largest part of a pose (7,)."""
    return float(np.abs(pose).max())


class Curve(NamedTuple):
    """Poses on which all equations but one combination hold, beside a middle.

    Attributes
    ----------
    layout : Layout
    parameters : (6, 13) complex array
    middle : (7,) complex array
    along, across : (7,) complex array
        The motion, and the combination of the equations.
    """

    layout: Layout
    parameters: Complex
    middle: Complex
    along: Complex
    across: Complex

    @property
    def real(self) -> bool:
        """Whether the middle is real, and real steps lead to real poses."""
        return not self.middle.imag.any()

    def single(self, reach: float) -> bool:
        """Whether r has one zero within a distance of the middle at most.

        It has where the real part of r'(t) / r'(0) is positive all around; it is looked at in four
        directions.
        """
        steps = reach * np.array([0.0, 1.0, -1.0, 1j, -1j])
        slopes = linear(self.layout, self.parameters, self.middle + steps[:, None] * self.along)[1]
        rates = (slopes @ self.along) @ self.across.conj()
        return bool((np.abs(rates[1:] - rates[0]) < SINGLE_SHARE * np.abs(rates[0])).all())

    def at(self, steps: Complex) -> tuple[Complex, Complex] | None:
        """Return the poses (n, 7) at steps (n,) along the motion, and what is left there, (n,).

        None where Newton's method does not converge. Residuals are in extended precision.
        """
        poses = self.middle + steps[:, None] * self.along
        rest = np.zeros(len(steps), dtype=np.complex128)
        bordered = np.zeros((len(steps), 8, 8), dtype=np.complex128)
        bordered[:, :7, 7], bordered[:, 7, :7] = -self.across, self.along.conj()
        last = np.inf
        for _ in range(ALONG_STEPS):
            bordered[:, :7, :7] = linear(self.layout, self.parameters, poses)[1]
            if not np.isfinite(bordered).all():
                return None
            error = extended_residuals(self.layout, self.parameters, poses)
            left = (error - rest[:, None] * self.across).astype(np.complex128)
            apart = (poses - self.middle) @ self.along.conj() - steps
            try:
                step = np.linalg.solve(bordered, np.column_stack((left, apart))[..., None])[..., 0]
            except np.linalg.LinAlgError:
                return None
            poses, rest = poses - step[:, :7], rest - step[:, 7]
            before, last = last, float(np.abs(step[:, :7]).max())
            if before < SETTLED_STEP * size(self.middle):  # this step was that of rounding
                break
        return (poses, rest) if last < LEAST_GAP * 1e-3 * size(self.middle) else None


def beside(layout: Layout, parameters: Complex, pose: Complex) -> Beside | None:
    """Return the solutions beside a pose (7,).

    None if there is none, or if more than one motion is hardly controlled there. Smaller circles
    are tried where r cannot be told from its values on a larger one.
    """
    curve = _curve(layout, parameters, pose)
    if curve is None:
        return None
    for share in RADII:
        radius = share * size(curve.middle)
        found = None if curve.single(INNER * radius) else _zeros(curve, radius)
        if found is not None:
            return found
    return None


def _zeros(curve: Curve, radius: float) -> Beside | None:
    """Return the solutions on a curve within a share of a radius; None if they are not told."""
    circle = radius * np.exp(2j * np.pi * np.arange(SAMPLES) / SAMPLES)
    found = curve.at(circle)
    if found is None:
        return None
    terms = np.fft.fft(found[1]) / SAMPLES  # coefficients times powers of the radius
    largest = np.abs(terms[1 : DEGREE + 1]).max()
    rest = np.abs(terms[DEGREE + 1 : SAMPLES // 2])
    if not rest.max() < TAIL_SHARE * largest:
        return None
    series = np.poly1d(terms[DEGREE::-1].real if curve.real else terms[DEGREE::-1])
    zeros = series.roots  # real ones, or conjugates
    alone = not ((np.abs(zeros) > INNER) & (np.abs(zeros) < 1.0)).any()
    zeros = zeros[np.abs(zeros) < INNER]
    noise = rest[-NOISE_TERMS:].max()
    error = noise + rest.max() * np.abs(zeros) ** (DEGREE + 1)
    with np.errstate(divide="ignore"):
        gaps = radius * ERROR_FACTOR * error / np.abs(series.deriv()(zeros))
    steps, numbers = _merged(radius * zeros, np.fmax(gaps, LEAST_GAP * size(curve.middle)))
    if not len(steps):
        return None
    ends = curve.at(steps.astype(np.complex128))
    if ends is None or np.abs(ends[1]).max() > REST_SHARE * largest + REST_FACTOR * noise:
        return None
    poses = np.where((steps.imag == 0.0)[:, None] & curve.real, ends[0].real, ends[0])
    reach = radius * (OUTER if alone else INNER)
    return Beside(poses.astype(np.complex128), numbers, curve.middle, reach)


def _curve(layout: Layout, parameters: Complex, pose: Complex) -> Curve | None:
    """Return the curve through the middle beside a pose; real if that is nearly so."""
    middle = pose.copy()
    if np.abs(middle.imag).max() < REAL_MIDDLE * size(middle):
        middle = middle.real.astype(np.complex128)
    for _ in range(MIDDLE_STEPS):
        error, slopes = linear(layout, parameters, middle[None])
        if not np.isfinite(slopes).all():
            return None
        middle -= np.linalg.pinv(slopes[0], rcond=MIDDLE_RCOND) @ error[0]
    slopes = linear(layout, parameters, middle[None])[1][0]
    if not np.isfinite(slopes).all():
        return None
    left, values, right = np.linalg.svd(slopes if middle.imag.any() else slopes.real)
    if values[-2] < SECOND_SHARE * values[0]:
        return None
    along, across = right[-1].conj(), left[:, -1]
    return Curve(layout, parameters, middle, *np.stack((along, across)).astype(np.complex128))


def _merged(zeros: Complex, gaps: Array) -> tuple[Complex, NDArray[np.int64]]:
    """Return zeros, those nearer than their gaps as their mean, and how many each stands for."""
    waiting, steps, numbers = list(range(len(zeros))), [], []
    while waiting:
        group = [waiting.pop(0)]
        for i in group:  # grows
            near = [j for j in waiting if abs(zeros[i] - zeros[j]) < max(gaps[i], gaps[j])]
            waiting = [j for j in waiting if j not in near]
            group += near
        mean = zeros[group].mean()
        pair = abs(mean.imag) < gaps[group].max() and len(group) > 1
        steps.append(mean.real if pair else mean)
        numbers.append(len(group))
    return np.array(steps, dtype=np.complex128), np.array(numbers, dtype=np.int64)
