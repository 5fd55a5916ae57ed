"""The picture of a design in space."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.catalogue import design, design_names, instantiate, mechanisms
from gsp.errors import InvalidInput
from gsp.model.legs import LEGS as KINDS
from gsp.plots import mechanism
from gsp.plots.style import LEGS

DESIGN = design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


def rods(ax) -> list[np.ndarray]:
    """Ends of the thin rods of the legs, (2, 3) each."""
    return [np.array(line.get_data_3d()).T for line in ax.lines if line.get_linewidth() == 2.0]


def test_rods_are_as_long_as_the_joint_distances():
    """The legs of distances d1 … d4 come first; the common normal of A1 follows."""
    ax = mechanism(DESIGN)
    lengths = [np.linalg.norm(b - a) for a, b in rods(ax)]
    np.testing.assert_allclose(lengths[:4], DESIGN.at(DESIGN.home).joints[:4], rtol=1e-12)
    assert len(lengths) == DESIGN.n_legs


def test_feet_lie_on_the_anchor_lines():
    ax = mechanism(DESIGN)
    pose = DESIGN.home
    for i, (foot, top) in enumerate(rods(ax)):
        off = foot - DESIGN.base_points[i]
        s, t = DESIGN.base_directions[i], pose.rotation @ DESIGN.platform_directions[i]
        distance = np.linalg.norm(np.cross(off, s) if np.isfinite(s).all() else off)
        assert distance < 1e-9
        off = top - (pose.position + pose.rotation @ DESIGN.platform_points[i])
        assert np.linalg.norm(np.cross(off, t) if np.isfinite(t).all() else off) < 1e-9


def test_scales_are_equal():
    ax = mechanism(DESIGN)
    spans = [np.ptp(limits) for limits in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
    aspect = np.array(ax._box_aspect)
    np.testing.assert_allclose(aspect / aspect.max(), np.array(spans) / max(spans), rtol=1e-6)


def test_legend_names_the_legs_that_are_there():
    texts = [t.get_text() for t in mechanism(DESIGN).get_legend().get_texts()]
    assert texts == [
        "D1 (SPS)", "D2 (SPC)", "D3 (CPS)", "A1 (CCC)", "D4 A1 (CCC)", "S joint", "C joint",
    ]  # fmt: skip
    assert set(LEGS) == {kind.name for kind in KINDS}
    assert len(set(LEGS.values())) == len(LEGS)


@pytest.mark.parametrize("name", design_names())
def test_every_published_design_draws(name, tmp_path):
    mechanism(design(name)).get_figure().savefig(tmp_path / "x.png", dpi=40)


@pytest.mark.parametrize("i", range(0, 195, 39))
def test_mechanisms_of_the_catalogue_draw(i, tmp_path):
    placed = instantiate(mechanisms()[i], design("toz-kucuk-2016-d3-6"))
    mechanism(placed).get_figure().savefig(tmp_path / "x.png", dpi=40)


def test_undefined_legs_are_named():
    points = DESIGN.base_points.copy()
    points[0] = DESIGN.platform_points[0]
    ax = mechanism(DESIGN.replace(base_points=points), gsp.Pose([0.0, 0.0, 0.0]))
    assert "undefined here: d1" in ax.get_title()
    assert len(rods(ax)) < DESIGN.n_legs


def test_given_axes_and_pose_are_used():
    import matplotlib.pyplot as plt

    ax = plt.figure().add_subplot(projection="3d")
    assert mechanism(DESIGN, gsp.Pose([0.0, 0.0, 120.0]), ax) is ax


def test_refuses_batches_and_missing_poses():
    with pytest.raises(InvalidInput, match="a single pose"):
        mechanism(DESIGN, gsp.Pose(np.zeros((2, 3))))
    with pytest.raises(InvalidInput, match="no home pose"):
        mechanism(DESIGN.replace(home=None))
