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
    coordinates,
    extended_residuals,
    linear,
)

# Share of the smallest singular value of a solution that may have others beside it, of equations
# and unknowns in their own scales; and the least share of the second smallest one.
BESIDE_SHARE, SECOND_SHARE = 1e-5, 1e-5
# Solutions nearer to each other than this share of the size of the pose are one multiple solution,
# as the rounding of joint values of a singular pose has this effect.
LEAST_GAP = 3e-7
# Radius of the circle on which r is sampled, as a share of the size of the pose, the numbers of
# samples and of coefficients that count, and the share of the radius in which zeros are taken.
RADIUS, SAMPLES, DEGREE, INNER = 4e-3, 32, 8, 0.25
# Distance from a cluster that is not told apart within which solutions belong to it.
CLUSTER_REACH = 1e-4
# Coefficients beyond the last that counts, as a share of the largest one, at most.
TAIL_SHARE = 1e-6
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
            if before < SETTLED_STEP * _size(self.middle):  # this step was that of rounding
                break
        return (poses, rest) if last < LEAST_GAP * 1e-3 * _size(self.middle) else None


def beside(layout: Layout, parameters: Complex, pose: Complex) -> Beside | None:
    """Return the solutions beside a pose (7,).

    None if there is none, or if more than one motion is hardly controlled there.
    """
    curve = _curve(layout, parameters, pose)
    if curve is None or curve.single(INNER * RADIUS * _size(curve.middle)):
        return None
    radius = RADIUS * _size(curve.middle)
    circle = radius * np.exp(2j * np.pi * np.arange(SAMPLES) / SAMPLES)
    found = curve.at(circle)
    if found is None:
        return None
    terms = np.fft.fft(found[1]) / SAMPLES  # coefficients times powers of the radius
    largest = np.abs(terms[1 : DEGREE + 1]).max()
    if not np.abs(terms[DEGREE + 1 : SAMPLES // 2]).max() < TAIL_SHARE * largest:
        return None
    terms = terms[DEGREE::-1]
    zeros = np.roots(terms.real if curve.real else terms) * radius  # real ones, or conjugates
    steps, numbers = _merged(zeros[np.abs(zeros) < INNER * radius], LEAST_GAP * _size(curve.middle))
    if not len(steps):
        return None
    ends = curve.at(steps.astype(np.complex128))
    if ends is None:
        return None
    poses = np.where((steps.imag == 0.0)[:, None] & curve.real, ends[0].real, ends[0])
    return Beside(poses.astype(np.complex128), numbers, curve.middle, INNER * radius)


def _size(pose: Complex) -> float:
    return float(np.abs(pose).max())


def _curve(layout: Layout, parameters: Complex, pose: Complex) -> Curve | None:
    """Return the curve through the middle beside a pose; real if that is nearly so."""
    middle = pose.copy()
    if np.abs(middle.imag).max() < REAL_MIDDLE * _size(middle):
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


def _merged(zeros: Complex, gap: float) -> tuple[Complex, NDArray[np.int64]]:
    """Return zeros, those nearer than a gap as their mean, and how many each stands for."""
    waiting, steps, numbers = list(zeros), [], []
    while waiting:
        first = waiting.pop(0)
        near = [x for x in waiting if abs(x - first) < gap]
        waiting = [x for x in waiting if abs(x - first) >= gap]
        group = np.array([first, *near])
        pair = abs(group.mean().imag) < gap and len(group) > 1
        steps.append(group.mean().real if pair else group.mean())
        numbers.append(len(group))
    return np.array(steps, dtype=np.complex128), np.array(numbers, dtype=np.int64)


class Apart(NamedTuple):
    """Solutions, once those beside each other are told apart.

    Attributes
    ----------
    regular : (n, 7) complex array
    beside : (n,) bool array
        Which of them were told apart; of these the real ones have no imaginary parts.
    clusters : (m, 7) complex array
        Multiple ones.
    numbers : (m,) int array
    """

    regular: Complex
    beside: NDArray[np.bool_]
    clusters: Complex
    numbers: NDArray[np.int64]


def told_apart(
    layout: Layout,
    parameters: Complex,
    regular: Complex,
    shares: Array,
    last: Complex,
    clusters: Complex,
    numbers: NDArray[np.int64],
) -> Apart:
    """Return solutions with those beside nearly singular ones in the place of these.

    A cluster that is not told apart takes the solutions beside it: they are the same multiple one,
    at which as many paths ended as at these from the general system of the cluster.

    Parameters
    ----------
    layout : Layout
    parameters : (6, 13) complex array
    regular : (n, 7) complex array
    shares : (n,) array [1]
        Their smallest singular values, of the largest ones.
    last : (k, 7) complex array
        Those of them that were found from the general system of the clusters.
    clusters : (m, 7) complex array
    numbers : (m,) int array
        How many paths ended at each.
    """
    weak = shares < BESIDE_SHARE
    if not len(clusters) and not weak.any():
        return Apart(regular, np.zeros(len(regular), dtype=bool), clusters, numbers)
    centres = np.vstack((clusters, regular[weak]))
    found: list[Complex] = []
    multiple: list[tuple[Complex, int]] = []
    open_ = np.ones(len(centres), dtype=bool)
    dropped = np.zeros(len(regular), dtype=bool)
    for i, centre in enumerate(centres):
        if not open_[i]:
            continue
        here = beside(layout, parameters, centre)
        if here is not None:
            open_ &= ~_within(centres, here.middle, here.reach)
            dropped |= _within(regular, here.middle, here.reach)
            for pose, number in zip(here.poses, here.numbers, strict=True):
                if number == 1:
                    found.append(pose)
                else:
                    multiple.append((pose, int(number)))
        elif i < len(clusters):
            reach = CLUSTER_REACH * _size(centre)
            open_ &= ~_within(centres, centre, reach)
            dropped |= _within(regular, centre, reach)
            multiple.append((centre, int(numbers[i] + _within(last, centre, reach).sum())))
    ends = np.array(found, dtype=np.complex128).reshape(-1, 7)
    both = np.vstack((regular[~dropped], ends))
    return Apart(
        both,
        np.arange(len(both)) >= len(both) - len(ends),
        np.array([pose for pose, _ in multiple], dtype=np.complex128).reshape(-1, 7),
        np.array([number for _, number in multiple], dtype=np.int64),
    )


def _within(poses: Complex, middle: Complex, reach: float) -> NDArray[np.bool_]:
    """Whether poses (n, 7) are within a distance of a pose, by rotations and positions."""
    apart = np.abs(coordinates(poses) - coordinates(middle[None])).max(axis=1, initial=0.0)
    return np.asarray(apart < reach)
