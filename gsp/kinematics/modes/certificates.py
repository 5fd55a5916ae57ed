"""Proofs that a real pose with given joint values exists in a box, and is the only one there."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.geometry.duals import Dual
from gsp.geometry.scalars import dot
from gsp.geometry.vectors import Array
from gsp.installed import optional
from gsp.kinematics.modes.equations import Layout, residual
from gsp.kinematics.newton.centred import centred
from gsp.model.design import Design

# Bits of the arithmetic, and half sides of the boxes that are tried: of the quaternion, and of the
# position as a share of the size of the design.
CERTIFICATE_BITS = 106
BOX_RADII = tuple(10.0**power for power in range(-13, -3))


def certified(design: Design, joints: Array, centres: Array) -> Array:
    """Return the half sides of boxes with exactly one solution each, (m,); NaN without a proof.

    The test is that of Krawczyk, in ball arithmetic, of the equations of
    `gsp.kinematics.modes.equations` with the dimensions and joint values as they are given. A box
    is a quaternion within the half side in each component, and a place of the centre of the
    platform anchors, seen from that of the base anchors, within that times `design.rms_radius`. So
    the origins of the frames have no influence: anchors are shifted in ball arithmetic. Boxes that
    overlap count as not proven.

    Parameters
    ----------
    design : Design
    joints : (6,) array [unit of the design, rad]
    centres : (m, 7) array
        Quaternions (w, x, y, z) and positions in the frames of `centred(design)`.

    Raises
    ------
    MissingSoftware
        Without python-flint.

    *Source: Krawczyk's operator, as in Moore, Kearfott and Cloud, Introduction to Interval
    Analysis.*
    """
    with optional("python-flint", "certified assembly modes", "verify", module="flint"):
        import flint
    with flint.ctx.workprec(CERTIFICATE_BITS):
        system = _System(flint, design, joints)
        radii = np.array([system.radius(centre) for centre in centres])
    return _disjoint(centres, radii)


class _System:
    """The equations of a design in ball arithmetic, in centred frames and sizes of the design."""

    def __init__(self, flint: Any, design: Design, joints: Array) -> None:
        self.flint, self.ball = flint, flint.arb
        frame = centred(design).frame
        self.size = self.ball(float(frame[0]))
        self.origins = [self.ball(float(x)) for x in frame[1:]]
        layout = Layout.of([leg.name for leg in design.legs])
        lines = np.nan_to_num(np.hstack((design.base_directions, design.platform_directions)))
        anchors = np.hstack((design.base_points, design.platform_points))
        self.forms = layout.forms
        self.rows = [
            self._row(anchors[leg], lines[leg], float(value), bool(angular))
            for leg, value, angular in zip(layout.legs, joints, layout.angular, strict=True)
        ]

    def _row(self, anchors: Array, lines: Array, value: float, angular: bool) -> list[Any]:
        points = [
            (self.ball(float(x)) - origin) / self.size
            for x, origin in zip(anchors, self.origins, strict=True)
        ]
        s, t = ([self.ball(float(x)) for x in half] for half in (lines[:3], lines[3:]))
        if angular:
            return [*points, *s, *t, self.ball(value).cos() * (dot(s, s) * dot(t, t)).sqrt()]
        return [*points, *s, *t, (self.ball(value) / self.size) ** 2]

    def linear(self, pose: list[Any]) -> tuple[Any, Any]:
        """Return residuals (7, 1) and derivatives (7, 7) over a box of poses."""
        one, zero = self.ball(1), self.ball(0)
        directions = [[one if i == j else zero for j in range(7)] for i in range(7)]
        z = [Dual(x, np.array(d)) for x, d in zip(pose, directions, strict=True)]
        rows = [residual(form, row, z) for form, row in zip(self.forms, self.rows, strict=True)]
        rows += [dot(z[:4], z[:4]) - one]
        matrix = self.flint.arb_mat
        values = matrix(7, 1, [row.real for row in rows])
        return values, matrix(7, 7, [entry for row in rows for entry in row.slope])

    def radius(self, centre: Array) -> float:
        """Return the least of `BOX_RADII` whose box has one solution, NaN if none is proven."""
        matrix, ball = self.flint.arb_mat, self.ball
        middle = [ball(float(x)) for x in centre]
        value, slopes = self.linear(middle)
        floats = np.array([[float(slopes[i, j].mid()) for j in range(7)] for i in range(7)])
        if not np.linalg.cond(floats) < 1e14:
            return float("nan")
        inverse = matrix(7, 7, [ball(float(x)) for x in np.linalg.inv(floats).ravel()])
        newton, identity = inverse * value, matrix(7, 7, [int(i % 8 == 0) for i in range(49)])
        for half in BOX_RADII:
            sides = [ball(0, half)] * 7
            box = [m + side for m, side in zip(middle, sides, strict=True)]
            rest = identity - inverse * self.linear(box)[1]
            moved = rest * matrix(7, 1, sides) - newton
            if all(abs(moved[i, 0]) < half for i in range(7)):
                return half
        return float("nan")


def _disjoint(centres: Array, radii: Array) -> Array:
    """Return the half sides, NaN where the box of another solution overlaps, as x or as −x."""
    turned = centres * np.repeat([-1.0, 1.0], [4, 3])
    clear = radii.copy()
    for i in range(len(centres)):
        apart = np.minimum(
            np.abs(centres - centres[i]).max(axis=1), np.abs(turned - centres[i]).max(axis=1)
        )
        apart[i] = np.inf
        if (apart <= 2.0 * (radii + radii[i])).any():
            clear[i] = np.nan
    return clear
