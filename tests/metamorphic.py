"""Designs and changes for tests of what depends on frames, units, order, exchange and mirror.

A case is a design at poses with its parameters. A change makes another case that describes the same
thing differently, and records how. Tests compare a quantity of the two by the fact that the record
of the quantity states.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

import gsp
from gsp.families import lee
from gsp.geometry.pose import Pose
from tests.support import turn

MIRROR = np.diag([1.0, -1.0, 1.0])
POINTS = ("base_points", "platform_points")
LINES = ("base_directions", "platform_directions")


# --- designs ------------------------------------------------------------------------------------


def random_design(legs, seed, name=""):
    """A design of general geometry with a home pose; `legs` are leg names or a mechanism."""
    rng = np.random.default_rng(seed)
    if isinstance(legs, str):
        name, legs = legs, [leg.name for leg in gsp.catalogue.mechanism(legs).legs]
    a, b, s, t = rng.normal(size=(4, len(legs), 3))
    home = Pose.from_rpy(rng.normal(size=3) + [0.0, 0.0, 3.0], 0.3 * rng.normal(size=3))
    return gsp.Design(legs, 2.0 * a, b, s, t, home=home, name=f"{name} {seed}")


def circle(angles_deg, radius=1.0, height=0.0):
    """Points on a circle about the z-axis, shape (n, 3)."""
    angles = np.deg2rad(angles_deg)
    return np.stack(
        (radius * np.cos(angles), radius * np.sin(angles), np.full(angles.shape, height)), axis=-1
    )


HEXAGON = np.arange(6) * 60.0
PAIRS = np.array([-10.0, 10.0, 110.0, 130.0, 230.0, 250.0])
LINE = np.array([[x, 0.0, 0.0] for x in (-2.0, -1.2, -0.3, 0.4, 1.1, 2.0)])
UP = np.tile([0.0, 0.0, 1.0], (6, 1))
RADIAL = circle(PAIRS)


def special_designs():
    """Designs of real machines' symmetries, and degenerate ones."""
    d1, d3 = ["D1"] * 6, ["D3"] * 6
    home = Pose([0.0, 0.0, 1.5])
    return [
        gsp.Design(d1, circle(PAIRS, 2.0), circle(PAIRS[::-1] + 60.0), name="D3 pairs"),
        gsp.Design(d1, circle(HEXAGON, 1.7), circle(HEXAGON + 20.0), name="D6 turned"),
        gsp.Design(d1, circle(HEXAGON, 1.7), circle(HEXAGON), name="similar hexagons"),
        gsp.Design(
            d1, circle([0, 50, 120, 180, 240, 310], 2.0), circle([20, 40, 100, 180, 260, 320]),
            name="mirror",
        ),
        lee.octahedral_3_3(1.0, 1.3),
        gsp.Design(d1, circle([0, 0, 120, 120, 240, 240], 1.5), circle(PAIRS), name="coincident"),
        gsp.Design(d1, LINE, circle(PAIRS), name="collinear base"),
        gsp.Design(d3, circle(PAIRS, 2.0), circle(PAIRS + 30.0), RADIAL, name="radial lines"),
        gsp.Design(d3, circle(PAIRS, 2.0), circle(PAIRS + 30.0), UP, name="parallel lines"),
        gsp.Design(
            ["D2"] * 6, circle(PAIRS, 2.0), circle(PAIRS), None, circle(PAIRS + 90.0), name="D2 D3"
        ),
        gsp.Design(
            ["D4"] * 6, circle(PAIRS, 2.0), circle(PAIRS + 60.0), RADIAL, circle(PAIRS + 90.0),
            home=home, name="D4 symmetric",
        ),
        gsp.Design(
            ["D2", "D3"] * 3, circle(PAIRS, 2.0), circle(PAIRS + 60.0), RADIAL, RADIAL,
            home=home, name="D2 D3 alternating",
        ),
    ]  # fmt: skip


