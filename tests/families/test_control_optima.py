"""CTN = 1 in the set M: T = λ N leg by leg, all solutions, and legs against ellipsoids."""

import numpy as np
import pytest
from scipy.optimize import least_squares

import gsp
from gsp.errors import InvalidInput
from gsp.families import nawratil
from gsp.indices import condition_number_ellipsoid, control_number
from tests.families.test_nawratil_families import source_metrics
from tests.support import random_pose

SPHERE = gsp.Ellipsoid(1.0)


def members(number, seed=0):
    """Random members: ratio, rise and phase, and their designs."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < number:
        ratio = float(np.exp(rng.uniform(-1.5, 1.5)))
        rise, phase = rng.uniform([0.05, -np.pi / 2], [0.9, np.pi / 2]).tolist()
        try:
            made = nawratil.control_optimum(3, ratio, rise, phase, mu=float(rng.uniform(0, 7)))
        except InvalidInput:
            continue
        found.append(((ratio, rise, phase), made))
    return found


def lines_of(design, g):
    """Distance, height of the foot, height of the middle, direction and length of legs 1, g + 1."""
    rows = []
    for a, b in zip(design.base_points[::g], design.platform_points[::g], strict=True):
        length = np.linalg.norm(b - a)
        u = (b - a) / length
        foot = a - u * (a[:2] @ u[:2]) / (u[:2] @ u[:2])
        u = u * np.sign(foot[0] * u[1] - foot[1] * u[0])
        rows.append((np.hypot(*foot[:2]), foot[2], (a + b)[2] / 2, u[2], length))
    return np.array(rows).T


@pytest.mark.parametrize("g", [3, 4, 7])
def test_the_passive_rates_are_the_same_in_all_directions(g):
    for (ratio, rise, phase), _ in members(12, seed=g):
        design = nawratil.control_optimum(g, ratio, rise, phase, 0.3, radius=2.5)
        n, _, t = source_metrics(design.at(design.home), SPHERE)
        size = np.sqrt(np.diag(n))
        factor = t[5, 5] / n[5, 5]
        np.testing.assert_allclose(t / np.outer(size, size), factor * n / np.outer(size, size),
                                   rtol=0, atol=1e-11 * factor)  # fmt: skip
        distance, _, _, sine, length = lines_of(design, g)
        assert length[0] / length[1] == pytest.approx(ratio, rel=1e-12)
        assert np.arcsin(sine[0]) == pytest.approx(rise, abs=1e-12)
        assert distance[0] == pytest.approx(2.5, rel=1e-12)


def test_the_isotropic_designs_are_members():
    """With legs of one length and t² = 1/2; phase 45° has p² = 1/2."""
    for p in (0.2, np.sqrt(0.5), 1.0, 4.0):
        x = nawratil.isotropic_parameters(p)
        middle = x["h"] + 0.5 * (x["a"] + x["b"]) * x["t"]
        phase = float(np.arctan2(x["h"], 2.0 * middle))
        ours = nawratil.control_optimum(5, phase=phase, mu=0.2)
        theirs = nawratil.isotropic(5, p, 0.2)
        np.testing.assert_allclose(ours.base_points, theirs.base_points, atol=1e-13)
        np.testing.assert_allclose(ours.platform_points, theirs.platform_points, atol=1e-13)
    assert nawratil.isotropic_parameters(np.sqrt(0.5))["r"] == pytest.approx(3**-0.5)


@pytest.mark.parametrize("seed", range(4))
def test_what_a_solver_finds_is_a_member(seed):
    """T = λ N for the coordinates of two legs, from random ones; up to mirror images."""

    def conditions(u):
        design = nawratil.set_m(u[:6].reshape(2, 3), u[6:].reshape(2, 3), 3)
        n, _, t = source_metrics(design.at(design.home), SPHERE)
        return (t / np.trace(t[3:, 3:]) - n / np.trace(n[3:, 3:]))[np.triu_indices(6)]

    start = np.random.default_rng(seed).normal(size=12)
    found = least_squares(conditions, start, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    assert np.abs(found.fun).max() < 1e-13
    pairs = found.x.reshape(2, 2, 3)
    distance, foot, middle, sine, length = lines_of(nawratil.set_m(*pairs, 3), 3)
    # The mirror image that rises at the first leg; heights count from the origin of a member.
    sign = np.sign(sine[0])
    alpha = length**-2 / (length**-2).sum()
    foot, middle = sign * (foot - alpha @ middle), sign * (middle - alpha @ middle)
    shape = np.arctan2((foot[0] - foot[1]) / 2.0, middle[0] - middle[1])
    turned = abs(shape) > np.pi / 2.0  # half a turn about the x-axis
    made = nawratil.control_optimum(
        3, float(length[0] / length[1]), float(np.arcsin(abs(sine[0]))),
        float(shape - np.sign(shape) * np.pi * turned), radius=float(distance[0]),
    )  # fmt: skip
    ours, flip = lines_of(made, 3), 1 - 2 * turned
    np.testing.assert_allclose(ours[0], distance, rtol=1e-7)
    np.testing.assert_allclose(flip * ours[1], foot, atol=1e-7 * length.max())
    np.testing.assert_allclose(flip * ours[2], middle, atol=1e-7 * length.max())
    np.testing.assert_allclose(ours[3], sign * sine, atol=1e-7)
    np.testing.assert_allclose(ours[4], length, rtol=1e-7)


def test_three_parameters_are_free():
    """Beside size, turn and g: they change lengths and distances, over their mean, in rank 3."""

    def shape(x):
        rows = lines_of(nawratil.control_optimum(3, *x.tolist()), 3)
        return np.concatenate([rows[[0, 1, 2, 4]].ravel() / rows[4].mean(), rows[3]])

    for parameters, _ in members(5):
        steps = 1e-6 * np.eye(3)
        at = np.array(parameters)
        slopes = np.array([shape(at + s) - shape(at - s) for s in steps]) / 2e-6
        assert np.linalg.svd(slopes)[1][2] > 1e-4


def test_turns_exchanges_and_settings():
    one = nawratil.control_optimum(4, 0.8, 0.5, 1.1)
    swap = [True, False, False, True, True, False, True, False]
    other = nawratil.control_optimum(4, 0.8, 0.5, 1.1, 0.9, swap=swap, name="mine", unit="mm")
    assert (other.name, other.unit) == ("mine", "mm")
    assert control_number(other.at(other.home)) == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(other.base_points[0], one.platform_points[0], atol=1e-15)
    np.testing.assert_allclose(other.base_points[1], one.base_points[1], atol=1e-15)


# --- legs and ellipsoids ---


def test_levels_are_the_least_over_the_points_of_a_leg():
    rng = np.random.default_rng(1)
    _, design = members(1)[0]
    ellipsoid = gsp.Ellipsoid((0.3, 0.7, 0.5), (0.1, -0.2, 0.3), random_pose(rng).rotation)
    poses = random_pose(rng, (3, 2))
    found = nawratil.leg_levels(design.at(poses), ellipsoid)
    assert found.shape == (3, 2, 6)
    share = np.linspace(0.0, 1.0, 20001)[:, None]
    for place in np.ndindex(3, 2):
        pose = poses[place]
        for leg in range(6):
            end = pose.position + pose.rotation @ design.platform_points[leg]
            points = (1.0 - share) * design.base_points[leg] + share * end
            local = (points - pose.position) @ pose.rotation - ellipsoid.center
            # x of the ellipsoid: rotation @ (semi_axes * y), |y| = 1.
            sizes = np.linalg.norm(
                np.linalg.solve(ellipsoid.rotation * ellipsoid.semi_axes, local.T), axis=0
            )
            assert found[place][leg] == pytest.approx(sizes.min(), rel=1e-6)
            assert found[place][leg] <= sizes.min() * (1.0 + 1e-12)


def test_a_member_with_legs_clear_of_its_ellipsoid():
    """CTN = 1 without the legs of the isotropic designs, which penetrate theirs."""
    design = nawratil.control_optimum(
        3, 1.0, *np.deg2rad([34.9, 69.2]), ellipsoid=gsp.Ellipsoid((0.82, 0.82, 0.23))
    )
    posture = design.at(design.home)
    assert control_number(posture) == pytest.approx(1.0, abs=1e-12)
    assert nawratil.leg_levels(posture, design.ellipsoid).min() > 1.0
    assert condition_number_ellipsoid(posture, design.ellipsoid) < 1.24
    for p in (0.3, np.sqrt(0.5), 2.0):
        other = nawratil.isotropic(3, p)
        assert nawratil.leg_levels(other.at(other.home), other.ellipsoid).max() < 1.0


@pytest.mark.parametrize(
    "given",
    [
        {"ratio": 0.0},
        {"ratio": 1e4},
        {"rise": 0.0},
        {"rise": -0.3},
        {"rise": 1.0},
        {"rise": np.pi - 0.3},
        {"phase": 0.0},  # with the default ratio and rise
        {"phase": 2.0},
        {"radius": 0.0},
        {"g": 2},
        {"swap": [True]},
    ],
)
def test_bad_parameters_are_errors(given):
    with pytest.raises(InvalidInput, match=next(iter(given))):
        nawratil.control_optimum(**given)


def test_legs_between_lines_are_no_segments():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.raises(InvalidInput, match="legs between two points"):
        nawratil.leg_levels(design.at(design.home), SPHERE)
