"""All assembly modes of the present joint values; those besides the present one are drawn."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gsp.app.scene.drawing import pose_numbers
from gsp.app.state.reading import read
from gsp.app.state.session import Session
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array
from gsp.kinematics.modes import assembly_modes
from gsp.model.design import Design

# Joint values are the same up to this share of the size of the design, and rad.
SAME_JOINTS = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class Modes:
    """The assembly modes of joint values.

    Attributes
    ----------
    design : Design
    joints : (6,) array [unit of the design, rad]
    positions : (n, 3) array [unit of the design]
    rotations : (n, 3, 3) array [1]
    sides : (n,) array [1]
        Signs of det J; 0 for singular modes.
    status : str
        As `gsp.assembly_modes` has it.
    """

    design: Design
    joints: Array
    positions: Array
    rotations: Array
    sides: Array
    status: str

    def belong_to(self, state: Session) -> bool:
        """Whether a state has the design and the joint values of the modes."""
        if state.design is not self.design:
            return False
        here = state.design.at(state.pose).joints
        scale = np.where(self.design.angular, 1.0, state.size)
        return bool((np.abs(here - self.joints) <= SAME_JOINTS * scale).all())

    def present(self, state: Session) -> int | None:
        """Return the number of the mode at which a state is, from 0; None if it is at none."""
        if not len(self.sides):
            return None
        apart = np.abs(self.positions - state.pose.position).max(axis=-1) / state.size
        turned = np.abs(self.rotations - state.pose.rotation).max(axis=(-1, -2))
        nearest = int(np.argmin(apart + turned))
        return nearest if apart[nearest] + turned[nearest] < SAME_POSE else None


# Poses are the same up to this share of the size of the design, plus that of the entries of R.
SAME_POSE = 1e-4


def modes_of(state: Session) -> Modes:
    """Return all assembly modes of the joint values of a state.

    Parameters
    ----------
    state : Session

    Raises
    ------
    GspError
        If the design has not six actuators, or joints are undefined at the pose.

    Examples
    --------
    >>> import gsp
    >>> from gsp.app.state.session import started
    >>> found = modes_of(started(gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)))
    >>> len(found.sides), found.status
    (8, 'found')
    """
    reading = read(state)
    if reading.undefined:
        raise InvalidInput(expected("joints", "defined values", reading.undefined[0]))
    joints = state.design.at(state.pose).joints
    found = assembly_modes(state.design, joints)
    return Modes(
        design=state.design,
        joints=joints,
        positions=found.poses.position,
        rotations=found.poses.rotation,
        sides=found.side,
        status=found.status,
    )


def taken(state: Session, modes: Modes, number: int) -> Session:
    """Return the state at another assembly mode, by its number from 0: a jump, not a motion."""
    pose = type(state.pose)(modes.positions[number], modes.rotations[number])
    message = f"assembly mode {number + 1} of {len(modes.sides)}"
    return replace(state, pose=pose, message=message)


def ghosts(state: Session, modes: Modes) -> list[dict[str, Any]]:
    """Return what is drawn of the modes besides the present one.

    Returns
    -------
    list of dict
        "name" (the number from 1), "position", "rotation", "feet" as in `placement`, and "same":
        whether det J has the sign of the present mode.
    """
    here = modes.present(state)
    sign = modes.sides[here] if here is not None else 0.0
    poses = type(state.pose)(modes.positions, modes.rotations)
    numbers = pose_numbers(state.design, poses)
    return [
        {"name": str(i + 1), "same": bool(modes.sides[i] == sign), **one}
        for i, one in enumerate(numbers)
        if i != here
    ]
