"""The TOML form of a task: writing, reading, and errors with file, line and key."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any, NoReturn

import numpy as np

from gsp.errors import GspError, InvalidInput, MalformedFile, brief, expected
from gsp.files.toml_lines import line_of, parse_toml
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox, PosePath
from gsp.limits import Limits
from gsp.model.design.toml import ELLIPSOID_KEYS
from gsp.statics import Masses

_SETTINGS = ("name", "unit", "samples", "seed", "length", "wrench", "resolution")
_MASSES = tuple(f.name for f in fields(Masses))
_LIMITS = tuple(f.name for f in fields(Limits) if f.init)
_PATH = ("times", "position", "turn", "rotation")
# The table of each kind of poses, and its keys.
_POSES = {
    "box": ("position", "angles", "angles_deg", "order"),
    "path": _PATH,
    "poses": ("position", "rotation", "rpy_deg"),
}
_WANTED = ("index", "of", "weight")


def toml_from_task(task: Any) -> str:
    """Return a task as TOML; floats are written so that they read back bit by bit.

    Parameters
    ----------
    task : Task

    Returns
    -------
    str
    """
    record = record_of(task)
    lines = [f"{key} = {_value(record[key])}" for key in _SETTINGS if record[key] is not None]
    for wish in record["wanted"]:
        lines += ["", "[[wanted]]", *_lines(wish)]
    for name in (*_POSES, "ellipsoid", "payload"):
        if record.get(name):
            lines += ["", f"[{name}]", *_lines(record[name])]
    limits = record["limits"]
    if limits is not None:
        inner = limits.pop("ellipsoid", None)
        lines += ["", "[limits]", *_lines(limits)]
        if inner:
            lines += ["", "[limits.ellipsoid]", *_lines(inner)]
    return "\n".join(lines) + "\n"


def record_of(task: Any) -> dict[str, Any]:
    """Return all parts of a task as texts, numbers and lists, by which tables record it.

    Parameters
    ----------
    task : Task

    Returns
    -------
    dict
        The keys of the TOML form; None where there is nothing.
    """
    limits = task.limits
    kept = None
    if limits is not None:
        given = {key: getattr(limits, key) for key in _LIMITS}
        kept = {key: _plain(value) for key, value in given.items() if value is not None}
    return {
        **{key: _plain(getattr(task, key)) for key in _SETTINGS},
        "wanted": [{key: getattr(wish, key) for key in _WANTED} for wish in task.wanted],
        **_poses_record(task.poses),
        "ellipsoid": _plain(task.ellipsoid),
        "payload": _plain(task.payload),
        "limits": kept,
    }


def _poses_record(poses: PoseBox | PosePath | Pose) -> dict[str, Any]:
    if isinstance(poses, PoseBox):
        pairs = np.stack((poses.low, poses.high), axis=-1).tolist()
        return {"box": {"position": pairs[:3], "angles": pairs[3:], "order": poses.order}}
    if isinstance(poses, PosePath):
        return {"path": {key: getattr(poses, key).tolist() for key in _PATH}}
    return {"poses": {key: getattr(poses, key).tolist() for key in ("position", "rotation")}}


def _plain(value: Any) -> Any:
    if isinstance(value, Ellipsoid):
        return {key: getattr(value, key).tolist() for key in ELLIPSOID_KEYS}
    if isinstance(value, Masses):
        return {key: _plain(getattr(value, key)) for key in _MASSES}
    if isinstance(value, np.ndarray):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value


def _lines(record: Mapping[str, Any]) -> list[str]:
    return [f"{key} = {_value(value)}" for key, value in record.items()]


def _value(value: Any) -> str:
    """Return a text, a number or a list as TOML; nan and inf are written as Python does."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return repr(value)


