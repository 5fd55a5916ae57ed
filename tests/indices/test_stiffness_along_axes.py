"""k_x, k_y, k_z: closed forms, linear systems, other axes and origins, and singular postures."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.indices import INDICES
from tests import driven
from tests.indices import nawratil_cases as cases
from tests.support import random_design, random_pose

NAMES = ("stiffness_x", "stiffness_y", "stiffness_z")
LENGTH = 0.8


def along_axes(posture, length=None):
    """The three values, shape (..., 3)."""
    return np.stack([INDICES[name].function(posture, length) for name in NAMES], axis=-1)


def by_linear_systems(posture, length):
    """Force along n per displacement along n: 12 unknowns, (displacement, wrench) of one pose.

    The springs are in equilibrium with a wrench along n that moves the origin by one along n.
    """
    rows = posture.jacobian * np.where(posture.angular, length, 1.0)[:, None]
    values = []
    for axis in range(3):
        # K x − w = 0; the five other parts of w are zero, and x is 1 along the axis.
        system, right = np.zeros((12, 12)), np.zeros(12)
        system[:6] = np.hstack((rows.T @ rows, -np.eye(6)))
        for row, part in enumerate(np.delete(np.arange(6), axis)):
            system[6 + row, 6 + part] = 1.0
        system[11, axis], right[11] = 1.0, 1.0
        values.append(np.linalg.solve(system, right)[6 + axis])
    return values


@pytest.mark.parametrize(
    "legs",
    [["D1"] * 6, ["D1", "D2", "D3", "D4", "D4 A1"], ["D1", "D2", "D3", "A1", "D4 A1", "D1", "D4"],
     ["D4 A1"] * 3, ["D1"] * 8],
)  # fmt: skip
def test_a_force_along_the_axis_moves_the_origin_by_its_share(legs):
    rng = np.random.default_rng(len(legs))
    design, pose = random_design(rng, legs), random_pose(rng, (3,))
    posture = design.at(pose)
    found = along_axes(posture, LENGTH)
    springs = np.where(design.angular, LENGTH**2, 1.0)
    for i in range(3):
        wanted = by_linear_systems(design.at(pose[i]), LENGTH)
        np.testing.assert_allclose(found[i], wanted, rtol=1e-9)
        other = gsp.statics.directional_stiffness(design, pose[i], springs, np.eye(3))
        np.testing.assert_allclose(found[i], other, rtol=1e-12)
    assert (found > 0.0).all()
    assert (found <= (~design.angular).sum()).all()


@pytest.mark.parametrize("make", [driven.hexaglide, driven.rotary, driven.mixed])
def test_drives_at_the_base(make):
    design = make()
    posture = design.at(design.home)
    wanted = by_linear_systems(posture, LENGTH)
    np.testing.assert_allclose(along_axes(posture, LENGTH), wanted, rtol=1e-9)


def test_the_cube_is_as_stiff_as_two_legs_along_each_axis():
    """Its legs are the edges of a cube, two along each of three directions across each other."""
    design = gsp.catalogue.design("dehaeze-cubic-centred")
    assert along_axes(design.at(design.home)) == pytest.approx([2.0] * 3, rel=1e-12)


def test_the_usual_hexapod_in_closed_form():
    """By symmetry a force along z lifts the platform alone: 6 (h/l)², with the leg length l."""
    height = 1.2
    design = gsp.hexapod(1.0, 0.4, 0.6, 0.5, height)
    posture = design.at(design.home)
    x, y, z = along_axes(posture)
    assert z == pytest.approx(6.0 * (height / posture.joints[0]) ** 2, rel=1e-12)
    assert x == pytest.approx(y, rel=1e-12)
    # With the turn held, the legs give this along x; a free turn makes it less.
    assert x < 3.0 * (1.0 - (height / posture.joints[0]) ** 2)


def test_values_along_turned_axes_are_those_of_the_turned_directions():
    rng = np.random.default_rng(4)
    design, pose = random_design(rng, ["D1", "D2", "D3", "D4", "D1", "D1"]), random_pose(rng)
    turn = random_pose(rng).rotation
    given = {name: getattr(design, name) @ turn.T for name in ("base_points", "base_directions")}
    turned = design.replace(**given).at(gsp.Pose(turn @ pose.position, turn @ pose.rotation))
    wanted = gsp.statics.directional_stiffness(design, pose, 1.0, turn)
    np.testing.assert_allclose(along_axes(turned), wanted, rtol=1e-10)
    assert np.abs(along_axes(turned) / along_axes(design.at(pose)) - 1.0).min() > 1e-3


def test_an_origin_on_the_same_line_of_force_changes_nothing_along_it():
    rng = np.random.default_rng(5)
    design = random_design(rng, ["D1"] * 6)
    there = gsp.Pose(rng.normal(size=3) + [0.0, 0.0, 3.0])
    before = along_axes(design.at(there))
    for axis in range(3):
        step = 0.7 * np.eye(3)[axis]
        shifted = design.replace(platform_points=design.platform_points - step)
        after = along_axes(shifted.at(gsp.Pose(there.position + step)))
        same = np.arange(3) == axis
        np.testing.assert_allclose(after[same], before[same], rtol=1e-10)
        assert (np.abs(after / before - 1.0)[~same] > 1e-3).all()


def test_it_is_zero_at_a_singular_posture():
    flat = cases.singular_by_a_translation()
    for posture in (flat, cases.singular_by_a_turn()):
        assert (along_axes(posture) == 0.0).all()
    # At a height h the legs have slopes of order h, and hold z with their squares.
    near = [along_axes(flat.design.at(gsp.Pose([0.0, 0.0, h])))[2] for h in (1e-2, 1e-3)]
    assert near[0] / near[1] == pytest.approx(100.0, rel=0.05)


def test_it_may_be_large_near_a_singular_posture():
    """Six legs that become parallel: they hold z, and neither x nor y."""
    height = 1.2
    for step in (1e-2, 1e-6, 0.0):
        design = gsp.hexapod(1.0, np.pi / 3 - step, 1.0, np.pi / 3 - step, height)
        posture = design.at(design.home)
        x, y, z = along_axes(posture)
        assert posture.singular() == (step == 0.0)
        up = (height / posture.joints[0]) ** 2
        assert z == pytest.approx(6.0 * up if step else 0.0, rel=1e-8)
        assert max(x, y) <= 3.0 * step**2


def test_lengths_are_for_angles_alone():
    rng = np.random.default_rng(6)
    with_angles = random_design(rng, ["D1"] * 4 + ["A1"] * 2).at(random_pose(rng))
    without = random_design(rng, ["D1"] * 5 + ["D3"]).at(random_pose(rng))
    for name in NAMES:
        function = INDICES[name].function
        with pytest.raises(MissingParameter, match="length"):
            function(with_angles)
        assert function(without) == function(without, 3.0)
        assert function(with_angles, 3.0) > function(with_angles, 2.0)
        for wrong in (0.0, -1.0, np.nan, "1", True, [1.0]):
            with pytest.raises(InvalidInput, match="length"):
                function(without, wrong)


def test_a_table_is_ranked_by_it_when_it_is_named():
    designs = [gsp.hexapod(1.0, 0.4, r, 0.5, 1.2) for r in (0.4, 0.6, 0.8)]
    poses = gsp.Pose([[0.0, 0.0, z] for z in (1.0, 1.2)])
    table = gsp.rank(designs, poses, "k_x, k_z", by="k_z")
    assert (np.diff(table["stiffness_z_mean"]) <= 0.0).all()
    assert not any(name.startswith("stiffness") for name in gsp.evaluate(designs[0], poses))
