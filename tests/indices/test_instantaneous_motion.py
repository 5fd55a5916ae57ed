"""The motion near a singularity, against motions that are known."""

import mpmath
import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.families import nawratil

PLUS = nawratil.example_design(nawratil.BEST_ALPHA)
CENTRE = np.array([0.0, 0.0, 2 * nawratil.BEST_H])


def turned(axis, angle):
    turn = np.zeros((*np.shape(angle), 3))
    turn[..., axis] = angle
    return PLUS.at(nawratil.example_pose(nawratil.BEST_H, turn))


def singular_angle(axis, low, high):
    return brentq(lambda x: np.linalg.det(turned(axis, x).jacobian), low, high, xtol=1e-15)


def test_the_first_twist_is_the_eigenvector_of_the_largest_eigenvalue():
    posture = turned(0, 0.9)
    jacobian, passive = posture.jacobian, posture.passive_rates(None)
    values, vectors = eigh(jacobian.T @ jacobian, passive.T @ passive)
    motion = gsp.instantaneous_motion(posture)
    np.testing.assert_allclose(motion.rates**2, values, rtol=1e-8)
    cosine = (
        abs(vectors[:, 0] @ motion.twist)
        / np.linalg.norm(vectors[:, 0])
        / np.linalg.norm(motion.twist)
    )
    assert cosine == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("method", ["control_number", "linear_complex"])
def test_known_axis_of_legs_that_meet_one_line(method):
    """Legs from points of one line can turn about it: pitch 0, and the axis is that line."""
    rng = np.random.default_rng(0)
    point, direction = rng.normal(size=(2, 3))
    direction /= np.linalg.norm(direction)
    base = point + np.outer(rng.normal(size=6), direction)
    design = gsp.Design(["D1"] * 6, base, rng.normal(size=(6, 3)))
    motion = gsp.instantaneous_motion(design.at(gsp.Pose([0.3, 0.2, 2.0])), method)
    sign = np.sign(motion.axis[:3] @ direction)
    np.testing.assert_allclose(sign * motion.axis[:3], direction, atol=1e-9)
    np.testing.assert_allclose(sign * motion.axis[3:], np.cross(point, direction), atol=1e-9)
    assert motion.pitch == pytest.approx(0.0, abs=1e-9)
    assert motion.fit() == "complex"


@pytest.mark.parametrize("method", ["control_number", "linear_complex"])
def test_known_pitch_of_legs_that_are_path_normals(method):
    """Legs normal to the paths of a screw: its pitch and axis come back."""
    rng = np.random.default_rng(1)
    pitch, point = 0.37, np.array([0.4, -0.2, 0.0])
    platform = rng.normal(size=(6, 3))
    velocity = np.cross([0, 0, 1.0], platform - point) + np.array([0, 0, pitch])
    legs = np.cross(velocity, rng.normal(size=(6, 3)))
    posture = gsp.Design(["D1"] * 6, platform - legs, platform).at(gsp.Pose([0, 0, 0]))
    motion = gsp.instantaneous_motion(posture, method)
    assert motion.pitch == pytest.approx(pitch, rel=1e-9)
    np.testing.assert_allclose(abs(motion.axis[2]), 1.0, atol=1e-12)
    np.testing.assert_allclose(motion.point, point, atol=1e-9)
    # The complex holds the legs: l · q̂ + l̂ · q = 0.
    unit = legs / np.linalg.norm(legs, axis=1, keepdims=True)
    q, q_hat = motion.complex[:3], motion.complex[3:]
    np.testing.assert_allclose(unit @ q_hat + np.cross(platform, unit) @ q, 0.0, atol=1e-12)


def test_the_least_rate_of_the_linear_complex_is_sigma_r():
    posture = turned(0, np.linspace(0.9, 1.3, 7))
    motion = gsp.instantaneous_motion(posture, "linear_complex")
    sigma = gsp.indices.complex_deviation_rotation(posture)
    np.testing.assert_allclose(motion.rates[..., 0], sigma, rtol=1e-12)
    rates = (posture.jacobian @ motion.twist[..., None])[..., 0]
    np.testing.assert_allclose(np.linalg.norm(rates, axis=-1), sigma, rtol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(motion.twist[..., 3:], axis=-1), 1.0, rtol=1e-12)


