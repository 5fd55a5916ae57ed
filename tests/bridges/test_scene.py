"""Models that are drawn at several poses: no gaps at any of them, and a camera that sees them."""

import numpy as np
import pytest

import gsp
from gsp.bridges import Solids, to_mjcf
from gsp.bridges.links.linkage import linkage
from gsp.bridges.mujoco.camera import FILLED, fit
from gsp.bridges.mujoco.scene import Scene
from gsp.bridges.proof import BOX, random_design

mujoco = pytest.importorskip("mujoco")

LIFT = gsp.hexapod(2.0, np.deg2rad(20.0), 1.0, np.deg2rad(30.0), 1.5, unit="m")
CLASSES = ("D1^6", "D1 D2 D3 D4 A1^2", "D4^3 A1^3", "D2^3 D3^3")


def moved_far():
    yield LIFT, gsp.sweeps.translation(LIFT.home, "x", np.linspace(-3.0, 3.0, 7)).pose
    rng = np.random.default_rng(8)
    for name in CLASSES:
        design = random_design(gsp.catalogue.mechanism(name), rng)
        yield design, BOX.sample(8, rng=rng)
        yield design.scaled(0.1).replace(unit="m"), scaled(BOX.sample(5, rng=rng), 0.1)
        yield design.scaled(1e6).replace(unit="um"), scaled(BOX.sample(5, rng=rng), 1e6)


def scaled(pose, factor):
    return gsp.Pose(factor * pose.position, pose.rotation)


def rod(scene, body, geom=0):
    """The ends of a capsule of a body, in base axes [m]."""
    geom += int(scene.model.body(body).geomadr[0])
    at, axis = scene.data.geom_xpos[geom], scene.data.geom_xmat[geom].reshape(3, 3)[:, 2]
    half = scene.model.geom_size[geom, 1] * axis
    return at - half, at + half


def test_the_links_of_every_leg_meet_at_every_pose():
    """Both are on the line between the feet, from one foot on, and together cover it."""
    for design, poses in moved_far():
        scene, metres = Scene(design, poses, None), 1.0 / design.rms_radius
        close = 1e-9 * metres * design.rms_radius
        thin = 2.0 * 0.02 * design.rms_radius * metres
        for frame in range(poses.size):
            scene.show(frame)
            segments = design.at(poses[frame]).segments
            for leg, chain in enumerate(linkage(design, poses[frame])):
                length = float(segments.length[leg]) * metres
                along = segments.direction[leg]
                lower = np.array(rod(scene, f"{chain.name}_lower"))
                upper = np.array(rod(scene, f"{chain.name}_upper"))
                foot = min(lower, key=lambda end: abs((end - lower[0]) @ along))
                ends = [(part - foot) @ along for part in (lower, upper)]
                np.testing.assert_allclose(ends[0].min(), 0.0, atol=close)
                np.testing.assert_allclose(ends[1].max(), length, atol=close)
                assert ends[0].max() >= ends[1].min(), (design.name, frame, leg)
                assert ends[0].max() <= max(length, thin) + close
                off = np.concatenate((lower, upper)) - foot
                off = off - np.outer(off @ along, along)
                assert np.abs(off).max() < close


def test_rails_hold_the_feet_at_every_pose():
    rng = np.random.default_rng(3)
    design = random_design(gsp.catalogue.mechanism("D2^3 D3^3"), rng)
    poses = BOX.sample(8, rng=rng)
    scene = Scene(design, poses, None)
    for frame in range(poses.size):
        scene.show(frame)
        for leg in linkage(design, poses[frame]):
            if leg.leg.platform_line:
                start, end = rod(scene, f"{leg.name}_rail")
                foot = rod(scene, f"{leg.name}_upper")[1]
                along = (end - start) / np.linalg.norm(end - start)
                assert 0.0 < (foot - start) @ along < np.linalg.norm(end - start)
                assert np.linalg.norm(np.cross(foot - start, along)) < 1e-9


@pytest.mark.parametrize("aspect", [0.5, 4.0 / 3.0])
def test_the_camera_sees_all_and_is_as_near_as_it_can_be(aspect):
    """By projection of the points, one by one, from the place of the camera."""
    rng = np.random.default_rng(5)
    for scale in (1e-6, 1.0, 1e6):
        points = scale * (rng.normal(size=(40, 3)) + [20.0, 0.0, 3.0])
        for azimuth, elevation in ((130.0, -25.0), (0.0, 0.0), (-40.0, -90.0), (10.0, 60.0)):
            shown = projected(points, aspect, azimuth, elevation)
            assert np.abs(shown).max() <= FILLED * (1.0 + 1e-9)
            np.testing.assert_allclose(shown.max(axis=0), -shown.min(axis=0), rtol=1e-6)
            assert np.isclose(shown.max(axis=0), FILLED, rtol=1e-6).any()


def projected(points, aspect, azimuth, elevation):
    """Places of points in a picture, each from -1 to 1, by the camera for these points."""
    view = fit(
        points,
        np.zeros(len(points)),
        azimuth=azimuth,
        elevation=elevation,
        field=45.0,
        aspect=aspect,
    )
    turned, raised = np.deg2rad([azimuth, elevation])
    flat = np.array([np.cos(turned), np.sin(turned), 0.0])
    ahead = np.cos(raised) * flat + np.sin(raised) * np.eye(3)[2]
    up = np.cos(raised) * np.eye(3)[2] - np.sin(raised) * flat
    away = points - (view.lookat - view.distance * ahead)
    depth = away @ ahead
    assert depth.min() > 0.0
    half = np.tan(np.deg2rad(22.5))
    across, high = away @ np.cross(ahead, up), away @ up
    return np.stack((across / (half * aspect), high / half), axis=1) / depth[:, None]


def test_balls_are_seen_with_their_radii():
    """A ball in the middle of the view touches the cone of the field."""
    view = fit(np.zeros((1, 3)), np.ones(1), azimuth=0.0, elevation=0.0, field=60.0, aspect=1.0)
    half = np.arctan(FILLED * np.tan(np.deg2rad(30.0)))
    assert view.distance == pytest.approx(1.0 / np.sin(half), rel=1e-12)
    np.testing.assert_allclose(view.lookat, 0.0, atol=1e-12)


@pytest.mark.parametrize("name", ["apo-secondary", "rubin-camera-hexapod", "lee-2000-3-3"])
def test_the_camera_of_a_model_sees_all_anchors_wherever_the_origins_are(name):
    """By projection: in a picture of 4 to 3, and with the field of view of MuJoCo, 45 degrees."""
    design = gsp.catalogue.design(name).with_origin([300.0, -200.0, 500.0])
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home, Solids(metres=1.0)))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    ends = design.home.position + design.platform_points @ design.home.rotation.T
    anchors = np.concatenate((design.base_points, ends))
    camera = data.camera("side")
    seen = (anchors - camera.xpos) @ camera.xmat.reshape(3, 3)
    across = np.abs(seen[:, :2] / -seen[:, 2:]) / np.tan(np.deg2rad(45.0 / 2)) / [4 / 3, 1.0]
    assert (seen[:, 2] < 0.0).all()
    assert 0.3 < across.max() < 1.0
    middle = 0.5 * (anchors.min(axis=0) + anchors.max(axis=0))
    np.testing.assert_allclose(model.stat.center, middle, rtol=1e-9, atol=1e-9 * model.stat.extent)
