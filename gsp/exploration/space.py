"""`Space`: the designs that a function makes from parameters in ranges, and samples of them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.checks import check_array, check_items, check_type, reading
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.space_toml import toml_from_space
from gsp.files.writing import write_text
from gsp.geometry.copies import ReadOnly, ReadOnlyDict
from gsp.geometry.pose.intervals import sample_points
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class Space(ReadOnly):
    """A space of designs: a function that makes a design, and ranges of its parameters.

    Parameters
    ----------
    make : function that returns a Design
        Called with one keyword per parameter, such as `gsp.hexapod`, a family of `gsp.families`,
        `gsp.catalogue.place`, or a function of yours.
    ranges : mapping from name to (low, high) [of the parameter]
        Numbers that vary continuously, low < high, in the units that the function takes.
    choices : mapping from name to sequence of str, numbers or bools
        Values to choose from, such as names of placements.
    fixed : mapping from name to value
        Arguments that do not vary.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type, no range and no choice, bounds that are not finite or cross,
        an empty choice or one that has a value twice, a name that is given twice, or names that
        the function does not take.

    Examples
    --------
    >>> import gsp
    >>> space = gsp.Space(
    ...     gsp.hexapod,
    ...     {"platform_radius": (0.5, 1.5), "height": (1.0, 2.0)},
    ...     fixed={"base_radius": 2.0, "base_angle": 0.3, "platform_angle": 0.3},
    ... )
    >>> space.sample(4, seed=1).shape
    (4, 2)
    """

    make: Callable[..., Design]
    ranges: Mapping[str, Sequence[float]] = field(default_factory=dict)
    choices: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    fixed: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        arguments.function("space.make", self.make)
        clean = {
            "ranges": {name: _range(name, pair) for name, pair in _named(self, "ranges")},
            "choices": {name: _choice(name, values) for name, values in _named(self, "choices")},
            "fixed": dict(_named(self, "fixed")),
        }
        given = [name for names in clean.values() for name in names]
        twice = [name for name in given if given.count(name) > 1]
        if twice:
            raise InvalidInput(expected("space", "each parameter once", f"twice {twice[0]!r}"))
        if not clean["ranges"] and not clean["choices"]:
            raise InvalidInput(expected("space", "at least one range or choice", "none"))
        _check_signature(self.make, given)
        for name, value in clean.items():
            object.__setattr__(self, name, ReadOnlyDict(value))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters that vary: ranges, then choices."""
        return (*self.ranges, *self.choices)

    @arguments.validated(seed=arguments.integer(0), method=arguments.text)
    def sample(self, n: int, *, seed: int, method: str = "halton") -> pd.DataFrame:
        """Return a low-discrepancy sample of the parameters.

        Parameters
        ----------
        n : int
            Number of designs, ≥ 1.
        seed : int
        method : "halton" or "sobol"
            Scrambled sequences of `scipy.stats.qmc`; sobol is balanced where n is a power of two.

        Returns
        -------
        pandas.DataFrame, shape (n, number of parameters)
            One column per parameter, ranges before choices.

        Raises
        ------
        InvalidInput
            On a number, seed or method that cannot be used.
        """
        import pandas as pd

        numbers = [len(values) for values in self.choices.values()]
        low = np.array([*(pair[0] for pair in self.ranges.values()), *(0.0 for _ in numbers)])
        high = np.array([*(pair[1] for pair in self.ranges.values()), *numbers], dtype=np.float64)
        points = sample_points(low, high, n, seed, method)
        columns: dict[str, Any] = dict(zip(self.ranges, points.T, strict=False))
        for k, (name, values) in enumerate(self.choices.items(), len(self.ranges)):
            places = np.minimum(points[:, k].astype(int), len(values) - 1)
            columns[name] = [values[place] for place in places]
        return pd.DataFrame(columns)

    def design(self, **parameters: Any) -> Design:
        """Return the design of values of the parameters; they may lie outside of the ranges.

        Parameters
        ----------
        **parameters : one value per parameter

        Returns
        -------
        Design

        Raises
        ------
        InvalidInput
            If a parameter is missing or unknown, is no number where there is a range, or no text,
            number or bool where there is a choice, or if the function returns no design.
        GspError
            Whatever the function raises.
        """
        if set(parameters) != set(self.names):
            got = ", ".join(parameters) or "none"
            raise InvalidInput(expected("parameters of Space.design", ", ".join(self.names), got))
        for name, value in parameters.items():
            if name in self.ranges:
                parameters[name] = arguments.number(name, value)
            else:
                _choice(name, [value])
        made = self.make(**{**self.fixed, **parameters})
        check_type("what make returns", made, Design)
        return made

    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the space as TOML; `gsp.exploration.read_space` gives the same designs, bit by bit.

        Parameters
        ----------
        path : path of a file
        overwrite : bool
            Whether a file that exists is replaced.

        Raises
        ------
        InvalidInput
            If the function is none that a file can name, such as one of yours, or a fixed value is
            no text, number, bool or list of these. Of `gsp.catalogue.place` the template has to be
            a published design.
        UnwritableOutput
            If the file exists and `overwrite` is not set, or the folder cannot be written.
        """
        allowed = arguments.flag("overwrite", overwrite)
        write_text(arguments.path("path", path), toml_from_space(self), overwrite=allowed)

    def record(self) -> dict[str, Any]:
        """Return the space as texts, numbers and lists, by which tables record it.

        Returns
        -------
        dict
            make (the name of the function), ranges, choices, and texts of the fixed values.
        """
        make: Any = self.make
        module, name = getattr(make, "__module__", ""), getattr(make, "__qualname__", brief(make))
        return {
            "make": f"{module}.{name}",
            "ranges": {key: list(pair) for key, pair in self.ranges.items()},
            "choices": {key: list(values) for key, values in self.choices.items()},
            "fixed": {key: brief(value) for key, value in self.fixed.items()},
        }


def _check_signature(make: Callable[..., Design], names: Sequence[str]) -> None:
    """Raise InvalidInput if a function does not take exactly such keywords, as far as is known."""
    try:
        signature = inspect.signature(make)
    except Exception:  # objects without one, and whatever an object raises when it is asked
        return
    try:
        signature.bind(**dict.fromkeys(names))
    except TypeError as error:
        got = ", ".join(names)
        wanted = "a function that takes the ranges, choices and fixed values by name"
        raise InvalidInput(expected("space.make", wanted, f"{got}: {error}")) from error


def _named(space: Space, what: str) -> list[tuple[str, Any]]:
    given = arguments.mapping(f"space.{what}", getattr(space, what))
    for name in given:
        if not isinstance(name, str) or not name.isidentifier():
            wanted = "names of arguments as keys"
            raise InvalidInput(expected(f"space.{what}", wanted, brief(name)))
    return list(given.items())


def _range(name: str, pair: Any) -> tuple[float, float]:
    what = f"space.ranges[{name!r}]"
    low, high = arguments.bounded_array(what, pair, (2,)).reshape(-1, 2)[0].tolist()
    if check_array(what, pair, (2,)).ndim != 1 or not low < high:
        raise InvalidInput(expected(what, "two numbers, low < high", brief(pair)))
    return low, high


def _choice(name: str, values: Any) -> tuple[Any, ...]:
    what, wanted = f"space.choices[{name!r}]", "different texts, numbers or bools"
    found = tuple(
        value.item() if isinstance(value, np.generic) else value
        for value in check_items(what, values, wanted)
    )
    plain = all(isinstance(value, str | int | float) for value in found)
    with reading(what, wanted, values):
        different = len({repr(value) for value in found}) == len(found)
    if not found or not plain or not different:
        raise InvalidInput(expected(what, wanted, brief(values)))
    return found
