"""What indices are given, and the checks of what evaluate() and rank() are given."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from gsp import determinant
from gsp.checks import check_positive, check_type
from gsp.errors import InvalidInput, MissingParameter, UnknownIndex, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.indices import INDICES, Index
from gsp.model.design import Design
from gsp.version import __version__

Maximum = float | Sequence[float] | Mapping[str, float] | Literal["sample"] | None


@dataclass(frozen=True)
class Settings:
    """What the indices are given: length, ellipsoid and maximum of |det J|, if found how."""

    length: float | None = None
    ellipsoid: Ellipsoid | None = None
    maximum: float | Literal["sample"] | None = None
    found: determinant.Maximum | None = None

    def given(self) -> tuple[str, ...]:
        """Return the names of the parameters that there are."""
        names = tuple(name for name, value in vars(self).items() if value is not None)
        return names if self.found is None else (*names, "maximum")

    def for_index(self, index: Index) -> dict[str, Any]:
        """Return the arguments of an index; "sample" stands for 1 until all poses are known."""
        given = {name: getattr(self, name) for name in index.parameters}
        if given.get("maximum") == "sample":
            given["maximum"] = 1.0
        return given


def settings_of(
    design: Design, length: float | None, ellipsoid: Ellipsoid | None, maximum: Any
) -> Settings:
    """Return what the indices of a design are given: the arguments, else what it records."""
    chosen = design.characteristic_length if length is None else check_positive("length", length)
    if ellipsoid is not None:
        check_type("ellipsoid", ellipsoid, Ellipsoid)
    return Settings(chosen, design.ellipsoid if ellipsoid is None else ellipsoid, maximum)


def maxima(maximum: Maximum, designs: Sequence[Design]) -> list[Any]:
    """Return the maximum that belongs to each design: a number, "sample" or None."""
    given: Any = maximum.tolist() if isinstance(maximum, np.ndarray) else maximum
    if given is None or (isinstance(given, str) and given == "sample"):
        return [given] * len(designs)
    if isinstance(given, str | bytes):
        raise InvalidInput(expected("maximum", 'a number or "sample"', brief(given)))
    if isinstance(given, Mapping):
        given = [given.get(design.name) for design in designs]
    elif not isinstance(given, Sequence):
        given = [given] * len(designs)
    if len(given) != len(designs):
        raise InvalidInput(expected("maximum", f"one a design, {len(designs)} in all", len(given)))
    for design, number in zip(designs, given, strict=True):
        if number is None:
            where = f"for design {design.name!r}"
            raise MissingParameter(expected("maximum", "a number", "none", where))
    return [check_positive("maximum", number) for number in given]


def check_types(designs: Sequence[Any], pose: Any, progress: Any) -> None:
    """Raise InvalidInput for what is not designs, a pose and a way to tell progress."""
    if not designs:
        raise InvalidInput(expected("designs", "at least one design", "none"))
    for i, design in enumerate(designs):
        check_type("design" if len(designs) == 1 else f"designs[{i}]", design, Design)
    check_type("pose", pose, Pose)
    if not pose.size:
        raise InvalidInput(expected("pose", "at least one pose", "an empty batch"))
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        wanted = "a function (done, total), a bool or None"
        raise InvalidInput(expected("progress", wanted, brief(progress)))


def check_index(name: str) -> str:
    """Return the name of an index, or raise UnknownIndex."""
    if not isinstance(name, str) or name not in INDICES:
        raise UnknownIndex("index", str(name), INDICES)
    return name


def check_indices(
    names: Iterable[str] | None, jobs: Sequence[tuple[Design, Settings]]
) -> tuple[str, ...]:
    """Return the names of known indices whose needs are met; default all routine ones."""
    if names is None:
        return tuple(
            name
            for name, index in INDICES.items()
            if index.routine and not any(index.missing(d, s.given()) for d, s in jobs)
        )
    if not isinstance(names, Iterable):
        raise InvalidInput(expected("indices", "names of indices", brief(names)))
    chosen = (names,) if isinstance(names, str) else tuple(names)
    for name in chosen:
        index = INDICES[check_index(name)]
        for design, settings in jobs:
            for need in index.missing(design, settings.given()):
                raise MissingParameter(
                    f"{index.missing_message(need, design)} (design {design.name!r})"
                )
    if not chosen:
        raise InvalidInput(expected("indices", "at least one name", "none"))
    return tuple(dict.fromkeys(chosen))


def provenance(settings: Settings) -> dict[str, Any]:
    """Return what a table records about how it was made."""
    ellipsoid = settings.ellipsoid
    return {
        "library": f"gsp {__version__}",
        "length": settings.length,
        "ellipsoid": None if ellipsoid is None else {
            "semi_axes": ellipsoid.semi_axes.tolist(),
            "center": ellipsoid.center.tolist(),
            "rotation": ellipsoid.rotation.tolist(),
        },
        "maximum": settings.maximum if settings.found is None else "found",
    }  # fmt: skip
