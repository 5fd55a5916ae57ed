"""Files of public packages for hexapods and cable robots, in YAML or JSON, as designs.

- github.com/oKermorgant/cdpr: `points` with `frame` and `platform`, `platform.position`.
- github.com/IRMA-LAB/cdpr_matlab: `actuator` with `pulley.pos_OD_glob` and `winch.pos_PA_loc`.
- github.com/64-B1T/basic_robotics: `BottomPlate`, `TopPlate`, `Actuators`, `Params`.

All lengths are metres. Masses, pulleys and drives are left out.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

import numpy as np

from gsp.checks import optional
from gsp.errors import MalformedFile, brief, expected
from gsp.families.circular import hexapod
from gsp.files.writing import read_text
from gsp.geometry.pose import Pose
from gsp.model.design import Design

PACKAGE_BYTES = 10_000_000  # bytes
LEAST_LEGS = 6
NAMES = ("oKermorgant/cdpr", "IRMA-LAB/cdpr_matlab", "64-B1T/basic_robotics")


class Form(NamedTuple):
    """A form of files: the keys by which it is recognised, and its reader."""

    keys: tuple[str, ...]
    read: Callable[[Keys, str], Design]


class Keys:
    """The contents of a file; errors name the file, the line where it is known, and the key."""

    def __init__(self, path: Path, content: Any, lines: Mapping[str, int], where: str = "") -> None:
        self._path, self._lines, self._where = path, lines, where
        self.content = content

    def __getitem__(self, key: str | int) -> Keys:
        """Return what is at a key, which must be there."""
        place = f"{self._where}[{key}]" if isinstance(key, int) else self._join(key)
        content = self.content
        if not isinstance(content, list if isinstance(key, int) else dict):
            self.fail("a list" if isinstance(key, int) else "a mapping of keys")
        try:
            found: Any = self.content[key]
        except (KeyError, IndexError):
            self._fail(place, "a value", "none")
        return Keys(self._path, found, self._lines, place)

    def __contains__(self, key: str) -> bool:
        """Whether there is a key."""
        return isinstance(self.content, dict) and key in self.content

    def items(self, least: int) -> list[Keys]:
        """Return the entries of a list, of which there must be some."""
        if not isinstance(self.content, list) or len(self.content) < least:
            self.fail(f"a list of at least {least} entries")
        return [self[i] for i in range(len(self.content))]

    def number(self) -> float:
        """Return a finite number."""
        value = self.content
        if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
            self.fail("a finite number")
        return float(value)

    def vector(self, count: int = 3) -> list[float]:
        """Return numbers in a list, each perhaps in a list of its own."""
        if not isinstance(self.content, list) or len(self.content) != count:
            self.fail(f"{count} numbers")
        each = [self[i] for i in range(count)]
        return [
            (x[0] if isinstance(x.content, list) and len(x.content) == 1 else x).number()
            for x in each
        ]

    def fail(self, wanted: str) -> NoReturn:
        """Raise an error about what is here."""
        self._fail(self._where, wanted, brief(self.content))

    def _join(self, key: str) -> str:
        return f"{self._where}.{key}" if self._where else key

    def _fail(self, where: str, wanted: str, got: str) -> NoReturn:
        near = where
        while near and near not in self._lines:
            near = near.rpartition("." if "." in near else "[")[0]
        line = f", line {self._lines[near]}" if near in self._lines else ""
        named = f", key {where}" if where else ""
        raise MalformedFile(expected(f"{self._path}{line}{named}", wanted, got))


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
    keys = _read(path)
    for form in FORMS:
        if all(key in keys for key in form.keys):
            return form.read(keys, path.stem if name is None else name)
    wanted = "a file of " + ", ".join(NAMES)
    known = "; ".join(" and ".join(form.keys) for form in FORMS)
    raise MalformedFile(expected(f"{path}, keys", f"{wanted} (with {known})", _keys_of(keys)))


def _keys_of(keys: Keys) -> str:
    if not isinstance(keys.content, dict):
        return brief(keys.content)
    return ", ".join(map(str, list(keys.content)[:8])) or "none"


def _read(path: Path) -> Keys:
    text = read_text(path, most=PACKAGE_BYTES)
    if path.suffix.lower() == ".json":
        try:
            return Keys(path, json.loads(text), {})
        except json.JSONDecodeError as error:
            raise MalformedFile(f"{path}, line {error.lineno}: not JSON: {error.msg}") from error
        except (ValueError, RecursionError) as error:
            raise MalformedFile(f"{path}: not JSON: {brief(str(error))}") from error
    with optional("yaml", "a file in YAML", "yaml"):
        import yaml  # type: ignore[import-untyped]
    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
        lines: dict[str, int] = {}
        _note_lines(node, "", lines, set())
        return Keys(path, yaml.safe_load(text), lines)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = f", line {mark.line + 1}" if mark is not None else ""
        raise MalformedFile(f"{path}{line}: not YAML: {error.problem}") from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise MalformedFile(f"{path}: not YAML: {brief(str(error))}") from error


def _note_lines(node: Any, where: str, lines: dict[str, int], seen: set[int]) -> None:
    """Note the line of each key of a YAML file; what aliases repeat is noted once."""
    if where and node is not None:
        lines[where] = node.start_mark.line + 1
    if node is None or id(node) in seen:
        return
    seen.add(id(node))
    if node.id == "mapping":
        for key, value in node.value:
            place = f"{where}.{key.value}" if where else str(key.value)
            _note_lines(value, place, lines, seen)
    elif node.id == "sequence":
        for i, value in enumerate(node.value):
            _note_lines(value, f"{where}[{i}]", lines, seen)


def _points(keys: Keys, name: str) -> Design:
    """Cable robots of oKermorgant/cdpr; the home pose is where the platform starts."""
    points = keys["points"].items(LEAST_LEGS)
    home = None
    if "platform" in keys and "position" in keys["platform"]:
        place = keys["platform"]["position"]
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


def _actuators(keys: Keys, name: str) -> Design:
    """Cable robots of IRMA-LAB/cdpr_matlab, with pulleys as points."""
    actuators = keys["actuator"].items(LEAST_LEGS)
    used = [x for x in actuators if "active" not in x or x["active"].content is not False]
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
    ends = [keys["Actuators"][key].number() for key in ("MinExtension", "MaxExtension")]
    height = keys["Params"]["RestHeight"].number()
    thickness = [plate["Thickness"].number() for plate in (bottom, top)]
    flat = hexapod(
        base_radius=bottom["JointRadius"].number(),
        base_angle=bottom["JointSpacing"].number(),
        platform_radius=top["JointRadius"].number(),
        platform_angle=top["JointSpacing"].number(),
        height=height,
        degrees=True,
        strokes=(ends[0], ends[1]),
        unit="m",
        name=name,
    )
    return flat.replace(
        base_points=flat.base_points + [0.0, 0.0, thickness[0]],
        platform_points=flat.platform_points - [0.0, 0.0, thickness[1]],
    )


FORMS = (
    Form(("points",), _points),
    Form(("actuator",), _actuators),
    Form(("BottomPlate", "TopPlate"), _plates),
)
