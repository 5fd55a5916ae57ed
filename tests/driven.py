"""Designs with legs that are driven at the base, for tests."""

import numpy as np

import gsp
from gsp import Crank, Design, Pose, Slider


def ring(radius, angles, z=0.0):
    angles = np.deg2rad(angles)
    return np.stack((radius * np.cos(angles), radius * np.sin(angles), 0.0 * angles + z), axis=1)


BASE = ring(2.0, [-8.0, 8.0, 112.0, 128.0, 232.0, 248.0])
PLATFORM = ring(1.0, [-52.0, 52.0, 68.0, 172.0, 188.0, 292.0])
HOME = Pose.from_rpy([0.1, 0.05, 1.6], [0.1, -0.05, 0.2])
# Across the radius, so that cranks turn in planes through it.
TANGENTS = ring(1.0, [82.0, 98.0, 202.0, 218.0, 322.0, 338.0])


def horns(branch, size=0.6):
    """Cranks that lie along the radius at the angle zero."""
    return [Crank(arm=size * x / 2.0, rod=2.0, branch=branch) for x in BASE]


def hexaglide(branch=1):
    """Rails in three parallel pairs along x, symmetric about it, and rods of one length."""
    base = [[0, y, 0] for y in (-1.5, -0.5, -1.0, 1.0, 0.5, 1.5)]
    platform = ring(0.6, [-150, -30, -90, 90, 30, 150])
    signs = [branch, -branch] * 3
    legs = [Slider(rod=2.2, branch=sign) for sign in signs]
    return Design(legs, base, platform, [[1, 0, 0]] * 6, home=Pose([0.1, 0.05, 1.4]), unit="m")


def rotary(branch=1):
    """The horns of a platform with servomotors, symmetric."""
    return Design(horns(branch), BASE, PLATFORM, TANGENTS, home=Pose([0, 0, 1.5]), unit="m")


def mixed(seed=0):
    """All kinds of legs, eight of them, with general dimensions: sliders, cranks, D1, D3, A1."""
    rng = np.random.default_rng(seed)
    legs = [
        Slider(rod=2.9, branch=1), Crank(arm=[0.7, 0.1, 0.3], rod=2.1), "D1", "D3",
        Slider(rod=2.9, branch=-1), Crank(arm=[-0.2, 0.6, 0.4], rod=2.3, branch=-1), "D4 A1",
    ]  # fmt: skip
    base = np.concatenate((BASE, [[0.3, 0.2, -0.1]])) + 0.1 * rng.normal(size=(7, 3))
    platform = np.concatenate((PLATFORM, [[-0.2, 0.1, 0.3]])) + 0.1 * rng.normal(size=(7, 3))
    lines = rng.normal(size=(7, 3))
    lines[1] = [0.2, 1.0, 0.1]
    lines[5] = [-0.9, -0.4, 0.3]
    return Design(legs, base, platform, lines, rng.normal(size=(7, 3)), home=HOME, unit="m")


def of_five_legs():
    """Two sliders, a crank whose tip is off the plane of its base point, D1 and D4 A1."""
    legs = [
        Slider(rod=2.4), "D1", Slider(rod=2.4, branch=-1),
        Crank(arm=0.3 * BASE[4] - 0.3 * TANGENTS[4], rod=2.1, branch=-1), "D4 A1",
    ]  # fmt: skip
    chosen = [0, 2, 3, 4, 5]
    lines = ring(1.0, [10.0, 30.0, 40.0, 50.0, 60.0], 0.5)
    home = Pose.from_rpy([0.05, 0.03, 1.5], [0.03, -0.05, 0.1])
    points = BASE[chosen], PLATFORM[chosen]
    return Design(legs, *points, TANGENTS[chosen], lines, home=home, unit="m", name="five legs")


