"""Pictures of all assembly modes: a panel for each, coloured by its side of det J = 0."""

from dataclasses import replace

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from tests import driven

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
LIFT = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)


def test_each_mode_has_a_panel_of_the_same_scale_with_its_platform():
    modes = gsp.assembly_modes(LIFT, LIFT.at(LIFT.home).joints)
    figure = gsp.plots.assembly_modes(LIFT, modes)
    assert [ax.get_title() for ax in figure.axes] == [f"{i + 1}" for i in range(8)]
    assert len({ax.get_xlim() + ax.get_ylim() + ax.get_zlim() for ax in figure.axes}) == 1
    assert figure.get_suptitle() == "hexapod: 8 real of 28 complex modes"
    anchors = LIFT.platform_points @ np.swapaxes(modes.poses.rotation, -1, -2)
    anchors = anchors + modes.poses.position[:, None]
    for ax, ends in zip(figure.axes, anchors, strict=True):
        tops = [np.array(line.get_data_3d())[:, 1] for line in ax.lines]
        np.testing.assert_allclose(tops, ends, atol=1e-12)
    faces = [ax.collections[2].get_facecolor()[0, :3] for ax in figure.axes]
    blue = np.array([face[2] > face[0] for face in faces])
    np.testing.assert_array_equal(blue, modes.side > 0)


def test_a_mode_that_is_far_away_leaves_the_others_their_scale(monkeypatch):
    monkeypatch.setattr("gsp.plots.modes._check_joints", lambda *_: None)  # it is moved by hand
    modes = gsp.assembly_modes(LIFT, LIFT.at(LIFT.home).joints)
    near = gsp.plots.assembly_modes(LIFT, modes).axes[0]
    position = modes.poses.position + np.array([0.0, 0.0, 60.0]) * (np.arange(8) == 1)[:, None]
    far = replace(modes, poses=gsp.Pose(position, modes.poses.rotation))
    figure = gsp.plots.assembly_modes(LIFT, far)
    sides = [np.ptp(ax.get_zlim()) for ax in figure.axes]
    assert sides[1] > 55.0
    assert max(sides[:1] + sides[2:]) <= np.ptp(near.get_zlim())
    assert "each panel has its own scale" in figure.get_suptitle()


def test_what_is_not_modes_or_none_at_all_is_refused():
    modes = gsp.assembly_modes(LIFT, [1.0, 1.0, 1.0, 1.0, 1.0, 50.0])
    with pytest.raises(InvalidInput, match="at least one real mode, received none"):
        gsp.plots.assembly_modes(LIFT, modes)
    with pytest.raises(InvalidInput, match="modes"):
        gsp.plots.assembly_modes(LIFT, "modes")
    modes = gsp.assembly_modes(LIFT, LIFT.at(LIFT.home).joints)
    eight = gsp.Design(["D1"] * 8, *np.random.default_rng(0).normal(size=(2, 8, 3)))
    for other in (gsp.hexapod(2.0, 0.3, 1.0, 0.5, 1.5), eight):
        with pytest.raises(InvalidInput, match="expected the one of the modes"):
            gsp.plots.assembly_modes(other, modes)


def test_base_and_platform_go_through_their_anchors_and_legs_end_at_their_feet():
    up = np.array([[0.3, 0.1, 1.0]] * 6)
    legs = ["D2", *["D1"] * 5]  # the line of the first one is that of the base
    design = gsp.Design(legs, LIFT.base_points, LIFT.platform_points, up, up)
    modes = gsp.assembly_modes(design, design.at(LIFT.home).joints)
    figure = gsp.plots.assembly_modes(design, modes)
    feet = design.at(modes.poses).segments
    for i, ax in enumerate(figure.axes):
        ends = np.array([np.transpose(line.get_data_3d()) for line in ax.lines])
        legs = ends[:6]
        np.testing.assert_allclose(legs[:, 0], feet.base_feet[i], atol=1e-9)
        np.testing.assert_allclose(legs[:, 1], feet.platform_feet[i], atol=1e-9)
        anchors = modes.poses[i].position + design.platform_points @ modes.poses[i].rotation.T
        starts = np.vstack((design.base_points, anchors))
        apart = np.abs(starts - np.vstack((feet.base_feet[i], feet.platform_feet[i])))
        slides = np.flatnonzero(apart.max(axis=1) > 1e-3)
        assert slides.size == 1
        np.testing.assert_allclose(ends[6:, 0], starts[slides], atol=1e-9)


def test_one_mode_and_a_singular_one_are_drawn():
    modes = gsp.assembly_modes(LIFT, LIFT.at(LIFT.home).joints)
    one = replace(modes, poses=modes.poses[:1], side=np.zeros(1), condition=np.array([np.inf]))
    figure = gsp.plots.assembly_modes(LIFT, one)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["singular"]


def test_rods_of_driven_legs_are_drawn_from_their_tips_and_other_branches_are_labelled():
    design = gsp.catalogue.design("lane-rotary")
    joints = design.at(design.home).joints + 0.1
    modes = gsp.assembly_modes(design, joints)
    assert not modes.on_branches.all()
    figure = gsp.plots.assembly_modes(design, modes)
    tips = driven.tips(design, design.at(modes.poses[int(modes.on_branches.argmax())]))
    for i, ax in enumerate(figure.axes):
        assert ("other branch" in ax.get_title()) == (not modes.on_branches[i])
        rods = [np.array(line.get_data_3d()).T for line in ax.lines[:6]]
        cranks = [np.array(line.get_data_3d()).T for line in ax.lines[6:12]]
        for leg, (rod, arm) in enumerate(zip(rods, cranks, strict=True)):
            np.testing.assert_allclose(rod[0], tips[leg], atol=1e-9)
            np.testing.assert_allclose(arm, [design.base_points[leg], tips[leg]], atol=1e-9)
            assert np.linalg.norm(rod[1] - rod[0]) == pytest.approx(design.drives[leg].rod)
