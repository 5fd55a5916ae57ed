"""Planar indices when a platform is described differently, as in tests/metamorphic.py.

Generated: designs, random ones of all sixteen mechanisms and symmetric or degenerate ones, times
changes. A table states which index changes with what; all else agrees to rounding.
"""

import numpy as np
import pytest

import gsp
from gsp import kinematics, planar
from gsp.planar import PlanarDesign, PlanarPose, indices
from tests import campaign

EPS = np.finfo(float).eps
ROUNDINGS = 200.0  # see tests/quantities.py
LENGTH = 0.7  # in sizes
STILL = PlanarPose([0.0, 0.0], 0.0)
MIRROR = np.diag([1.0, -1.0])


def random_design(legs, seed):
    rng = np.random.default_rng(seed)
    a, b, s, t = rng.normal(size=(4, len(legs), 2))
    return PlanarDesign(legs, 2.0 * a, b, s, t, name=f"{' '.join(legs)} {seed}")


def ring(angles_deg, radius=1.0):
    angles = np.deg2rad(angles_deg)
    return radius * np.stack((np.cos(angles), np.sin(angles)), axis=-1)


THREE = np.array([0.0, 120.0, 240.0])
LINE = np.array([[-1.0, 0.0], [0.2, 0.0], [1.5, 0.0]])
ALONG = np.tile([0.0, 1.0], (3, 1))
DESIGNS = [
    *(random_design(list(m.legs), i) for i, m in enumerate(planar.mechanisms())),
    random_design(["D1"] * 4, 20),
    random_design(["D1", "D2", "D3", "A1"], 21),
    PlanarDesign(["D1"] * 3, ring(THREE, 2.0), ring(THREE + 20.0), name="turned triangles"),
    PlanarDesign(["D1"] * 3, ring(THREE, 2.0), ring(THREE), name="similar triangles"),
    PlanarDesign(["D1"] * 3, ring([0, 0, 140], 2.0), ring(THREE), name="coincident anchors"),
    PlanarDesign(["D1"] * 3, LINE, ring(THREE), name="collinear base"),
    PlanarDesign(["D3"] * 3, ring(THREE, 2.0), ring(THREE), ALONG, name="parallel lines"),
]


def poses(design):
    rng = np.random.default_rng(0)
    size = design.rms_radius
    return PlanarPose(size * rng.uniform(-1.0, 1.0, (4, 2)), [0.7, -0.4, 1.1, 0.2])


def changed(case, base=STILL, platform=STILL, order=None, hand=None, factor=1.0):
    """The design and pose with bodies moved, legs in another order, mirrored, scaled."""
    design, pose, ellipsoid, _ = case
    order = np.arange(design.n_legs) if order is None else order
    hand = np.eye(2) if hand is None else hand

    def moved(x, m, shift):
        return (x @ hand @ m.rotation.T + shift * m.position)[order] * (factor if shift else 1.0)

    other = PlanarDesign(
        [design.legs[i].name for i in order],
        moved(design.base_points, base, 1.0),
        moved(design.platform_points, platform, 1.0),
        moved(design.base_directions, base, 0.0),
        moved(design.platform_directions, platform, 0.0),
    )
    mirrored = PlanarPose(pose.position @ hand, pose.angle * np.linalg.det(hand))
    there = base.compose(mirrored).compose(platform.inverse())
    axes = np.eye(3)
    axes[:2, :2] = platform.rotation @ hand
    centre = np.append(platform.rotation @ hand @ ellipsoid.center[:2] + platform.position, 0.0)
    turn = axes @ ellipsoid.rotation
    turn[:, 2] *= np.linalg.det(turn)  # the axis off the plane, in either sense
    held = gsp.Ellipsoid(ellipsoid.semi_axes, centre, turn).scaled(factor)
    return other, PlanarPose(there.position * factor, there.angle), held, factor


def exchanged(case):
    design, pose, ellipsoid, unit = case
    return design.exchanged(), pose.inverse(), ellipsoid, unit


def shift(size, k):
    return PlanarPose(k * size * np.array([0.6, -0.8]), 0.0)


