"""Forward kinematics of planar platforms with three legs: all assembly modes, and the nearest one.

With z = exp(iφ) the angle of the platform is a root of a polynomial, of degree six for three RPR
legs. The position follows from two equations that are linear in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose

# Greatest degree of the eliminant in cos φ and sin φ, from the degrees of its factors; below
# SAMPLES / 2, so that its Fourier coefficients are those of the samples.
DEGREE, SAMPLES = 4, 16
# Fourier coefficients below this share of the largest are zero; the largest below this share of
# the terms of the eliminant: it vanishes, and the platform moves with locked legs.
ZERO = 1e-12
# Singular values of the linear equations below which they may be dependent at the exact root, as
# a fourfold one is found to 1e-4, and below which they are.
NEAR, EXACT = 1e-2, 1e-9
# How far from the unit circle a root may be that Newton's method is to make a real angle of:
# multiple ones are found to a root of the rounding.
CIRCLE = 1e-3
# Newton steps, errors of joint values that count as met, and distances at which modes are one: in
# sizes of the design, and rad.
STEPS, MET, SAME = 30, 1e-11, 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class PlanarModes:
    """Result of `planar_modes`.

    Attributes
    ----------
    pose : PlanarPose of batch shape (n,)
        The poses with the joint values, by angle in (−π, π].
    residual : (n,) array [1, rad]
        Largest joint error, distances as a share of `design.rms_radius`.
    side : (n,) array [1]
        Sign of det J.
    status : str
        "found": all modes but such as differ from others by less than 1e-6. "moving": the joint
        values allow a motion, and there are poses besides those listed. "undefined": joint values
        that are NaN or none that a joint can have; there are no poses.
    """

    pose: PlanarPose
    residual: Array
    side: Array
    status: str


def planar_modes(design: PlanarDesign, joints: ArrayLike) -> PlanarModes:
    """Return all poses at which the actuators of a planar platform have given values.

    Per choice of the sides of lines the position is eliminated from the equations of the legs. What
    is left is a polynomial in z = exp(iφ), whose coefficients are the Fourier coefficients of
    samples. Its roots on the unit circle are refined by Newton's method, and kept if the joint
    values are met. For three RPR legs it is the sextic of their direct kinematics.

    Parameters
    ----------
    design : PlanarDesign
        With three legs, at most one of which is A1.
    joints : (3,) array_like [unit of the design, rad]

    Returns
    -------
    PlanarModes

    Raises
    ------
    InvalidInput
        On other designs, types or shapes.

    *Source: ours; the degree six of 3-RPR is classical.*

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.kinematics import planar_modes
    >>> from gsp.planar import PlanarDesign, PlanarPose
    >>> angle = np.arange(3) * 2 * np.pi / 3
    >>> ring = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    >>> design = PlanarDesign(["D1"] * 3, 2 * ring, ring)
    >>> found = planar_modes(design, design.at(PlanarPose([0.1, 0.2], 0.3)).joints)
    >>> found.pose.angle.round(6)
    array([-0.3,  0.3])
    """
    target = _check(design, joints)
    if not _possible(design, target):
        return _result(design, target, np.empty((0, 3)), "undefined")
    linear = [i for i, leg in enumerate(design.legs) if leg.name in ("D2", "D3")]
    found, moving = [], False
    for signs in product((1.0, -1.0), repeat=len(linear)):
        signed = target.copy()
        signed[linear] *= signs
        equations = _Equations(design, signed)
        turned = [leg.name for leg in design.legs].count("A1") == 1
        angles, vanishes = (equations.given_angle(), False) if turned else equations.angles()
        moving |= vanishes
        for angle in angles:
            positions, free = equations.positions(angle)
            moving |= free
            found += [[*position, angle] for position in positions]
    poses = _refined(design, target, np.array(found).reshape(-1, 3))
    return _result(design, target, poses, "moving" if moving else "found")


def planar_forward(design: PlanarDesign, joints: ArrayLike, guess: PlanarPose) -> PlanarPose:
    """Return the pose with given joint values that is nearest to a guess on its side of det J = 0.

    Of all assembly modes with the sign of det J that the guess has it is the one with the least
    |Δp| / L + |Δφ|, L = `design.rms_radius`. That a regular path leads there is not proven.

    Parameters
    ----------
    design : PlanarDesign
        With three legs, at most one of which is A1.
    joints : (3,) array_like [unit of the design, rad]
    guess : PlanarPose of batch shape ()

    Returns
    -------
    PlanarPose of batch shape ()

    Raises
    ------
    InvalidInput
        If there is no such pose, or on other designs, types or shapes.

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.kinematics import planar_forward
    >>> from gsp.planar import PlanarDesign, PlanarPose
    >>> angle = np.arange(3) * 2 * np.pi / 3
    >>> ring = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    >>> design = PlanarDesign(["D1"] * 3, 2 * ring, ring)
    >>> joints = design.at(PlanarPose([0.1, 0.2], 0.3)).joints
    >>> planar_forward(design, joints, PlanarPose([0.0, 0.0], 0.2)).position.round(9)
    array([0.1, 0.2])
    """
    check_type("guess", guess, PlanarPose)
    if guess.shape:
        raise InvalidInput(expected("guess", "a single pose", f"shape {guess.shape}"))
    modes = planar_modes(design, joints)
    here = np.sign(np.linalg.det(np.nan_to_num(design.at(guess).jacobian)))
    apart = np.hypot(*(modes.pose.position - guess.position).T) / design.rms_radius
    apart = apart + np.abs(_wrapped(modes.pose.angle - guess.angle))
    apart[modes.side != here] = np.inf
    if not np.isfinite(apart).any():
        wanted = "values that a pose on the side of the guess has"
        raise InvalidInput(expected("joints", wanted, np.asarray(joints).tolist()))
    return modes.pose[int(np.argmin(apart))]


class _Equations:
    """The equations of three legs with signed distances, complex and in sizes of the design.

    Points and directions are complex, p the position of the platform origin. A leg D1 gives
    |p + z b − a|² = d², D2 and D3 give Re((p + z b − a) conj(n)) = d with the normal n of the line.
    """

    def __init__(self, design: PlanarDesign, joints: Array) -> None:
        self.size = design.rms_radius
        self.names = [leg.name for leg in design.legs]
        self.base, self.platform = (
            _complex(points) / self.size for points in (design.base_points, design.platform_points)
        )
        self.s, self.t = map(_complex, (design.base_directions, design.platform_directions))
        self.value = np.where(design.angular, joints, joints / self.size)
        # The frames have their origins in the anchors of a circle, so that its centre is fixed.
        circles = [i for i, name in enumerate(self.names) if name == "D1"]
        self.first = circles[0] if circles else -1
        origin = circles[0] if circles else 0
        self.corner = self.base[origin], self.platform[origin]
        self.base, self.platform = self.base - self.corner[0], self.platform - self.corner[1]

    def rows(self, z: Array) -> tuple[Array, Array]:
        """Return the linear equations of the position, Re(p conj(n)) = k, of all legs but one D1.

        (m, q) arrays n and k for the m values of z.
        """
        normals, rights = [], []
        for i, name in enumerate(self.names):
            w = z * self.platform[i] - self.base[i]
            if name == "D1" and i != self.first:
                # Difference to the first circle, |p|² = d².
                normals.append(2.0 * w)
                rights.append(self.value[i] ** 2 - self.value[self.first] ** 2 - np.abs(w) ** 2)
            elif name in ("D2", "D3"):
                normal = 1j * (z * self.t[i] if name == "D2" else self.s[i] + 0.0 * z)
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
        z = np.exp(2j * np.pi * np.arange(SAMPLES) / SAMPLES)
        values, sizes = self.eliminant(z)
        coefficients = np.fft.fft(values) / SAMPLES
        largest = np.abs(coefficients).max()
        if not largest > ZERO * sizes.max():
            return np.empty(0), True
        ordered = coefficients[np.arange(DEGREE, -DEGREE - 1, -1)]
        kept = np.flatnonzero(np.abs(ordered) > ZERO * largest)
        roots = np.roots(ordered[kept[0] : kept[-1] + 1])
        return np.angle(roots[np.abs(np.abs(roots) - 1.0) < CIRCLE]), False

    def given_angle(self) -> Array:
        """Return the angle that an A1 leg gives."""
        i = self.names.index("A1")
        return np.array([_wrapped(self.value[i] + np.angle(self.s[i]) - np.angle(self.t[i]))])

    def positions(self, angle: float) -> tuple[list[tuple[float, float]], bool]:
        """Return the positions at an angle [unit of the design], and whether they are a curve."""
        n, k, u, s, vt = self.solved(angle)
        if s[0] < NEAR and self.names.count("D1") == 3:
            # All anchors of one body on those of the other: the angle is a fourfold root.
            angle = float(np.angle((self.platform.conj() * self.base).sum()))
            n, k, u, s, vt = self.solved(angle)
        if s[0] < EXACT or (self.first < 0 and s[1] < EXACT):
            return [], bool(np.abs(k).max() < EXACT or self.first < 0)
        points = [np.linalg.lstsq(np.stack((n.real, n.imag), axis=-1), k, rcond=None)[0]]
        if s[1] < NEAR and self.first >= 0:
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


def _complex(points: Array) -> Array:
    return np.asarray(points[:, 0] + 1j * points[:, 1])


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _check(design: PlanarDesign, joints: ArrayLike) -> Array:
    check_type("design", design, PlanarDesign, "a gsp.planar.PlanarDesign")
    names = [leg.name for leg in design.legs]
    if len(names) != 3 or names.count("A1") > 1:
        raise InvalidInput(expected("design", "three legs, at most one of them A1", names))
    target = check_array("joints", joints, (3,), finite=False)
    if target.ndim != 1:
        raise InvalidInput(expected("joints", "shape (3,)", f"shape {target.shape}"))
    return target


def _possible(design: PlanarDesign, target: Array) -> bool:
    with np.errstate(invalid="ignore"):
        inside = np.where(design.angular, np.abs(target) <= np.pi, target >= 0.0)
    return bool((inside & np.isfinite(target)).all())


def _errors(design: PlanarDesign, target: Array, poses: Array) -> tuple[Array, Array]:
    """Return joint errors and rows in sizes of the design: (m, 3) and (m, 3, 3)."""
    posture = design.at(PlanarPose(poses[:, :2], poses[:, 2]))
    error = posture.joints - target
    error = np.where(design.angular, _wrapped(error), error / design.rms_radius)
    return error, posture.homogeneous(design.rms_radius)


def _refined(design: PlanarDesign, target: Array, poses: Array) -> Array:
    """Return the poses that meet the joint values after Newton's method, each once, by angle."""
    size = design.rms_radius
    best, least = poses.copy(), np.full(len(poses), np.inf)
    for _ in range(STEPS):
        error, rows = _errors(design, target, poses)
        largest = np.where(np.isnan(error), np.inf, np.abs(error)).max(axis=-1, initial=0.0)
        better = largest < least
        best[better], least[better] = poses[better], largest[better]
        usable = np.isfinite(rows).all(axis=(-2, -1)) & np.isfinite(error).all(axis=-1)
        step = np.zeros_like(poses)
        step[usable] = (np.linalg.pinv(rows[usable]) @ error[usable, :, None])[..., 0]
        poses = poses - np.where(np.abs(step) < 1.0, step, 0.0) * [size, size, 1.0]
    kept: list[Array] = []
    for pose in best[least <= MET]:
        pose[2] = -_wrapped(-pose[2])
        apart = [
            np.hypot(*(pose[:2] - other[:2])) / size + abs(float(_wrapped(pose[2] - other[2])))
            for other in kept
        ]
        if min(apart, default=np.inf) > SAME:
            kept.append(pose)
    return np.array(sorted(kept, key=lambda pose: float(pose[2]))).reshape(-1, 3)


def _result(design: PlanarDesign, target: Array, poses: Array, status: str) -> PlanarModes:
    error, rows = _errors(design, target, poses)
    return PlanarModes(
        pose=PlanarPose(poses[:, :2], poses[:, 2]),
        residual=np.abs(error).max(axis=-1, initial=0.0),
        side=np.sign(np.linalg.det(rows)),
        status=status,
    )