class TaskReader:
    """Reads the arguments of a task from one TOML text, with the line of each key."""

    def __init__(self, text: str, origin: str) -> None:
        self.lines, self.origin = text.split("\n"), origin
        self.data = parse_toml(text, origin)

    def arguments(self) -> dict[str, Any]:
        """Return the arguments of a task.

        Raises
        ------
        MalformedFile
            With origin, line and key of the first mistake.
        """
        data = self.data
        self._known(data, (*_SETTINGS, "wanted", *_POSES, "ellipsoid", "payload", "limits"))
        there = [key for key in _POSES if key in data]
        if len(there) != 1:
            wanted = "one of the tables " + ", ".join(f"[{key}]" for key in _POSES)
            got = " and ".join(f"[{key}]" for key in there) or "none"
            raise MalformedFile(f"{self.origin}: expected {wanted}, received {got}")
        result = {key: data[key] for key in _SETTINGS if key in data}
        result["wanted"] = self._wanted(data.get("wanted", ()))
        result["poses"] = self._made(there[0], self._poses)
        if "ellipsoid" in data:
            result["ellipsoid"] = self._made("ellipsoid", _ellipsoid)
        if "payload" in data:
            result["payload"] = self._made("payload", self._payload)
        if "limits" in data:
            result["limits"] = self._made("limits", self._limits)
        return result

    def fail_of_wanted(self, error: Exception, number: int) -> NoReturn:
        """Raise the error of the number-th thing that is wanted with the line of its key.

        Raises
        ------
        MalformedFile
        """
        found = re.match(r"wanted\.(\w+)", str(error))
        self._fail(str(error), found[1] if found else "index", "wanted", number)

    def fail_of_task(self, error: Exception) -> NoReturn:
        """Raise the error of an argument of a task with the line of its key or table.

        Raises
        ------
        MalformedFile
        """
        found = re.match(r"task\.(\w+)", str(error))
        key = found[1] if found else ""
        if key == "poses":
            key = next(key for key in _POSES if key in self.data)
        if key not in self.data:
            raise MalformedFile(f"{self.origin}: {error}") from error
        self._fail(str(error), key)

    def _fail(self, message: str, key: str, table: str = "", number: int = 0) -> NoReturn:
        line = line_of(self.lines, key, table, number)
        raise MalformedFile(f"{self.origin}, line {line}, key {key!r}: {message}")

    def _known(
        self, data: Mapping[str, Any], keys: Iterable[str], table: str = "", number: int = 0
    ) -> None:
        names = tuple(keys)
        for key in data:
            if key not in names:
                wanted = "one of " + ", ".join(names)
                self._fail(expected("key", wanted, repr(key)), key, table, number)

    def _made(self, key: str, make: Any) -> Any:
        """Return what a function makes of a table; its errors get the line of the table."""
        table = self.data[key]
        if not isinstance(table, dict):
            self._fail(expected("value", f"a table [{key}]", brief(table)), key)
        try:
            return make(table) if make is _ellipsoid else make(key, table)
        except MalformedFile:
            raise
        except (GspError, TypeError) as error:
            self._fail(str(error), key)

    def _wanted(self, tables: Any) -> list[dict[str, Any]]:
        if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
            wish = "tables [[wanted]] with index, of and weight"
            raise MalformedFile(f"{self.origin}: expected {wish}, received {brief(tables)}")
        for i, table in enumerate(tables):
            self._known(table, _WANTED, "wanted", i)
            if "index" not in table:
                self._fail("expected this key, received none", "index", "wanted", i)
        return tables

    def _poses(self, kind: str, table: dict[str, Any]) -> PoseBox | PosePath | Pose:
        self._known(table, _POSES[kind], kind)
        if kind == "box":
            degrees = "angles_deg" in table
            key = "angles_deg" if degrees else "angles"
            self._needs(table, ("position", key), kind)
            if degrees and "angles" in table:
                self._fail(expected("key", "angles or angles_deg", "both"), key, kind)
            order = table.get("order", "rpy")
            return PoseBox(table["position"], table[key], degrees=degrees, order=order)
        if kind == "path":
            self._needs(table, ("times", "position", "turn"), kind)
            return PosePath(**table)
        self._needs(table, ("position",), kind)
        if "rpy_deg" in table and "rotation" in table:
            self._fail(expected("key", "rotation or rpy_deg", "both"), "rpy_deg", kind)
        if "rpy_deg" in table:
            return Pose.from_rpy(table["position"], table["rpy_deg"], degrees=True)
        return Pose(table["position"], table.get("rotation"))

    def _needs(self, table: Mapping[str, Any], keys: Iterable[str], name: str) -> None:
        for key in keys:
            if key not in table:
                self._fail("expected this key, received none", key, name)

    def _payload(self, key: str, table: dict[str, Any]) -> Masses:
        self._known(table, _MASSES, key)
        return Masses(**table)

    def _limits(self, key: str, table: dict[str, Any]) -> Limits:
        self._known(table, _LIMITS, key)
        given = dict(table)
        if "ellipsoid" in given:
            if not isinstance(given["ellipsoid"], dict):
                got = brief(given["ellipsoid"])
                raise InvalidInput(expected("ellipsoid", "a table [limits.ellipsoid]", got))
            given["ellipsoid"] = _ellipsoid(given["ellipsoid"])
        return Limits(**given)


def _ellipsoid(table: dict[str, Any]) -> Ellipsoid:
    unknown = [key for key in table if key not in ELLIPSOID_KEYS]
    if unknown or "semi_axes" not in table:
        got = ", ".join(table) or "none"
        raise InvalidInput(expected("ellipsoid", f"keys of {', '.join(ELLIPSOID_KEYS)}", got))
    return Ellipsoid(**table)
