"""The TOML form of a design: writing, reading, and errors with file, line and key."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import Any, NoReturn

import numpy as np

from gsp import arguments
from gsp.errors import GspError, InvalidInput, MalformedFile, brief, expected
from gsp.files.toml_lines import line_of, parse_toml
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array, Mask
from gsp.model.design.checks import below_zero
from gsp.model.design.forms import SPATIAL, Form

_TEXTS = ("name", "source", "unit")
_TOP = (*_TEXTS, "characteristic_length", "ellipsoid", "home", "legs")
_LEG = (
    "constraints",
    "base_point",
    "base_direction",
    "base_second_point",
    "platform_point",
    "platform_direction",
    "platform_second_point",
    "strokes",
)
ELLIPSOID_KEYS = ("semi_axes", "center", "rotation")
# What the arrays of a shape are called; those with two axes are rotations and strokes.
_WORDS = {
    (): "a number",
    (2,): "two numbers",
    (3,): "three numbers",
    (3, 3): "three rows of three numbers",
    (1, 2): "two numbers, least and greatest",
    (2, 2): "two pairs of least and greatest",
}
# Numbers of constraints in words.
_NUMBERS = {3: "three", 6: "six"}


def toml_from_design(design: Any) -> str:
    """Return the design as TOML; floats are written so that they read back bit by bit.

    Parameters
    ----------
    design : Design or PlanarDesign

    Returns
    -------
    str
    """
    lines = [f"{key} = {_quoted(getattr(design, key))}" for key in _TEXTS]
    if design.characteristic_length is not None:
        lines.append(f"characteristic_length = {design.characteristic_length!r}")
    if design.ellipsoid is not None:
        lines += [
            "",
            "[ellipsoid]",
            *(f"{k} = {_numbers(getattr(design.ellipsoid, k))}" for k in ELLIPSOID_KEYS),
        ]
    if design.home is not None:
        lines += [
            "",
            "[home]",
            *(f"{k} = {_numbers(getattr(design.home, k))}" for k in design.form.written),
        ]
    row = 0
    for i, leg in enumerate(design.legs):
        drive = getattr(leg, "drive", None)
        lines += ["", "[[legs]]", f'constraints = "{leg.name if drive is None else "D1"}"']
        lines += [] if drive is None else [f"drive = {_drive_text(drive)}"]
        lines.append(f"base_point = {_numbers(design.base_points[i])}")
        if leg.base_line:
            lines.append(f"base_direction = {_numbers(design.base_directions[i])}")
        lines.append(f"platform_point = {_numbers(design.platform_points[i])}")
        if leg.platform_line:
            lines.append(f"platform_direction = {_numbers(design.platform_directions[i])}")
        n = len(leg.constraints)
        if design.strokes is not None:
            lines.append(f"strokes = {_numbers(design.strokes[row : row + n])}")
        row += n
    return "\n".join(lines) + "\n"


def parameters_from_toml(text: str, origin: str, form: Form = SPATIAL) -> dict[str, Any]:
    """Return the arguments of a design of a form that a TOML text gives.

    Raises
    ------
    MalformedFile
        With origin, line and key of the first mistake.
    """
    return Reader(text, origin, form).design(parse_toml(text, origin))


class Reader:
    """Reads one file, with the line of each key."""

    def __init__(self, text: str, origin: str, form: Form) -> None:
        self.lines = text.split("\n")
        self.origin = origin
        self.form = form

    def fail(self, message: str, key: str, table: str = "", number: int = 0) -> NoReturn:
        """Raise MalformedFile with the line of a key."""
        line = line_of(self.lines, key, table, number)
        raise MalformedFile(f"{self.origin}, line {line}, key {brief(key)}: {message}")

    def known(
        self, data: dict[str, Any], keys: tuple[str, ...], table: str = "", number: int = 0
    ) -> None:
        """Raise MalformedFile for a key that is not known."""
        for key in data:
            if key not in keys:
                self.fail(
                    expected("key", "one of " + ", ".join(keys), repr(key)), key, table, number
                )

    def holds_boolean(self, value: Any) -> bool:
        """Whether a value is true or false, or a list that holds one at any depth."""
        if isinstance(value, list):
            return any(map(self.holds_boolean, value))
        return isinstance(value, bool)

    def array(
        self, data: dict[str, Any], key: str, shape: tuple[int, ...], table: str, number: int = 0
    ) -> Array:
        """Return the numbers of a key, of one shape."""
        if key not in data:
            self.fail("expected this key, received none", key, table, number)
        if self.holds_boolean(data[key]):  # numpy takes true for 1
            self.fail(expected("value", "real numbers", brief(data[key])), key, table, number)
        try:
            array = arguments.bounded_array("value", data[key], (), finite=key != "strokes")
        except InvalidInput as error:
            self.fail(str(error), key, table, number)
        if array.shape != shape:
            message = expected("value", _WORDS[shape], brief(data[key]))
            self.fail(message, key, table, number)
        return array

    def one_of(self, data: dict[str, Any], keys: tuple[str, ...], table: str, number: int) -> None:
        """Raise MalformedFile for a table with two keys for one quantity."""
        given = [key for key in keys if key in data]
        if len(given) > 1:
            message = expected("key", "only one of " + ", ".join(keys), " and ".join(given))
            self.fail(message, given[1], table, number)

    def design(self, data: dict[str, Any]) -> dict[str, Any]:
        """Return the arguments of a design."""
        self.known(data, _TOP)
        result: dict[str, Any] = {}
        for key in _TEXTS:
            if not isinstance(data.get(key, ""), str):
                self.fail(expected("value", "a text", brief(data[key])), key)
            result[key] = data.get(key, "")
        length = data.get("characteristic_length")
        try:
            result["characteristic_length"] = (
                None if length is None else arguments.size("value", length)
            )
        except InvalidInput as error:
            self.fail(str(error), "characteristic_length")
        for key, read in (("ellipsoid", self.ellipsoid), ("home", self.home)):
            table = data.get(key)
            if table is not None and not isinstance(table, dict):
                self.fail(expected("value", f"a table [{key}]", brief(table)), key)
            try:
                result[key] = None if table is None else read(table)
            except MalformedFile:
                raise
            except GspError as error:
                self.fail(str(error), key)
        return result | self.legs(data.get("legs"))

    def ellipsoid(self, data: dict[str, Any]) -> Ellipsoid:
        """Return the ellipsoid of its table."""
        self.known(data, ELLIPSOID_KEYS, "ellipsoid")
        shapes = {"semi_axes": (3,), "center": (3,), "rotation": (3, 3)}
        given = {k: self.array(data, k, shapes[k], "ellipsoid") for k in ("semi_axes", *data)}
        return Ellipsoid(**given)

    def home(self, data: dict[str, Any]) -> Any:
        """Return the pose of its table."""
        self.known(data, self.form.home_keys, "home")
        return self.form.home(self, data)

    def legs(self, tables: Any) -> dict[str, Any]:
        """Return the arguments of a design that the tables of the legs give."""
        if tables is None:
            raise MalformedFile(f"{self.origin}: expected tables [[legs]], received none")
        if not isinstance(tables, list) or not all(isinstance(leg, dict) for leg in tables):
            self.fail(expected("value", "tables [[legs]]", brief(tables)), "legs")
        columns: dict[str, list[Any]] = {
            key: []
            for key in (
                "legs",
                "base_points",
                "platform_points",
                "base_directions",
                "platform_directions",
                "strokes",
            )
        }
        for i, leg in enumerate(tables):
            self.known(leg, (*_LEG, "drive") if self.form.drive else _LEG, "legs", i)
            try:
                kind = self.form.check_leg(leg.get("constraints", ""), f"legs[{i}]")
            except InvalidInput as error:
                self.fail(str(error), "constraints", "legs", i)
            if self.form.drive is not None and "drive" in leg:
                kind = self.form.drive(self, leg["drive"], kind, i)
            columns["legs"].append(kind)
            for side, line in (("base", kind.base_line), ("platform", kind.platform_line)):
                point = self.array(leg, f"{side}_point", (self.form.dimension,), "legs", i)
                columns[f"{side}_points"].append(point)
                columns[f"{side}_directions"].append(self.direction(leg, side, point, line, i))
            signed = np.array([one.signed for one in kind.constraints])
            columns["strokes"].append(self.strokes(leg, signed, i))
        number = sum(map(len, columns["strokes"]))
        if number < self.form.least:
            wanted = f"at least {_NUMBERS[self.form.least]} constraints"
            self.fail(expected("legs", wanted, number), "legs")
        return {**columns, "strokes": np.concatenate(columns.pop("strokes"))}

    def strokes(self, leg: dict[str, Any], signed: Mask, i: int) -> Array:
        """Return the limits of the actuators of a leg, (1, 2) or (2, 2); one pair serves alone."""
        given, shape = leg.get("strokes"), (len(signed), 2)
        if given is None:
            return np.full(shape, np.nan)
        pair = shape[0] == 1 and isinstance(given, list) and len(given) == 2
        limits = self.array({"strokes": [given] if pair else given}, "strokes", shape, "legs", i)
        if (reversed_ := limits[:, 0] > limits[:, 1]).any():
            got = brief(limits[reversed_][0].tolist())
            self.fail(expected("value", "least ≤ greatest", got), "strokes", "legs", i)
        if (below := ~signed & below_zero(limits)).any():
            wanted = "numbers ≥ 0, as no distance is negative"
            got = brief(limits[below][0].tolist())
            self.fail(expected("value", wanted, got), "strokes", "legs", i)
        return limits

    def direction(self, leg: dict[str, Any], side: str, point: Array, line: bool, i: int) -> Array:
        """Return the direction of a line, NaN for a point."""
        key, second = f"{side}_direction", f"{side}_second_point"
        shape = (self.form.dimension,)
        if not line:
            return np.full(shape, np.nan)
        self.one_of(leg, (key, second), "legs", i)
        if second in leg:
            vector = self.array(leg, second, shape, "legs", i) - point
            key = second
        else:
            vector = self.array(leg, key, shape, "legs", i)
        if not vector.any():
            self.fail(
                expected("value", "a line of two different points", vector.tolist()), key, "legs", i
            )
        return vector


def _drive_text(drive: Any) -> str:
    """Return a drive as a TOML table in one line."""
    numbers = (f"{part.name} = {_numbers(getattr(drive, part.name))}" for part in fields(drive))
    return f'{{ kind = "{drive.kind}", {", ".join(numbers)} }}'


def _numbers(array: Array) -> str:
    return str(np.asarray(array).tolist())


def _quoted(text: str) -> str:
    """Return a text as TOML: quotes, backslashes and control characters are escaped."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
