"""The canonical form of designs: the changes on which it depends, and the others."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.determinant.canonical import canonical
from gsp.determinant.domain import Neighbourhood
from gsp.families import lee
from gsp.geometry.pose import Pose, PoseBox
from gsp.indices import manipulability

LEGS = [["D1"] * 6, ["D1", "D2", "D3", "D4 A1", "A1"], ["D3"] * 6, ["D1"] * 7]


def random_design(legs, seed=0):
    return gsp.Design(legs, *np.random.default_rng(seed).normal(size=(4, len(legs), 3)))


def moved(design, seed=1, factor=25.4):
    """The design in other axes of base and platform, another unit, another order of legs."""
    rng = np.random.default_rng(seed)
    low, high = (Pose.from_rpy(rng.normal(size=3), rng.normal(size=3)) for _ in range(2))
    order = rng.permutation(design.n_legs)
    points = [
        (p @ m.rotation.T + m.position)[order] * factor
        for p, m in ((design.base_points, low), (design.platform_points, high))
    ]
    lines = [
        (d @ m.rotation.T)[order]
        for d, m in ((design.base_directions, low), (design.platform_directions, high))
    ]
    return gsp.Design([design.legs[i].name for i in order], *points, *lines)


@pytest.mark.parametrize("legs", LEGS)
def test_key_is_invariant_under_axes_unit_order_and_exchange(legs):
    design = random_design(legs)
    key = canonical(design).key
    assert canonical(moved(design)).key == key
    assert canonical(moved(design).exchanged()).key == key
    assert canonical(random_design(legs, seed=5)).key != key


@pytest.mark.parametrize("design", [lee.octahedral_3_3(1, 2), lee.separated_along_side(1, 2, 0.2)])
def test_key_is_invariant_under_them_for_symmetric_designs(design):
    key = canonical(design).key
    assert all(canonical(moved(design, seed)).key == key for seed in range(5))


def test_key_differs_for_a_change_of_a_millionth_and_for_other_pairs_of_anchors():
    design = random_design(["D1"] * 6)
    points = design.base_points.copy()
    points[0, 0] += 1e-6
    assert canonical(design.replace(base_points=points)).key != canonical(design).key
    swapped = design.replace(platform_points=design.platform_points[[1, 0, 2, 3, 4, 5]])
    assert canonical(swapped).key != canonical(design).key


@pytest.mark.parametrize("legs", LEGS)
def test_poses_go_in_and_out_with_the_determinant(legs):
    design = random_design(legs)
    other = moved(design).exchanged()
    pose = Pose.from_rpy([0.3, 0.4, 0.9], [0.1, 0.2, 0.3])
    here, there = canonical(design), canonical(other)
    back = here.outward(here.inward(pose))
    np.testing.assert_allclose(back.position, pose.position, atol=1e-12)
    np.testing.assert_allclose(back.rotation, pose.rotation, atol=1e-12)
    value = manipulability(design.at(pose)) / here.scale(design)
    carried = there.outward(here.inward(pose))
    other_value = manipulability(other.at(carried)) / there.scale(other)
    assert other_value == pytest.approx(float(value), rel=1e-10)


def test_redundant_designs_with_angles_keep_their_unit():
    # By Cauchy and Binet, sqrt(det JᵀJ) then has terms of different powers of the length.
    design = random_design(["D1"] * 5 + ["A1", "A1"])
    assert canonical(design).length == 1.0
    assert canonical(design).design.rms_radius == pytest.approx(design.rms_radius)
    assert canonical(design.scaled(2.0)).key != canonical(design).key
    assert canonical(design.scaled(1.0 + 1e-6)).key != canonical(design).key


@pytest.mark.parametrize("unit", [1e-60, 1e-9, 1.0, 1e12, 1e60])
def test_their_keys_are_rounded_by_their_size(unit):
    plain = random_design(["D1"] * 5 + ["A1", "A1"])
    other, far = (d.scaled(unit) for d in (moved(plain, factor=1.0), plain))
    assert canonical(other).key == canonical(far).key == canonical(other.exchanged()).key
    points = far.base_points.copy()
    points[0, 0] += 1e-12 * unit
    near = far.replace(base_points=points)
    assert canonical(near).key == canonical(far).key
    points[0, 0] += 1e-6 * unit
    changed = far.replace(base_points=points)
    assert canonical(changed).key != canonical(far).key

    box, wide = (PoseBox([(-k * unit, k * unit)] * 3, [(-0.2, 0.2)] * 3) for k in (1.0, 2.0))
    assert canonical(near, box).key == canonical(far, box).key
    assert canonical(changed, box).key != canonical(far, box).key
    assert canonical(far, wide).key != canonical(far, box).key
    assert canonical(plain.scaled(2.0 * unit), wide).key != canonical(far, box).key
    here, there = (
        Neighbourhood(home=Pose(np.zeros(3)), centre=np.zeros(3), displacement=k * unit, angle=0.1)
        for k in (1.0, 2.0)
    )
    assert canonical(near, here).key == canonical(far, here).key
    assert canonical(far, there).key != canonical(far, here).key


def test_over_a_box_axes_matter_and_order_and_unit_do_not():
    design = random_design(["D2"] * 3 + ["D3"] * 3)
    box = PoseBox([(-1, 1)] * 3, [(-0.2, 0.2)] * 3)
    key = canonical(design, box).key
    order = [2, 0, 1, 5, 4, 3]
    permuted = gsp.Design(
        [design.legs[i].name for i in order],
        design.base_points[order],
        design.platform_points[order],
        design.base_directions[order],
        design.platform_directions[order],
    )
    assert canonical(permuted, box).key == key
    wide = PoseBox([(-25.4, 25.4)] * 3, [(-0.2, 0.2)] * 3)
    assert canonical(design.scaled(25.4), wide).key == key
    assert canonical(design.scaled(25.4), box).key != key
    assert canonical(design).key != key
    assert canonical(moved(design, factor=1.0), box).key != key
