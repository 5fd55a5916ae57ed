import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.families import nawratil
from gsp.indices import condition_number, condition_number_ellipsoid
from tests.support import random_design, random_pose

D3 = gsp.catalogue.design("toz-kucuk-2016-d3-6")
MIXED = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


@pytest.mark.parametrize("p", [0.3, 0.6, 0.9, 1.4, 3.0])
def test_the_minimiser_of_a_diagonal_matrix_with_slack_is_an_interval(p):
    """JᵀJ ~ diag(2p²+2, 2p²+2, 4; 6, 6, 6): any L with both rotational values around 6 is best."""
    design = nawratil.isotropic(3, p)
    found = gsp.characteristic_length(design)
    ends = np.sort(np.sqrt([(2 * p**2 + 2) / 6, 4 / 6]))
    np.testing.assert_allclose([found.low, found.high], ends, rtol=1e-8)
    assert not found.unique
    assert found.condition_number == pytest.approx(ends[1] / ends[0], rel=1e-9)
    assert found.length == pytest.approx(np.sqrt(ends[0] * ends[1]), rel=1e-8)
    for inside in (ends[0], found.length, ends[1]):
        value = condition_number(design.at(design.home), inside)
        assert value == pytest.approx(found.condition_number, rel=1e-9)
    for outside in (ends[0] * 0.99, ends[1] * 1.01):
        assert condition_number(design.at(design.home), outside) > found.condition_number * 1.001


def test_it_is_the_three_way_length_of_an_isotropic_design_with_a_sphere():
    design = nawratil.isotropic(4, 1.0)
    best = gsp.characteristic_length(design)
    assert best.unique
    assert float(best) == pytest.approx(np.sqrt(2 / 3), rel=1e-8)
    assert float(gsp.characteristic_length(design, method="sphere")) == pytest.approx(
        np.sqrt(2 / 3)
    )
    assert float(gsp.characteristic_length(design, method="anchors")) == pytest.approx(1.0)


@pytest.mark.parametrize("design", [D3, MIXED], ids=lambda d: d.name)
def test_the_minimum_is_the_least_of_a_fine_scan(design):
    found = gsp.characteristic_length(design)
    lengths = np.geomspace(1.0, 1e5, 4001)
    posture = design.at(design.home)
    values = [float(condition_number(posture, x)) for x in lengths]
    assert found.condition_number <= min(values) * (1 + 1e-12)
    assert lengths[np.argmin(values)] == pytest.approx(found.length, rel=0.01)


def test_the_mean_over_several_poses_is_minimised_and_bad_poses_do_not_count():
    design = nawratil.example_design(0.1)
    heights = np.array([0.3, 0.6, 1.2])
    good = gsp.characteristic_length(design, nawratil.example_pose(heights))
    with_singular = gsp.characteristic_length(design, nawratil.example_pose([*heights, 0.0]))
    assert with_singular == good
    assert good.poses == 3
    means = [
        condition_number(design.at(nawratil.example_pose(heights)), good.length * k).mean()
        for k in (0.99, 1.0, 1.01)
    ]
    assert means[1] == pytest.approx(good.condition_number, rel=1e-12)
    assert means[1] <= min(means)


