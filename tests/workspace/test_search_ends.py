"""A search of cells that ends early, by its levels or its budget, proves nothing false."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.workspace.sets import dextrous, fixed_orientation, orientations, reachable
from gsp.workspace.sets.tree import growing

SIX_THREE = gsp.catalogue.design("workspace-6-3")
PLANE = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
TILTS = gsp.PoseBox([0, 0, 0], [(-5, 5), (-5, 5), (0, 0)], degrees=True, order="approach-roll")
QUESTIONS = {
    "one orientation": lambda **k: fixed_orientation(SIX_THREE, **k),
    "plane": lambda **k: fixed_orientation(SIX_THREE, plane=PLANE, **k),
    "all angles": lambda **k: dextrous(SIX_THREE, TILTS, **k),
    "some angles": lambda **k: reachable(SIX_THREE, rotations=TILTS, **k),
    "orientations": lambda **k: orientations(SIX_THREE, [0.0, 0.0, 10.5], **k),
}


@pytest.mark.parametrize("resolution", [None, 1e-300, 1e-3])
@pytest.mark.parametrize("half", [0.0, 1e-9])
def test_a_set_of_one_position_is_never_proven_empty(half, resolution):
    """The cells around it stay undecided, however often they are halved."""
    pose = gsp.Pose([0.3, 0.2, 8.0], np.eye(3))
    strokes = SIX_THREE.at(pose).joints[:, None] + half * np.array([-1.0, 1.0])
    region = fixed_orientation(SIX_THREE.replace(strokes=strokes), resolution=resolution)
    assert not region.empty
    assert region.volume[1] > 0.0
    assert region.contains(pose.position) >= 0


@pytest.mark.parametrize("question", QUESTIONS)
def test_an_early_end_proves_no_less_than_a_late_one(monkeypatch, question):
    ask = QUESTIONS[question]
    low, high = ask(budget=40_000).bracket
    assert 0.0 <= low < high
    for budget in (1, 100, 3000):
        least, most = ask(budget=budget).bracket
        assert least <= high
        assert most >= low
    for levels in (0, 1, 4, 9):
        monkeypatch.setattr(growing, "MOST_LEVELS", levels)
        region = ask(budget=40_000)
        assert region.levels <= levels
        assert region.bracket[0] <= high
        assert region.bracket[1] >= max(low, 0.01 * high)
