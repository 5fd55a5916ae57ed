"""Pictures are drawn without a window, where there is an OpenGL to do it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import gsp

pytest.importorskip("mujoco")

# One process per try, because mujoco looks at MUJOCO_GL once, when it is imported.
PROGRAM = """
import sys, numpy as np, gsp
design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
try:
    picture = gsp.bridges.render(design, design.home, width=160, height=120)
except gsp.GspError as error:
    print(error)
    sys.exit(77)
assert picture.shape == (120, 160, 3) and picture.dtype == np.uint8
tiny = design.scaled(1e-5).replace(unit="furlong")  # neither masses nor the unit are drawn
again = gsp.bridges.render(tiny, tiny.home, width=160, height=120)
assert np.abs(again.astype(int) - picture).mean() < 1.0
blue = (picture[..., 2].astype(int) - picture[..., 0]) > 30  # the platform
green = (picture[..., 1].astype(int) - picture[..., 0]) > 40  # the D3 legs
white = (picture > 200).all(axis=-1)
print(blue.sum(), green.sum(), white.sum())
sys.exit(not (blue.sum() > 100 and green.sum() > 50 and white.sum() > 5000))
"""


def drawn(backend):
    return subprocess.run(
        [sys.executable, "-c", PROGRAM],
        env={**os.environ, "MUJOCO_GL": backend},
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_mechanism_is_drawn():
    tries = [drawn(backend) for backend in ("egl", "osmesa")]
    done = [result for result in tries if result.returncode != 77]
    if not done:
        pytest.skip("no offscreen OpenGL: neither egl nor osmesa")
    assert done[0].returncode == 0, done[0].stdout + done[0].stderr


TWICE = """
import gsp
design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
for _ in range(2):
    try:
        gsp.bridges.render(design, design.home, width=16, height=12)
    except (gsp.GspError, ImportError) as error:
        print(type(error).__name__)
"""


def test_without_opengl_the_second_call_raises_the_same_error_as_the_first():
    """MuJoCo itself ends the process there."""
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(
        [sys.executable, "-c", TWICE],
        env={**environment, "MUJOCO_GL": "glfw"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() in ([], ["GspError"] * 2, ["MissingSoftware"] * 2)


@pytest.mark.parametrize("name", ["exotic", "driven"])
def test_the_committed_picture_has_its_script(name):
    folder = Path(__file__).parents[2] / "docs" / "images"
    assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert (folder / f"{name}.py").is_file()


@pytest.mark.parametrize("wrong", [None, "toz-kucuk-2016-d3-6", 1.0])
def test_what_is_no_design_is_not_drawn(wrong):
    pose = gsp.Pose([0.0, 0.0, 1.0])
    for draw, poses in ((gsp.bridges.render, pose), (gsp.bridges.render_motion, pose.reshape(1))):
        with pytest.raises(gsp.errors.InvalidInput, match=r"design: expected a gsp\.Design"):
            draw(wrong, poses)
