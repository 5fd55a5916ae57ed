"""Weights of platform and legs against differences of their potential energy."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.statics import Masses, gravity_wrench, holding_forces
from tests import driven
from tests.support import derivative, random_design, random_pose, turn

LEGS = [["D1"] * 6, ["D2", "D3", "D4", "A1", "D4 A1"], ["D1", "D2", "D3", "D4", "D1", "D1", "D2"]]
DOWN = np.array([1.0, -2.0, -9.0])


def energy(design, masses, pose):
    """Minus gravity times mass and place of each body; feet from `Posture.segments`."""
    found = design.at(pose).segments
    platform = pose.position + pose.rotation @ masses.centre
    lower = found.base_feet + masses.lower_centre[:, None] * found.direction
    upper = found.platform_feet - masses.upper_centre[:, None] * found.direction
    return -masses.platform * platform @ DOWN - (
        masses.lower * (lower @ DOWN) + masses.upper * (upper @ DOWN)
    ).sum(axis=-1)


@pytest.mark.parametrize("legs", LEGS, ids=" ".join)
def test_the_wrench_is_the_slope_of_the_potential_energy(legs):
    rng = np.random.default_rng(len(legs))
    design, pose = random_design(rng, legs), random_pose(rng, (2,))
    numbers = rng.uniform(0.1, 1.0, (4, len(legs)))
    masses = Masses(2.5, [0.1, -0.2, 0.4], *numbers)
    found = gravity_wrench(design, pose, masses, DOWN)
    slope = derivative(lambda pose: energy(design, masses, pose), pose)
    assert found.shape == (2, 6)
    np.testing.assert_allclose(found, -slope, atol=1e-8)
    forces = holding_forces(design, pose, masses, DOWN)
    np.testing.assert_allclose(design.at(pose).wrench(forces), -found, atol=1e-9)


def lower_links(design, masses, posture):
    """Centres of carriages and of cranks, turned by Rodrigues' formula, and of lower links."""
    found = posture.segments
    centres = found.base_feet + masses.lower_centre[:, None] * found.direction
    for row, (leg, _) in enumerate(design.rows):
        drive, s, a = design.drives[leg], design.base_directions[leg], design.base_points[leg]
        q = posture.joints[..., row, None]
        if isinstance(drive, gsp.Slider):
            centres[..., leg, :] = a + (q + 0.3) * s + [0.1, 0.2, 0.3]  # wherever it is
        elif isinstance(drive, gsp.Crank):
            across = np.array(drive.arm) - s * (s @ drive.arm)
            point = masses.lower_centre[leg] * across / np.linalg.norm(across)
            turned = point * np.cos(q) + np.cross(s, point) * np.sin(q)
            centres[..., leg, :] = a + turned + 0.7 * s
    return centres


@pytest.mark.parametrize("name", driven.DESIGNS)
def test_carriages_cranks_and_rods_have_the_slope_of_their_potential_energy(name):
    """Also with counterweights, whose centres are on the other side of the axis."""
    rng = np.random.default_rng(4)
    design, pose = driven.DESIGNS[name], driven.near_home(driven.DESIGNS[name], 2)
    numbers = rng.uniform(0.1, 1.0, (4, design.n_legs))
    numbers[1, ::2] *= -1.0
    masses = Masses(2.5, [0.1, -0.2, 0.4], *numbers)

    def energy(pose):
        posture = design.at(pose)
        found = posture.segments
        platform = pose.position + pose.rotation @ masses.centre
        lower = lower_links(design, masses, posture)
        upper = found.platform_feet - masses.upper_centre[:, None] * found.direction
        legs = masses.lower * (lower @ DOWN) + masses.upper * (upper @ DOWN)
        return -masses.platform * platform @ DOWN - legs.sum(axis=-1)

    found = gravity_wrench(design, pose, masses, DOWN)
    np.testing.assert_allclose(found, -derivative(energy, pose), atol=1e-7)
    forces = holding_forces(design, pose, masses, DOWN)
    np.testing.assert_allclose(design.at(pose).wrench(forces), -found, atol=1e-9)
    many = gsp.Pose(np.repeat(pose.position[:1], 800, axis=0), pose.rotation[0])
    np.testing.assert_array_equal(gravity_wrench(design, many, masses, DOWN)[799], found[0])


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_forces_that_hold_do_not_depend_on_frames_and_units(unit):
    rng = np.random.default_rng(8)
    design, pose = random_design(rng, LEGS[1]), random_pose(rng)
    at = {"lower_centre": 0.3, "upper_centre": 0.2}
    masses = Masses(2.5, [0.1, -0.2, 0.4], lower=0.7, upper=0.4, **at)
    ours = holding_forces(design, pose, masses, DOWN)
    # Another origin of the platform, other axes of the base, and another unit of length.
    shift, axes = rng.normal(size=3), turn(rng.normal(size=3))
    other = design.with_origin(shift)
    placed = pose.compose(gsp.Pose(shift))
    other = other.replace(
        base_points=unit * other.base_points @ axes.T,
        base_directions=other.base_directions @ axes.T,
        platform_points=unit * other.platform_points,
    )
    placed = gsp.Pose(unit * axes @ placed.position, axes @ placed.rotation)
    at = {name: unit * value for name, value in at.items()}
    same = Masses(2.5, unit * (masses.centre - shift), lower=0.7, upper=0.4, **at)
    theirs = holding_forces(other, placed, same, axes @ DOWN)
    expected = ours * np.where(design.angular, unit, 1.0)
    np.testing.assert_allclose(theirs, expected, rtol=1e-9)


