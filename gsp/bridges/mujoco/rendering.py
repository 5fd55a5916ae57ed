"""Pictures of a design at a pose or along a path, rendered by MuJoCo without a window."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.bridges.linkage import linkage
from gsp.bridges.mujoco.elements import LARGEST_PICTURE, configuration
from gsp.bridges.mujoco.mjcf import to_mjcf
from gsp.bridges.mujoco.simulation import compiled, load_mujoco
from gsp.bridges.solids import Solids, check_solids
from gsp.checks import check_memory, check_type
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import norm
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
    check_type("pose", pose, Pose)
    if pose.shape:
        raise InvalidInput(expected("pose", "a single pose", f"a batch of shape {pose.shape}"))
    pictures = _pictures(design, pose.reshape(1), solids, (height, width), (azimuth, elevation))
    return np.asarray(pictures[0])


@arguments.validated(azimuth=arguments.number, elevation=arguments.number)
def render_motion(
    design: Design,
    poses: Pose,
    solids: Solids | None = None,
    *,
    width: int = 800,
    height: int = 600,
    azimuth: float = 130.0,
    elevation: float = -25.0,
) -> NDArray[np.uint8]:
    """Return pictures of a design at poses, by one model and one camera: (n, height, width, 3).

    The model is that of the pose at which no leg is much shorter than it becomes, and its joints
    are set to their values at each pose, so that links keep their lengths.

    Parameters
    ----------
    design : Design
    poses : Pose of shape (n,), n ≥ 1
        At which all legs are defined.
    solids : Solids or None
        Sizes of the links.
    width, height : int
        In pixels, at most 1600 by 1200.
    azimuth, elevation : float [degrees]
        Viewing direction of the camera.

    Returns
    -------
    (n, height, width, 3) array of uint8

    Raises
    ------
    MissingSoftware
        If MuJoCo is not installed.
    GspError
        If there is no OpenGL to draw with.
    InvalidInput
        If `poses` has another shape, or so many pictures do not fit into the memory.
    UndefinedPosture, MissingParameter
        See `to_mjcf`.
    """
    check_type("poses", poses, Pose)
    if len(poses.shape) != 1 or not poses.size:
        wanted = "poses of shape (n,), n ≥ 1"
        raise InvalidInput(expected("poses", wanted, f"shape {poses.shape}"))
    return _pictures(design, poses, solids, (height, width), (azimuth, elevation))


def _pictures(
    design: Design,
    poses: Pose,
    solids: Solids | None,
    shape: tuple[int, int],
    view: tuple[float, float],
) -> NDArray[np.uint8]:
    size = [
        arguments.integer(1, most)(what, number)
        for what, number, most in zip(("height", "width"), shape, LARGEST_PICTURE, strict=True)
    ]
    check_memory("poses", poses.size, 3 * size[0] * size[1], "pictures")
    mujoco = load_mujoco()
    unit = check_solids(solids).unit(design)
    legs = [linkage(design, poses[i]) for i in range(poses.size)]
    # Of the model; at another pose a leg may be longer, and beyond 1.2 times there is a gap
    # between its two links.
    lengths = np.array([[chain.length for chain in chains] for chains in legs])
    start = int((lengths / lengths.max(axis=0)).min(axis=1).argmax())
    model = compiled(to_mjcf(design, poses[start], solids))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer = _renderer(mujoco, model, size)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = model.stat.center
    # The extent is the diameter of a sphere around all bodies, which fits a little below this.
    moved = float(norm(poses.position - poses.position[start]).max()) * unit
    camera.distance = 1.2 * (model.stat.extent + 3.0 * moved)
    camera.azimuth, camera.elevation = view
    pictures = np.empty((poses.size, *size, 3), dtype=np.uint8)
    with renderer:
        for i, picture in enumerate(pictures):
            data.qpos[:] = configuration(legs[start], legs[i], poses[i], unit)
            mujoco.mj_kinematics(model, data)
            mujoco.mj_camlight(model, data)
            renderer.update_scene(data, camera)
            picture[:] = renderer.render()
    return pictures


def _renderer(mujoco: Any, model: Any, shape: list[int]) -> Any:
    global _failed
    if _failed is None:
        try:
            return mujoco.Renderer(model, *shape)
        except Exception as error:  # each way of having no OpenGL raises another kind
            _failed = f"{type(error).__name__}: {error}"
    wanted = "egl or osmesa, set before mujoco is imported, and its library"
    raise GspError(expected("MUJOCO_GL", wanted, _failed))
