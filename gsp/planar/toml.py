"""The TOML form of a planar design: as in space, with two coordinates and an angle."""

from __future__ import annotations

from typing import Any

from gsp.checks import is_a, plain_text
from gsp.errors import InvalidDesign, brief, expected
from gsp.model.design.forms import Form
from gsp.model.design.toml import Reader
from gsp.planar.constraints import PLANAR_CONSTRAINT, PlanarConstraint
from gsp.planar.pose import PlanarPose


def check_planar_leg(name: Any, where: str) -> PlanarConstraint:
    """Return the leg of a name.

    Parameters
    ----------
    name : str
        "D1", "D2", "D3" or "A1".
    where : str
        What the message calls it.

    Raises
    ------
    InvalidDesign
        For another name.
    """
    if is_a(name, PlanarConstraint):
        return name
    name = plain_text(name)
    if not is_a(name, str) or name not in PLANAR_CONSTRAINT:
        wanted = "one of " + ", ".join(PLANAR_CONSTRAINT)
        raise InvalidDesign(expected(where, wanted, brief(name)))
    return PLANAR_CONSTRAINT[name]


def _home(reader: Reader, data: dict[str, Any]) -> PlanarPose:
    reader.one_of(data, ("angle", "angle_deg"), "home", 0)
    position = reader.array(data, "position", (2,), "home")
    for key in ("angle", "angle_deg"):
        if key in data:
            angle = reader.array(data, key, (), "home")
            return PlanarPose(position, angle, degrees=key == "angle_deg")
    return PlanarPose(position)


PLANAR = Form(
    dimension=2,
    least=3,
    check_leg=check_planar_leg,
    home_keys=("position", "angle", "angle_deg"),
    home=_home,
    written=("position", "angle"),
)
