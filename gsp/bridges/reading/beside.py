"""What `gsp export` writes beside a model: loops, joint variables, the pose of the platform."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gsp.bridges.reading.linkages import Freedom, Link
from gsp.errors import MalformedFile, brief, expected
from gsp.files.writing import read_text
from gsp.geometry.pose import Pose

# Names of passive joints in exported models: "leg4_slide", "leg1_base_turn" …
PASSIVE = re.compile(r"leg\d+_(base_|platform_)?(slide|turn)|.*passive.*", re.IGNORECASE)
PACKAGE_BYTES = 10_000_000  # bytes


class Closing(NamedTuple):
    """A loop: link_1 is fixed to link_2 where `placement` lies on link_2."""

    name: str
    link_1: str
    link_2: str
    placement: Pose


@dataclass(frozen=True, eq=False, kw_only=True)
class Beside:
    """The contents of such a file; empty where there is none."""

    path: Path
    loops: Sequence[Closing] = ()
    active: Mapping[str, float] = field(default_factory=dict)
    passive: Mapping[str, float] = field(default_factory=dict)
    platform: str = ""

    def applied(self, link: Link) -> Link:
        """Return a link whose freedoms know what drives them, and what their joints count."""
        return replace(link, freedoms=[self._known(x) for x in link.freedoms])

    def _known(self, freedom: Freedom) -> Freedom:
        name = freedom.name
        if self.active:
            active: bool | None = name in self.active
        else:
            active = freedom.active
            if active is None:
                active = PASSIVE.fullmatch(name) is None
        value = self.passive.get(name, self.active.get(name, freedom.value))
        return replace(freedom, active=active, value=value)


def read_beside(path: Path) -> Beside:
    """Return what a file beside a model has, or nothing if there is no such file.

    Raises
    ------
    MalformedFile
        With the file, and the line or key of the first mistake.
    """
    if not path.is_file():
        return Beside(path=path)
    try:
        content = json.loads(read_text(path, most=PACKAGE_BYTES))
    except (ValueError, RecursionError) as error:
        line = f", line {error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        raise MalformedFile(f"{path}{line}: not JSON: {error}") from error
    if not isinstance(content, dict):
        raise MalformedFile(expected(str(path), "an object", brief(content)))
    numbers = [
        {str(k): _number(path, f"{key}.{k}", v) for k, v in _object(path, content, key).items()}
        for key in ("joints_at_zero", "slides_at_zero")
    ]
    loops = content.get("loops", [])
    if not isinstance(loops, list):
        raise MalformedFile(expected(f"{path}, loops", "an array", brief(loops)))
    closings = tuple(_closing(path, f"loops[{i}]", loop) for i, loop in enumerate(loops))
    return Beside(
        path=path,
        loops=closings,
        active=numbers[0],
        passive=numbers[1],
        platform=closings[0].link_2 if closings else "",
    )


def _object(path: Path, content: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    found = content.get(key, {})
    if not isinstance(found, dict):
        raise MalformedFile(expected(f"{path}, {key}", "an object", brief(found)))
    return found


def _closing(path: Path, where: str, loop: Any) -> Closing:
    if not isinstance(loop, dict):
        raise MalformedFile(expected(f"{path}, {where}", "an object", brief(loop)))
    texts = []
    for key in ("name", "link_1", "link_2"):
        if not isinstance(loop.get(key), str) or not loop[key]:
            raise MalformedFile(expected(f"{path}, {where}.{key}", "a name", brief(loop.get(key))))
        texts.append(loop[key])
    vectors = [
        _numbers(path, f"{where}.{key}", loop.get(key), count)
        for key, count in (("position", 3), ("rotation", 4))
    ]
    if not any(vectors[1]):
        wanted = "a quaternion other than zero"
        raise MalformedFile(expected(f"{path}, {where}.rotation", wanted, brief(vectors[1])))
    name, link_1, link_2 = texts
    return Closing(name, link_1, link_2, Pose.from_quaternion(*vectors))


def _numbers(path: Path, where: str, value: Any, count: int) -> list[float]:
    if not isinstance(value, list) or len(value) != count:
        raise MalformedFile(expected(f"{path}, {where}", f"{count} numbers", brief(value)))
    return [_number(path, f"{where}[{i}]", x) for i, x in enumerate(value)]


def _number(path: Path, where: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
        raise MalformedFile(expected(f"{path}, {where}", "a finite number", brief(value)))
    return float(value)