def test_a_batch_is_its_elements():
    rng = np.random.default_rng(2)
    design, masses = random_design(rng, LEGS[1]), Masses(lower=1.0, upper=0.5, upper_centre=0.2)
    pose = random_pose(rng, (800,))  # more than are evaluated at once
    found = gravity_wrench(design, pose, masses)
    for i in (0, 700, 799):
        np.testing.assert_array_equal(found[i], gravity_wrench(design, pose[i], masses))


def test_a_vertical_strut_of_each_leg_has_a_closed_form():
    """Under a platform on parallel legs each leg carries its share and its upper link."""
    ring = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])
    design = gsp.Design(["D1"] * 6, ring, ring)
    wrench = gravity_wrench(design, gsp.Pose([0, 0, 2.0]), Masses(6.0, lower=1.0, upper=2.0))
    # A lower link that does not move does no work; an upper one moves with the platform.
    np.testing.assert_allclose(wrench, [0, 0, -9.81 * 18.0, 0, 0, 0], atol=1e-12)


def test_a_payload_adds_up():
    masses = Masses(platform=3.0, centre=[0.0, 0.1, 0.0], lower=[1.0] * 6)
    both = masses.carrying(1.0, [0.4, 0.1, 0.8])
    assert both.platform == 4.0
    np.testing.assert_allclose(both.centre, [0.1, 0.1, 0.2])
    assert (both.lower == 1.0).all()
    assert Masses().carrying(0.0).platform == 0.0
    design = gsp.hexapod(1.0, 0.3, 0.5, 0.3, 1.0)
    apart = [gravity_wrench(design, design.home, m) for m in (masses, Masses().carrying(
        1.0, [0.4, 0.1, 0.8]))]  # fmt: skip
    np.testing.assert_allclose(gravity_wrench(design, design.home, both), sum(apart), atol=1e-12)


def test_undefined_and_singular_postures_are_not_held():
    ring = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])
    design = gsp.Design(["D1"] * 6, ring, ring)
    pose = gsp.Pose([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    assert np.isnan(holding_forces(design, pose, Masses(1.0, upper=1.0))).all()
    assert np.isnan(gravity_wrench(design, pose, Masses(1.0, upper=1.0))).all(axis=-1).tolist() == [
        False,
        True,
    ]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"platform": -1.0}, r"masses\.platform: expected a number from 0"),
        ({"lower": [1.0, -2.0]}, r"masses\.lower: expected numbers ≥ 0, received -2"),
        ({"centre": [1.0, 2.0]}, r"masses\.centre"),
        ({"upper": [[1.0]]}, r"masses\.upper: expected one number, or shape \(n_legs,\)"),
    ],
)
def test_bad_masses(given, message):
    with pytest.raises(InvalidInput, match=message):
        Masses(**given)


def test_masses_of_another_number_of_legs():
    design = gsp.hexapod(1.0, 0.3, 0.5, 0.3, 1.0)
    with pytest.raises(InvalidInput, match=r"masses\.upper: expected one number, or 6, received 5"):
        holding_forces(design, design.home, Masses(upper=[1.0] * 5))


@pytest.mark.parametrize("gravity", [9.81, [0.0, 0.0], [[0.0, 0.0, -1.0]] * 2])
def test_gravity_is_one_vector(gravity):
    rng = np.random.default_rng(1)
    with pytest.raises(InvalidInput, match=r"gravity: expected three numbers, shape \(3,\)"):
        gravity_wrench(random_design(rng, LEGS[0]), random_pose(rng), Masses(1.0), gravity)