def test_the_two_singular_postures_of_figure_7():
    delta, gamma = singular_angle(1, -1.2, -0.7), singular_angle(0, 0.89, 1.39)
    assert round(delta, 2) == -0.95
    assert round(gamma, 2) == 1.14
    about_y = gsp.instantaneous_motion(turned(1, delta))
    np.testing.assert_allclose(np.abs(about_y.axis[:3]), [0, 1, 0], atol=1e-9)
    assert about_y.pitch == pytest.approx(0.0, abs=1e-9)
    about_x = gsp.instantaneous_motion(turned(0, gamma))
    np.testing.assert_allclose(np.abs(about_x.axis[:3]), [1, 0, 0], atol=1e-9)
    assert abs(about_x.pitch) == pytest.approx(0.52, abs=0.005)  # the source prints 0.53


def test_the_pitch_of_the_second_singular_posture_in_fifty_digits():
    """det J = 0 and its kernel, from (1) and (25) alone: the pitch is 0.5207, not 0.53."""
    with mpmath.workdps(50):
        mp = mpmath.mpf
        kappa = mpmath.sqrt(2 * mpmath.sqrt(5) - 2)
        alpha = -mpmath.atan((mpmath.sqrt(5) * kappa - mpmath.sqrt(15)) / 5)
        third = mpmath.pi / 3

        def jacobian(gamma):
            rows = []
            for k in range(6):
                middle = 2 * third * (k // 2)
                a = middle + (alpha if k % 2 else -alpha)
                b = middle + (third - alpha if k % 2 else alpha - third)
                base = (mpmath.cos(a), mpmath.sin(a), -kappa / 2)
                y = mpmath.sin(b)
                p = (mpmath.cos(b), mpmath.cos(gamma) * y, mpmath.sin(gamma) * y)
                u = [p[i] - base[i] for i in range(3)]
                size = mpmath.sqrt(sum(x * x for x in u))
                u = [x / size for x in u]
                moment = [
                    p[1] * u[2] - p[2] * u[1],
                    p[2] * u[0] - p[0] * u[2],
                    p[0] * u[1] - p[1] * u[0],
                ]
                rows.append(u + moment)
            return mpmath.matrix(rows)

        gamma = mpmath.findroot(lambda x: mpmath.det(jacobian(x)), mp("1.14"))
        j = jacobian(gamma)
        # Fix ω_x = 1 and solve for the other five components by least squares.
        known = [0, 1, 2, 4, 5]
        left = mpmath.matrix([[j[i, c] for c in known] for i in range(6)])
        x = mpmath.lu_solve(left, -j[:, 3])
        omega, v = (mp(1), x[3], x[4]), (x[0], x[1], x[2])
        pitch = sum(a * b for a, b in zip(omega, v, strict=True)) / sum(a * a for a in omega)
        assert mpmath.norm(left * x + j[:, 3]) < mp(10) ** -40
        assert abs(abs(pitch) - mp("0.5206787")) < mp("1e-7")
        posture = turned(0, float(gamma))
        assert float(pitch) == pytest.approx(gsp.instantaneous_motion(posture).pitch, abs=1e-9)


def test_pencil_and_bundle_near_double_and_triple_singularities():
    flat = nawratil.example_design(0.2).at(nawratil.example_pose([0.5, 1e-3, 0.0]))
    assert gsp.instantaneous_motion(flat).multiplicity()[2] == 3  # three motions out of a plane
    assert gsp.instantaneous_motion(flat).fit()[2] == "bundle"
    # Legs from the z-axis and all normal to it can turn about it and slide along it.
    rng = np.random.default_rng(3)
    z = rng.normal(size=6)
    base = np.column_stack((np.zeros((6, 2)), z))
    platform = np.column_stack((rng.normal(size=(6, 2)), z))
    motion = gsp.instantaneous_motion(
        gsp.Design(["D1"] * 6, base, platform).at(gsp.Pose([0, 0, 0]))
    )
    assert motion.multiplicity() == 2
    assert motion.fit() == "pencil"
    # Near it both are held badly, though not equally; a wide tolerance states it.
    near = gsp.Design(["D1"] * 6, base + 1e-4 * rng.normal(size=(6, 3)), platform)
    rates = gsp.instantaneous_motion(near.at(gsp.Pose([0, 0, 0]))).rates
    assert rates[1] < 1e-3 * rates[2]


def test_the_double_eigenvalue_of_the_example_set_is_a_pencil():
    """λ1 = λ2 and λ4 = λ5: where the double one is the largest, two complexes fit equally well."""
    posture = nawratil.example_design(0.2).at(nawratil.example_pose([0.1, 1.5]))
    motion = gsp.instantaneous_motion(posture)
    np.testing.assert_allclose(motion.rates[:, 0], motion.rates[:, 1], rtol=1e-9)
    assert (motion.multiplicity(1e-6) == 2).all()


@pytest.mark.parametrize("tolerance", [-1.0, -1e-9, 1.0, 2.0, float("nan")])
def test_tolerances_outside_0_to_1_are_errors(tolerance):
    """At 1 every twist would count, below 0 none, which stands for an undefined posture."""
    motion = gsp.instantaneous_motion(nawratil.example_design(0.2).at(nawratil.example_pose(0.5)))
    for method in (motion.multiplicity, motion.fit):
        with pytest.raises(InvalidInput, match="tolerance: expected a number in"):
            method(tolerance)
    assert motion.multiplicity(0.0) >= 1


def test_undefined_postures_are_nan_and_change_no_others():
    base = np.eye(6, 3) + np.arange(18.0).reshape(6, 3) % 5
    design = gsp.Design(["D1"] * 6, base, np.roll(base, 1, axis=0) + 0.3)
    touching = gsp.Pose(np.array([base[0] - design.platform_points[0], [0.1, 0.2, 3.0]]))
    for method in ("control_number", "linear_complex"):
        motion = gsp.instantaneous_motion(design.at(touching), method)
        assert np.isnan(motion.pitch[0])
        assert motion.multiplicity()[0] == 0
        alone = gsp.instantaneous_motion(design.at(touching[1]), method)
        assert motion.pitch[1] == pytest.approx(alone.pitch, rel=1e-9)


def test_cylindrical_legs_need_a_length():
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    posture = design.at(design.home)
    with pytest.raises(MissingParameter):
        gsp.instantaneous_motion(posture)
    with pytest.raises(InvalidInput, match="method"):
        gsp.instantaneous_motion(posture, "other")
    motion = gsp.instantaneous_motion(posture, length=160.0)
    rates = posture.weighted(160.0) @ motion.twists
    np.testing.assert_allclose(np.linalg.norm(rates, axis=-2), motion.rates, rtol=1e-9)


@pytest.mark.parametrize("turned", [[0.0, 0.0, 0.0], [0.3, -1.2, 0.7], [2.0, 0.1, -0.4]])
def test_a_translation_has_no_axis_in_any_frame(turned):
    """Six legs that are perpendicular to one direction do not hold the translation along it."""
    rng = np.random.default_rng(1)
    base, platform = rng.normal(size=(2, 6, 3))
    platform[:, 0] = base[:, 0]
    turn = gsp.geometry.exp3(turned)
    design = gsp.Design(["D1"] * 6, base @ turn.T, platform @ turn.T)
    motion = gsp.instantaneous_motion(design.at(gsp.Pose([0.0, 0.0, 0.0])))
    assert np.isnan(motion.pitch)
    assert np.isnan(motion.axis).all()
    along = motion.complex[3:]
    np.testing.assert_allclose(abs(along @ turn[:, 0]), 1.0, rtol=1e-12)
    np.testing.assert_array_equal(motion.complex[:3], 0.0)
