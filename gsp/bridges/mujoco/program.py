"""The program MuJoCo: whether it is there, its models, and how far their loops are open."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.errors import GspError, InvalidInput, brief, expected
from gsp.geometry.vectors import Array, Mask, norm
from gsp.installed import optional

if TYPE_CHECKING:
    import mujoco

AXES = 3


def load_mujoco() -> Any:
    """Import MuJoCo, or raise MissingSoftware, or GspError if the environment is wrong for it.

    It looks for the OpenGL that the environment names when it is imported, and raises errors of
    several kinds.
    """
    try:
        with optional("mujoco", "a simulation", "mujoco"):
            import mujoco
    except GspError:
        raise
    except Exception as error:
        wanted = "egl, osmesa or glfw, and its library, or nothing"
        got = f"{os.environ.get('MUJOCO_GL', '')!r} ({type(error).__name__}: {brief(str(error))})"
        raise GspError(expected("MUJOCO_GL", wanted, got)) from error
    return mujoco


@contextmanager
def silent(program: Any) -> Iterator[None]:
    """Leave out warnings of MuJoCo, which it prints and writes to a file where it runs."""
    before = program.get_mju_user_warning()
    program.set_mju_user_warning(lambda _: None)
    try:
        yield
    finally:
        program.set_mju_user_warning(before)


def compiled(text: str) -> mujoco.MjModel:
    """Return the model of a text, or raise InvalidInput with MuJoCo's reason."""
    try:
        return load_mujoco().MjModel.from_xml_string(text)
    except ValueError as error:
        reason = " ".join(str(error).split())
        wanted = "bodies and legs of which MuJoCo can make a model"
        raise InvalidInput(expected("design, solids", wanted, brief(reason))) from error


def largest_gap(data: mujoco.MjData) -> float:
    """Return the largest violation of a loop [m, or rad]."""
    gaps, turns = gaps_of(data)
    return max(float(gaps.max()), float(turns.max(initial=0.0)))


def loop_rows(data: mujoco.MjData) -> Mask:
    """Return which rows of the constraints close loops (the others are limits of joints)."""
    return np.asarray(data.efc_type == load_mujoco().mjtConstraint.mjCNSTR_EQUALITY)


def gaps_of(data: mujoco.MjData) -> tuple[Array, Array]:
    """Return how far loops are open: distances [m], and angles of the welds [rad]."""
    loop = loop_rows(data)
    violations, which = data.efc_pos[loop], data.efc_id[loop]
    # The rows of a loop follow each other: a distance, then for a weld an axis times sin(angle/2).
    turn = np.arange(which.size) - np.searchsorted(which, which) >= AXES
    gaps, sines = (norm(violations[rows].reshape(-1, AXES)) for rows in (~turn, turn))
    return gaps, 2.0 * np.arcsin(np.minimum(sines, 1.0))


def largest_speed(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the largest speed of the joints of legs [m/s, or rad/s]; the platform has none."""
    kinds = load_mujoco().mjtJoint
    speeds = [0.0]
    for joint, first in enumerate(model.jnt_dofadr):
        ball = model.jnt_type[joint] == int(kinds.mjJNT_BALL)
        if model.jnt_type[joint] != int(kinds.mjJNT_FREE):
            speeds.append(float(norm(data.qvel[first : first + (AXES if ball else 1)])))
    return max(speeds)
