"""The parameters of the indices of a design: length, ellipsoid and maximum of |det J|."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from gsp import arguments, determinant
from gsp.checks import check_items, check_positive, check_type, has, is_a, plain_text
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array
from gsp.indices import Index
from gsp.indices.table import MAXIMUM_SHARES
from gsp.model.design import Design
from gsp.version import __version__

Maximum = float | Sequence[float] | Mapping[str, float] | Literal["sample"] | None


@dataclass(frozen=True)
class Settings:
    """The parameters of the indices of a design.

    Attributes
    ----------
    length : float or None [unit of the design]
    ellipsoid : Ellipsoid or None
    maximum : float, "sample" or None [unit of |det J|]
    found : gsp.determinant.Maximum or None
        Where `maximum` comes from, if it was searched.
    """

    length: float | None = None
    ellipsoid: Ellipsoid | None = None
    maximum: float | Literal["sample"] | None = None
    found: determinant.Maximum | None = None

    def given(self) -> tuple[str, ...]:
        """Return the names of the parameters that have a value."""
        names = tuple(name for name, value in vars(self).items() if value is not None)
        return names if self.found is None else (*names, "maximum")

    def for_index(self, index: Index) -> dict[str, Any]:
        """Return the arguments of an index; "sample" stands for 1 until all poses are known."""
        given = {name: getattr(self, name) for name in index.parameters}
        if given.get("maximum") == "sample":
            given["maximum"] = 1.0
        return given


class Job(NamedTuple):
    """A design with the settings of its indices."""

    design: Design
    settings: Settings


def settings_of(
    design: Design, length: float | None, ellipsoid: Ellipsoid | None, maximum: Any
) -> Settings:
    """Return the settings of a design: the arguments, else what the design records."""
    chosen = design.characteristic_length if length is None else arguments.size("length", length)
    if ellipsoid is not None:
        check_type("ellipsoid", ellipsoid, Ellipsoid)
    return Settings(chosen, design.ellipsoid if ellipsoid is None else ellipsoid, maximum)


def maximum_of_each(maximum: Any, designs: Sequence[Design]) -> list[Any]:
    """Return the maximum that belongs to each design: a number, "sample" or None.

    Parameters
    ----------
    maximum : float, sequence (one per design), mapping from design name, "sample" or None
        A Series whose labels are texts is a mapping, another one a sequence.
    designs : sequence of Design

    Raises
    ------
    InvalidInput
        If there is not one positive number per design, or a Series has a label twice.
    MissingParameter
        If a mapping has no number for a design.
    """
    given: Any = plain_text(_by_label(maximum))
    if given is None or (is_a(given, str) and given == "sample"):
        return [given] * len(designs)
    if is_a(given, str | bytes):
        raise InvalidInput(expected("maximum", 'a number or "sample"', brief(given)))
    if is_a(given, Mapping):
        known = arguments.mapping("maximum", given)
        given = [known.get(design.name) for design in designs]
    elif is_a(given, Sequence):
        given = arguments.sequence()("maximum", given)
    else:
        given = [given] * len(designs)
    if len(given) != len(designs):
        got = len(given)
        raise InvalidInput(expected("maximum", f"one per design, {len(designs)} in all", got))
    for design, number in zip(designs, given, strict=True):
        if number is None:
            where = f"for design {design.name!r}"
            raise MissingParameter(expected("maximum", "a number", "none", where))
    return [check_positive("maximum", number) for number in given]


def _by_label(maximum: Any) -> Any:
    """Return a Series with names as a mapping, other arrays as lists, and the rest as it is."""
    if not has(maximum, "tolist"):
        return maximum
    if isinstance(maximum, np.ndarray) and maximum.ndim:
        return check_items("maximum", maximum, "one number per design")
    labels = list(maximum.index) if has(maximum, "to_dict") else []
    if not any(isinstance(label, str) for label in labels):
        return maximum.tolist()
    if len(set(labels)) < len(labels):
        raise InvalidInput(expected("maximum", "one number per label", brief(labels)))
    return dict(zip(labels, maximum.tolist(), strict=True))


def provenance(settings: Settings) -> dict[str, Any]:
    """Return the parameters as a table records them."""
    ellipsoid = settings.ellipsoid
    return {
        "library": f"gsp {__version__}",
        "length": settings.length,
        "ellipsoid": None
        if ellipsoid is None
        else {
            "semi_axes": ellipsoid.semi_axes.tolist(),
            "center": ellipsoid.center.tolist(),
            "rotation": ellipsoid.rotation.tolist(),
        },
        "maximum": settings.maximum if settings.found is None else "found",
    }


def divide_by_largest(columns: Mapping[str, Array]) -> None:
    """Divide shares of a maximum by the largest of them, in place; all are NaN if it is 0 (0/0)."""
    for name in columns.keys() & set(MAXIMUM_SHARES):
        column = columns[name]
        largest = np.fmax.reduce(column, initial=0.0)
        column /= largest if largest > 0.0 else np.nan
