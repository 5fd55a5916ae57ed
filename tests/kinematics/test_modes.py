"""All assembly modes: published numbers, joints of each mode, traces, certificates, statuses."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import gsp
from gsp.catalogue import mechanism, mechanisms
from gsp.errors import InvalidInput
from gsp.kinematics.modes.census import (
    confirmed_counts,
    counted,
    root_counts,
    row_of,
    text_of,
)
from gsp.kinematics.modes.certificates import certified
from gsp.kinematics.modes.clearance import Clearances
from gsp.kinematics.modes.ends import ends_of, moves, other_system, real_poses
from gsp.kinematics.modes.equations import (
    Layout,
    linear,
    normal,
    parameters_from,
    residual,
    rotations,
)
from gsp.kinematics.modes.forms import FORMS, NUMBER
from gsp.kinematics.modes.reach import contradict
from gsp.kinematics.modes.starts import TRACE_TOLERANCE, start_of, trace
from gsp.kinematics.newton.centred import centred
from gsp.model.constraints import CONSTRAINT
from gsp.model.legs import LEG
from tests.campaign import count, some
from tests.support import random_design, random_pose

SIX = ["D1"] * 6
POSE = gsp.Pose([0.1, 0.2, 1.3], Rotation.from_euler("xyz", [0.1, 0.2, 0.3]).as_matrix())
# P. Dietmaier, The Stewart-Gough platform of general geometry can have 40 real postures, 1998, in
# Advances in Robot Kinematics: Analysis and Control: a platform and its six lengths.
DIETMAIER = gsp.Design(
    SIX,
    base_points=[
        [0, 0, 0], [1.107915, 0, 0], [0.549094, 0.756063, 0], [0.735077, -0.223935, 0.525991],
        [0.514188, -0.526063, -0.368418], [0.590473, 0.094733, -0.205018],
    ],
    platform_points=[
        [0, 0, 0], [0.542805, 0, 0], [0.956919, -0.528915, 0], [0.665885, -0.353482, 1.402538],
        [0.478359, 1.158742, 0.107672], [-0.137087, -0.235121, 0.353913],
    ],
)  # fmt: skip
LENGTHS = [1, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071]


def apart(modes, pose):
    """Distances of the modes from a pose, by position and rotation."""
    position = np.abs(modes.poses.position - pose.position).max(axis=1)
    return position + np.abs(modes.poses.rotation - pose.rotation).max(axis=(1, 2))


def numbers(modes):
    return modes.n_complex + modes.n_singular + modes.n_infinite + modes.n_lost == modes.n_paths


def test_forty_real_postures_of_dietmaier_are_found_and_proven():
    modes = gsp.assembly_modes(DIETMAIER, LENGTHS, certify=True)
    assert (modes.status, modes.n_complex, len(modes.poses.position)) == ("found", 40, 40)
    assert modes.certified.all()
    assert modes.residual.max() < 1e-13
    np.testing.assert_allclose(DIETMAIER.at(modes.poses).joints, np.tile(LENGTHS, (40, 1)))
    # Two well-conditioned ones of the solutions that PHCpack comes with (demo stewgou40), whose
    # equations have ten digits: unit vectors of the first leg and of the platform.
    for leg, x in (
        ([0.8633257137708, 0.0056440286799, -0.5046155535476],
         [0.1912883330123, 0.9437565017706, 0.2696895233763]),
        ([0.6361117806568, 0.7714519603698, 0.0149557798623],
         [0.4039951110577, -0.5703692490473, -0.7151691198470]),
    ):  # fmt: skip
        near = np.abs(modes.poses.position - leg).max(axis=1)
        near = near + np.abs(modes.poses.rotation[:, :, 0] - x).max(axis=1)
        assert near.min() < 1e-7


# D. Rusin, Re: Stewart platform, newsgroup article of 22 September 1999, in The Mathematical Atlas:
# an octahedral platform with sides 11, 10, 9, and the first coefficients of the polynomial of
# degree 16 of the height of its third vertex, of which only even powers occur.
ATLAS_BASE = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [5.0, 8.0, 0.0]])
ATLAS_SIDES = 11.0, 10.0, 9.0
ATLAS_LENGTHS = [6.0, 12.0, 7.0, 11.0, 13.0, 9.0]
ATLAS_FEET = [0, 1, 1, 2, 0, 2]
ATLAS_COEFFICIENTS = (
    Fraction(233520143876274504789, 242177763763360000),
    Fraction(7255016240942576514134370463827, 34830199726657445888000000),
    Fraction(-6135855545804589799118335658802661631, 445826556501215307366400000000),
    Fraction(-815801522057339831032333444255677424613211, 365221115085795579794554880000000),
    Fraction(2893043016821964206280419999396021687312902961, 584353784137272927671287808000000000),
)


def _triangle(d12, d13, d23):
    x = (d12**2 + d13**2 - d23**2) / (2.0 * d12)
    return np.array([[0.0, 0.0, 0.0], [d12, 0.0, 0.0], [x, np.sqrt(d13**2 - x**2), 0.0]])


def test_a_published_platform_with_four_real_postures():
    corners = _triangle(*ATLAS_SIDES)
    platform = gsp.Design(SIX, ATLAS_BASE[ATLAS_FEET], corners[[0, 0, 1, 1, 2, 2]])
    modes = gsp.assembly_modes(platform, ATLAS_LENGTHS, certify=True)
    assert (modes.status, modes.n_complex, len(modes.residual)) == ("found", 16, 4)
    assert modes.certified.all()
    assert modes.residual.max() < 1e-13
    # As printed: the first vertex has x = −2/5.
    np.testing.assert_allclose(modes.poses.position[:, 0], -0.4)
    # In pairs that are mirror images in the plane of the base.
    mirror = np.diag([1.0, 1.0, -1.0])
    for position, rotation in zip(modes.poses.position, modes.poses.rotation, strict=True):
        assert apart(modes, gsp.Pose(mirror @ position, mirror @ rotation @ mirror)).min() < 1e-12
    # The heights of the third vertex of all 16 complex solutions have the printed polynomial.
    system, start = centred(platform), start_of(tuple(SIX), 40)
    values = system.joints_from(np.array(ATLAS_LENGTHS))
    target = np.ascontiguousarray(parameters_from(system, values))
    ends = ends_of(start, target, 40)
    poses = ends.poses[~ends.singular]
    size, (base, top) = system.frame[0], system.frame[1:].reshape(2, 3)
    heights = poses[:, 6] * size + base[2] + (rotations(poses) @ (corners[2] - top))[:, 2]
    polynomial = np.poly(heights)
    np.testing.assert_allclose(polynomial[1::2], 0.0, atol=1e-9 * np.abs(heights).max() ** 15)
    for place, printed in enumerate(ATLAS_COEFFICIENTS):
        assert polynomial[2 * place + 2] == pytest.approx(float(printed), rel=1e-10)


def test_the_four_real_postures_are_counted_without_polynomials():
    """Each vertex is on a circle about a side of the base.

    For an angle of the first, two places each of the others are at their distance from it, and
    their distance from each other has its value at as many angles as there are postures.
    """
    sides, circles = ATLAS_SIDES, []
    for vertex in range(3):
        first, second = ATLAS_BASE[ATLAS_FEET[2 * vertex : 2 * vertex + 2]]
        one, two = ATLAS_LENGTHS[2 * vertex : 2 * vertex + 2]
        span = np.linalg.norm(second - first)
        axis = (second - first) / span
        along = (one**2 - two**2 + span**2) / (2.0 * span)
        across = np.cross([0.0, 0.0, 1.0], axis)
        circles.append((first + along * axis, across, np.sqrt(one**2 - along**2)))
    up, angles = np.array([0.0, 0.0, 1.0]), np.linspace(-np.pi, np.pi, 20_001)

    def on(circle, angle):
        centre, across, radius = circle
        return centre + radius * (np.cos(angle)[..., None] * across + np.sin(angle)[..., None] * up)

    def at_distance(circle, points, distance):
        """Both angles at which a circle is at a distance from points: c cos + s sin = k."""
        centre, across, radius = circle
        from_points = centre - points
        c, s = 2.0 * radius * from_points @ across, 2.0 * radius * from_points @ up
        k = distance**2 - radius**2 - (from_points**2).sum(axis=-1)
        with np.errstate(invalid="ignore"):
            half = np.arccos(k / np.hypot(c, s))
        return np.arctan2(s, c) + np.stack((half, -half))

    points = on(circles[0], angles)
    second, third = (
        on(circle, at_distance(circle, points, side))
        for circle, side in zip(circles[1:], sides[:2], strict=True)
    )
    postures = 0
    for a in second:
        for b in third:
            excess = np.linalg.norm(a - b, axis=-1) - sides[2]
            postures += (excess[1:] * excess[:-1] < 0.0).sum()
    assert postures == 4


def test_six_sps_legs_have_forty_modes():
    rng = np.random.default_rng(3)
    designs = count(15, 1000)
    for i in range(designs):
        design = gsp.Design(SIX, rng.standard_normal((6, 3)), rng.standard_normal((6, 3)))
        proven = designs == 1000 or i < 3
        modes = gsp.assembly_modes(design, design.at(POSE).joints, certify=proven)
        assert (modes.status, modes.n_complex) == ("found", 40)
        assert modes.certified.all() == proven
        assert apart(modes, POSE).min() < 1e-7
        assert modes.residual.max() < 1e-12
        # Complex solutions come in pairs.
        assert len(modes.residual) % 2 == 0


def test_known_numbers_of_special_platforms():
    """Planar: 40; 6–5: 40; 6–4: 32; 6–3 and octahedral 3–3: 16. Modes of planar ones in pairs."""
    rng = np.random.default_rng(5)
    flat = [1.0, 1.0, 0.0]
    a, b = rng.standard_normal((2, 6, 3))
    pairs = [[0, 0, 2, 3, 4, 5], [0, 0, 2, 2, 4, 5], [0, 0, 2, 2, 4, 4]]
    cases = [
        (a * flat, b * flat, 40),
        *((a, b[p], n) for p, n in zip(pairs, (40, 32, 16), strict=True)),
        (a[[0, 2, 2, 4, 4, 0]], b[pairs[2]], 16),
    ]
    for base, platform, expected in cases:
        design = gsp.Design(SIX, base, platform)
        modes = gsp.assembly_modes(design, design.at(POSE).joints)
        assert (modes.n_complex, modes.n_paths) == (expected, 40)
        assert modes.status == "found"
        assert numbers(modes)
        assert apart(modes, POSE).min() < 1e-7
    # Mirrored in the plane of the base: z changes its sign, and the platform turns over.
    design = gsp.Design(SIX, a * flat, b * flat)
    modes = gsp.assembly_modes(design, design.at(POSE).joints)
    mirror = np.diag([1.0, 1.0, -1.0])
    for position, rotation in zip(modes.poses.position, modes.poses.rotation, strict=True):
        assert apart(modes, gsp.Pose(mirror @ position, mirror @ rotation @ mirror)).min() < 1e-9


# Short form: small numbers of solutions, all constraints, shared lines.
FEW = ("D1^3 A1^3", "D1^4 A1^2", "D1^2 D4 A1^3", "D1 D2 D3 A1^3")


@pytest.mark.parametrize("name", FEW)
def test_the_known_pose_is_among_the_modes(name):
    _known_pose(mechanism(name), np.random.default_rng(2), count(3, 50))


def test_the_known_pose_is_among_the_modes_of_all_mechanisms():
    """In full 100,035 pairs of a design and a pose, which take days."""
    names = ("D1^5 A1", "D1^3 D3 A1^2")
    for chosen in mechanisms() if count(1, 2) == 2 else map(mechanism, names):
        _known_pose(chosen, np.random.default_rng(4), count(1, 513))


def _known_pose(chosen, rng, times):
    number, incomplete = confirmed_counts().get(chosen.name), 0
    for _ in range(times):
        design = random_design(rng, [leg.name for leg in chosen.legs])
        pose = random_pose(rng)
        modes = gsp.assembly_modes(design, design.at(pose).joints)
        if modes.n_lost:  # which the status states
            assert modes.status == "incomplete"
            incomplete += 1
            continue
        assert modes.status == "found"
        assert modes.n_paths == modes.n_complex == (number or modes.n_complex)
        assert apart(modes, pose).min() < 1e-6
        assert modes.residual.max() < 1e-12
    assert incomplete <= 0.05 * times


@pytest.mark.parametrize("share", [1e-3, 1e-5])
def test_joints_near_the_ends_of_their_range_are_met_as_exactly(share):
    """Cosines near 1 and squares near 0 have larger errors as angles and distances."""
    rng = np.random.default_rng(5)
    pose = random_pose(rng)
    design = random_design(rng, ["D1"] * 5 + ["A1"])
    lines = np.array(design.base_directions)
    lines[5] = pose.rotation @ design.platform_directions[5] + share * np.array([1.0, 0.3, -0.2])
    nearly_parallel = design.replace(base_directions=lines)
    design = random_design(rng, SIX)
    points = np.array(design.base_points)
    points[5] = pose.position + pose.rotation @ design.platform_points[5] + share
    nearly_in_contact = design.replace(base_points=points)
    for one in (nearly_parallel, nearly_in_contact):
        joints = one.at(pose).joints
        assert joints[5] < 3.0 * share
        modes = gsp.assembly_modes(one, joints)
        assert (modes.status, modes.n_complex) == ("found", 40)
        assert modes.residual.max() < 1e-13
        assert apart(modes, pose).min() < 1e-10


def test_solutions_that_are_far_away_are_refined():
    """A platform with legs of about 22 sizes, and two complex solutions at 1e5 sizes."""
    rng = np.random.default_rng(31)
    for _ in range(143):
        design = gsp.Design(SIX, rng.standard_normal((6, 3)), rng.standard_normal((6, 3)))
        place = rng.standard_normal(3) * 10 ** rng.uniform(-1, 1.5)
        pose = gsp.Pose(place, Rotation.random(rng=rng).as_matrix())
    joints = design.at(pose).joints
    modes = gsp.assembly_modes(design, joints)
    assert (modes.status, modes.n_complex) == ("found", 40)
    system, start = centred(design), start_of(tuple(SIX), 40)
    target = np.ascontiguousarray(parameters_from(system, system.joints_from(joints)))
    poses = ends_of(start, target, 40).poses
    size = np.abs(poses).max(axis=1)
    assert size.max() > 1e5
    # The residuals with 50 digits, of squared distances; a correction of them that is as small.
    with mpmath.workdps(50):
        for pose in poses[size > 1e4]:
            exact = [mpmath.mpc(x) for x in pose]
            rows = [[mpmath.mpc(x) for x in row] for row in target]
            errors = [residual(FORMS[NUMBER["D1"]], row, exact) for row in rows]
            errors += [sum(x * x for x in exact[:4]) - 1]
            slopes = linear(start.layout, target, pose[None])[1][0]
            step = np.linalg.solve(slopes, np.array([complex(e) for e in errors]))
            assert np.abs(step).max() < 1e-9 * np.abs(pose).max()


def test_legs_in_any_order_and_lines_apart():
    """A design with the angle on a leg of its own has other lines, and its own general system."""
    rng = np.random.default_rng(6)
    for legs in (["A1", "D1", "D4 A1", "D1", "A1"], ["A1", "D1", "D4", "D1", "A1", "A1"]):
        design, pose = random_design(rng, legs), random_pose(rng)
        modes = gsp.assembly_modes(design, design.at(pose).joints)
        assert modes.status == "found"
        assert apart(modes, pose).min() < 1e-6


def test_modes_are_the_same_in_other_units_and_frames():
    rng = np.random.default_rng(8)
    design = random_design(rng, SIX)
    joints = design.at(POSE).joints
    modes = gsp.assembly_modes(design, joints)
    scaled = gsp.assembly_modes(design.scaled(1000.0), 1000.0 * joints)
    np.testing.assert_allclose(
        np.sort(scaled.poses.position[:, 0]), 1000.0 * np.sort(modes.poses.position[:, 0])
    )
    back = gsp.assembly_modes(design.exchanged(), joints)
    assert len(back.residual) == len(modes.residual)


def _same(position, rotation):
    return position, rotation


def _changed(name, design, rng):
    """Points of a design in other frames, order or hand; the order; the map of poses to it."""
    b, p, order = design.base_points, design.platform_points, np.arange(6)
    if name == "frames":
        base, platform = (Rotation.from_rotvec(rng.normal(size=3)).as_matrix() for _ in range(2))
        shift, origin = 3.0 * rng.normal(size=(2, 3))
        points = b @ base.T + shift, (p - origin) @ platform.T
        return points, order, lambda x, r: (base @ (x + r @ origin) + shift, base @ r @ platform.T)
    if name == "order":
        order = rng.permutation(6)
        return (b[order], p[order]), order, _same
    mirror = np.diag([1.0, -1.0, 1.0])
    return (b @ mirror, p @ mirror), order, lambda x, r: (mirror @ x, mirror @ r @ mirror)


@pytest.mark.parametrize("name", ["frames", "order", "mirror"])
def test_modes_and_the_fallback_move_with_frames_order_and_hand(name):
    rng = np.random.default_rng(9)
    design = random_design(rng, SIX)
    (base, platform), order, moved = _changed(name, design, rng)
    other = design.replace(base_points=base, platform_points=platform)
    joints = design.at(POSE).joints
    modes, there = gsp.assembly_modes(design, joints), gsp.assembly_modes(other, joints[order])
    assert len(there.residual) == len(modes.residual) > 1
    assert (there.status, there.n_complex) == (modes.status, modes.n_complex)
    for pose in modes.poses:
        assert apart(there, gsp.Pose(*moved(pose.position, pose.rotation))).min() < 1e-8
    # A guess from which the iteration alone finds no pose.
    far = POSE.position + [2.0, -1.0, 0.5], Rotation.from_rotvec([2.0, 1.5, -1.0]).as_matrix()
    found = gsp.forward(design, joints, gsp.Pose(*far), fallback="modes")
    again = gsp.forward(other, joints[order], gsp.Pose(*moved(*far)), fallback="modes")
    assert found.status == again.status == "nearest mode"
    place, turned = moved(found.pose.position, found.pose.rotation)
    np.testing.assert_allclose(again.pose.position, place, atol=1e-8)
    np.testing.assert_allclose(again.pose.rotation, turned, atol=1e-8)


@pytest.mark.parametrize(("legs", "seed"), [(SIX, 0), (SIX, 7), (["D3"] * 6, 1)])
def test_the_fallback_is_the_same_mode_in_frames_that_are_far_from_the_anchors(legs, seed):
    rng = np.random.default_rng(11 + seed)
    design, shift = _drawn(legs, seed)[0], 2e4 * rng.normal(size=(2, 3))
    joints = design.at(POSE).joints
    turned = Rotation.from_rotvec([2.0, 1.5, -1.0]).as_matrix()
    guess = gsp.Pose(POSE.position + [2.0, -1.0, 0.5], turned)
    found = gsp.forward(design, joints, guess, fallback="modes")
    assert found.status == "nearest mode"
    far = design.replace(
        base_points=design.base_points + shift[0], platform_points=design.platform_points + shift[1]
    )
    moved = gsp.Pose(guess.position + shift[0] - turned @ shift[1], turned)
    again = gsp.forward(far, joints, moved, fallback="modes")
    assert again.status == found.status
    np.testing.assert_allclose(again.pose.rotation, found.pose.rotation, atol=1e-9)
    back = again.pose.position - shift[0] + again.pose.rotation @ shift[1]
    np.testing.assert_allclose(back, found.pose.position, atol=1e-7)


def _drawn(legs, seed):
    """A general design and a pose whose paths come near to each other, or to infinity."""
    rng = np.random.default_rng(seed)
    base, *rest = rng.normal(size=(4, len(legs), 3))
    turn = Rotation.from_quat(rng.normal(size=4)).as_matrix()
    return gsp.Design(legs, 2.0 * base, *rest), gsp.Pose(1.5 * rng.normal(size=3), turn)


@pytest.mark.parametrize("seed", [5001, 5005, 5009])
def test_a_path_that_came_to_a_regular_solution_of_another_is_not_multiple(seed):
    design, pose = _drawn(["D3", "D3", "D4 A1", "A1", "A1"], seed)
    modes = gsp.assembly_modes(design, design.at(pose).joints)
    assert np.linalg.cond(design.at(pose).jacobian) < 1e4
    assert modes.status == ("incomplete" if modes.n_lost else "found")
    assert (modes.n_complex + modes.n_lost, modes.n_singular, modes.n_infinite) == (64, 0, 0)
    assert modes.n_lost or apart(modes, pose).min() < 1e-6
    assert np.isfinite(modes.condition).all()


def test_solutions_of_a_general_design_are_finite():
    """Large poses on the way of a path do not make it one to infinity."""
    design, pose = _drawn(["D1"] * 4 + ["D2", "D3"], 5001)
    joints = design.at(pose).joints
    modes = gsp.assembly_modes(design, joints)
    assert (modes.n_complex + modes.n_lost, modes.n_infinite, modes.n_singular) == (160, 0, 0)
    assert modes.status == ("incomplete" if modes.n_lost else "found")


def test_fewer_known_solutions_than_expected_count_as_lost():
    start = start_of(tuple(SIX), 40)
    rng = np.random.default_rng(3)
    design = gsp.Design(SIX, rng.standard_normal((6, 3)), rng.standard_normal((6, 3)))
    system = centred(design)
    parameters = parameters_from(system, system.joints_from(design.at(POSE).joints))
    few = ends_of(start, parameters, 41)
    assert (len(few.poses), few.lost) == (40, 1)
    all_of_them = ends_of(start, parameters, 40)
    assert (len(all_of_them.poses), all_of_them.lost, all_of_them.excess) == (40, 0, 0)


# --- statuses ---


def test_named_ends():
    lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    for wrong in ([np.nan, 1, 1, 1, 1, 1], [-1.0, 1, 1, 1, 1, 1], [np.inf, 1, 1, 1, 1, 1]):
        assert gsp.assembly_modes(lift, wrong).status == "undefined"
    # No two of them contradict each other, and all solutions are complex.
    far = gsp.assembly_modes(lift, [2.6, 1.7, 1.1, 1.0, 3.0, 3.3])
    assert (far.status, len(far.residual)) == ("found", 0)
    assert far.n_complex > 0
    # Longer by more than the distances of the anchors, at most 4 and 2: no pose, without paths.
    far = gsp.assembly_modes(lift, [1.0, 1.0, 1.0, 1.0, 1.0, 9.0], certify=True)
    assert (far.status, len(far.residual), far.n_paths) == ("impossible", 0, 0)
    turned = random_design(np.random.default_rng(1), ["D1"] * 5 + ["A1"])
    assert gsp.assembly_modes(turned, [4.0] * 6).status == "undefined"
    with pytest.raises(InvalidInput, match="six actuators"):
        gsp.assembly_modes(gsp.Design(["D1"] * 7, np.eye(7, 3), np.eye(7, 3)), np.ones(7))


def test_joint_values_contradict_each_other_beyond_a_triangle_inequality():
    """Legs that are straight behind each other reach just as far as the anchors allow."""
    rng = np.random.default_rng(12)
    base, platform = rng.standard_normal((2, 6, 3))
    for legs in (SIX, ["D1", "D1", "D2", "D3", "D4 A1"]):
        for seed in range(count(20, 2000)):  # joint values of poses never do
            one, pose = _drawn(legs, seed)
            assert not contradict(one, one.at(pose).joints)
    base[1], platform[:2] = base[0] + [3.0, 0.0, 0.0], [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]
    design = gsp.Design(SIX, base, platform)
    # On one line: the platform anchors of two legs at x and x ± 2, those of the base at 0 and 3.
    step, back = 1e-9, np.diag([-1.0, -1.0, 1.0])
    for x, turn, outward in ((-1, back, 1), (6, back, -1), (0.5, np.eye(3), -1)):
        joints = design.at(gsp.Pose(base[0] + [x, 0.0, 0.0], turn)).joints
        assert not contradict(design, joints)
        assert contradict(design, joints + outward * step * np.eye(6)[1])
    # In other units, and far away.
    for factor in (1e-6, 1e6):
        scaled = design.scaled(factor)
        assert contradict(scaled, factor * (joints - step * np.eye(6)[1]))
        assert not contradict(scaled, factor * joints)
    # The distance from a line is no longer than that from a point on it, and may be shorter.
    axes = np.tile([0.0, 0.0, 1.0], (6, 1))
    for names in (["D1", "D2"], ["D2", "D1"], ["D2", "D2"]):
        lines = gsp.Design([*names, *["A1"] * 4], base, platform, axes, axes)
        for values in ([1.0, 7.0], [7.0, 1.0]):
            shorter_is_of_points = names[int(np.argmin(values))] == "D1"
            wrong = np.array([*values, *np.ones(4)])
            assert contradict(lines, wrong) == shorter_is_of_points


@pytest.mark.parametrize(
    "name", some(["lee-2000-3-3", "dehaeze-cubic-centred", "rubin-m2-hexapod"], 2)
)
def test_other_general_systems_lead_to_the_same_modes(name):
    """The system from which paths start is random: two others give the same real poses."""
    design = gsp.catalogue.design(name)
    joints = design.at(design.home).joints
    first, second = (gsp.assembly_modes(design, joints) for _ in range(2))
    assert np.array_equal(first.poses.position, second.poses.position)
    system = centred(design)
    start = start_of(tuple(SIX), None)
    target = np.ascontiguousarray(parameters_from(system, system.joints_from(joints)))
    found = [start, *(other_system(start, seed) for seed in (0, 1))]
    everything = [ends_of(one, target) for one in found]
    heights = [
        np.sort(real_poses(one.layout, target, ends)[0][:, 6])
        for one, ends in zip(found, everything, strict=True)
    ]
    for ends, height in zip(everything[1:], heights[1:], strict=True):
        assert (~ends.singular).sum() == (~everything[0].singular).sum()
        assert ends.moving == everything[0].moving
        if not ends.moving:
            assert height == pytest.approx(heights[0], abs=1e-9)
        else:
            assert len(height) == len(heights[0])


def test_motions_of_many_singular_solutions_are_decided_together():
    """Each alone took 0.1 s, and degenerate joint values have hundreds of them."""
    design = gsp.catalogue.design("dehaeze-cubic-centred")
    system = centred(design)
    start = start_of(tuple(SIX), None)
    values = system.joints_from(design.at(design.home).joints)
    target = np.ascontiguousarray(parameters_from(system, values))
    ends = ends_of(start, target)
    singular = ends.poses[ends.singular]
    alone = [moves(start.layout, target, pose[None]) for pose in singular]
    assert len(singular) > 3
    assert any(alone)
    assert moves(start.layout, target, singular)
    assert not moves(start.layout, target, singular[:0])


def test_self_motions_are_recognised():
    """Equal hexagons with equal legs translate on a circle; a Griffis–Duffy platform moves too."""
    angle = np.arange(6) * np.pi / 3
    ring = np.stack((np.cos(angle), 0.7 * np.sin(angle), 0 * angle), axis=1)
    assert gsp.assembly_modes(gsp.Design(SIX, ring, ring), [1.2] * 6).status == "moving"
    ring[:, 1] /= 0.7  # regular hexagons
    assert gsp.assembly_modes(gsp.Design(SIX, ring, ring), [1.2] * 6).status == "moving"
    corners = np.array([[0, 0, 0], [2, 0, 0], [1, np.sqrt(3), 0]])
    base = np.stack((corners, (corners + np.roll(corners, -1, axis=0)) / 2), axis=1).reshape(6, 3)
    platform = gsp.Design(SIX, base, 0.6 * np.roll(base, 3, axis=0))
    joints = platform.at(gsp.Pose([0.0, 0.0, 1.0])).joints
    assert gsp.assembly_modes(platform, joints).status == "moving"
    # Two equal legs: every solution lies on a curve, and none is regular.
    rng = np.random.default_rng(0)
    base, anchors = rng.standard_normal((2, 6, 3))[:, [0, 1, 2, 3, 4, 4]]
    twice = gsp.Design(SIX, base, anchors)
    modes = gsp.assembly_modes(twice, twice.at(POSE).joints)
    assert (modes.status, modes.n_complex) == ("moving", 0)
    assert numbers(modes)
    # Three equal legs: two freedoms, and all solutions are on complex surfaces.
    base, anchors = rng.standard_normal((2, 6, 3))[:, [0, 1, 2, 3, 3, 3]]
    thrice = gsp.Design(SIX, base, anchors)
    for place in ([0.0, 0.0, 1.0], [3.0, -8.0, 9.0]):
        joints = thrice.at(gsp.Pose(place, POSE.rotation)).joints
        assert gsp.assembly_modes(thrice, joints).status in ("moving", "incomplete")


def test_regular_solutions_are_not_searched_for_motions(monkeypatch):
    """That took five times as long as all the rest."""

    def refused(*_):
        raise AssertionError("no solution is multiple")

    monkeypatch.setattr("gsp.kinematics.modes.ends.returned", refused)
    assert gsp.assembly_modes(DIETMAIER, LENGTHS).status == "found"


def _griffis_duffy(change, seed):
    """A moving platform whose base anchors are changed, and its joint values."""
    corners = 2.0 * np.array([[1, 0, 0], [-0.5, np.sqrt(0.75), 0], [-0.5, -np.sqrt(0.75), 0]])
    ring = np.stack((corners, (corners + np.roll(corners, -1, axis=0)) / 2), axis=1).reshape(6, 3)
    base = ring + change * np.random.default_rng(seed).normal(size=(6, 3))
    design = gsp.Design(SIX, base, np.roll(ring, 1, axis=0))
    return design, design.at(gsp.Pose([0.0, 0.0, 1.1])).joints


@pytest.mark.parametrize("seed", range(count(2, 20)))
def test_a_platform_that_nearly_moves_is_not_said_to_move(seed):
    assert gsp.assembly_modes(*_griffis_duffy(1e-13, seed)).status == "moving"
    for change in (1e-7, 3e-7, 1e-6):
        assert gsp.assembly_modes(*_griffis_duffy(change, seed)).status != "moving"
    modes = gsp.assembly_modes(*_griffis_duffy(1e-5, seed), certify=True)
    assert modes.status in ("found", "multiple")
    assert modes.n_complex + modes.n_singular == 40
    assert modes.certified.sum() >= 0.8 * len(modes.side)


@pytest.mark.parametrize("seed", range(count(3, 30)))
def test_a_curve_of_complex_solutions_is_no_motion(seed):
    """Parallel legs keep squared lengths along (ε, iε, 0); the conditions of second order have
    no real solution, so the pose is isolated."""
    rng = np.random.default_rng(seed)
    base, lengths = rng.normal(size=(6, 3)), rng.uniform(0.8, 2.0, 6)
    design = gsp.Design(SIX, base, base + lengths[:, None] * [0.0, 0.0, 1.0])
    modes = gsp.assembly_modes(design, lengths)
    rows = design.at(gsp.Pose(np.zeros(3))).jacobian
    balance = np.linalg.svd(rows.T)[2][-3:]  # λ with Σ λᵢ $ᵢ = 0
    angles = np.linspace(0.0, np.pi, 91)
    a, b = (x.ravel() for x in np.meshgrid(angles, 2.0 * angles))
    free = np.stack((np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)), axis=1)
    shifts = free[:, None, :2] + free[:, 2, None, None] * np.stack(
        (-base[:, 1], base[:, 0]), axis=1
    )  # of the anchors, across the legs; a translation and a turn about the common direction
    second = ((shifts**2).sum(axis=2) / lengths) @ balance.T
    assert np.abs(second).max(axis=1).min() > 1e-3
    assert modes.status in ("multiple", "incomplete")
    assert 0.0 in modes.side
    assert apart(modes, gsp.Pose(np.zeros(3))).min() < 1e-4


def test_near_a_fold_two_real_modes_become_complex():
    """At a pose where det J = 0 two modes meet: beside it there are two more or two less."""
    rng = np.random.default_rng(3)
    design = gsp.Design(SIX, rng.standard_normal((6, 3)), rng.standard_normal((6, 3)))

    def at(z):
        return gsp.Pose([0.1, 0.2, z], Rotation.from_euler("x", z).as_matrix())

    low, high = 0.3, 2.5
    signs = [np.linalg.det(design.at(at(z)).jacobian) for z in (low, high)]
    assert signs[0] * signs[1] < 0
    for _ in range(60):
        middle = (low + high) / 2
        same = np.linalg.det(design.at(at(middle)).jacobian) * signs[0] > 0
        low, high = (middle, high) if same else (low, middle)
    fold = design.at(at(low))
    normal = np.linalg.svd(fold.jacobian)[0][:, -1]
    two, none = (gsp.assembly_modes(design, fold.joints + e * normal) for e in (1e-6, -1e-6))
    if len(two.residual) < len(none.residual):
        two, none = none, two
    assert (two.n_complex, none.n_complex) == (40, 40)
    assert len(two.residual) == len(none.residual) + 2
    exact = gsp.assembly_modes(design, fold.joints)
    assert exact.status in ("multiple", "found")
    assert apart(exact, at(low)).min() < 1e-5


def _fold(seed):
    """A random platform, joint values of a singular pose of it, and the direction of the fold."""
    rng = np.random.default_rng(seed)
    design = gsp.Design(SIX, *rng.normal(size=(2, 6, 3)))
    pose, twist = gsp.Pose(rng.normal(size=3)), rng.normal(size=6)

    def det(s):
        return float(np.linalg.det(design.at(pose.moved(s * twist)).jacobian))

    steps = np.linspace(0.0, 3.0, 400)
    first = next(i for i in range(399) if det(steps[i]) * det(steps[i + 1]) < 0)
    found = brentq(det, steps[first], steps[first + 1], xtol=1e-16)
    posture = design.at(pose.moved(found * twist))
    return design, posture.joints, np.linalg.svd(posture.jacobian)[0][:, -1]


def _exact_step(design, joints, pose):
    """A Newton step with residuals of 50 digits, 0 at an exact solution."""
    posture = design.at(pose)
    with mpmath.workdps(50):
        turn = mpmath.matrix(pose.rotation.tolist())
        rows = []
        for a, b, d in zip(design.base_points, design.platform_points, joints, strict=True):
            leg = mpmath.matrix(pose.position.tolist()) + turn * mpmath.matrix(b.tolist())
            leg -= mpmath.matrix(a.tolist())
            rows.append(float(mpmath.norm(leg) - mpmath.mpf(float(d))))
    return np.linalg.solve(posture.jacobian, rows)


@pytest.mark.parametrize("seed", range(count(3, 30)))
def test_two_modes_beside_a_fold_are_told_apart(seed):
    """Their distance is a root of that of the joint values; nearer ones are one double mode."""
    design, joints, normal_to_fold = _fold(seed)
    gaps = {}
    for change in (-1e-11, 1e-11, -1e-13, 1e-13, 0.0):
        target = joints + change * normal_to_fold
        modes = gsp.assembly_modes(design, target, certify=True)
        assert (modes.n_complex + modes.n_singular, modes.n_paths) == (40, 40)
        assert modes.multiplicity.sum() == len(modes.side) + (modes.side == 0.0).sum()
        assert not modes.certified[modes.multiplicity > 1].any()
        if change == 0.0:
            assert (modes.status, modes.n_singular) == ("multiple", 2)
            continue
        assert (modes.status, modes.n_complex) == ("found", 40)
        points = np.hstack((modes.poses.position, modes.poses.rotation.reshape(-1, 9)))
        distances = np.abs(points[:, None] - points).max(axis=2) + np.eye(len(points))
        i, j = np.unravel_index(distances.argmin(), distances.shape) if len(points) else (0, 0)
        if not len(points) or distances[i, j] > 1e-3:
            continue
        gaps[change] = distances[i, j]
        assert modes.side[i] * modes.side[j] == -1.0
        # Each is near an exact solution of its own.
        for k in (i, j):
            assert np.abs(_exact_step(design, target, modes.poses[k])).max() < 0.1 * gaps[change]
    # On one side of the fold there are two, on the other none.
    (one, two), ratio = sorted(gaps, key=abs), np.sqrt(100.0)
    assert one * two > 0.0
    assert gaps[two] / gaps[one] == pytest.approx(ratio, rel=0.05)


# A triple solution of a random platform: position, and two columns of the rotation.
CUSP = [0.2926042111179088, 0.7277920858865635, 1.8614506886639526]
CUSP_TURN = [
    [0.999882224633902, 0.004802981863322625, 0.014576289870187713],
    [-0.006598161911926178, 0.9920430498620526, 0.12572609705141144],
    [-0.013856446894610092, -0.1258074663349418, 0.9919579024806644],
]


@pytest.mark.parametrize("shift", [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-2])
def test_beside_a_cusp_the_pose_of_the_joint_values_is_among_the_modes(shift):
    """Three solutions are beside each other there, one of which or all are real."""
    rng = np.random.default_rng(100)
    design = gsp.Design(SIX, rng.normal(size=(6, 3)), 0.7 * rng.normal(size=(6, 3)))
    pose = gsp.Pose(CUSP, CUSP_TURN).moved([0.0, 0.0, shift, 0.0, 0.0, 0.0])
    modes = gsp.assembly_modes(design, design.at(pose).joints)
    assert (modes.status, modes.n_complex, modes.n_paths) == ("found", 40, 40)
    assert apart(modes, pose).min() < (1e-6 if shift < 1e-3 else 1e-9)
    assert len(modes.side) % 2 == 0
    assert modes.residual.max() < 1e-13


@pytest.mark.parametrize("seed", range(count(3, 30)))
def test_platforms_that_lie_in_their_base_plane_have_no_more_solutions_than_others(seed):
    """Three motions are not controlled there; joint values are rounded."""
    rng = np.random.default_rng(seed)
    base, top = np.pad(rng.normal(size=(2, 6, 2)), ((0, 0), (0, 0), (0, 1)))
    lengths = np.linalg.norm(top - base, axis=1) * (1.0 + 3e-14 * rng.normal(size=6))
    modes = gsp.assembly_modes(gsp.Design(SIX, base, top), lengths, certify=True)
    assert modes.n_paths == 40
    assert not modes.certified[modes.multiplicity > 1].any()
    real = int(modes.multiplicity.sum())
    if modes.status != "incomplete":
        assert (modes.n_complex + modes.n_singular - real) % 2 == 0


def _uncontrolled(kind, seed):
    """A platform on whose legs no, two or three twists work: base and platform anchors."""
    rng = np.random.default_rng(seed)
    if kind == "two lines":  # all legs meet both
        lines = rng.normal(size=(2, 2, 3))
        first, second = (a + rng.normal(size=(6, 1)) * b for a, b in lines)
    elif kind == "point":  # all legs meet in it
        first = np.tile(rng.normal(size=3), (6, 1))
        second = first + rng.normal(size=(6, 3))
    else:  # all legs are in a plane
        first, second = np.pad(rng.normal(size=(2, 6, 2)), ((0, 0), (0, 0), (0, 1)))
    along, before = second - first, rng.uniform(0.4, 1.0, (6, 1))
    return first - before * along, first + rng.uniform(0.6, 1.6, (6, 1)) * along


@pytest.mark.parametrize("seed", range(count(2, 40)))
@pytest.mark.parametrize("kind", ["two lines", "point", "plane"])
def test_modes_beside_poses_with_several_uncontrolled_motions(kind, seed):
    """Four to eight solutions are 1e-4 apart there, and each path comes to its own."""
    base, top = _uncontrolled(kind, seed)
    design = gsp.Design(SIX, base, top)
    values = np.linalg.svd(design.at(gsp.Pose(np.zeros(3))).jacobian, compute_uv=False)
    assert (values < 1e-10).sum() >= 2
    rng = np.random.default_rng([seed, 1])
    pose = gsp.Pose(np.zeros(3)).moved(1e-4 * rng.normal(size=6))
    modes = gsp.assembly_modes(design, design.at(pose).joints, certify=True)
    if modes.status != "found":
        assert (kind, seed) == ("plane", 6)  # paths to two solutions are lost
        return
    assert (modes.n_complex, modes.n_paths) == (40, 40)
    assert apart(modes, pose).min() < 1e-7
    assert modes.residual.max() < 1e-12
    assert modes.multiplicity.sum() % 2 == 0


def test_a_solution_is_alone_within_its_clearance():
    """Beside a fold the two solutions are a multiple of it apart, and rounding moves them less."""
    design, joints, normal_to_fold = _fold(0)
    system, start = centred(design), start_of(tuple(SIX), 40)
    for change in (1e-11, -1e-11, 1e-9, -1e-9):
        values = system.joints_from(joints + change * normal_to_fold)
        target = np.ascontiguousarray(parameters_from(system, values))
        poses = ends_of(start, target, 40).poses
        clear = Clearances.of(start.layout, target, poses)
        assert clear.regular.all()
        weak = np.flatnonzero(np.isfinite(clear.distances))
        assert weak.size >= 2
        for i in weak:
            signs = np.sign((poses[:, :4] @ poses[i, :4].conj()).real)[:, None]
            apart_ = np.abs(np.hstack((signs * poses[:, :4], poses[:, 4:])) - poses[i]).max(axis=1)
            nearest = np.delete(apart_, i).min()
            assert clear.rounding[i] < 0.1 * clear.distances[i]
            assert clear.distances[i] * clear.sizes[i] < nearest


def test_other_general_systems_differ_from_the_first():
    start = start_of(tuple(SIX), None)
    systems = [start, *(other_system(start, number) for number in range(3))]
    first = [system.parameters[0, 0] for system in systems]
    assert len(set(first)) == 4


def test_an_odd_number_of_solutions_that_are_not_real_is_incomplete(monkeypatch):
    real = real_poses

    def without_one(*arguments):
        poses, places = real(*arguments)
        return poses[1:], places[1:]

    assert gsp.assembly_modes(DIETMAIER, LENGTHS).status == "found"
    monkeypatch.setattr("gsp.kinematics.modes.modes.real_poses", without_one)
    assert gsp.assembly_modes(DIETMAIER, LENGTHS).status == "incomplete"


# --- certificates ---


def _centres(design, poses):
    """Quaternions and positions in centred frames, as the certificates take them."""
    small = centred(design).pose_from(poses)
    return np.hstack((small.quaternion[:, [3, 0, 1, 2]], small.position))


def test_certificates_are_of_solutions_only():
    modes, lengths = gsp.assembly_modes(DIETMAIER, LENGTHS), np.array(LENGTHS)
    one = _centres(DIETMAIER, modes.poses[:1])
    assert np.isfinite(certified(DIETMAIER, lengths, one)).all()
    for change in (1e-2, 1e-3):
        assert np.isnan(certified(DIETMAIER, lengths, one + change * np.eye(7)[0])).all()
        assert np.isnan(certified(DIETMAIER, lengths, one + change * np.eye(7)[5])).all()
        assert np.isnan(certified(DIETMAIER, lengths + change, one)).all()
    # The same solution twice: their boxes overlap, also as x and −x.
    turned = one * np.repeat([-1.0, 1.0], [4, 3])
    assert np.isnan(certified(DIETMAIER, lengths, np.vstack((one, turned)))).all()


@pytest.mark.parametrize("shift", [1e3, 1e8])
def test_certificates_do_not_depend_on_the_origins_of_the_frames(shift):
    """Dimensions are multiples of 2⁻²⁰, so that they are the same design after the shifts."""
    rng = np.random.default_rng(1)
    base, platform = np.round(2**20 * rng.standard_normal((2, 6, 3))) / 2**20
    design = gsp.Design(SIX, base, platform)
    to_base, to_platform = shift * np.array([[3.0, -1.0, 2.0], [1.0, 2.0, -1.0]])
    far = design.replace(base_points=base + to_base, platform_points=platform + to_platform)
    joints = design.at(POSE).joints
    here, there = (gsp.assembly_modes(one, joints, certify=True) for one in (design, far))
    assert here.certified.all()
    assert there.certified.all()
    assert len(there.radius) == len(here.radius) > 1
    # A box contains a solution of the other design, of which the rotation is the same.
    for turn, radius in zip(there.poses.rotation, there.radius, strict=True):
        apart_by = np.abs(here.poses.rotation - turn).max(axis=(1, 2)).min()
        assert apart_by < 8.0 * (radius + here.radius.max())


def test_modes_of_lines_and_angles_are_certified():
    rng = np.random.default_rng(9)
    design, pose = random_design(rng, ["D1", "D2", "D4 A1", "A1", "A1"]), random_pose(rng)
    modes = gsp.assembly_modes(design, design.at(pose).joints, certify=True)
    assert modes.certified.all()
    assert modes.radius.max() < 1e-6
    assert not gsp.assembly_modes(design, design.at(pose).joints).certified.any()


# --- numbers of complex solutions ---


def test_table_of_root_counts():
    table = root_counts()
    assert list(table) == [m.name for m in mechanisms()]
    assert all(table[m.exchanged().name] == table[m.name] for m in mechanisms())
    assert table["D1^6"] == 40
    assert table["D1 D2^3 D3 A1"] == 512
    assert "D1^6" in confirmed_counts()
    assert "D4^6" not in confirmed_counts()
    # Three angles leave eight rotations: three quadrics in projective space. Of three quadrics in
    # the position, two spheres may be replaced by a sphere and a plane.
    for m in mechanisms():
        if m.group == "3D3A":
            assert table[m.name] == 8 * 8 // 2 ** max(m.counts[0] - 1, 0)


@pytest.mark.parametrize("name", ["D1^6", "D1^3 A1^3", "D1^2 D4 A1^3"])
def test_rows_of_the_table_are_found_again(name):
    row = row_of(mechanism(name), seed=2)
    assert int(row["complex_modes"]) == root_counts()[name]
    assert row["confidence"].startswith("trace test")
    assert text_of([row]).startswith("mechanism,complex_modes,method,confidence\n")


def test_the_trace_test_notices_one_missing_solution():
    start, error, _ = counted(mechanism("D1^5 A1"))
    assert error < TRACE_TOLERANCE
    rng = np.random.default_rng(0)
    assert trace(replace(start, poses=start.poses[1:]), rng) > 100 * TRACE_TOLERANCE


def test_equations_hold_at_poses_of_the_model():
    """With the joint values of a posture the equations vanish, for all kinds of rows."""
    rng = np.random.default_rng(4)
    for legs in (["D1", "D2", "D3", "D4 A1", "A1"], ["D4", "A1", "D2", "D3", "D4", "A1"]):
        design, pose = random_design(rng, legs), random_pose(rng)
        system = centred(design)
        parameters = parameters_from(system, system.joints_from(design.at(pose).joints))
        small = system.pose_from(pose)
        x = Rotation.from_matrix(pose.rotation).as_quat()[[3, 0, 1, 2]]
        error, _ = linear(Layout.of(legs), parameters, np.append(x, small.position)[None])
        assert np.abs(error).max() < 1e-13


def test_each_constraint_has_its_equation():
    assert set(NUMBER) == set(CONSTRAINT)
    assert [NUMBER[form.constraint] for form in FORMS] == list(range(len(FORMS)))


def test_an_unknown_constraint_has_no_equation(monkeypatch):
    """A constraint that is new in the model is not evaluated as another one."""
    d5 = replace(CONSTRAINT["D3"], name="D5")
    leg = replace(LEG["D3"], name="D5", constraints=(d5,))
    monkeypatch.setattr("gsp.kinematics.modes.equations.LEG", {**LEG, "D5": leg})
    with pytest.raises(KeyError, match="D5"):
        Layout.of(["D5"] * 6)


def test_compiled_equations_are_those_of_the_table(monkeypatch):
    """Values, and derivatives against central differences, of each kind of row.

    The functions run without being compiled, which would take seconds.
    """
    from gsp.kinematics.modes import tracking

    for name in ("rotation_of", "_turn", "_dot", "_cross"):
        monkeypatch.setattr(tracking, name, getattr(tracking, name).py_func)
    rng = np.random.default_rng(7)
    kinds = np.arange(6) % (len(FORMS) + 1)
    start, rates, z = (normal(rng, *shape) for shape in ((6, 13), (6, 13), (7,)))
    z[:4] /= np.sqrt((z[:4] ** 2).sum())
    m = np.empty((6, 8), complex)
    tracking.linearise.py_func(kinds, start, rates, z, np.empty(9, complex), m)
    w, v = z[0], z[1:4]

    def moved(j, h):
        """The pose after a small step along a coordinate of the twist, and the parameters."""
        e = np.eye(7)[j] * h
        turn = 0.5 * np.append(-e[3:6] @ v, e[3:6] * w + np.cross(e[3:6], v))
        new = np.append(z[:4] + turn, z[4:] + e[:3])
        new[:4] /= np.sqrt((new[:4] ** 2).sum())
        return new, start + e[6] * rates

    for i, form in enumerate(FORMS):
        np.testing.assert_allclose(m[i, 6], residual(form, start[i], z), rtol=1e-12)
        for j, column in enumerate((0, 1, 2, 3, 4, 5, 7)):
            (one, there), (other, here) = moved(j, 1e-6), moved(j, -1e-6)
            slope = (residual(form, there[i], one) - residual(form, here[i], other)) / 2e-6
            np.testing.assert_allclose(m[i, column], slope, rtol=1e-6, atol=1e-7)
    assert np.isnan(m[len(FORMS), 6:]).all()
