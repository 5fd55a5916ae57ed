"""Pictures of a design at a pose or along a path, rendered by MuJoCo without a window."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.bridges.links.solids import Solids
from gsp.bridges.mujoco.camera import fit
from gsp.bridges.mujoco.elements import LARGEST_PICTURE
from gsp.bridges.mujoco.program import load_mujoco
from gsp.bridges.mujoco.scene import Scene
from gsp.checks import check_memory, check_type
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import norm
from gsp.model.design import Design

# Of the diagonal of the box of all anchors: how far beyond it a part may be that the camera shows.
SHOWN_AROUND = 0.5

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
    check_type("design", design, Design)
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

    The model is that of the first pose, and its joints are set to their values at each pose. Each
    of the two links of a leg has 0.6 of the leg's greatest length over the poses, so that they meet
    at every pose; where the leg is shorter than that, they have its length. Rails hold the feet at
    all poses. The camera stands as near as it can to see the mechanism at all poses.

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
    check_type("design", design, Design)
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
    scene = Scene(design, poses, solids)
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = view
    _aim(camera, scene, size[1] / size[0])
    pictures = np.empty((poses.size, *size, 3), dtype=np.uint8)
    with _renderer(mujoco, scene.model, size) as renderer:
        for i, picture in enumerate(pictures):
            scene.show(i)
            renderer.update_scene(scene.data, camera)
            picture[:] = renderer.render()
    return pictures


def _aim(camera: Any, scene: Scene, aspect: float) -> None:
    """Place a camera and a light that see the scene at all of its poses.

    Of parts that lie far from the anchors, such as the rails of lines that are nearly parallel,
    only those in a box around the anchors count.
    """
    anchors, (centres, radii) = scene.anchors(), scene.balls()
    low, high = anchors.min(axis=0), anchors.max(axis=0)
    around = SHOWN_AROUND * float(norm(high - low))
    if around > 0.0:
        centres = np.clip(centres, low - around, high + around)
    model = scene.model
    fitted = fit(
        centres,
        radii,
        azimuth=camera.azimuth,
        elevation=camera.elevation,
        field=float(model.vis.global_.fovy),
        aspect=aspect,
    )
    camera.lookat[:], camera.distance = fitted
    # MuJoCo draws what is between shares of this extent away from the camera.
    model.stat.extent = fitted.distance
    middle = (low + high) / 2.0
    model.light_pos[0] = middle + np.array([0.0, 0.0, 2.0 * fitted.distance])


def _renderer(mujoco: Any, model: Any, shape: list[int]) -> Any:
    global _failed
    if _failed is None:
        try:
            with warnings.catch_warnings():  # of GLFW, where there is no display
                warnings.simplefilter("ignore")
                return mujoco.Renderer(model, *shape)
        except Exception as error:  # each way of having no OpenGL raises another kind
            _failed = f"{type(error).__name__}: {error}"
    wanted = "egl or osmesa, set before mujoco is imported, and its library"
    raise GspError(expected("MUJOCO_GL", wanted, _failed))
