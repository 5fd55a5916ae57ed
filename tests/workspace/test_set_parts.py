"""Cells of free orientation: witnesses that turn with the position, balls, parts, mirrors."""

import numpy as np
import pytest

import gsp
from gsp.limits.legs import segment_distance
from gsp.workspace.sets import dextrous, reachable
from gsp.workspace.sets.compiled import connecting
from gsp.workspace.sets.compiled.gaps import segment_gap
from gsp.workspace.sets.compiled.sums import (
    BASE,
    BEND,
    COUPLING,
    PULL,
    SUM_SCALARS,
    ball,
    radius,
    rise,
)
from gsp.workspace.sets.compiled.witness import covered
from gsp.workspace.sets.problem import bounded
from gsp.workspace.sets.tree.boxes import components, located
from gsp.workspace.sets.tree.cuts import shares, sides
from gsp.workspace.sets.tree.symmetry import mirror_planes
from tests.campaign import count
from tests.interpreted import interpreted
from tests.reference.workspace_samples import product_of_turns, rotations
from tests.reference.workspace_samples import reachable as found_by_samples
from tests.support import random_design, turn


@pytest.fixture
def plain():
    """Run compiled functions that are called alone as plain Python."""
    with interpreted("gsp.workspace.sets.compiled", "gsp.kernels.compiled", __name__):
        yield


def strokes_about(bare, home, wide, rng):
    joints = bare.at(home).joints
    share = rng.uniform(0.5, 1.5, (len(joints), 2)) * wide
    return np.stack((joints * (1 - share[:, 0]), joints * (1 + share[:, 1])), axis=1)


def designs(seed, n, wide):
    """Random hexapods with strokes, and the pose about which their strokes are."""
    rng = np.random.default_rng(seed)
    for _ in range(n):
        bare = random_design(rng, ["D1"] * 6)
        home = gsp.Pose(rng.uniform(-0.3, 0.3, 3) + [0, 0, 1.5], turn(rng.uniform(-1, 1, 3)))
        yield (
            rng,
            home,
            gsp.Design(
                ["D1"] * 6,
                bare.base_points,
                bare.platform_points,
                strokes=strokes_about(bare, home, wide, rng),
            ),
        )


