"""The nearest allowed pose in other units and frames, against its conditions, and from home."""

import numpy as np
import pytest

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput
from gsp.geometry import Pose
from gsp.kinematics import nearest_pose
from tests.campaign import some
from tests.metamorphic import random_design

LEGS = ("D1^6", "D1 D2 D3 D4^3", "D2^2 D3^2 D4 A1", "D2^5 A1")


def problem(legs, seed):
    """A design, a pose, and strokes that the home pose satisfies."""
    design = random_design(legs, seed)
    joints, angular = design.at(design.home).joints, design.angular
    low = np.where(angular, np.maximum(joints - 0.25, 0.01), 0.8 * joints)
    high = np.where(angular, np.minimum(joints + 0.2, 3.13), 1.15 * joints)
    pose = design.home.moved(0.4 * np.random.default_rng(seed).normal(size=6))
    return design, pose, np.stack((low, high), axis=1)


def solved(design, pose, limits, starts=2):
    try:
        return gsp.nearest(design, pose, limits, starts=starts)
    except EmptyWorkspace:
        return None


def shifted(pose, base, platform):
    return Pose(pose.position + base - pose.rotation @ platform, pose.rotation)


@pytest.mark.parametrize("legs", LEGS)
def test_units_and_origins_change_neither_status_nor_pose(legs):
    design, pose, strokes = problem(legs, 12)
    home = design.home if legs == "D2^5 A1" else None
    design = design.replace(home=home)
    near = solved(design, pose, gsp.Limits(strokes=strokes))
    changes = [(1e-6, 0.0), (2.0, 0.0), (1000.0, 3.0), (1.0, 100.0)]
    for factor, offset in changes:
        base, platform = offset * np.array([[1.0, -0.3, 0.6], [0.4, 0.2, -1.0]])
        moved = design.replace(
            base_points=factor * (design.base_points + base),
            platform_points=factor * (design.platform_points + platform),
            home=home and shifted(home, base, platform).scaled(factor),
        )
        limits = gsp.Limits(strokes=strokes * np.where(design.angular, 1.0, factor)[:, None])
        found = solved(moved, shifted(pose, base, platform).scaled(factor), limits)
        assert (found is None) == (near is None)
        if near is not None:
            back = shifted(found.pose.scaled(1.0 / factor), -base, -platform)
            assert found.distance == pytest.approx(near.distance, abs=1e-9)
            np.testing.assert_allclose(back.position, near.pose.position, atol=1e-8)
            np.testing.assert_allclose(back.rotation, near.pose.rotation, atol=1e-8)
            assert found.starts == near.starts


def test_units_of_all_limits_are_changed():
    design, pose, strokes = problem("D1^6", 5)
    k = 1e-6
    e = gsp.Ellipsoid([0.3, 0.4, 0.5], center=[0.1, 0.2, 0.1])

    def limits(k):
        x, _, z = design.home.position
        return gsp.Limits(
            strokes=k * strokes,
            base_cone=0.3,
            platform_cone=0.35,
            position=[(k * (x - 0.2), k * (x + 0.2)), None, (None, k * (z + 0.1))],
            leg_radius=0.001 * k,
            indices=[f"manipulability >= {0.02 * k**3!r}", "CTN >= 1e-3", f"σ_r >= {0.001 * k!r}",
                     "λ >= 1e-4", "CDN_OE <= 1000"],
            length=k,
            ellipsoid=e.scaled(k),
            maximum=10.0 * k**3,
        )  # fmt: skip

    near = gsp.nearest(design, pose, limits(1.0), starts=1)
    found = gsp.nearest(design.scaled(k), pose.scaled(k), limits(k), starts=1)
    assert near.distance > 0.1
    assert found.distance == pytest.approx(near.distance, abs=1e-9)
    np.testing.assert_allclose(found.pose.position / k, near.pose.position, atol=1e-8)
    inside = gsp.feasible(design, near.pose, limits(1.0))
    assert np.nanmax(inside.low - inside.values) < 1e-8
    assert np.nanmax(inside.values - inside.high) < 1e-8


@pytest.mark.parametrize("legs", LEGS)
def test_it_is_never_farther_than_an_allowed_home_pose_and_no_step_from_it_is_nearer(legs):
    design, pose, strokes = problem(legs, 3)
    limits = gsp.Limits(strokes=strokes)
    near = gsp.nearest(design, pose, limits, starts=1)
    centre, size = design.platform_points.mean(axis=0), design.rms_radius

    def distance(other):
        p = other.position + other.rotation @ centre - pose.position - pose.rotation @ centre
        turn = gsp.geometry.log3(other.rotation @ pose.rotation.T)
        return np.hypot(np.linalg.norm(p, axis=-1) / size, np.linalg.norm(turn, axis=-1))

    assert distance(near.pose) == pytest.approx(near.distance, abs=1e-9)
    assert near.distance <= distance(design.home)
    rng = np.random.default_rng(1)
    steps = 10.0 ** rng.uniform(-6, -2, (4000, 1)) * rng.normal(size=(4000, 6))
    around = near.pose.moved(steps * np.repeat([size, 1.0], 3))
    allowed = gsp.feasible(design, around, limits).ok
    assert allowed.any()
    assert distance(around)[allowed].min() >= near.distance - 1e-8


