"""The equations of six constraints in a complex pose, and their parameters.

A pose is z = (x, p): a quaternion x with x · x = 1 and a position p, both complex. A row has
parameters (a, b, s, t, k): points of base and platform, directions of the lines through them, and
k as in `gsp.kinematics.modes.forms`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.duals import Dual
from gsp.geometry.scalars import dot, minus, plus, rotation_from_quaternion, turned
from gsp.geometry.vectors import Array
from gsp.kinematics.modes.forms import FORMS, NUMBER, Form
from gsp.kinematics.newton.centred import Centred
from gsp.model.constraints import CONSTRAINT
from gsp.model.legs import LEG, LEGS

Complex = NDArray[np.complex128]

# Two poses are one if they differ by less, as a share of their size.
SAME_POSE_SHARE = 1e-6
# Newton steps with residuals in extended precision.
REFINING_STEPS = 4


@dataclass(frozen=True, eq=False, kw_only=True)
class Layout:
    """The constraints of six rows, and on which leg each is.

    Attributes
    ----------
    kinds : (6,) int array
        Places in `gsp.kinematics.modes.forms.FORMS`.
    legs : (6,) int array
        Number of the leg; rows of one leg have the same points and lines.
    """

    kinds: NDArray[np.int64]
    legs: NDArray[np.int64]

    @classmethod
    def of(cls, legs: Sequence[str]) -> Layout:
        """Return the layout of legs, by their names."""
        rows = [(NUMBER[c.name], i) for i, n in enumerate(legs) for c in LEG[n].constraints]
        kinds, places = np.array(rows, dtype=np.int64).T
        return cls(kinds=np.ascontiguousarray(kinds), legs=np.ascontiguousarray(places))

    @property
    def forms(self) -> tuple[Form, ...]:
        """Equations of the rows."""
        return tuple(FORMS[k] for k in self.kinds)

    @property
    def angular(self) -> NDArray[np.bool_]:
        """Whether a row is that of an angle, (6,)."""
        return np.array([CONSTRAINT[f.constraint].quantity == "angle" for f in self.forms])

    @property
    def moved(self) -> NDArray[np.bool_]:
        """Which distances the trace test moves, (6,): those of D1–D3, or of D4 if there are none.

        Those of D4 decide which solutions are at infinity: the sum has poles where they move.
        """
        plain = np.array([form.keeps_infinity for form in self.forms])
        return np.asarray(plain if plain.any() else ~self.angular)

    def random(self, rng: np.random.Generator) -> Complex:
        """Return random complex parameters, (6, 13)."""
        drawn = normal(rng, 6, 13)
        drawn[:, :12] = drawn[self.legs, :12]
        return drawn


def residual(form: Form, row: Any, pose: Any) -> Any:
    """Return left minus right side of the equation of one row, for numbers of any type.

    Parameters
    ----------
    form : Form
    row : 13 scalars
    pose : seven scalars
        With x · x = 1.
    """
    (a, b, s, t), k = (list(row[i : i + 3]) for i in (0, 3, 6, 9)), row[12]
    turn = rotation_from_quaternion(pose[:4])
    d = minus(plus(list(pose[4:]), turned(turn, b)), a)
    return form.residual(d, s, turned(turn, t), k)


def linear(layout: Layout, parameters: Complex, poses: Complex) -> tuple[Complex, Complex]:
    """Return residuals and derivatives at poses (m, 7), with x · x − 1 last: (m, 7), (m, 7, 7)."""
    m = len(poses)
    values, slopes = np.empty((7, m), np.complex128), np.empty((7, 7, m), np.complex128)
    columns: Any = poses.T  # the numbers of `Dual` may be complex here
    z = [Dual(columns[i, None], np.eye(7)[:, i, None, None]) for i in range(7)]
    for number in np.unique(layout.kinds):  # rows of one kind are evaluated together
        rows = np.flatnonzero(layout.kinds == number)
        some = residual(FORMS[number], parameters[rows].T[:, :, None], z)
        values[rows], slopes[:, rows] = some.real, some.slope
    unit = dot(z[:4], z[:4]) - 1.0
    values[6], slopes[:, 6] = unit.real[0], unit.slope[:, 0]
    return values.T, slopes.T


def refined(
    layout: Layout, parameters: Complex, poses: Complex
) -> tuple[Complex, NDArray[np.float64]]:
    """Return solutions near poses (m, 7), and last corrections as shares of their sizes, (m,).

    Newton's method with residuals in extended precision, where the machine has it: those of a pose
    of size 1e5 are differences of numbers of 1e10.
    """
    exact: Any = poses.astype(np.clongdouble)
    last = np.full(len(poses), np.inf)
    for _ in range(REFINING_STEPS):
        errors = extended_residuals(layout, parameters, exact).astype(np.complex128)
        slopes = linear(layout, parameters, exact.astype(np.complex128))[1]
        try:
            steps = np.linalg.solve(slopes, errors[..., None])[..., 0]
        except np.linalg.LinAlgError:
            break
        exact = exact - steps
        with np.errstate(invalid="ignore"):
            last = np.abs(steps).max(axis=1) / np.abs(exact).max(axis=1).astype(float)
    return exact.astype(np.complex128), last


def extended_residuals(layout: Layout, parameters: Complex, poses: Any) -> Any:
    """Return residuals at poses (m, 7), with x · x − 1 last, (m, 7), in extended precision."""
    exact: Any = poses.T.astype(np.clongdouble)
    rows = parameters.astype(np.clongdouble)
    errors = [residual(f, row, exact) for f, row in zip(layout.forms, rows, strict=True)]
    return np.stack([*errors, dot(exact[:4], exact[:4]) - 1.0], axis=-1)


def order_of(legs: Sequence[str]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Return the names of legs in the order of `LEGS`, and the rows of a design in that order."""
    places = sorted(range(len(legs)), key=lambda i: LEGS.index(LEG[legs[i]]))
    counts = [len(LEG[name].constraints) for name in legs]
    first = np.cumsum([0, *counts])
    rows = [first[i] + j for i in places for j in range(counts[i])]
    return tuple(legs[i] for i in places), np.array(rows, dtype=np.int64)