# --- cases --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, kw_only=True)
class Case:
    """A design at poses (k,), its parameters, and how it was changed.

    `base` and `platform` are the placements of the old frames in the new ones; `rows` are the
    old numbers of the rows; `reversed` are the rows of angles to lines whose sense was reversed;
    `distance` is the distance of an origin from its body, in sizes of the design.
    """

    design: gsp.Design
    pose: Pose
    length: float
    maximum: float
    unit: float = 1.0
    base: Pose = field(default_factory=lambda: Pose(np.zeros(3)))
    platform: Pose = field(default_factory=lambda: Pose(np.zeros(3)))
    rows: np.ndarray
    reversed: np.ndarray
    distance: float = 1.0

    @cached_property
    def posture(self):
        return self.design.at(self.pose)

    def parameters(self, names):
        """The parameters that have these names, for an index."""
        given = {
            "length": self.length,
            "ellipsoid": self.design.ellipsoid,
            "maximum": self.maximum,
        }
        return {name: given[name] for name in names}


def case(design, seed=0, poses=4):
    """A case of a design: random poses above its base, and the one without a turn."""
    rng = np.random.default_rng(seed)
    size = design.rms_radius
    above = np.array([0.0, 0.0, 1.2])
    position = size * (above + 0.3 * rng.uniform(-1.0, 1.0, (poses, 3)))
    rotation = turn(rng.uniform(-0.5, 0.5, (poses, 3)))
    position[-1], rotation[-1] = size * above, np.eye(3)
    pose = Pose(position, rotation)
    ellipsoid = gsp.Ellipsoid(
        size * np.array([0.5, 0.7, 0.4]), size * np.array([0.1, -0.2, 0.3]), turn([0.3, 0.2, 0.1])
    )
    design = design.replace(ellipsoid=ellipsoid, home=pose[0])
    joints = design.at(pose).joints
    middle = np.median(joints, axis=0)
    strokes = np.stack((0.8 * middle, 1.2 * middle), axis=1)
    n = len(design.joint_names)
    return Case(
        design=design.replace(strokes=np.where(design.angular[:, None], np.nan, strokes)),
        pose=pose,
        length=0.6 * size,
        maximum=20.0 * size**3,
        rows=np.arange(n),
        reversed=np.zeros(n, dtype=bool),
    )


# --- changes ------------------------------------------------------------------------------------


def changed(design, base=None, platform=None, order=None, mirror=None, factor=1.0):
    """The design with its bodies moved by poses, legs in another order, mirrored, scaled."""
    base, platform = (Pose(np.zeros(3)) if m is None else m for m in (base, platform))
    order = np.arange(design.n_legs) if order is None else order
    hand = np.eye(3) if mirror is None else mirror

    def points(x, m):
        return (x @ hand @ m.rotation.T + m.position)[order] * factor

    def lines(x, m):
        return (x @ hand @ m.rotation.T)[order]

    home, ellipsoid, strokes = design.home, design.ellipsoid, design.strokes
    if home is not None:
        home = changed_pose(home, base, platform, hand, factor)
    if ellipsoid is not None:
        ellipsoid = gsp.Ellipsoid(
            ellipsoid.semi_axes,
            platform.rotation @ hand @ ellipsoid.center + platform.position,
            platform.rotation @ hand @ ellipsoid.rotation @ hand,
        ).scaled(factor)
    if strokes is not None:
        rows = row_order(design, order)
        strokes = (strokes * np.where(design.angular, 1.0, factor)[:, None])[rows]
    return gsp.Design(
        [design.legs[i].name for i in order],
        points(design.base_points, base),
        points(design.platform_points, platform),
        lines(design.base_directions, base),
        lines(design.platform_directions, platform),
        home=home,
        ellipsoid=ellipsoid,
        strokes=strokes,
        name=design.name,
    )


def changed_pose(pose, base, platform, hand=MIRROR @ MIRROR, factor=1.0):
    """The pose that belongs to `changed`."""
    pose = Pose(pose.position @ hand, hand @ pose.rotation @ hand)
    pose = base.compose(pose).compose(platform.inverse())
    return Pose(pose.position * factor, pose.rotation)


def row_order(design, order):
    """The old numbers of the rows of the Jacobian for legs in another order."""
    return np.concatenate([[k for k, r in enumerate(design.rows) if r.leg == i] for i in order])


def angles(design):
    """The number of rows of angles."""
    return int(design.angular.sum())


