"""The example set and the isotropic families against independent statements about them."""

from itertools import product

import numpy as np
import pytest
from scipy.optimize import minimize

import gsp
from gsp.errors import InvalidInput
from gsp.families import nawratil
from gsp.indices import condition_number_ellipsoid, control_number

PS = (0.3, np.sqrt(0.5), 1.0, 2.5)


def source_metrics(posture, ellipsoid):
    """N, D and T of the source in its own coordinates, written out from (6), (12) and (19)–(22)."""
    lines, p = posture.lines, posture.pose.position
    base, plat = posture.design.base_points, p + lines.arm
    n, d, t = np.zeros((6, 6)), np.zeros((6, 6)), np.zeros((6, 6))

    def velocity(x):  # of a point x for q = (q, q̂): q̂ + q × x
        return np.hstack(
            (-np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]]), np.eye(3))
        )

    for b, q in zip(base, plat, strict=True):
        leg = q - b
        length = np.linalg.norm(leg)
        row = leg @ velocity(q) / length
        n += np.outer(row, row)
        for x in (q, b):
            t += (velocity(x).T @ velocity(x) - np.outer(row, row)) / length**2
    for s in posture.pose.position + ellipsoid.vertices @ posture.pose.rotation.T:
        d += velocity(s).T @ velocity(s)
    return n, d, t


@pytest.mark.parametrize("alpha", [0.0, 0.1, np.pi / 7])
@pytest.mark.parametrize("h", [0.2, 1.0])
def test_example_anchors_are_those_of_the_source(alpha, h):
    """The angles of §3.4, spelled out leg by leg."""
    a = [
        -alpha,
        alpha,
        2 * np.pi / 3 - alpha,
        2 * np.pi / 3 + alpha,
        4 * np.pi / 3 - alpha,
        4 * np.pi / 3 + alpha,
    ]
    third = np.pi / 3
    b = [a[1] - third, a[0] + third, a[3] - third, a[2] + third, a[5] - third, a[4] + third]
    design, pose = nawratil.example_design(alpha), nawratil.example_pose(h)
    np.testing.assert_allclose(design.base_points[:, 0], np.cos(a), atol=1e-15)
    np.testing.assert_allclose(design.base_points[:, 1], np.sin(a), atol=1e-15)
    np.testing.assert_allclose(design.platform_points[:, 0], np.cos(b), atol=1e-15)
    np.testing.assert_allclose(design.platform_points[:, 1], np.sin(b), atol=1e-15)
    assert pose.position.tolist() == [0.0, 0.0, 2 * h]
    assert not design.at(pose).singular()


def test_the_ends_of_the_example_set_are_singular():
    assert nawratil.example_design(np.pi / 6).at(nawratil.example_pose([0.1, 1.0])).singular().all()
    assert nawratil.example_design(0.2).at(nawratil.example_pose(0.0)).singular()


def test_k_plus_is_what_optimisation_finds():
    """(25) from a search that does not use it."""

    def loss(x):
        alpha, h = np.clip(x[0], 0, np.pi / 6), max(x[1], 1e-3)
        return -float(control_number(nawratil.example_design(alpha).at(nawratil.example_pose(h))))

    tight = {"xatol": 1e-12, "fatol": 1e-15, "maxiter": 2000}
    ends = [
        minimize(loss, x0, method="Nelder-Mead", options=tight) for x0 in ([0.3, 0.8], [0.02, 0.2])
    ]
    for end in ends:
        np.testing.assert_allclose(end.x, [nawratil.BEST_ALPHA, nawratil.BEST_H], atol=1e-8)
        assert -end.fun == pytest.approx(nawratil.BEST_CONTROL_NUMBER, abs=1e-10)


def test_k_plus_is_determined_by_the_eigenvalues_that_the_source_names():
    posture = nawratil.example_design(nawratil.BEST_ALPHA).at(
        nawratil.example_pose(nawratil.BEST_H)
    )
    n, _, t = source_metrics(posture, gsp.Ellipsoid(1.0))
    eigenvalues = np.sort(np.linalg.eigvals(np.linalg.solve(n, t)).real)
    small, large = eigenvalues[0], eigenvalues[-1]
    assert np.sqrt(small / large) == pytest.approx(np.sqrt(2 * np.sqrt(5) - 4), abs=1e-12)
    # λ1 = λ2 = λ4 = λ5 and λ3 = λ6: four and two.
    counts = {
        np.isclose(eigenvalues, small, rtol=1e-9).sum(),
        np.isclose(eigenvalues, large, rtol=1e-9).sum(),
    }
    assert counts == {4, 2}


@pytest.mark.parametrize("g", [3, 4, 5, 8])
@pytest.mark.parametrize("p", PS)
@pytest.mark.parametrize("mu", [0.0, 0.4, np.pi / 3])
def test_isotropic_designs_are_isotropic_in_both_indices(g, p, mu):
    design = nawratil.isotropic(g, p, mu)
    posture = design.at(design.home)
    assert condition_number_ellipsoid(posture, design.ellipsoid) == pytest.approx(1.0, abs=1e-12)
    assert control_number(posture) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("p", [1e-6, -1e-6, 1e6])