def exact_turn(vectors):
    """Rotations by rotation vectors (n, 3), independent of the library."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(vectors).as_matrix()


@pytest.mark.usefixtures("plain")
@pytest.mark.parametrize("wide", [0.03, 0.1])
def test_witnesses_are_feasible_beyond_their_cut(wide):
    checked, whole = 0, 0
    for rng, home, design in designs(2, 60, wide):
        problem = bounded(design, None, domain=False)
        half = rng.uniform(0.2, 1.0, 3) * wide * rng.choice([0.2, 1.0])
        normal, follows = rng.normal(size=3), rng.normal(size=(3, 3)) * rng.choice([0.0, 0.5])
        r = np.ascontiguousarray(home.rotation.ravel())
        none = np.empty((0, 3))
        c = covered(home.position, half, problem.legs, r, follows, normal, none, follows)
        if c == np.inf:
            continue
        share = rng.uniform(-1, 1, (400, 3))
        share[:8] = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        delta = share * half
        delta = delta[delta @ normal >= c]
        poses = gsp.Pose(home.position + delta, exact_turn(delta @ follows.T) @ home.rotation)
        assert gsp.feasible(design, poses).ok.all()
        checked += len(delta)
        whole += c == -np.inf
    assert checked > 500
    assert whole > 0


@pytest.mark.usefixtures("plain")
@pytest.mark.parametrize("ranged", [False, True])
def test_no_pose_in_a_ball_of_rotations_is_feasible(ranged):
    radii, many = [], count(400, 3000)
    for rng, home, design in designs(3, count(30, 60), 0.05):
        box = gsp.PoseBox([0, 0, 0], [(-0.5, 0.1), (-0.2, 0.4), (0.1, 0.3)]) if ranged else None
        problem = bounded(design, None, rotations=box, domain=False)
        p = home.position + rng.normal(size=3) * 0.3
        half, r = rng.uniform(0.0, 0.1, 3), rotations(rng, 1)[0]
        n = 13 + len(problem.faces)
        room = [np.empty(n), np.empty((n, 6)), np.empty(n), np.empty(6), np.empty(SUM_SCALARS)]
        cut = np.append(rng.normal(size=3), rng.normal() * 0.05)
        cutting = bool(rng.integers(2))
        if ranged:
            r = product_of_turns(box.low[None, 3:] + [[0.0, 0.2, 0.1]], "rpy")[0]
        legs, faces, wide = problem.legs, problem.faces, rng.uniform(0.1, 2.0)
        # Every other search for weights begins with any, as those of another cell.
        warm = len(radii) % 2 == 0
        room[2][:] = np.linspace(0.0, 1.0, n)
        angle = ball(p, half, legs, faces, r.ravel(), wide, -np.inf, cut, cutting, *room, warm)
        if angle <= 0.0:
            continue
        radii.append(angle)
        assert room[-1][BASE] + rise(room[-1], np.sin(angle / 2.0)) < 0.0
        delta = rng.uniform(-1, 1, (many, 3)) * half
        axis = rng.normal(size=(many, 3))
        axis *= (angle * rng.uniform(size=many) ** 0.3 / np.linalg.norm(axis, axis=1))[:, None]
        turned = exact_turn(axis) @ r
        kept = (delta @ cut[:3] <= cut[3]) | (not cutting)
        if ranged:
            # Angles of the range; those of the ball alone are mostly beyond it.
            angles = rng.uniform(box.low[3:], box.high[3:], (many, 3))
            turned = product_of_turns(angles, "rpy")
            trace = np.einsum("kij,ij->k", turned, r)
            kept &= np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0)) <= angle
        poses = gsp.Pose(p + delta[kept], turned[kept])
        assert not gsp.feasible(design, poses).ok.any()
    assert len(radii) > count(15, 30)
    assert max(radii) == np.pi
    assert min(radii) < 1.0


@pytest.mark.usefixtures("plain")
def test_a_sum_rises_by_turns_as_its_formula_does():
    rng = np.random.default_rng(6)
    for _ in range(100):
        out = np.zeros(SUM_SCALARS)
        out[COUPLING], out[PULL], out[BEND] = (
            rng.uniform(0, 2) ** 3,
            rng.uniform(0, 2),
            rng.normal(),
        )
        theta = np.pi * rng.uniform()
        t = np.linspace(0.0, theta, 2001)
        top = (out[PULL] * np.sin(t) + out[BEND] * (1.0 - np.cos(t))).max()
        expected = top + out[COUPLING] * np.sin(theta / 2.0)
        np.testing.assert_allclose(rise(out, np.sin(theta / 2.0)), expected, rtol=1e-5, atol=1e-9)
        out[BASE] = -expected
        # Ten halvings of the sine of half the angle.
        last = np.sin(radius(out) / 2.0)
        assert out[BASE] + rise(out, last) < 1e-9
        assert last == 1.0 or out[BASE] + rise(out, last + 2.0**-10) >= -1e-6


def test_shares_of_cells_are_nearly_those_of_samples():
    rng = np.random.default_rng(4)
    n = 40
    low = rng.normal(size=(n, 3))
    high = low + rng.uniform(0.1, 1.0, (n, 3))
    cuts = np.zeros((n, 8))
    for at in (0, 4):
        flat = rng.choice([0.0, 1e-6, 1.0], (n, 3))
        flat[:, at // 2] = 1.0
        cuts[:, at : at + 3] = rng.normal(size=(n, 3)) * flat
        size = (np.abs(cuts[:, at : at + 3]) * 0.5 * (high - low)).sum(axis=1)
        cuts[:, at + 3] = rng.uniform(-1.2, 1.2, n) * size
    inside, outside = shares(low, high, cuts)
    points = low + rng.uniform(size=(20000, n, 3)) * (high - low)
    delta = points - 0.5 * (low + high)
    beyond = ((delta * cuts[:, :3]).sum(axis=2) <= cuts[:, 3]).mean(axis=0)
    within = ((delta * cuts[:, 4:7]).sum(axis=2) >= cuts[:, 7]).mean(axis=0)
    assert np.abs(outside - beyond).max() < 0.016
    assert np.abs(inside - within).max() < 0.016
    assert (outside <= beyond + 0.015).all()
    assert (inside <= within + 0.015).all()


def test_shares_of_a_plane_through_corners_are_those_of_a_tetrahedron():
    cuts = np.array([[1.0, 1.0, 1.0, -0.5, -1.0, 0.0, 0.0, 0.25]])
    inside, outside = shares(np.zeros((1, 3)), np.ones((1, 3)), cuts)
    assert outside == pytest.approx(1 / 6, abs=1e-8)
    assert inside == pytest.approx(1 / 4, abs=1e-8)


def test_parts_of_undecided_cells_agree_with_samples():
    design = gsp.catalogue.design("workspace-6-3")
    region = reachable(design, budget=150_000, progress=False)
    assert region.volume[0] > 0.0
    rng = np.random.default_rng(6)
    open_ = np.flatnonzero(region.codes == 0)
    inside, outside = shares(region.low[open_], region.high[open_], region.cuts[open_])
    for part, code in ((inside, 1), (outside, -1)):
        cells = rng.choice(open_[part > 0.2], 30)
        points = rng.uniform(region.low[cells], region.high[cells])
        of = sides(points, region.low[cells], region.high[cells], region.cuts[cells])
        found = found_by_samples(
            design, points[of == code], *design.strokes.T, rng, starts=100, rounds=40
        )
        assert len(found) > 5
        # The search by samples may miss a rotation, but never finds one that is none.
        assert found.mean() > 0.9 if code == 1 else not found.any()


@pytest.mark.parametrize(("n", "d"), [(1, 2), (40, 2), (300, 3), (200, 5)])
def test_parts_are_those_of_every_pair_of_boxes(n, d):
    """Boxes on a grid, so that many touch in faces, edges and corners; half of the axes repeat."""
    rng = np.random.default_rng(n + d)
    turn = np.where(np.arange(d) % 2, 8.0, 0.0)
    low = rng.integers(0, 8, (n, d)) + np.where(turn, rng.integers(-1, 2, (n, d)) * turn, 0.0)
    high = low + 0.5 ** rng.integers(0, 3, (n, d))
    gap = np.maximum(low[:, None] - high, low - high[:, None])
    for k in np.flatnonzero(turn):
        shifts = 8.0 * np.arange(-3, 4)[:, None, None]
        one = low[:, None, k] - high[:, k] + shifts
        two = low[:, k] - high[:, None, k] - shifts
        gap[..., k] = np.maximum(one, two).min(axis=0)
    touch = (gap <= 0.0).all(axis=-1)
    number = np.arange(n)
    for _ in range(n):
        number = np.where(touch, number, n).min(axis=1)
    expected = np.unique(number, return_inverse=True)[1]
    assert components(low, high, turn).tolist() == expected.tolist()
    # Without numba's cache each process compiles it, which takes longer than most regions.
    assert connecting.connect.stats.cache_path
    assert n == 1 or 1 < len(set(expected)) < n


def test_mirror_planes_of_symmetric_designs():
    six_three = gsp.catalogue.design("workspace-6-3")
    assert mirror_planes(bounded(six_three, None)) == [(1, 0.0), (2, 0.0)]
    uneven = six_three.strokes.copy()
    uneven[1, 1] += 1.0
    assert mirror_planes(bounded(six_three, gsp.Limits(strokes=uneven))) == [(2, 0.0)]
    raised = gsp.Limits(position=[None, None, (0, None)])
    assert mirror_planes(bounded(six_three, raised)) == [(1, 0.0)]
    some = gsp.PoseBox([0, 0, 0], [0, 0, (-10, 10)], degrees=True)
    assert mirror_planes(bounded(six_three, None, None, some)) == []
    for _, _, design in designs(5, 3, 0.1):
        assert mirror_planes(bounded(design, None)) == []


def test_regions_are_mirrored():
    design = gsp.catalogue.design("workspace-6-3")
    region = reachable(design, budget=40_000, progress=False)
    rng = np.random.default_rng(8)
    points = rng.uniform(*region.domain, (60, 3))
    codes = region.contains(points)
    for sign in ([1, -1, 1], [1, 1, -1]):
        other = region.contains(points * sign)
        assert (codes * other >= 0).all()
    assert {1, -1} <= set(codes.tolist())


@pytest.mark.parametrize("order", ["rpy", "approach-roll"])
def test_dextrous_points_keep_sampled_rotations_and_others_do_not(order):
    """Both by a fine grid of rotations, with the joint values alone."""
    inside, outside = 0, 0
    for rng, home, design in designs(9, count(3, 6), 0.25):
        angles = home.angles(order=order)
        wide = rng.uniform(0.02, 0.15, 3)
        box = gsp.PoseBox(
            [0, 0, 0], [(a - w, a + w) for a, w in zip(angles, wide, strict=True)], order=order
        )
        region = dextrous(design, box, budget=150_000, progress=False)
        points = home.position + rng.uniform(-0.4, 0.4, (60, 3))
        if not region.empty:
            chosen = rng.integers(0, len(region.low), 60)
            near = rng.uniform(region.low[chosen], region.high[chosen])
            points = np.concatenate((points, near))
        codes = region.contains(points)
        share = np.linspace(-1, 1, 9)
        grid = np.stack(np.meshgrid(share, share, share), axis=-1).reshape(-1, 3)
        turns = gsp.Pose.from_angles(np.zeros(3), angles + grid * wide, order=order).rotation
        low, high = design.strokes.T
        for point, code in zip(points, codes, strict=True):
            at = np.repeat(point[None], len(turns), axis=0)
            joints = design.at(gsp.Pose(at, turns)).joints
            beyond = np.maximum(low - joints, joints - high).max()
            if code == 1:
                assert beyond <= 0.0
            if code == -1:
                # The grid misses the worst rotation by little.
                assert beyond > -0.01
        inside, outside = inside + (codes == 1).sum(), outside + (codes == -1).sum()
    assert inside > 30
    assert outside > 30


def test_parts_of_dextrous_cells_hold_at_samples():
    design = gsp.catalogue.design("workspace-6-3")
    box = gsp.PoseBox([0, 0, 0], [(-20, 20)] * 3, degrees=True)
    region = dextrous(design, box, budget=300_000, progress=False)
    assert region.volume[0] > 0.0
    rng = np.random.default_rng(10)
    angles = np.deg2rad(rng.uniform(-20, 20, (2000, 3)))
    angles[:1000] = np.deg2rad(rng.choice([-20.0, 20.0], (1000, 3)))
    turns = gsp.Pose.from_rpy(np.zeros(3), angles).rotation
    open_ = np.flatnonzero(region.codes == 0)
    parts, _ = shares(region.low[open_], region.high[open_], region.cuts[open_])
    cells = rng.choice(open_[parts > 0.1], 40)
    points = rng.uniform(region.low[cells], region.high[cells])
    of = sides(points, region.low[cells], region.high[cells], region.cuts[cells])
    assert (of == 1).sum() > 5
    for point in points[of == 1]:
        poses = gsp.Pose(np.repeat(point[None], 2000, axis=0), turns)
        assert gsp.feasible(design, poses).ok.all()


@pytest.mark.parametrize("depth", [5, 15, 19, 20])
def test_points_are_found_in_cells_of_any_depth(depth):
    rng = np.random.default_rng(depth)
    domain = np.array([[-8484.30231069, -46930.13008647], [41886.75383848, 12682.57280823]])
    side = (domain[1] - domain[0]) / 2.0**depth
    numbers = rng.integers(0, 2**depth, (200, 2))
    numbers[0] = 2**depth - 1
    low = domain[0] + numbers * side
    codes = np.ones(200, dtype=np.int8)
    points = low + rng.uniform(0.01, 0.99, (200, 2)) * side
    assert (located(points, low, low + side, codes, domain) == 1).all()


def pairs_of_segments(rng):
    """Start and vector of pairs of segments: random, parallel, collinear, touching, points."""
    p, u, q, v = rng.normal(size=(4, 3))
    share, other = rng.uniform(-1.5, 1.5, 2)
    return {
        "random": (p, u, q, v),
        "parallel": (p, u, q, share * u),
        "collinear": (p, u, p + other * u, share * u),
        "touching at ends": (p, u, p + u, v),
        "touching within": (p, u, p + 0.3 * u - 0.6 * v, v),
        "point and segment": (p, 0.0 * u, q, v),
        "point on segment": (p, u, p + 0.4 * u, 0.0 * v),
        "two points": (p, 0.0 * u, q, 0.0 * v),
        "nearly parallel": (p, u, q, share * u + 1e-9 * v),
        "large": (1e9 * p, 1e9 * u, 1e9 * q, 1e9 * v),
    }


def test_the_compiled_distance_of_segments_is_that_of_limits():
    rng = np.random.default_rng(8)
    for _ in range(100):
        for kind, (p, u, q, v) in pairs_of_segments(rng).items():
            sine = np.linalg.norm(np.cross(u, v)) / max(np.sqrt((u @ u) * (v @ v)), 1e-300)
            # Where lines are nearest is known to rounding / sine²; beyond 1e-7 ends are compared.
            error = 4e-15 * np.abs((p, u, q, v)).max() / (sine**2 if sine > 1e-7 else 1.0)
            found = segment_gap(p, p + u, q, q + v)
            assert abs(found - segment_distance(p, u, q, v)) < error, kind
            swapped = segment_gap(q + v, q, p, p + u)  # the order of legs and ends is arbitrary
            assert abs(found - swapped) < error, kind
