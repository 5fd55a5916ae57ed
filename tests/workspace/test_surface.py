import numpy as np
import pytest

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput
from gsp.workspace import exact_shells, surface
from gsp.workspace.surfaces import symmetry


def test_volume_of_a_fixed_orientation_against_the_exact_one(platform):
    """The part above the base is star-shaped about its middle."""
    mapped = surface(platform, [0.0, 0.0, 8.5], rotation=np.eye(3), counts=(61, 72))
    exact = exact_shells(platform).volume((0.0, np.inf)).value
    assert mapped.maximal.all()
    assert mapped.folds == 1
    volume = mapped.volume()
    assert volume.value == pytest.approx(exact, rel=2e-3)
    assert abs(volume.value - exact) <= 3 * volume.error < 0.05 * exact
    shells = exact_shells(platform)
    assert shells.contains(mapped.points, 1e-9).all()
    outside = mapped.origin + 1.001 * (mapped.points - mapped.origin)
    assert not shells.contains(outside).any()


def test_reachable_ends_are_feasible_symmetric_and_farther_than_with_fixed_orientation(platform):
    counts = (4, 6)
    free = surface(platform, counts=counts, starts=2)
    fixed = surface(platform, rotation=np.eye(3), counts=(12, 6))
    assert free.folds == 3
    assert free.points.shape == (12, 6, 3)
    assert free.maximal.mean() > 0.9
    known = free.maximal.repeat(3, axis=0).reshape(4, 3, 6).transpose(1, 0, 2).reshape(12, 6)
    far = np.linalg.norm(free.points - free.origin, axis=-1)
    near = np.linalg.norm(fixed.points - fixed.origin, axis=-1)
    assert (far[known] >= near[known] - 1e-9).all()


def test_symmetry_of_designs():
    assert symmetry(gsp.catalogue.design("workspace-6-3")) == 3
    assert symmetry(gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")) == 1
    uneven = gsp.catalogue.design("workspace-6-3")
    strokes = uneven.strokes.copy()
    strokes[0, 1] = 14.0
    assert symmetry(uneven.replace(strokes=strokes)) == 1


def test_bad_input(platform):
    with pytest.raises(EmptyWorkspace):
        surface(platform, [0.0, 0.0, 40.0])
    with pytest.raises(InvalidInput, match="origin: expected numbers of at most"):
        surface(platform, [1e200] * 3)
    with pytest.raises(InvalidInput, match="counts: expected an integer"):
        surface(platform, counts=(0, 3))
