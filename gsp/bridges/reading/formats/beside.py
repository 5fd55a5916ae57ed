"""What `gsp export` writes beside a model: loops, joint variables, the pose of the platform."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from gsp.bridges.reading.mechanism.linkages import Freedom, Link
from gsp.bridges.reading.texts.keys import Keys, read_keys
from gsp.errors import MalformedFile, brief, expected
from gsp.geometry.pose import Pose

KEYS = ("loops", "joints_at_zero", "slides_at_zero")


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

    def check_driven(self, stated: Collection[str]) -> None:
        """Raise MalformedFile if the model, which states some, has other driven joints."""
        for name in sorted({*stated} ^ {*self.active} if stated and self.active else ()):
            where = f"{self.path}, key {KEYS[1]}"
            beside = "with" if name in self.active else "without"
            wanted = "the joints that have an actuator in the model"
            raise MalformedFile(expected(where, wanted, f"them {beside} {brief(name)}"))

    def check_joints(self, known: Collection[str]) -> None:
        """Raise MalformedFile if it has a value of a joint that the model does not have."""
        for key, values in zip(KEYS[1:], (self.active, self.passive), strict=True):
            for name in values:
                if name not in known:
                    where = f"{self.path}, key {key}"
                    wanted = "names of joints of the model"
                    raise MalformedFile(expected(where, wanted, brief(name)))

    def applied(self, link: Link) -> Link:
        """Return a link whose freedoms know what drives them, and what their joints count."""
        return replace(link, freedoms=[self._known(x) for x in link.freedoms])

    def _known(self, freedom: Freedom) -> Freedom:
        name = freedom.name
        active = name in self.active if self.active else freedom.active
        value = self.passive.get(name, self.active.get(name, freedom.value))
        return replace(freedom, active=active, value=value)


def read_beside(path: Path) -> Beside:
    """Return what a file beside a model has, or nothing if there is no such file.

    Raises
    ------
    MalformedFile
        With the file, line and key of the first mistake.
    """
    if not path.is_file():
        return Beside(path=path)
    keys = read_keys(path)
    if not any(key in keys for key in KEYS):
        keys.fail("a mapping with " + ", ".join(KEYS) + " or some of them")
    numbers = [
        {name: keys[key][name].number() for name in keys[key].names()} if key in keys else {}
        for key in KEYS[1:]
    ]
    closings = tuple(map(_closing, keys["loops"].items(1))) if "loops" in keys else ()
    for number, closing in enumerate(closings):
        if closing.name in {other.name for other in closings[:number]}:
            keys["loops"][number]["name"].fail("a name of its own")
    return Beside(
        path=path,
        loops=closings,
        active=numbers[0],
        passive=numbers[1],
        platform=_common(closings),
    )


def _common(closings: Sequence[Closing]) -> str:
    """Return the link that all loops have."""
    for name in (x for loop in closings[:1] for x in (loop.link_2, loop.link_1)):
        if all(name in (loop.link_1, loop.link_2) for loop in closings):
            return name
    return ""


def _closing(loop: Keys) -> Closing:
    name, link_1, link_2 = (loop[key].text() for key in ("name", "link_1", "link_2"))
    position, rotation = loop["position"].vector(3), loop["rotation"].vector(4)
    if not any(rotation):
        loop["rotation"].fail("a quaternion other than zero")
    return Closing(name, link_1, link_2, Pose.from_quaternion(position, rotation))