TURN = PlanarPose([0.0, 0.0], 0.9)
# Name: the fact, the distance of an origin in sizes, and what makes the other description.
CHANGES = {
    "base turned": ("base_turn", 1.0, lambda c, _: changed(c, base=TURN)),
    "platform turned": ("platform_turn", 1.0, lambda c, _: changed(c, platform=TURN)),
    **{
        f"base shifted by {k:g}": (
            "base_shift", 1.0 + k, lambda c, size, k=k: changed(c, base=shift(size, k))
        )
        for k in (1.0, 1e4)
    },
    **{
        f"platform shifted by {k:g}": (
            "platform_shift", 1.0 + k, lambda c, size, k=k: changed(c, platform=shift(size, k))
        )
        for k in (1.0, 1e4)
    },
    **{
        f"unit {k:g}": ("unit", 1.0, lambda c, _, k=k: changed(c, factor=k))
        for k in (1e-6, 25.4, 1e6)
    },
    "order": ("order", 1.0, lambda c, _: changed(c, order=np.arange(c[0].n_legs)[::-1])),
    "mirror": ("mirror", 1.0, lambda c, _: changed(c, hand=MIRROR)),
    "exchange": ("exchange", 1.0, lambda c, _: exchanged(c)),
}  # fmt: skip
FACTS = list(dict.fromkeys(fact for fact, _, _ in CHANGES.values()))

INDICES = {
    "condition_number": {"platform_shift", "exchange"},
    "condition_number_ellipsoid": {"exchange"},
    "control_number": set(),
    "manipulability": set(),
}


def value(name, case, length):
    """The index, as a reciprocal where it may be infinite."""
    design, pose, ellipsoid, unit = case
    posture, number = design.at(pose), length * unit
    if name == "condition_number":
        return 1.0 / indices.condition_number(posture, number)
    if name == "condition_number_ellipsoid":
        return 1.0 / indices.condition_number_ellipsoid(posture, ellipsoid, number)
    if name == "control_number":
        return indices.control_number(posture, number)
    return indices.manipulability(posture)


@pytest.mark.parametrize("name", INDICES)
def test_each_change_has_the_effect_that_the_table_states(name):
    most = dict.fromkeys(FACTS, 0.0)
    for design in DESIGNS:
        size = design.rms_radius
        angles = int(design.angular.sum())
        redundant = len(design.joint_names) > 3 and angles
        tilt = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
        ellipsoid = gsp.Ellipsoid(size * np.array([0.5, 0.7, 0.4]), [0.1, -0.2, 0.0], tilt)
        case = (design, poses(design), ellipsoid, 1.0)
        before = value(name, case, LENGTH * size)
        scale = np.ones(4)
        if name == "manipulability":
            rows = design.at(case[1]).jacobian
            scale = np.linalg.norm(rows / [1.0, 1.0, size], axis=-1).prod(axis=-1) * size
        for what, (fact, distance, make) in CHANGES.items():
            other = make(case, size)
            there = value(name, other, LENGTH * size)
            if fact in INDICES[name] or (name == "manipulability" and fact == "unit" and redundant):
                with np.errstate(divide="ignore", invalid="ignore"):
                    gap = np.abs(there / before - 1.0)
                most[fact] = max(most[fact], np.max(gap, initial=0.0, where=np.isfinite(gap)))
                continue
            power = 1 - angles if name == "manipulability" else 0
            factor = other[3] ** power
            margin = ROUNDINGS * EPS * distance * scale * factor
            np.testing.assert_array_equal(np.isnan(there), np.isnan(before), err_msg=what)
            with np.errstate(invalid="ignore"):
                near = (np.abs(there - before * factor) <= margin) | np.isnan(before)
            assert near.all(), f"{design.name}, {what}: {there} for {before * factor}"
    for fact in INDICES[name]:
        assert most[fact] > 1e-3, f"{name} is not changed by {fact}"


# --- joints, rows, modes ---


def crossed(x):
    """Turned by a right angle."""
    return np.stack((-x[..., 1], x[..., 0]), axis=-1)


