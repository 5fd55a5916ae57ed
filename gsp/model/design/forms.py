"""What differs between the files of designs in space and in the plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields
from functools import partial
from typing import TYPE_CHECKING, Any

from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.model.drives import DRIVES
from gsp.model.legs import Leg, check_leg

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
    drive : function (reader, value of the key, leg, number) -> leg, or None
        The leg of fixed length that the table of a drive gives; None where legs have no drives.
    """

    dimension: int
    least: int
    check_leg: Callable[[Any, str], Any]
    home_keys: tuple[str, ...]
    home: Callable[[Reader, dict[str, Any]], Any]
    written: tuple[str, ...]
    drive: Callable[[Reader, Any, Any, int], Any] | None = None


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


def _driven_leg(reader: Reader, data: Any, leg: Leg, number: int) -> Leg:
    fail = partial(reader.fail, key="drive", table="legs", number=number)
    if not isinstance(data, dict) or data.get("kind") not in DRIVES:
        wanted = "a table with kind = " + " or ".join(map(repr, DRIVES))
        fail(expected("value", wanted, brief(data)))
    if leg.name != "D1":
        fail(
            expected("key", "none, as only legs D1 can be driven at the base", f"a leg {leg.name}")
        )
    kept = {key: value for key, value in data.items() if key != "kind"}
    parts = fields(DRIVES[data["kind"]])
    reader.known(kept, tuple(part.name for part in parts), "legs", number)
    for part in parts:
        if part.default is MISSING and part.name not in kept:
            fail(expected("value", f"the key {part.name!r}", "none"))
        if reader.holds_boolean(kept.get(part.name)):
            fail(expected("value", "real numbers", brief(data)))
    try:
        return check_leg(DRIVES[data["kind"]](**kept))
    except InvalidInput as error:
        fail(str(error))


SPATIAL = Form(
    dimension=3,
    least=6,
    check_leg=check_leg,
    home_keys=("position", "rotation", "rpy_deg", "angles_deg", "order"),
    home=_spatial_home,
    written=("position", "rotation"),
    drive=_driven_leg,
)