def parameters_from(design: Centred, joints: Array) -> Complex:
    """Return the parameters (6, 13) of a centred design with joint values (6,) in its units."""
    layout = Layout.of([leg.name for leg in design.design.legs])
    anchors = design.geometry.reshape(-1, 13)[layout.legs, :12]
    values = np.where(layout.angular, np.cos(joints), joints**2)
    return np.hstack((anchors, values[:, None])).astype(np.complex128)


def normal(rng: np.random.Generator, *shape: int) -> Complex:
    """Return complex numbers with independent standard normal parts."""
    return np.asarray(rng.standard_normal(shape) + 1j * rng.standard_normal(shape))


def rotations(poses: Complex) -> Complex:
    """Return the rotations (m, 3, 3) of poses (m, 7)."""
    return np.array(rotation_from_quaternion([*poses[:, :4].T])).T.reshape(-1, 3, 3)


def coordinates(poses: Complex) -> Complex:
    """Return rotations and positions of poses (m, 7) as one array (m, 12)."""
    return np.hstack((rotations(poses).reshape(-1, 9), poses[:, 4:]))


def distinct(poses: Complex, reach: Array | None = None) -> NDArray[np.int64]:
    """Return the places of poses (m, 7) that differ from all before them, ascending.

    Poses are the same within a distance of rotations and positions, (m,); without one, within
    `SAME_POSE_SHARE` of their size.
    """
    from scipy.spatial import cKDTree

    points = coordinates(poses)
    plane = np.hstack((points.real, points.imag))
    if reach is None:
        reach = SAME_POSE_SHARE * np.sqrt((plane**2).sum(axis=1))
    if _apart_on_a_line(plane, reach):
        return np.arange(len(poses))
    near = cKDTree(plane).query_ball_point(plane, reach)
    kept = np.zeros(len(poses), dtype=bool)
    for i, others in enumerate(near):
        kept[i] = not any(kept[j] for j in others if j < i)
    return np.flatnonzero(kept)


def _apart_on_a_line(points: Array, reach: Array) -> bool:
    """Whether the projections of points (m, n) on a line differ by more than their reach (m,).

    Then the points do, too. Of usual solutions they do, which takes less time than a tree.
    """
    on_line = points @ np.sin(np.arange(1.0, points.shape[1] + 1.0)) / np.sqrt(points.shape[1])
    order = on_line.argsort()
    gaps = np.diff(on_line[order])
    return bool((gaps > np.maximum(reach[order[1:]], reach[order[:-1]])).all())
