"""Pictures of a design, rendered by MuJoCo without a window."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.bridges.mujoco.mjcf import to_mjcf
from gsp.bridges.mujoco.simulation import compiled, load_mujoco
from gsp.bridges.solids import Solids
from gsp.checks import check_integer
from gsp.errors import GspError, expected
from gsp.geometry.pose import Pose
from gsp.model.design import Design

# Why MuJoCo had no OpenGL in this process. It chooses one when it is imported, and a second try
# after a failure ends the process.
_failed: str | None = None


@arguments.validated(azimuth=arguments.number, elevation=arguments.number)
def render(
    design: Design,
    pose: Pose,
    solids: Solids | None = None,
    *,
    width: int = 800,
    height: int = 600,
    azimuth: float = 130.0,
    elevation: float = -25.0,
) -> NDArray[np.uint8]:
    """Return a picture of a design at a pose, shape (height, width, 3).

    Parameters
    ----------
    design : Design
    pose : Pose
        A single pose, at which all legs are defined.
    solids : Solids or None
        Sizes of the links.
    width, height : int
        In pixels, at most 1600 by 1200.
    azimuth, elevation : float [degrees]
        Viewing direction of the camera.

    Raises
    ------
    MissingSoftware
        If MuJoCo is not installed.
    GspError
        If there is no OpenGL to draw with.
    UndefinedPosture, InvalidInput, MissingParameter
        See `to_mjcf`.
    """
    shape = [check_integer("height", height), check_integer("width", width)]
    mujoco = load_mujoco()
    model = compiled(to_mjcf(design, pose, solids))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer = _renderer(mujoco, model, shape)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = model.stat.center
    # The extent is the diameter of a sphere around all bodies, which fits a little below this.
    camera.distance = 1.2 * model.stat.extent
    camera.azimuth, camera.elevation = azimuth, elevation
    with renderer:
        renderer.update_scene(data, camera)
        return np.array(renderer.render())


def _renderer(mujoco: Any, model: Any, shape: list[int]) -> Any:
    global _failed
    if _failed is None:
        try:
            return mujoco.Renderer(model, *shape)
        except Exception as error:  # each way of having no OpenGL raises another kind
            _failed = f"{type(error).__name__}: {error}"
    wanted = "egl or osmesa, set before mujoco is imported, and its library"
    raise GspError(expected("MUJOCO_GL", wanted, _failed))
