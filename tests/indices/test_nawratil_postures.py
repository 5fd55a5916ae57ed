"""Nawratil's K+ and his family of isotropic postures, built from his equations."""

from itertools import product

import numpy as np
import pytest

import gsp
from gsp.indices import condition_number_ellipsoid, control_number


def posture_of(base, platform):
    """UPS legs between points that are both given in base axes."""
    return gsp.Design(["D1"] * len(base), base, platform).at(gsp.Pose([0.0, 0.0, 0.0]))


def family_3_4(alpha, h):
    """The two-parametric set of §3.4."""
    thirds = np.repeat(np.arange(3) * 2 * np.pi / 3, 2)
    signs = np.tile([-1.0, 1.0], 3)
    a = thirds + signs * alpha
    b = thirds + np.tile([alpha - np.pi / 3, np.pi / 3 - alpha], 3)
    one = np.ones(6)
    base = np.stack((np.cos(a), np.sin(a), -2 * h * one), axis=1)
    return base, np.stack((np.cos(b), np.sin(b), 0 * one), axis=1)


KAPPA = np.sqrt(2 * np.sqrt(5) - 2)
ALPHA = -np.arctan((np.sqrt(5) * KAPPA - np.sqrt(15)) / 5)


def test_k_plus():
    """*Source: Nawratil, eq. (25).*"""
    value = control_number(posture_of(*family_3_4(ALPHA, KAPPA / 4)))
    assert value == pytest.approx(np.sqrt(2 * np.sqrt(5) - 4), abs=1e-12)
    assert np.degrees(ALPHA) == pytest.approx(4, abs=0.5)
    assert KAPPA / 4 == pytest.approx(0.4, abs=0.05)


def test_k_plus_is_the_maximum_of_its_set():
    best = control_number(posture_of(*family_3_4(ALPHA, KAPPA / 4)))
    for da, dh in product((-1e-3, 0.0, 1e-3), repeat=2):
        if da or dh:
            assert control_number(posture_of(*family_3_4(ALPHA + da, KAPPA / 4 + dh))) < best


def isotropic(g, p, mu):
    """Points x_i, y_i on the lines of eqs. (26), (31), (32) and (34), in base axes: (2g, 3)."""
    r, h, t = np.sqrt(3) / 3, np.sqrt(6 + 12 * p**2) / 6, np.sqrt(2) / 2
    turns = 2 * np.arange(g) * np.pi / g
    angle = np.concatenate((turns, mu + turns))
    side = np.repeat([1.0, -1.0], g)
    feet = np.stack((r * np.cos(angle), r * np.sin(angle), side * h), axis=1)
    lines = np.stack((-np.sin(angle), np.cos(angle), side * t), axis=1)
    spread = 2 * np.sqrt(6 * p**2 * (1 + 2 * p**2))
    root = np.sqrt(12 + 24 * p**2)
    a, b = (np.array([-root - spread, -root + spread]) / (6 * (1 + 2 * p**2))).tolist()
    return feet + a * lines, feet + b * lines


FAMILY = list(product((3, 4, 5), (0.3, np.sqrt(0.5), 1.0, 2.0), (0.0, 0.4, np.pi / 3)))


@pytest.mark.parametrize(("g", "p", "mu"), FAMILY)
def test_isotropic_family(g, p, mu):
    """*Source: Nawratil, eqs. (26)–(34).*"""
    base, platform = isotropic(g, p, mu)
    posture, ellipsoid = posture_of(base, platform), gsp.Ellipsoid([1.0, 1.0, p])
    assert condition_number_ellipsoid(posture, ellipsoid) == pytest.approx(1.0, abs=1e-12)
    assert control_number(posture) == pytest.approx(1.0, abs=1e-12)
    on_it = (base / [1.0, 1.0, p]) ** 2  # eq. (35)
    np.testing.assert_allclose(on_it.sum(axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize(("g", "p", "mu"), FAMILY[::5])
def test_isotropic_family_is_isolated(g, p, mu):
    """The claim is sharp: another ellipsoid, or anchors moved along their lines, are worse."""
    base, platform = isotropic(g, p, mu)
    other = gsp.Ellipsoid([1.0, 1.0, 1.01 * p])
    assert condition_number_ellipsoid(posture_of(base, platform), other) > 1.0 + 1e-4
    assert control_number(posture_of(base, platform + 0.01 * (platform - base))) < 1.0 - 1e-4


@pytest.mark.parametrize("legs", [[0], [1, 4], [0, 2, 3, 5], range(6)])
def test_anchors_may_change_ends(legs):
    """*Source: Nawratil, Theorem 5.*"""
    base, platform = isotropic(3, 0.8, 0.7)
    rng = np.random.default_rng(0)
    platform = platform + rng.uniform(-0.2, 0.2, platform.shape)
    swapped = np.isin(np.arange(6), list(legs))[:, None]
    one = control_number(posture_of(base, platform))
    other = control_number(
        posture_of(np.where(swapped, platform, base), np.where(swapped, base, platform))
    )
    assert 0.1 < one < 0.99
    assert other == pytest.approx(one, rel=1e-13)


def test_control_number_depends_on_the_anchors_on_their_lines():
    """*Source: Nawratil, Theorem 5.*"""
    base, platform = family_3_4(ALPHA, KAPPA / 4)
    longer = posture_of(base, platform + 0.5 * (platform - base))
    assert control_number(longer) < 0.6
