"""The indices that `Nawratil` reviews: over the whole catalogue, in batches, and at the edges."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.families import nawratil
from gsp.indices import INDICES, condition_number_ellipsoid, condition_number_points

REVIEWED = (
    "condition_number_plain",
    "condition_number_points",
    "complex_deviation_rotation",
    "complex_deviation_translation",
    "rigidity_rate",
)
TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
HEXAPOD = nawratil.example_design(0.1)


def test_they_are_computed_when_named_and_not_otherwise():
    named = gsp.evaluate(HEXAPOD, nawratil.example_pose(0.5), REVIEWED)
    assert list(named) == list(REVIEWED)
    unnamed = gsp.evaluate(HEXAPOD, nawratil.example_pose(0.5))
    assert not set(unnamed) & set(REVIEWED)


def test_the_whole_catalogue_can_be_ranked_by_them():
    designs = [gsp.catalogue.instantiate(m, TEMPLATE) for m in gsp.catalogue.mechanisms()]
    pose = gsp.Pose.sample(
        [(-20, 20), (-20, 20), (120, 150)], [(-10, 10)] * 3, 3, rng=1, degrees=True
    )
    assert len(designs) == 195
    for i, by in enumerate(REVIEWED):
        # All indices are computed each time: once for all designs, then for some in another order.
        some = designs if i == 0 else designs[i::10]
        table = gsp.rank(some, pose, REVIEWED, by, length=95.0)
        assert len(table) == len(some)
        assert (table["undefined"] == 0).all()
        means = table[f"{by}_mean"].to_numpy()
        direction = 1 if INDICES[by].better == "lower" else -1
        assert (direction * np.diff(means[np.isfinite(means)]) >= 0).all()


@pytest.mark.parametrize("name", REVIEWED)
@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
def test_a_batch_is_its_elements(name, shape):
    rng = np.random.default_rng(4)
    design = gsp.catalogue.instantiate(gsp.catalogue.mechanism("D1 D2 D3 D4 A1^2"), TEMPLATE)
    pose = gsp.Pose.from_rpy(
        rng.normal(size=(*shape, 3)) * 10 + np.array([0, 0, 138.0]),
        0.2 * rng.normal(size=(*shape, 3)),
    )
    index = INDICES[name]
    given = {k: 95.0 for k in index.missing(design, ())}
    values = index.function(design.at(pose), **given)
    assert np.shape(values) == shape
    for where in np.ndindex(shape):
        alone = index.function(design.at(pose[where]), **given)
        np.testing.assert_allclose(values[where], alone, rtol=1e-10)


@pytest.mark.parametrize("name", REVIEWED)
def test_an_undefined_pose_is_nan_and_changes_no_others(name):
    base, platform = HEXAPOD.base_points, HEXAPOD.platform_points
    pose = gsp.Pose([base[2] - platform[2], [0.1, 0.0, 0.9]])
    index = INDICES[name]
    values = index.function(HEXAPOD.at(pose))
    assert np.isnan(values[0])
    assert values[1] == pytest.approx(float(index.function(HEXAPOD.at(pose[1]))), rel=1e-10)


@pytest.mark.parametrize("name", REVIEWED)
def test_something_else_than_a_posture_is_an_error(name):
    with pytest.raises(InvalidInput, match="posture"):
        INDICES[name].function(HEXAPOD)


@pytest.mark.parametrize("name", ["condition_number_points", "complex_deviation_rotation"])
def test_angles_need_a_length(name):
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    with pytest.raises(MissingParameter, match="length"):
        INDICES[name].function(design.at(design.home))


def test_the_rigidity_rate_is_for_six_actuators():
    redundant = nawratil.isotropic(4)
    with pytest.raises(InvalidInput, match="six actuators"):
        gsp.indices.rigidity_rate(redundant.at(redundant.home))
    with pytest.raises(MissingParameter, match="expected 6 actuators, received 8"):
        gsp.evaluate(redundant, redundant.home, ["rigidity_rate"])


def test_the_rigidity_rate_depends_on_the_viewpoint():
    """Base and platform exchanged give another value, as the source states."""
    rng = np.random.default_rng(0)
    design = gsp.Design(["D1"] * 6, rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    pose = gsp.Pose([0.2, 0.1, 2.0])
    here = gsp.indices.rigidity_rate(design.at(pose))
    there = gsp.indices.rigidity_rate(design.exchanged().at(pose.inverse()))
    assert abs(here - there) > 0.05
    # It does not see where the base anchors are on the leg lines, and sees the platform's.
    lines = design.at(pose).lines.d
    lower = design.replace(base_points=design.base_points - 0.7 * lines)
    assert gsp.indices.rigidity_rate(lower.at(pose)) == pytest.approx(float(here), rel=1e-9)
    higher = design.replace(platform_points=design.platform_points + 0.7 * lines)
    assert abs(gsp.indices.rigidity_rate(higher.at(pose)) - here) > 0.01


@pytest.mark.parametrize("alpha", [0.0, 0.2, 0.5])
def test_the_rigidity_rate_of_the_example_set_is_a_right_angle_up_to_the_singularity(alpha):
    design = nawratil.example_design(alpha)
    values = gsp.indices.rigidity_rate(
        design.at(nawratil.example_pose([1.0, 0.1, 1e-3, 1e-4, 0.0]))
    )
    np.testing.assert_allclose(values[:4], np.pi / 2, atol=1e-6)
    assert values[4] == 0.0


def test_indices_of_the_lines_do_not_see_the_anchors_and_the_control_number_does():
    """Anchors moved along the leg lines: σ_r, σ_t and |det J| stay, CTN changes."""
    rng = np.random.default_rng(8)
    design = gsp.Design(["D1"] * 6, rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    pose = gsp.Pose([0.0, 0.3, 2.0])
    moved = design.replace(base_points=design.base_points - 0.5 * design.at(pose).lines.d)
    for name in ("complex_deviation_rotation", "complex_deviation_translation", "manipulability"):
        function = INDICES[name].function
        np.testing.assert_allclose(function(moved.at(pose)), function(design.at(pose)), rtol=1e-9)
    before, after = (gsp.indices.control_number(d.at(pose)) for d in (design, moved))
    assert abs(before - after) > 0.01 * before


def test_three_points_are_a_flat_ellipsoid():
    """D of three points about their centroid is that of an ellipse in their plane."""
    points = np.array([[0.5, 0.1, 0.2], [-0.7, 0.3, 0.1], [0.2, -0.6, 0.4]])
    centre = points.mean(axis=0)
    spread, turn = np.linalg.eigh((points - centre).T @ (points - centre))
    turn[:, 0] *= np.linalg.det(turn)
    axes = np.maximum(np.sqrt(np.maximum(spread, 0.0)), 1e-7)
    rng = np.random.default_rng(6)
    design = gsp.Design(["D1"] * 7, rng.normal(size=(7, 3)), rng.normal(size=(7, 3)))
    pose = gsp.Pose.from_rpy(
        rng.normal(size=(4, 3)) + np.array([0, 0, 3.0]), rng.normal(size=(4, 3))
    )
    flat = condition_number_ellipsoid(design.at(pose), gsp.Ellipsoid(axes, centre, turn))
    found = condition_number_points(design.at(pose), points=points)
    np.testing.assert_allclose(found, flat, rtol=1e-9)
    other = condition_number_points(design.at(pose), points=1.5 * points)
    assert not np.allclose(found, other, rtol=1e-2)  # the choice of the points matters


def test_three_points_must_span_a_triangle():
    posture = HEXAPOD.at(nawratil.example_pose(0.5))
    with pytest.raises(InvalidInput, match="not on a line"):
        condition_number_points(posture, points=[[0, 0, 0], [1, 1, 1], [2, 2, 2]])
    with pytest.raises(InvalidInput, match="points"):
        condition_number_points(posture, points=[[0, 0, 0], [1, 1, 1]])
    line = HEXAPOD.replace(platform_points=np.outer(np.arange(6.0), [1, 2, 3]))
    assert np.isnan(condition_number_points(line.at(nawratil.example_pose(0.5))))


def test_sigma_t_is_greatest_for_isotropic_directions():
    """At h = sin(π/6 − α)/√2 the six directions are isotropic, and σ_t = √2 for every α."""
    for alpha in (0.0, 0.2, 0.5):
        best = np.sin(np.pi / 6 - alpha) / np.sqrt(2)
        posture = nawratil.example_design(alpha).at(
            nawratil.example_pose([0.9 * best, best, 1.1 * best])
        )
        below, most, above = gsp.indices.complex_deviation_translation(posture)
        assert most == pytest.approx(np.sqrt(2), rel=1e-12)
        assert max(below, above) < most - 0.01
