"""Files of public packages for hexapods and cable robots, in YAML or JSON, as designs.

- github.com/oKermorgant/cdpr: `points` with `frame` and `platform`, `platform.position`, perhaps
  within `model`.
- github.com/IRMA-LAB/cdpr_matlab: `actuator` with `pulley.pos_OD_glob` and `winch.pos_PA_loc`.
- github.com/64-B1T/basic_robotics: `BottomPlate`, `TopPlate`, `Actuators`, `Params`.

All lengths are metres. Masses, pulleys and drives are left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from gsp import arguments
from gsp.bridges.reading.texts.keys import Keys, read_keys
from gsp.errors import MalformedFile, brief, expected
from gsp.families.circular import LARGEST_PAIR_ANGLE_DEG, hexapod
from gsp.geometry.pose import Pose
from gsp.model.design import Design

LEAST_LEGS = 6
# Keys of the place of a platform in files of oKermorgant/cdpr.
PLACE = ("xyz", "rpy")
NAMES = ("oKermorgant/cdpr", "IRMA-LAB/cdpr_matlab", "64-B1T/basic_robotics")


class Form(NamedTuple):
    """A form of files: keys by which it is recognised, its reader, and the key of the name."""

    keys: tuple[str, ...]
    read: Callable[[Keys, str], Design]
    name: str = ""

    def name_of(self, keys: Keys) -> str:
        """Return the name that a file states, or an empty text."""
        if not self.name or self.name not in keys or keys[self.name].content in ("", None):
            return ""
        return keys[self.name].text()


def design_of_package(path: Path, name: str | None = None) -> Design:
    """Return the design of a file of a public package.

    Parameters
    ----------
    path : Path
        Ending in .json, .yaml or .yml.
    name : str or None
        Of the design; default that in the file, or of the file.

    Raises
    ------
    MalformedFile
        With the file, line and key of the first mistake.
    MissingSoftware
        If the file is YAML, and PyYAML is not installed.
    """
    keys = read_keys(path)
    for form in FORMS:
        if all(_has(keys, key) for key in form.keys):
            if name is None:
                name = form.name_of(keys) or path.stem
            return form.read(keys, name)
    wanted = "a file of " + ", ".join(NAMES)
    known = "; ".join(" and ".join(form.keys) for form in FORMS)
    raise MalformedFile(expected(f"{path}, keys", f"{wanted} (with {known})", _keys_of(keys)))


def _has(keys: Keys, key: str) -> bool:
    first, _, rest = key.partition(".")
    return first in keys and (not rest or _has(keys[first], rest))


def _keys_of(keys: Keys) -> str:
    if not isinstance(keys.content, dict):
        return brief(keys.content)
    return ", ".join(map(str, list(keys.content)[:8])) or "none"


def _points(keys: Keys, name: str) -> Design:
    """Cable robots of oKermorgant/cdpr; the home pose is where the platform starts."""
    points = _beside_or_in_model(keys, "points")["points"].items(LEAST_LEGS)
    home = None
    keys = _beside_or_in_model(keys, "platform")
    if "platform" in keys and "position" in keys["platform"].names():
        place = keys["platform"]["position"]
        for key in place.names():
            if key not in PLACE:
                place[key].fail("one of the keys " + ", ".join(PLACE))
        turn = place["rpy"].vector() if "rpy" in place else [0.0, 0.0, 0.0]
        home = Pose.from_rpy(place["xyz"].vector(), turn)
    return Design(
        ["D1"] * len(points),
        [x["frame"].vector() for x in points],
        [x["platform"].vector() for x in points],
        home=home,
        unit="m",
        name=name,
    )


def _beside_or_in_model(keys: Keys, key: str) -> Keys:
    """Return the mapping that has a key: that of the whole file, or the one of its `model`."""
    within = keys["model"] if "model" in keys else keys
    if key not in within.names():
        return keys
    if within is not keys and key in keys:
        within[key].fail(f"{key} beside `model` or in it, not both")
    return within


def _actuators(keys: Keys, name: str) -> Design:
    """Cable robots of IRMA-LAB/cdpr_matlab, with pulleys as points."""
    actuators = keys["actuator"].items(LEAST_LEGS)
    used = [x for x in actuators if "active" not in x or x["active"].flag()]
    if len(used) < LEAST_LEGS:
        keys["actuator"].fail(f"at least {LEAST_LEGS} active entries")
    return Design(
        ["D1"] * len(used),
        [x["pulley"]["pos_OD_glob"].vector() for x in used],
        [x["winch"]["pos_PA_loc"].vector() for x in used],
        unit="m",
        name=name,
    )


def _plates(keys: Keys, name: str) -> Design:
    """Stewart platforms of 64-B1T/basic_robotics: pairs of anchors, above and below the plates."""
    bottom, top = keys["BottomPlate"], keys["TopPlate"]
    most = arguments.LARGEST_NUMBER
    thickness = [plate["Thickness"].between(0.0, most, "a number ≥ 0") for plate in (bottom, top)]
    radii = [plate["JointRadius"].size() for plate in (bottom, top)]
    wanted = f"an angle in [0, {LARGEST_PAIR_ANGLE_DEG:g}] degrees"
    spacings = [
        plate["JointSpacing"].between(0.0, LARGEST_PAIR_ANGLE_DEG, wanted)
        for plate in (bottom, top)
    ]
    ends = _ends(keys["Actuators"])
    flat = hexapod(
        base_radius=radii[0],
        base_angle=spacings[0],
        platform_radius=radii[1],
        platform_angle=spacings[1],
        height=1.0,
        degrees=True,
        strokes=ends,
        unit="m",
        name=name,
    )
    if _has(keys, "Params.RestHeight") and not _is_set(keys, "Settings.IgnoreRestHeight"):
        height = keys["Params"]["RestHeight"].size()
    else:
        height = _middle_height(keys, flat, ends) + sum(thickness)
    return flat.replace(
        base_points=flat.base_points + [0.0, 0.0, thickness[0]],
        platform_points=flat.platform_points - [0.0, 0.0, thickness[1]],
        home=Pose([0.0, 0.0, height]),
    )


def _is_set(keys: Keys, key: str) -> bool:
    first, second = key.split(".")
    return _has(keys, key) and keys[first][second].flag()


def _ends(actuators: Keys) -> tuple[float, float]:
    """Return the least and greatest length of the legs."""
    most = arguments.LARGEST_NUMBER
    low = actuators["MinExtension"].between(0.0, most, "a number ≥ 0")
    wanted = f"at least MinExtension, which is {low:g}"
    return low, actuators["MaxExtension"].between(low, most, wanted)


def _middle_height(keys: Keys, flat: Design, ends: tuple[float, float]) -> float:
    """Return the height of the platform anchors where the legs are half extended.

    There the function `midHeightEstimate` of the package places the platform at its start, which
    does not read `Params`. All six legs have this length, by the symmetry of the pairs.
    """
    length = 0.5 * ends[0] + 0.5 * ends[1]
    across = math.hypot(*(flat.platform_points[0] - flat.base_points[0])[:2])
    if not length > across:
        wanted = f"a mean with MinExtension above {across:g}, the distance of the anchors across"
        keys["Actuators"]["MaxExtension"].fail(wanted)
    return math.sqrt((length - across) * (length + across))


FORMS = (
    Form(("points",), _points),
    Form(("model.points",), _points),
    Form(("actuator",), _actuators),
    Form(("BottomPlate", "TopPlate"), _plates, name="Name"),
)