@pytest.mark.parametrize(
    "name", some(["CDN", "CDN_CL", "CDN_OE", "F_max", "SD", "k_x", "σ_min"], 3)
)
def test_thresholds_are_those_of_the_design_wherever_its_origins_are(name):
    """The index is 2 % better than at home, by the posture of the design in its own frames."""
    design = gsp.hexapod(2.0, 0.25, 1.0, 0.4, 1.5).with_origin([0.3, -0.2, 0.7])
    shift = np.array([3.0, -2.0, 1.0])
    home = Pose(design.home.position + shift, design.home.rotation)
    design = design.replace(
        base_points=design.base_points + shift, home=home, ellipsoid=gsp.Ellipsoid([0.4, 0.5, 0.6])
    )

    def value(pose):
        return float(gsp.evaluate(design, pose, [name], length=1.2).iloc[0, 0])

    upward = gsp.indices.INDICES[gsp.indices.index_name(name)].better == "higher"
    better = value(home) * (1.02 if upward else 0.98)
    limits = gsp.Limits(indices=[f"{name} {'>=' if upward else '<='} {better!r}"], length=1.2)
    found = gsp.nearest(design, home, limits, starts=2)
    assert value(found.pose) == pytest.approx(better, rel=1e-6)
    assert found.distance > 0.0


def test_random_poses_are_tried_where_no_search_ends_at_an_allowed_one(monkeypatch):
    """Searches for thresholds on indices that are not smooth may all end beside the limit."""
    design = gsp.hexapod(2.0, 0.25, 1.0, 0.4, 1.5).replace(home=None)
    away, limits = Pose([0.3, 0.2, 1.9]), gsp.Limits(strokes=[[1.6, 2.3]] * 6)
    assert not gsp.feasible(design, away, limits).ok
    for name in ("minimum_from", "restored_from"):
        monkeypatch.setattr(nearest_pose._Search, name, lambda *_: None)
    found = gsp.nearest(design, away, limits)
    assert gsp.feasible(design, found.pose, gsp.Limits(strokes=[[1.6 - 1e-8, 2.3 + 1e-8]] * 6)).ok
    assert 1 <= found.starts <= nearest_pose.NEAREST_SAMPLES


def test_poses_too_far_for_the_searches_are_refused():
    """A distance is then known to fewer digits than the steps beside it have."""
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=(1.5, 2.5))
    for z in (1e5, 1e99):
        with pytest.raises(InvalidInput, match="pose: expected a pose within 1000 sizes"):
            gsp.nearest(design, Pose([0.0, 0.0, z]))
    with pytest.raises(InvalidInput, match=r"within 1000 sizes .* received one at 1000\.5"):
        gsp.nearest(design, Pose(design.home.position + [1000.5 * design.rms_radius, 0.0, 0.0]))
    found = gsp.nearest(design, Pose([0.0, 0.0, 900.0]))
    np.testing.assert_allclose(design.at(found.pose).joints, 2.5, atol=1e-8)


def test_the_distance_is_that_of_the_size_where_an_index_keeps_the_unit():
    """A threshold on CDN, whose unit is mixed, for a design of 0.1 m."""
    design = gsp.hexapod(0.2, 0.25, 0.1, 0.4, 0.15)
    away = design.home.moved([0.02, -0.01, 0.03, 0.1, 0.05, -0.1])
    value = float(gsp.evaluate(design, away, ["CDN"]).iloc[0, 0])
    found = gsp.nearest(design, away, gsp.Limits(indices=[f"CDN <= {0.99 * value!r}"]), starts=2)
    centre = design.platform_points.mean(axis=0)
    ends = [pose.position + pose.rotation @ centre for pose in (found.pose, away)]
    step = (ends[0] - ends[1]) / design.rms_radius
    turn = gsp.geometry.log3(found.pose.rotation @ away.rotation.T)
    assert found.distance == pytest.approx(np.hypot(*map(np.linalg.norm, (step, turn))), rel=1e-9)


def test_the_greatest_force_of_several_actuators_at_once():
    """Beside a symmetric pose F_max has an edge, where other actuators have the greatest force."""
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    away = design.home.moved([0.3, -0.2, 0.1, 0.4, 0.3, 0.5])
    limits = gsp.Limits(indices=["F_max <= 0.9"], length=1.0)
    found = gsp.nearest(design, away, limits)
    rows = np.linalg.pinv(design.at(found.pose).homogeneous(1.0).T)
    forces = np.sort(np.linalg.norm(rows, axis=1))
    assert forces[-2] == pytest.approx(0.9, abs=1e-8)
    assert forces[-1] == pytest.approx(0.9, abs=1e-8)
    steps = np.random.default_rng(2).normal(size=(3000, 6)) * np.geomspace(1e-5, 0.1, 3000)[:, None]
    size = design.rms_radius
    around = found.pose.moved(steps * np.repeat([size, 1.0], 3))
    allowed = around[gsp.feasible(design, around, limits).ok]
    middle = design.platform_points.mean(axis=0)

    def centre(pose):
        return pose.position + pose.rotation @ middle

    turn = np.linalg.norm(gsp.geometry.log3(allowed.rotation @ away.rotation.T), axis=-1)
    shift = np.linalg.norm(centre(allowed) - centre(away), axis=-1) / size
    assert allowed.size > 100
    assert np.hypot(turn, shift).min() >= found.distance - 1e-8


@pytest.mark.parametrize("scale", some([1e-6, 1.0, 1e6], 1))
def test_an_empty_workspace_is_one_in_every_unit(scale):
    """A vacuous threshold on CDN keeps the unit; legs are too short for the height, by 1e-3."""
    design = gsp.hexapod(1.0, 0.4, 0.6, 0.4, 1.2).scaled(scale)
    length = float(design.at(design.home).joints[0])
    limits = gsp.Limits(
        strokes=[[0.9 * length, length]] * 6,
        position=[None, None, (1.201 * scale, 2.0 * scale)],
        indices=["CDN <= 1e12"],
    )
    with pytest.raises(EmptyWorkspace):
        gsp.nearest(design, design.home, limits, starts=2)