def test_isotropic_designs_at_the_ends_of_their_range(p):
    design = nawratil.isotropic(3, p)
    posture = design.at(design.home)
    assert control_number(posture) == pytest.approx(1.0, abs=1e-9)
    ellipsoid = design.ellipsoid
    assert condition_number_ellipsoid(posture, ellipsoid) == pytest.approx(1.0, abs=1e-9)
    with pytest.raises(InvalidInput, match=r"\|p\|: expected a number in \[1e-06, 1e\+06\]"):
        nawratil.isotropic(3, p**1.5 if p > 0 else p / 10.0)


@pytest.mark.parametrize("p", PS)
def test_the_metrics_are_the_diagonal_matrices_of_the_source(p):
    """(28), (29) and D, entry by entry, with n66 = 2 t² (1 + t²) D where the print has z²."""
    g, x = 4, nawratil.isotropic_parameters(p)
    design = nawratil.isotropic(g, p, 0.7)
    n, d, t = source_metrics(design.at(design.home), design.ellipsoid)
    r, h, rise = x["r"], x["h"], x["t"]
    factor = g / (1 + rise**2) ** 2
    n11 = (h**2 + rise**4 * r**2 + h**2 * rise**2 + rise**2 * r**2) * factor
    n33, n44 = 2 * r**2 * (1 + rise**2) * factor, (rise**2 + 1) * factor
    n66 = 2 * rise**2 * (1 + rise**2) * factor
    np.testing.assert_allclose(n, np.diag([n11, n11, n33, n44, n44, n66]), atol=1e-12)
    np.testing.assert_allclose(d, np.diag([2 * p**2 + 2, 2 * p**2 + 2, 4, 6, 6, 6]), atol=1e-12)
    np.testing.assert_allclose(t, t[5, 5] / n[5, 5] * n, atol=1e-12)


def test_all_choices_of_base_and_platform_have_the_same_control_number():
    """Theorem 5, for all 2^6 at an isotropic and at a common posture of the set N."""
    common = dict(r=0.5, h=0.9, t=0.4, a=-1.1, b=0.3, mu=0.2)
    one = nawratil.set_n(3, **common)
    value = control_number(one.at(one.home))
    assert value < 0.9
    for swap in product([False, True], repeat=6):
        d = nawratil.set_n(3, **common, swap=swap)
        assert control_number(d.at(d.home)) == pytest.approx(value, abs=1e-12)
        e = nawratil.isotropic(3, 0.8, 0.1, swap)
        assert control_number(e.at(e.home)) == pytest.approx(1.0, abs=1e-12)
        assert condition_number_ellipsoid(e.at(e.home), e.ellipsoid) == pytest.approx(
            1.0, abs=1e-12
        )


@pytest.mark.parametrize("p", PS)
def test_all_anchors_of_the_isotropic_designs_lie_on_the_ellipsoid(p):
    """(35)"""
    design = nawratil.isotropic(5, p, 0.3)
    for points in (design.base_points, design.platform_points):
        left = points[:, 0] ** 2 + points[:, 1] ** 2 + points[:, 2] ** 2 / p**2
        np.testing.assert_allclose(left, 1.0, atol=1e-12)


def test_isotropy_needs_the_printed_solution():
    """Each of r, h, t changes CDN_OE, and each of the five changes CTN."""
    x = nawratil.isotropic_parameters(1.0)
    sphere = gsp.Ellipsoid(1.0)
    for key in x:
        d = nawratil.set_n(3, **{**x, key: x[key] * 1.05})
        posture = d.at(d.home)
        assert control_number(posture) < 0.999
        if key in "rht":
            assert condition_number_ellipsoid(posture, sphere) > 1.01


def test_designs_of_the_set_m_are_closed_under_the_turn():
    rng = np.random.default_rng(4)
    first, second = rng.normal(size=(2, 2, 3))
    design = nawratil.set_m(first, second, 5)
    turn = gsp.Pose.from_rpy([0, 0, 0], [0, 0, 72.0], degrees=True).rotation
    for points in (design.base_points, design.platform_points):
        for half in (points[:5], points[5:]):
            np.testing.assert_allclose(half @ turn.T, np.roll(half, -1, axis=0), atol=1e-12)
    x = nawratil.isotropic_parameters(1.3)
    n = nawratil.set_n(5, **x, mu=0.3)
    again = nawratil.set_m(
        (n.base_points[0], n.platform_points[0]), (n.base_points[5], n.platform_points[5]), 5
    )
    np.testing.assert_allclose(again.base_points, n.base_points, atol=1e-14)
    np.testing.assert_allclose(again.platform_points, n.platform_points, atol=1e-14)


@pytest.mark.parametrize(
    "make",
    [
        lambda: nawratil.example_design(0.6),
        lambda: nawratil.example_design(-0.1),
        lambda: nawratil.isotropic(2),
        lambda: nawratil.isotropic(3.5),
        lambda: nawratil.isotropic(3, 0.0),
        lambda: nawratil.isotropic(3, 1.0, swap=[True]),
        lambda: nawratil.set_n(3, 1.0, 1.0, 1.0, 0.5, 0.5),
        lambda: nawratil.set_n(3, -1.0, 1.0, 1.0, 0.1, 0.5),
        lambda: nawratil.set_m(np.zeros((3, 3)), np.zeros((2, 3)), 3),
        lambda: nawratil.example_pose(np.nan),
    ],
)
def test_bad_parameters_are_errors(make):
    with pytest.raises(InvalidInput):
        make()
