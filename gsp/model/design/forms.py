"""What differs between the files of designs in space and in the plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gsp.geometry.pose import Pose
from gsp.model.legs import check_leg

if TYPE_CHECKING:
    from gsp.model.design.toml import Reader


@dataclass(frozen=True, kw_only=True)
class Form:
    """What differs between the files of designs in space and in the plane.

    Attributes
    ----------
    dimension : int
        Coordinates of a point.
    least : int
        How many constraints a design has at least.
    check_leg : function (name, where) -> leg
        The kind of a leg by its name; it raises InvalidInput.
    home_keys, home : tuple of str, function (reader, table) -> pose
        Keys of the table [home], and how it is read.
    written : tuple of str
        Attributes of a pose that give it bit by bit, which are keys of the table.
    """

    dimension: int
    least: int
    check_leg: Callable[[Any, str], Any]
    home_keys: tuple[str, ...]
    home: Callable[[Reader, dict[str, Any]], Any]
    written: tuple[str, ...]


def _spatial_home(reader: Reader, data: dict[str, Any]) -> Pose:
    reader.one_of(data, ("rpy_deg", "angles_deg", "rotation"), "home", 0)
    position = reader.array(data, "position", (3,), "home")
    if "rpy_deg" in data:
        return Pose.from_rpy(position, reader.array(data, "rpy_deg", (3,), "home"), degrees=True)
    if "angles_deg" in data:
        angles = reader.array(data, "angles_deg", (3,), "home")
        return Pose.from_angles(position, angles, data.get("order", "rpy"), degrees=True)
    if "rotation" in data:
        return Pose(position, reader.array(data, "rotation", (3, 3), "home"))
    return Pose(position)


SPATIAL = Form(
    dimension=3,
    least=6,
    check_leg=check_leg,
    home_keys=("position", "rotation", "rpy_deg", "angles_deg", "order"),
    home=_spatial_home,
    written=("position", "rotation"),
)
