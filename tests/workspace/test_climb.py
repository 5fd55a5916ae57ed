import numpy as np
import pytest

import gsp
from gsp.limits.bounds import bounded_quantities
from gsp.workspace import Limits, feasible
from gsp.workspace.boundary.climb import climb_compiled, climb_stacked
from gsp.workspace.boundary.mapping import feasible_orientations


@pytest.mark.parametrize("turns", [np.eye(3), np.eye(3)[2:], np.zeros((0, 3))])
def test_compiled_and_stacked_climbs_end_at_the_same_poses(platform, turns):
    bounds = bounded_quantities(platform)
    turn = feasible_orientations(platform, bounds, platform.home.position, None, 40, 3)
    place = np.tile(platform.home.position, (len(turn), 1))
    heading = np.random.default_rng(1).normal(size=place.shape)
    heading /= np.linalg.norm(heading, axis=1)[:, None]
    one = climb_stacked(bounds, turns, place.copy(), turn.copy(), heading)
    two = climb_compiled(bounds, turns, place.copy(), turn.copy(), heading)
    assert np.abs(one.position - place).max() > 1.0
    assert np.abs(one.position - two.position).max() < 1e-9 * bounds.scale
    assert np.abs(one.rotation - two.rotation).max() < 1e-9
    assert np.abs(one.slack - two.slack).max() < 1e-9


def test_thresholds_by_compiled_code_are_those_of_the_indices(platform, monkeypatch):
    pose = gsp.PoseBox.around(platform.home, [3, 3, 3, 0.3, 0.3, 0.3]).sample(200, rng=1)
    bounds = Limits(indices=["condition_number <= 20", "CTN >= 0.1"], length=platform.rms_radius)
    exact = feasible(platform, pose, bounds)
    monkeypatch.setattr("gsp.limits.bounds.POSES_FOR_COMPILED", 1)
    fast = feasible(platform, pose, bounds)
    assert 0.1 < exact.ok.mean() < 0.9
    assert (exact.ok == fast.ok).all()
    assert np.allclose(exact.values, fast.values, rtol=1e-9)
