"""Placements, twists and wrenches as arrays and as objects of Pinocchio.

Pinocchio is imported only where one of its objects is made. The type of an object is determined
without importing it: as long as Pinocchio is not loaded, none of its objects exist.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_integer, check_items, check_text, has, is_a, reading
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.frames.software import import_pinocchio
from gsp.geometry.rotations import check_rotation
from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    import pinocchio


class _Placed(Protocol):
    """An object with a position and a rotation, such as `gsp.Pose` and `Placement`."""

    @property
    def position(self) -> Array: ...

    @property
    def rotation(self) -> Array: ...


@read_only_tuple
class Placement(NamedTuple):
    """Placements of frames as arrays; `gsp.Pose` holds the same, checked.

    Attributes
    ----------
    position : (..., 3) array [length]
        Origin of the frame in the axes of the outer one.
    rotation : (..., 3, 3) array [1]
        From axes of the frame to axes of the outer one.
    """

    position: Array
    rotation: Array


# A Pose, Placement, pinocchio.SE3 or pinocchio.Frame, or a sequence of the last two.
PlacementLike: TypeAlias = "_Placed | pinocchio.SE3 | pinocchio.Frame | Sequence[Any]"
# A (..., 6) array_like, or an object of Pinocchio.
TwistLike: TypeAlias = "ArrayLike | pinocchio.Motion"
WrenchLike: TypeAlias = "ArrayLike | pinocchio.Force"


def placement_of(value: PlacementLike) -> Placement:
    """Return arrays from a Pose, a Placement, or objects of Pinocchio.

    Parameters
    ----------
    value : Pose or Placement of batch shape (...), pinocchio.SE3, pinocchio.Frame, or a sequence
        A sequence of n SE3 or Frame has the batch shape (n,). Rotations of a Pose or Placement are
        taken as they are.

    Returns
    -------
    Placement of batch shape (...) [length]

    Raises
    ------
    InvalidInput, InvalidRotation
        If it is none of these, or shapes do not fit.
    """
    given: Any = value
    if has(given, "position") and has(given, "rotation"):
        position = check_array("placement.position", given.position, (3,), finite=False)
        rotation = check_array("placement.rotation", given.rotation, (3, 3), finite=False)
        return Placement(position, rotation)
    single = _parts(value)
    if single is not None:
        return Placement(*single)
    wanted = "SE3, Frame, a sequence of them, or a gsp.Pose"
    if is_a(value, str | bytes) or has(value, "keys"):  # texts, mappings and tables
        raise InvalidInput(expected("placement", wanted, brief(value)))
    parts = []
    for item in check_items("placement", given, wanted):
        pair = _parts(item)
        if pair is None:
            raise InvalidInput(expected("placement", wanted, brief(value)))
        parts.append(pair)
    return Placement(
        np.array([p for p, _ in parts]).reshape(-1, 3),
        np.array([r for _, r in parts]).reshape(-1, 3, 3),
    )


def se3(placement: PlacementLike) -> Any:
    """Return placements as objects of Pinocchio.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame

    Returns
    -------
    pinocchio.SE3, or for a batch a list of them, nested as the batch is

    Raises
    ------
    InvalidInput, InvalidRotation
        If it is not a placement.
    """
    pin = import_pinocchio()
    position, rotation = placement_of(placement)
    common_shape("placement", position.shape[:-1], rotation.shape[:-2])
    if position.ndim == 1 and rotation.ndim == 2:
        return pin.SE3(rotation.copy(), position.copy())
    shape = np.broadcast_shapes(position.shape[:-1], rotation.shape[:-2])
    p, r = np.broadcast_to(position, (*shape, 3)), np.broadcast_to(rotation, (*shape, 3, 3))
    return [se3(Placement(p[i], r[i])) for i in range(shape[0])]


def frame(name: str, placement: PlacementLike, joint: int = 0) -> pinocchio.Frame:
    """Return an operational frame of Pinocchio, for `pinocchio.Model.addFrame`.

    Parameters
    ----------
    name : str
    placement : Pose or Placement of batch shape (), pinocchio.SE3 or pinocchio.Frame
        Of the frame, in the frame of its joint.
    joint : int
        Number of the joint that carries it; default the universe.

    Returns
    -------
    pinocchio.Frame

    Raises
    ------
    InvalidInput, InvalidRotation
        If `placement` is none or a batch, or `joint` is not an integer ≥ 0.
    """
    pin = import_pinocchio()
    text = check_text("name", name)
    place = se3(placement)
    if isinstance(place, list):
        raise InvalidInput(expected("placement", "a single placement", f"a batch of {len(place)}"))
    parent = check_integer("joint", joint, least=0)
    return pin.Frame(text, parent, place, pin.FrameType.OP_FRAME)


def motion(twist: TwistLike) -> Any:
    """Return a twist as an object of Pinocchio.

    Parameters
    ----------
    twist : (..., 6) array_like, or pinocchio.Motion [length, rad, per time]

    Returns
    -------
    pinocchio.Motion, or for a batch a list of them, nested as the batch is

    Raises
    ------
    InvalidInput
        On a wrong shape.
    """
    pin = import_pinocchio()
    return _objects(pin.Motion, vectors_of("twist", twist))


def force(wrench: WrenchLike) -> Any:
    """Return a wrench as an object of Pinocchio.

    Parameters
    ----------
    wrench : (..., 6) array_like, or pinocchio.Force [force, force · length]

    Returns
    -------
    pinocchio.Force, or for a batch a list of them, nested as the batch is

    Raises
    ------
    InvalidInput
        On a wrong shape.
    """
    pin = import_pinocchio()
    return _objects(pin.Force, vectors_of("wrench", wrench))


def _objects(kind: Any, values: Array) -> Any:
    return kind(values.copy()) if values.ndim == 1 else [_objects(kind, part) for part in values]


def _parts(value: Any) -> tuple[Array, Array] | None:
    """Position and rotation of an object of Pinocchio; None for anything else."""
    pin = sys.modules.get("pinocchio")
    if pin is None:
        return None
    if is_a(value, pin.Frame):
        value = value.placement
    if not is_a(value, pin.SE3):
        return None
    return np.array(value.translation), check_rotation("placement.rotation", value.rotation.copy())


def vectors_of(what: str, value: Any) -> Array:
    """Return (..., 6) arrays from arrays, from a Motion or Force, or from sequences of them."""
    with reading(what, "six numbers, or objects with them as their vector", value):
        if has(value, "vector"):
            value = value.vector
        elif isinstance(value, list | tuple) and value and has(value[0], "vector"):
            value = [item.vector if has(item, "vector") else item for item in value]
    return check_array(what, value, (6,), finite=False)


def common_shape(what: str, *shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape that batch shapes broadcast to, or raise InvalidInput."""
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError as error:
        got = " and ".join(str(shape) for shape in shapes)
        raise InvalidInput(expected(what, "batch shapes that broadcast", got)) from error


def is_placement(value: Any) -> bool:
    """Return whether a value is a pinocchio.SE3 or pinocchio.Frame."""
    pin = sys.modules.get("pinocchio")
    return pin is not None and is_a(value, pin.SE3 | pin.Frame)


def is_motion(value: Any) -> bool:
    """Return whether a value is a pinocchio.Motion."""
    pin = sys.modules.get("pinocchio")
    return pin is not None and is_a(value, pin.Motion)


def is_force(value: Any) -> bool:
    """Return whether a value is a pinocchio.Force."""
    pin = sys.modules.get("pinocchio")
    return pin is not None and is_a(value, pin.Force)
