"""Statements of an index's record about the six properties; the negative ones by example.

What motions, similarities and units do to the values is in tests/test_metamorphic.py.
"""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import gsp
from gsp.families import nawratil
from gsp.indices import INDICES
from tests.indices import nawratil_cases as cases

ALL = list(INDICES.values())


def having(flag, wanted):
    chosen = [i for i in ALL if getattr(i.properties, flag) is wanted]
    return pytest.mark.parametrize("index", chosen, ids=[i.name for i in chosen])


def usual(index):
    return [p for p in cases.postures() if cases.applies(index, p.design)]


def test_no_index_denies_the_first_property():
    assert all(i.properties.non_negative for i in ALL)


@having("non_negative", True)
def test_merits_are_not_negative(index):
    rng = np.random.default_rng(3)
    design, _ = cases.hexapod(rng)
    pose = gsp.Pose.from_rpy(rng.normal(size=(300, 3)), rng.uniform(-3, 3, size=(300, 3)))
    assert (cases.merit(index, design.at(pose)) >= 0).all()


@having("zero_iff_singular", True)
def test_merit_is_zero_at_singular_postures_and_only_there(index):
    flat = nawratil.example_design(0.2).at(nawratil.example_pose(0.0))
    parallel = cases.singular_everywhere_alike()
    turn, shift = cases.singular_by_a_turn(), cases.singular_by_a_translation()
    for posture in (turn, shift, flat, parallel):
        assert posture.singular()
        assert cases.merit(index, posture) == pytest.approx(0.0, abs=1e-12)
    for posture in usual(index):
        assert not posture.singular()
        assert cases.merit(index, posture) > 1e-6


@having("zero_iff_singular", False)
def test_merit_is_not_zero_at_some_singular_posture(index):
    turn, shift = cases.singular_by_a_turn(), cases.singular_by_a_translation()
    assert max(cases.merit(index, turn), cases.merit(index, shift)) > 0.1


def test_each_of_the_two_deviations_vanishes_at_its_own_singularities():
    turn, shift = cases.singular_by_a_turn(), cases.singular_by_a_translation()
    assert gsp.indices.complex_deviation_rotation(turn) == pytest.approx(0.0, abs=1e-14)
    assert gsp.indices.complex_deviation_translation(shift) == 0.0
    assert gsp.indices.complex_deviation_rotation(shift) > 0.1
    assert gsp.indices.complex_deviation_translation(turn) > 0.1


# --- geometric meaning: the same number from motions of points and legs, by differences ---------

H = 1e-5


def by_differences(posture, function):
    """Rates of function(posture) in the six unit twists, by central differences: (m, 6)."""
    design, pose = posture.design, posture.pose
    columns = []
    for twist in np.eye(6):
        at = []
        for h in (H, -H):
            xyzw = [*(np.sin(h / 2) * twist[3:]), np.cos(h / 2)]
            turn = gsp.Pose.from_quaternion([0, 0, 0], xyzw).rotation
            at.append(gsp.Pose(pose.position + h * twist[:3], turn @ pose.rotation))
        up, down = (np.ravel(function(design.at(p))) for p in at)
        columns.append((up - down) / (2 * H))
    return np.stack(columns, axis=1)


def ratio(posture, function):
    """Least and greatest |rates of function| over motions with unit leg rates: their ratio."""
    rates = by_differences(posture, lambda p: p.joints)
    speeds = by_differences(posture, function)
    inverse = np.linalg.pinv(rates) if rates.shape[0] == 6 else None
    if inverse is None:  # redundant: parametrise the possible leg rates by an orthonormal basis
        inverse = np.linalg.inv(np.linalg.qr(rates)[1])
    values = np.linalg.svd(speeds @ inverse, compute_uv=False)
    return values[5] / values[0]


def platform_points(points):
    return lambda p: p.pose.position + points @ p.pose.rotation.T


def sphere(length):
    radius = np.sqrt(1.5) * length
    return gsp.Ellipsoid(radius).vertices


def leg_directions(p):
    """Unit vectors of the legs seen from the base and from the platform."""
    u = p.lines.d / np.linalg.norm(p.lines.d, axis=-1, keepdims=True)
    return np.concatenate((u, u @ p.pose.rotation))


def seen_condition_number(p, length):
    return 1 / ratio(p, platform_points(sphere(length)))


def seen_minimum(p, length):
    """Least norm of leg rates over motions of unit rms speed of the sphere's vertices."""
    rates = by_differences(p, lambda q: q.joints)
    speeds = by_differences(p, platform_points(sphere(length))) / np.sqrt(6.0)
    return np.linalg.svd(rates @ np.linalg.inv(np.linalg.qr(speeds)[1]), compute_uv=False)[-1]


def seen_ellipsoid(p, ellipsoid):
    return 1 / ratio(p, platform_points(ellipsoid.vertices))


def seen_points(p):
    from gsp.indices.cdn_points import largest_triangles

    return 1 / ratio(p, platform_points(largest_triangles(p.design)[0]))


def seen_control(p):
    return ratio(p, leg_directions)


def seen_rotation(p):
    """Least leg rates over screws with unit angular velocity, by elimination with lstsq."""
    from scipy.optimize import minimize

    rates = by_differences(p, lambda q: q.joints)

    def deviation(x):
        w = np.array([np.sin(x[0]) * np.cos(x[1]), np.sin(x[0]) * np.sin(x[1]), np.cos(x[0])])
        best = np.linalg.lstsq(rates[:, :3], -rates[:, 3:] @ w, rcond=None)[0]
        return np.linalg.norm(rates[:, :3] @ best + rates[:, 3:] @ w)

    starts = [(a, b) for a in (0.4, 1.2, 2.2) for b in (0.3, 1.4, 2.5, 4.0)]
    tight = {"xatol": 1e-9, "fatol": 1e-13}
    return min(minimize(deviation, s, method="Nelder-Mead", options=tight).fun for s in starts)