def moved(given, base=None, platform=None, distance=1.0):
    """The case with its bodies described in other frames."""
    base, platform = (Pose(np.zeros(3)) if m is None else m for m in (base, platform))
    return replace(
        given,
        design=changed(given.design, base, platform),
        pose=changed_pose(given.pose, base, platform),
        base=base,
        platform=platform,
        distance=distance,
    )


def _turn(rng):
    return Pose(np.zeros(3), turn(rng.uniform(-1.5, 1.5, 3)))


def _shift(given, rng, sizes):
    direction = rng.normal(size=3)
    return Pose(sizes * given.design.rms_radius * direction / np.linalg.norm(direction))


def _scaled(given, factor):
    power = 3 - angles(given.design)
    return replace(
        given,
        design=changed(given.design, factor=factor),
        pose=given.pose.scaled(factor),
        length=given.length * factor,
        maximum=given.maximum * factor**power,
        unit=factor,
    )


def _ordered(given, rng):
    order = rng.permutation(given.design.n_legs)
    return replace(
        given, design=changed(given.design, order=order), rows=row_order(given.design, order)
    )


def _exchanged(given):
    """Base and platform change places; the ellipsoid is fixed to the platform, as before."""
    design = given.design.exchanged().replace(ellipsoid=given.design.ellipsoid)
    return replace(given, design=design, pose=given.pose.inverse())


def _mirrored(given):
    still = Pose(np.zeros(3))
    return replace(
        given,
        design=changed(given.design, mirror=MIRROR),
        pose=changed_pose(given.pose, still, still, MIRROR),
    )


def _slid(given, rng):
    """Anchor points moved along their lines, by about a size."""
    design = given.design
    points = {}
    for point, line in zip(POINTS, LINES, strict=True):
        step = design.rms_radius * rng.normal(size=(design.n_legs, 1))
        points[point] = getattr(design, point) + np.nan_to_num(step * getattr(design, line))
    # The stroke and home stay: the values of all joints do.
    return replace(given, design=design.replace(**points), distance=3.0)


def _reversed(given, rng):
    """The base lines of some legs with the opposite sense; the angles to them are π − θ."""
    design = given.design
    other = rng.random(design.n_legs) < 0.5
    other[0] = True
    signs = np.where(other, -1.0, 1.0)[:, None]
    rows = np.array([other[row.leg] for row in design.rows]) & design.angular
    return replace(
        given, design=design.replace(base_directions=design.base_directions * signs), reversed=rows
    )


@dataclass(frozen=True, kw_only=True)
class Change:
    """A change: its name, the fact of the record that it is about, and what makes it."""

    name: str
    fact: str
    make: Callable[[Case, np.random.Generator], Case]


CHANGES = (
    Change(name="base turned", fact="base_turn", make=lambda c, rng: moved(c, _turn(rng))),
    *(
        Change(
            name=f"base shifted by {k:g}", fact="base_shift",
            make=lambda c, rng, k=k: moved(c, _shift(c, rng, k), distance=1.0 + k),
        )
        for k in (1.0, 1e4)
    ),
    Change(
        name="platform turned", fact="platform_turn",
        make=lambda c, rng: moved(c, platform=_turn(rng)),
    ),
    *(
        Change(
            name=f"platform shifted by {k:g}", fact="platform_shift",
            make=lambda c, rng, k=k: moved(c, None, _shift(c, rng, k), distance=1.0 + k),
        )
        for k in (1.0, 1e4)
    ),
    *(
        Change(name=f"unit {k:g}", fact="unit", make=lambda c, _, k=k: _scaled(c, k))
        for k in (1e-6, 25.4, 1e6)
    ),
    Change(name="order of legs", fact="order", make=_ordered),
    Change(name="exchange", fact="exchange", make=lambda c, _: _exchanged(c)),
    Change(name="mirror", fact="mirror", make=lambda c, _: _mirrored(c)),
    Change(name="anchors slid along lines", fact="slide", make=_slid),
    Change(name="lines reversed", fact="reversal", make=_reversed),
)  # fmt: skip
FACTS = tuple(dict.fromkeys(change.fact for change in CHANGES))