def general(kind, branch, seed=1):
    """Six legs of one kind with general dimensions."""
    rng = np.random.default_rng(seed)
    base, platform = BASE + 0.1 * rng.normal(size=(6, 3)), PLATFORM + 0.1 * rng.normal(size=(6, 3))
    lines = TANGENTS + 0.2 * rng.normal(size=(6, 3))
    if kind == "slider":
        legs = [Slider(rod=3.0, branch=branch)] * 6
    else:
        arms = 0.6 * BASE / 2.0 + 0.1 * rng.normal(size=(6, 3))
        legs = [Crank(arm=arm, rod=2.0, branch=branch) for arm in arms]
    home = HOME if kind == "slider" else Pose.from_rpy([0.05, 0.02, 1.5], [0.05, -0.05, 0.05])
    return Design(legs, base, platform, lines, home=home, unit="m")


DESIGNS = {
    "hexaglide": hexaglide(),
    "hexaglide, other branches": hexaglide(-1),
    "rotary": rotary(),
    "rotary, other branch": rotary(-1),
    "sliders": general("slider", 1),
    "sliders, other branch": general("slider", -1),
    "cranks": general("crank", 1),
    "cranks, other branch": general("crank", -1),
    "mixed": mixed(),
}


def mixture(seed):
    """Sliders, cranks and other legs with six constraints together, dimensions at random."""
    rng = np.random.default_rng(seed)
    kinds, others = ["slider", "crank"], ["slider", "crank", "D1", "D2", "D3", "D4", "A1", "D4 A1"]
    while (count := sum(len(kind.split()) for kind in kinds)) < 6:
        fitting = [kind for kind in others if count + len(kind.split()) <= 6]
        kinds.append(str(rng.choice(fitting)))
    base, platform = rng.uniform(-1.0, 1.0, (2, len(kinds), 3))
    lines = rng.normal(size=(2, len(kinds), 3))
    box = gsp.PoseBox([(-0.5, 0.5), (-0.5, 0.5), (1.0, 2.0)], [(-0.6, 0.6)] * 3)
    home = box.sample(1, rng=rng)[0]
    legs = list(kinds)
    for i, kind in enumerate(kinds):
        d = home.position + home.rotation @ platform[i] - base[i]
        branch = int(rng.choice([-1, 1]))
        s = lines[0, i] / np.linalg.norm(lines[0, i])
        if kind == "slider":
            rod = rng.uniform(1.05, 2.0) * np.linalg.norm(np.cross(d, s))
            legs[i] = Slider(rod=rod, branch=branch)
        elif kind == "crank":  # in reach at some angle
            arm, q = 0.4 * rng.normal(size=3), rng.uniform(-3.0, 3.0)
            turned = arm * np.cos(q) + np.cross(s, arm) * np.sin(q)
            rod = np.linalg.norm(d - turned - s * (s @ arm) * (1.0 - np.cos(q)))
            legs[i] = Crank(arm=arm, rod=rod, branch=branch)
    return Design(legs, base, platform, *lines, home=home, unit="m")


def near_home(design, count, seed=0):
    """Poses near home where all legs are defined."""
    size = design.rms_radius
    widths = [0.06 * size] * 3 + [0.08] * 3
    poses = gsp.PoseBox.around(design.home, widths).sample(4 * count, rng=seed)
    return poses[np.flatnonzero(design.at(poses).defined)[:count]]


def tips(design, posture):
    """The tips of the rods from joint values, written apart from the library: {leg: (..., 3)}."""
    found = {}
    for row, (leg, _) in enumerate(design.rows):
        drive, s, a = design.drives[leg], design.base_directions[leg], design.base_points[leg]
        q = posture.joints[..., row, None]
        if isinstance(drive, Slider):
            found[leg] = a + q * s
        elif isinstance(drive, Crank):
            arm = np.array(drive.arm)
            # Rodrigues' formula.
            turned = arm * np.cos(q) + np.cross(s, arm) * np.sin(q)
            found[leg] = a + turned + s * (s @ arm) * (1.0 - np.cos(q))
    return found
