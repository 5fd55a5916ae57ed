"""Indices against 50-digit arithmetic and against the printed definitions."""

import mpmath
import numpy as np
import pytest
from scipy.optimize import brentq

import gsp
from gsp.indices import condition_number, condition_number_ellipsoid, control_number
from tests import exact
from tests.support import random_design, random_pose, turn

LENGTH = 0.8
ELLIPSOID = gsp.Ellipsoid([0.5, 0.7, 0.4], [0.1, -0.2, 0.3], turn([0.3, 0.2, 0.1]))
OFFSETS = 10.0 ** np.array([-1.0, -4.0, -8.0, -10.0, -11.5])


def computed(posture):
    return (
        float(condition_number(posture, LENGTH)),
        float(condition_number_ellipsoid(posture, ELLIPSOID, LENGTH)),
        float(control_number(posture, LENGTH)),
    )


def path_through_a_singularity(design, rng):
    """Poses along a line of positions and turns, as a function, and where det J changes sign."""
    for _ in range(100):
        ends = rng.uniform(-1.0, 1.0, (2, 6)) * [0.5, 0.5, 0.5, 1.0, 1.0, 1.0] + [
            0,
            0,
            1.5,
            0,
            0,
            0,
        ]

        def poses(x, ends=ends):
            values = ends[0] + np.multiply.outer(x, ends[1] - ends[0])
            return gsp.Pose(values[..., :3], turn(values[..., 3:]))

        def det(x, poses=poses):
            return np.linalg.det(design.at(poses(x)).jacobian)

        x = np.linspace(0.0, 1.0, 200)
        values = det(x)
        for i in np.flatnonzero(values[1:] * values[:-1] < 0.0):
            root = brentq(lambda y, det=det: float(det(y)), x[i], x[i + 1], xtol=1e-15, disp=False)
            # A D4 row changes its sign where lines meet: that is not a singularity.
            if np.linalg.cond(design.at(poses(root)).jacobian) > 1e9:
                return poses, root
    raise AssertionError("no singular pose found")


MECHANISMS = ["D1^6", "D2^3 D3^3", "D4^6", "D1^3 D2 D3 A1", "D1 D2 D3 D4 A1^2"]


@pytest.mark.parametrize("name", MECHANISMS)
def test_towards_a_singularity_against_50_digits(name):
    """Relative error at most condition × 1e-15, for conditions up to 1e12."""
    rng = np.random.default_rng(len(name))
    mechanism = gsp.catalogue.mechanism(name)
    design = random_design(rng, [leg.name for leg in mechanism.legs])
    poses, root = path_through_a_singularity(design, rng)
    largest = 0.0
    for offset in OFFSETS:
        pose = poses(root + offset)
        cdn_cl, cdn_oe, ctn = map(float, exact.indices(design, pose, LENGTH, ELLIPSOID))
        for value, true, condition in zip(
            computed(design.at(pose)),
            (cdn_cl, cdn_oe, ctn),
            (cdn_cl, cdn_oe, 1 / ctn),
            strict=True,
        ):
            if condition < 1e12:
                largest = max(largest, condition)
                assert value == pytest.approx(true, rel=1e-15 * max(condition, 10.0))
    assert largest > 1e10


@pytest.mark.parametrize("seed", range(4))
def test_printed_definition(seed):
    """Generalised eigenvalues of (D, N) and (T, N), in the printed coordinates and matrices."""
    rng = np.random.default_rng(seed)
    n = 6 + seed % 3
    design, pose = random_design(rng, ["D1"] * n), random_pose(rng)
    with mpmath.workdps(exact.DIGITS):
        d, big_n, t = exact.nawratil_matrices(design, pose, ELLIPSOID)
        low, high = exact.extremes(d, big_n)
        cdn_oe = float(mpmath.sqrt(high / low))
        low, high = exact.extremes(t, big_n)
        ctn = float(mpmath.sqrt(low / high))
    posture = design.at(pose)
    assert condition_number_ellipsoid(posture, ELLIPSOID) == pytest.approx(cdn_oe, rel=1e-12)
    assert control_number(posture) == pytest.approx(ctn, rel=1e-12)


def test_operation_sphere_is_a_characteristic_length():
    """CDN_CL is CDN_OE for a sphere about the platform origin of radius L sqrt(3/2).

    *Source: Nawratil, after Theorem 3.*
    """
    rng = np.random.default_rng(0)
    posture = random_design(rng, ["D1", "D2", "D3", "D1", "D2", "D4"]).at(random_pose(rng, (20,)))
    sphere = gsp.Ellipsoid(LENGTH * np.sqrt(1.5))
    np.testing.assert_allclose(
        condition_number_ellipsoid(posture, sphere), condition_number(posture, LENGTH), rtol=1e-12
    )