def test_it_scales_with_the_unit():
    metres = gsp.characteristic_length(MIXED.scaled(0.001))
    assert 1000 * metres.length == pytest.approx(gsp.characteristic_length(MIXED).length, rel=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_with_the_sphere_length_the_two_condition_numbers_are_equal(seed):
    """CDN_CL = CDN_OE at L = sqrt(2/3) × radius, and a percent beside it they are not."""
    rng = np.random.default_rng(seed)
    design = gsp.Design(["D1"] * 7, rng.normal(size=(7, 3)), rng.normal(size=(7, 3)))
    pose = gsp.Pose.from_rpy(
        rng.normal(size=(5, 3)) + np.array([0, 0, 3.0]), rng.normal(size=(5, 3))
    )
    length = gsp.characteristic_length(design, method="sphere", radius=0.8).length
    posture = design.at(pose)
    sphere = condition_number_ellipsoid(posture, gsp.Ellipsoid(0.8))
    np.testing.assert_allclose(condition_number(posture, length), sphere, rtol=1e-12)
    assert not np.allclose(condition_number(posture, 1.01 * length), sphere, rtol=1e-4)


@pytest.mark.parametrize("axes", [(1.0, 1.0, 1.0), (0.5, 0.9, 1.4)])
def test_the_ellipsoid_index_is_a_ratio_of_kinetic_energies_of_a_shell(axes):
    """Theorem 3, with the energy integrated over the shell between similar ellipsoids."""
    rng = np.random.default_rng(2)
    design = gsp.Design(["D1"] * 6, rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    pose = gsp.Pose.from_rpy(rng.normal(size=3) + np.array([0, 0, 2.0]), rng.normal(size=3))
    centre = np.array([0.2, -0.1, 0.3])
    # Gauss in z, equal steps in longitude: exact for the quadratic integrand on the sphere.
    z, weight = np.polynomial.legendre.leggauss(6)
    angle = np.arange(12) * np.pi / 6
    ring = np.sqrt(1 - z**2)
    unit = np.stack(
        (np.outer(ring, np.cos(angle)), np.outer(ring, np.sin(angle)), np.outer(z, 0 * angle + 1)),
        -1,
    )
    masses = np.repeat(weight / weight.sum() / 12, 12)
    points = pose.rotation @ (centre + unit.reshape(-1, 3) * axes).T
    energy = np.zeros((6, 6))
    for m, x in zip(masses, points.T, strict=True):
        velocity = np.hstack((np.eye(3), [[0, x[2], -x[1]], [-x[2], 0, x[0]], [x[1], -x[0], 0]]))
        energy += m / 2 * velocity.T @ velocity
    jacobian = design.at(pose).jacobian
    inverse = np.linalg.inv(jacobian)
    energies = np.linalg.eigvalsh(inverse.T @ energy @ inverse)  # over Σ d_i² = 1
    value = condition_number_ellipsoid(design.at(pose), gsp.Ellipsoid(axes, centre))
    assert value == pytest.approx(np.sqrt(energies[-1] / energies[0]), rel=1e-9)


def test_invalid_arguments_are_errors():
    design = nawratil.example_design(0.1)
    with pytest.raises(MissingParameter, match="home"):
        gsp.characteristic_length(design)
    with pytest.raises(InvalidInput, match="method"):
        gsp.characteristic_length(design, method="guess")
    with pytest.raises(InvalidInput, match="singular"):
        gsp.characteristic_length(design, nawratil.example_pose(0.0))
    with pytest.raises(MissingParameter, match="radius"):
        gsp.characteristic_length(design, method="sphere")
    with pytest.raises(MissingParameter, match="not a sphere"):
        gsp.characteristic_length(nawratil.isotropic(3, 2.0), method="sphere")
    with pytest.raises(InvalidInput, match="radius"):
        gsp.characteristic_length(design, method="sphere", radius=-1)


def test_wrong_types_are_errors():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.raises(InvalidInput, match=r"design: expected a gsp\.Design"):
        gsp.characteristic_length("D1^6")
    with pytest.raises(InvalidInput, match=r"pose: expected a gsp\.Pose"):
        gsp.characteristic_length(design, [0.0, 0.0, 1.0])


@pytest.mark.parametrize("name", ["D1^3 A1^3", "D4^3 A1^3"])
def test_a_condition_number_that_falls_with_every_length_is_an_error(name):
    """Three distances and three angles: J is block triangular; long lengths decouple blocks."""
    rng = np.random.default_rng(4)
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    design, pose = random_design(rng, legs), random_pose(rng)
    values = [condition_number(design.at(pose), length) for length in (0.1, 1.0, 10.0, 100.0)]
    assert (np.diff(values) < 0.0).all()
    with pytest.raises(InvalidInput, match="falls toward a length of infinity"):
        gsp.characteristic_length(design, pose)