def seen_translation(p):
    u = leg_directions(p)[: p.design.n_legs]
    grid = np.random.default_rng(0).normal(size=(200_000, 3))
    grid /= np.linalg.norm(grid, axis=1, keepdims=True)
    return np.sqrt(((grid @ u.T) ** 2).sum(axis=1)).min()


def seen_rigidity(p):
    """Turn and growth of a platform that keeps its leg lengths, by differences in seven twists."""
    d = p.lines.d

    def grown(h):
        return np.linalg.norm(d + h * p.lines.arm, axis=-1)

    growth = (grown(H) - grown(-H)) / (2 * H)
    motion = np.linalg.solve(by_differences(p, lambda q: q.joints), -growth)
    return np.arctan2(1.0, np.linalg.norm(motion[3:]))


def seen_stiffness(axis):
    """Least sum of the squared leg rates over motions of unit speed along an axis of the base."""

    def least(p):
        rates = by_differences(p, lambda q: q.joints)
        others = np.delete(rates, axis, axis=1)
        rest = np.linalg.lstsq(others, -rates[:, axis], rcond=None)[0]
        return ((rates[:, axis] + others @ rest) ** 2).sum()

    return least


def seen_conditioning(p, length):
    return 1.0 / seen_condition_number(p, length)


FROM_MOTIONS = {
    "local_conditioning": (seen_conditioning, 1e-6),
    "condition_number": (seen_condition_number, 1e-6),
    "condition_number_ellipsoid": (seen_ellipsoid, 1e-6),
    "control_number": (seen_control, 1e-6),
    "minimum_singular_value": (seen_minimum, 1e-6),
    "condition_number_points": (seen_points, 1e-6),
    "complex_deviation_rotation": (seen_rotation, 1e-6),
    "complex_deviation_translation": (seen_translation, 2e-3),
    "rigidity_rate": (seen_rigidity, 1e-6),
    **{f"stiffness_{'xyz'[i]}": (seen_stiffness(i), 1e-6) for i in range(3)},
}


@having("geometric", True)
def test_value_is_seen_in_motions_of_the_mechanism(index):
    seen, tolerance = FROM_MOTIONS[index.name]
    ups = [p for p in usual(index) if {leg.name for leg in p.design.legs} == {"D1"}]
    assert ups
    for posture in ups:
        given = cases.parameters(index, posture.design)
        assert seen(posture, **given) == pytest.approx(
            float(cases.value(index, posture)), rel=tolerance
        )


def test_the_determinant_is_the_volume_of_a_framework_for_special_designs_only():
    """Lee's octahedron (platform sides a, base sides 2a, height a) against K+."""

    def volume_and_determinant(posture):
        base = posture.design.base_points
        platform = posture.pose.position + posture.lines.arm
        hull = ConvexHull(np.unique(np.concatenate((base, platform)).round(12), axis=0))
        return hull.volume, float(gsp.indices.manipulability(posture))

    def triangle(side, turn):
        angle = np.arange(3) * 2 * np.pi / 3 + turn
        return side / np.sqrt(3) * np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)

    base, platform = triangle(2.0, 0.0), triangle(1.0, np.pi / 3)
    octahedron = gsp.Design(["D1"] * 6, np.repeat(base, 2, axis=0), platform[[0, 2, 1, 0, 2, 1]])
    volume, determinant = volume_and_determinant(octahedron.at(gsp.Pose([0, 0, 1.0])))
    assert determinant == pytest.approx(3 * np.sqrt(3) / 4, rel=1e-12)
    assert volume == pytest.approx(determinant, rel=1e-9)
    best = nawratil.example_design(nawratil.BEST_ALPHA)
    volume, determinant = volume_and_determinant(best.at(nawratil.example_pose(nawratil.BEST_H)))
    assert abs(volume - determinant) > 0.1 * determinant


@having("real_time", True)
def test_a_posture_costs_a_fixed_number_of_factorisations(index, monkeypatch):
    """The same few calls for one posture and for many, and no parameter that takes a search."""
    assert "maximum" not in index.needs
    calls = []
    for name in ("svd", "qr", "det", "inv", "solve", "eigvalsh", "lstsq"):
        original = getattr(np.linalg, name)
        monkeypatch.setattr(
            np.linalg, name, lambda *a, _f=original, **k: (calls.append(1), _f(*a, **k))[1]
        )
    design, _ = cases.hexapod(np.random.default_rng(1))
    numbers = []
    for n in (1, 40):
        calls.clear()
        pose = gsp.Pose(np.random.default_rng(n).normal(size=(n, 3)))
        cases.value(index, design.at(pose))
        numbers.append(len(calls))
    assert numbers[0] == numbers[1] <= 4


@having("real_time", False)
def test_it_needs_a_maximum_over_all_postures(index):
    """A search: the maximum of a design is not a function of the posture alone."""
    assert "maximum" in index.needs
    design = nawratil.example_design(0.1)
    values = gsp.indices.manipulability(design.at(nawratil.example_pose([0.3, 0.5, 0.9])))
    assert values.max() / values.min() > 1.05