def moved_rows(what, case, rows):
    """The rows that the other description should have, legs in the same order."""
    design, pose, _, _ = case
    size, k = design.rms_radius, float(what.split()[-1]) if what[-1].isdigit() else 1.0
    force, moment = rows[..., :2], rows[..., 2:]
    if what == "base turned":
        force = force @ TURN.rotation.T
    elif what.startswith("platform shifted"):
        arm = -(pose.rotation @ shift(size, k).position)
        moment = moment - (crossed(arm)[:, None] * force).sum(axis=-1, keepdims=True)
    elif what.startswith("unit"):
        angular = design.angular[:, None]
        force, moment = np.where(angular, force / k, force), np.where(angular, moment, moment * k)
    elif what == "mirror":
        # Angles from base to platform line have the other sense in the mirror.
        sense = np.where(design.angular, -1.0, 1.0)[:, None]
        force, moment = sense * (force @ MIRROR), -sense * moment
    return np.concatenate((force, moment), axis=-1)


def moved_joints(what, case, joints):
    angular = case[0].angular
    if what.startswith("unit"):
        return np.where(angular, joints, joints * float(what.split()[-1]))
    return np.where(angular, -joints, joints) if what in ("mirror", "exchange") else joints


def test_joints_and_rows_change_as_the_plane_does():
    for design in DESIGNS:
        size = design.rms_radius
        ellipsoid = gsp.Ellipsoid(size * np.ones(3))
        case = (design, poses(design), ellipsoid, 1.0)
        here = design.at(case[1])
        for what, (_, distance, make) in CHANGES.items():
            other, pose, _, unit = make(case, size)
            there = other.at(pose)
            order = slice(None, None, -1) if what == "order" else slice(None)
            joints = moved_joints(what, case, here.joints)[:, order]
            scale = np.where(other.angular, 1.0, 10.0 * size * unit)
            off = there.joints - joints
            off = np.where(other.angular, (off + np.pi) % (2 * np.pi) - np.pi, off)
            margin = ROUNDINGS * EPS * distance
            assert not (np.abs(off) > margin * scale).any(), (design.name, what)
            np.testing.assert_array_equal(np.isnan(there.joints), np.isnan(joints))
            if what == "exchange":
                continue
            rows = moved_rows(what, case, here.jacobian)[:, order]
            lost = np.abs(rows).max(axis=(-2, -1), keepdims=True, initial=1.0) * distance
            assert not (np.abs(there.jacobian - rows) > margin * lost).any(), (design.name, what)


@pytest.mark.parametrize("legs", [["D1"] * 3, ["D1", "D2", "D3"], ["D1", "D3", "A1"]])
def test_modes_are_the_same_in_all_descriptions(legs):
    """As many of them, and the control number at each; one of them is the pose itself."""
    for seed in range(campaign.count(1, 10)):
        design = random_design(legs, seed)
        size = design.rms_radius
        case = (design, poses(design)[:1], gsp.Ellipsoid(size * np.ones(3)), 1.0)
        wanted = modes(case, size)
        assert len(wanted)
        for what, (_, distance, make) in CHANGES.items():
            other = make(case, size)
            found = modes(other, size)
            margin = 1e-7 if distance < 1e3 else 1e-4
            np.testing.assert_allclose(found, wanted, atol=margin, err_msg=what)
            near = kinematics.planar_forward(other[0], other[0].at(other[1][0]).joints, other[1][0])
            off = np.hypot(*(near.position - other[1][0].position)) / (size * other[3])
            assert off < margin, what


def modes(case, size):
    """Control numbers of all modes, ascending."""
    design, pose, _, unit = case
    found = kinematics.planar_modes(design, design.at(pose[0]).joints)
    return np.sort(indices.control_number(design.at(found.pose), LENGTH * size * unit))


@pytest.mark.parametrize("name", INDICES)
def test_one_planar_pose_and_many_are_the_same(name):
    for design in DESIGNS:
        pose, length = poses(design), LENGTH * design.rms_radius
        ellipsoid = gsp.Ellipsoid(np.ones(3))
        whole = value(name, (design, pose, ellipsoid, 1.0), length)
        square = value(name, (design, pose.reshape(2, 2), ellipsoid, 1.0), length)
        np.testing.assert_array_equal(square, whole.reshape(2, 2))
        single = [value(name, (design, pose[i], ellipsoid, 1.0), length) for i in range(4)]
        np.testing.assert_allclose(single, whole, rtol=1e-12)
