"""Films whose mechanism MuJoCo draws: the model follows the poses, and pictures become a film."""

import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import gsp
from gsp.bridges.links.linkage import linkage
from gsp.bridges.mujoco.elements import configuration
from gsp.bridges.proof import BOX, random_design
from gsp.errors import InvalidInput, UndefinedPosture

mujoco = pytest.importorskip("mujoco")

LIFT = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)


@pytest.mark.parametrize("name", ["D1^6", "D1 D2 D3 D4 A1^2", "D4^3 A1^3", "D2^3 D3^3"])
def test_the_model_is_assembled_at_all_poses(name):
    """Loops are closed, the platform and the joint variables are right, also far from the start."""
    rng = np.random.default_rng(4)
    design, poses = random_design(gsp.catalogue.mechanism(name), rng), BOX.sample(6, rng=rng)
    model = mujoco.MjModel.from_xml_string(gsp.bridges.to_mjcf(design, poses[0]))
    data = mujoco.MjData(model)
    start = linkage(design, poses[0])
    for i in range(poses.size):
        data.qpos[:] = configuration(start, linkage(design, poses[i]), poses[i], 1.0)
        mujoco.mj_forward(model, data)
        assert np.abs(data.efc_pos).max() < 1e-9
        np.testing.assert_allclose(data.body("platform").xpos, poses[i].position, atol=1e-12)
        ours = np.abs(design.at(poses[i]).joints)
        np.testing.assert_allclose(np.abs(data.actuator_length), ours, atol=1e-9)


# One process per try, because mujoco looks at MUJOCO_GL once, when it is imported.
PROGRAM = """
import sys, numpy as np, gsp
lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
turn = gsp.sweeps.turn(lift.home, "z", [0.0, 40.0])
try:
    film = gsp.plots.animate(lift, turn, renderer="mujoco", seconds=1.0)
except (gsp.GspError, ImportError, AttributeError) as error:
    print(error)
    sys.exit(77)
film.save(sys.argv[1], progress=False)
pictures = gsp.bridges.render_motion(lift, turn.pose, width=160, height=120)
assert pictures.shape == (2, 120, 160, 3) and pictures.dtype == np.uint8
apart = np.abs(pictures[1:].astype(int) - pictures[:-1]).max(axis=(1, 2, 3))
assert (apart > 50).all(), apart
blue = ((pictures[..., 2].astype(int) - pictures[..., 0]) > 30).sum(axis=(1, 2))
assert (blue > 100).all(), blue
edge = np.concatenate([pictures[:, [0, -1]].ravel(), pictures[:, :, [0, -1]].ravel()])
assert (edge > 200).all(), "the mechanism is cut at the edge"
def spread(pictures):
    ink = (pictures.min(axis=-1) < 200).any(axis=0)
    places = [np.flatnonzero(ink.any(axis=k)) for k in (0, 1)]
    return max(np.ptp(places[k]) / ink.shape[1 - k] for k in (0, 1))
away = lift.with_origin([20.0, 0.0, 0.0])
swing = gsp.sweeps.turn(away.home, "z", [-30.0, 30.0])
for shown in (pictures, gsp.bridges.render_motion(away, swing.pose, width=160, height=120)):
    assert spread(shown) > 0.85, spread(shown)
still = [gsp.bridges.render(d, d.home, width=160, height=120).astype(int) for d in (lift, away)]
assert np.abs(still[0] - still[1]).mean() < 1.0, "the origin of the platform changes the picture"
one = gsp.bridges.render(lift, lift.home, width=160, height=120)
assert one.shape == (120, 160, 3)
"""


def test_a_film_is_drawn_and_written(tmp_path):
    path = tmp_path / "turn.gif"
    tries = (drawn(backend, path) for backend in ("egl", "osmesa"))
    done = next((result for result in tries if result.returncode != 77), None)
    if done is None:
        pytest.skip("no offscreen OpenGL: neither egl nor osmesa")
    assert done.returncode == 0, done.stdout + done.stderr
    with Image.open(path) as film:
        assert film.n_frames == 2


def drawn(backend, path):
    return subprocess.run(
        [sys.executable, "-c", PROGRAM, str(path)],
        env={**os.environ, "MUJOCO_GL": backend},
        capture_output=True,
        text=True,
        check=False,
    )


def test_wrong_arguments_are_refused():
    turn = gsp.sweeps.turn(LIFT.home, "z", [0.0, 30.0])
    with pytest.raises(InvalidInput, match="renderer: expected matplotlib or mujoco"):
        gsp.plots.animate(LIFT, turn, renderer="povray")
    with pytest.raises(InvalidInput, match='solids: expected renderer="mujoco"'):
        gsp.plots.animate(LIFT, turn, solids=gsp.bridges.Solids())
    with pytest.raises(InvalidInput, match="poses: expected poses of shape"):
        gsp.bridges.render_motion(LIFT, LIFT.home)
    with pytest.raises(InvalidInput, match="width: expected an integer ≤ 1600"):
        gsp.bridges.render_motion(LIFT, turn.pose, width=5000)
    with pytest.raises(InvalidInput, match="pose: expected a single pose"):
        gsp.bridges.render(LIFT, turn.pose)


def test_errors_have_the_number_of_the_pose_in_the_path():
    """Cranks of a platform that rises do not reach it any more; 12 of 100 poses are shown."""
    design = gsp.catalogue.design("lane-rotary")
    steps = np.linspace(0.0, 2.0 * design.rms_radius, 100)[:, None] * [0.0, 0, 1, 0, 0, 0]
    poses = design.home.moved(steps)
    with pytest.raises(UndefinedPosture, match="of lane-rotary at pose ") as error:
        gsp.plots.animate(design, poses, renderer="mujoco", frames=12)
    (number,) = error.value.undefined[0].pose
    assert number in np.linspace(0, 99, 12).round()
    assert np.isnan(design.at(poses[number]).joints).any()
    before = design.at(poses[: number - 9]).joints
    assert np.isfinite(before).all()
