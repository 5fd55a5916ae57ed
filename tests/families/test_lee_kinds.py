"""Joints separated in one way on the platform, in another on the base: points, det J, best pose."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from gsp.families import lee
from gsp.geometry.pose import Pose

KINDS = ("edges", "centre", "side")
PAIRS = list(itertools.product(KINDS, KINDS))


@pytest.mark.parametrize(("top", "base"), PAIRS)
def test_determinant_and_lengths_are_those_of_the_rows(top, base):
    rng = np.random.default_rng(41)
    for _ in range(10):
        a, b, h = rng.uniform(0.3, 3.0, 3)
        alpha, beta = rng.uniform(0.0, 1.0, 2)
        theta = rng.uniform(-np.pi, np.pi, 4)
        design = lee.separated_by_kinds(a, b, alpha, beta, top=top, base=base)
        turns = np.stack((0.0 * theta, 0.0 * theta, theta), axis=-1)
        posture = design.at(Pose.from_rpy(np.broadcast_to([0.0, 0.0, h], (4, 3)), turns))
        found = lee.by_kinds(a, b, alpha, beta, theta, h, top=top, base=base)
        wanted = np.abs(np.linalg.det(posture.jacobian))
        np.testing.assert_allclose(found.determinant, wanted, rtol=1e-10, atol=1e-13)
        for k, length in enumerate(found.lengths):
            np.testing.assert_allclose(posture.joints[:, k::2].T, [length] * 3, rtol=1e-12)


@pytest.mark.parametrize(("kind", "closed"), [("centre", lee.to_centre), ("side", lee.along_side)])
def test_of_one_kind_it_is_the_closed_form_of_the_dissertation(kind, closed):
    theta = np.linspace(-1.5, 1.5, 7)
    for rho in (0.0, 0.2, 0.7):
        found = lee.by_kinds(1.3, 2.1, rho, rho, theta, top=kind, base=kind)
        wanted = closed(1.3, 2.1, rho, theta)
        np.testing.assert_allclose(found.determinant, wanted.determinant, rtol=1e-12)
        np.testing.assert_allclose(found.height, wanted.height, rtol=1e-12)
        assert lee.best_pose_by_kinds(1.3, 2.1, rho, rho, top=kind, base=kind)[:2] == pytest.approx(
            lee.best_central_pose(closed, 1.3, 2.1, rho)[:2], abs=1e-9
        )


def test_along_both_edges_it_is_the_closed_form_of_the_dissertation():
    for alpha, beta in ((0.0, 0.3), (0.25, 0.1), (0.8, 0.7)):
        found = lee.by_kinds(1.3, 2.1, alpha, beta, 0.0, top="edges", base="edges")
        assert found.determinant == pytest.approx(lee.central_maximum(1.3, 2.1, alpha, beta))
        assert found.height == pytest.approx(lee.best_height(1.3, 2.1, alpha, beta))


@pytest.mark.parametrize(("top", "base"), PAIRS)
def test_the_best_pose_is_above_all_of_a_grid(top, base):
    """Heights and twists of a grid, by the rows; with shares above 1/2 the best twist is 180°."""
    for alpha, beta in ((0.2, 0.35), (0.7, 0.9)):
        design = lee.separated_by_kinds(1.0, 2.0, alpha, beta, top=top, base=base)
        value, theta, pose = lee.best_pose_by_kinds(1.0, 2.0, alpha, beta, top=top, base=base)
        assert -np.pi < theta <= np.pi
        here = abs(np.linalg.det(design.at(pose).jacobian))
        assert here == pytest.approx(value, rel=1e-10)
        h, t = np.meshgrid(np.linspace(0.05, 2.0, 40), np.linspace(-np.pi, np.pi, 61))
        zero = 0.0 * h
        grid = Pose.from_rpy(np.stack((zero, zero, h), -1), np.stack((zero, zero, t), -1))
        values = np.abs(np.linalg.det(design.at(grid).jacobian))
        assert values.max() <= value * (1.0 + 1e-12)
        assert values.max() > 0.97 * value


@pytest.mark.parametrize("unit", [1e-95, 1e95])
def test_it_scales_with_the_unit_of_length(unit):
    words = {"top": "centre", "base": "side"}
    value, theta, pose = lee.best_pose_by_kinds(1.3, 2.1, 0.2, 0.1, **words)
    large, twist, far = lee.best_pose_by_kinds(1.3 * unit, 2.1 * unit, 0.2, 0.1, **words)
    assert (large / unit**3, twist) == pytest.approx((value, theta), rel=1e-9)
    np.testing.assert_allclose(far.position / unit, pose.position, rtol=1e-9)


def test_where_each_pose_is_singular_there_is_no_twist():
    value, theta, _ = lee.best_pose_by_kinds(1.0, 2.0, 1.0, 1.0, top="centre", base="centre")
    assert value == 0.0
    assert np.isnan(theta)
