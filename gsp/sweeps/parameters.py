"""Indices and maxima of |det J| over a parameter of a family of designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import determinant
from gsp.checks import check_text, check_type
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import angle_of
from gsp.geometry.vectors import Array
from gsp.indices import index_names
from gsp.model.design import Design
from gsp.progress import Progress, meter
from gsp.sweeps.paths import Path, check_single, check_steps
from gsp.sweeps.tables import sweep

if TYPE_CHECKING:
    import pandas as pd

    from gsp.determinant import Maximum


# Columns of `maxima`.
FACTS = ("method", "agreed", "starts", "proven")
COLUMNS = ("value", "x", "y", "z", "turn_deg", *FACTS)


def over_designs(
    make: Callable[[float], Design],
    name: str,
    values: ArrayLike,
    pose: Pose | Callable[[Design], Pose],
    indices: Iterable[str] | str = ("quality_index",),
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
) -> pd.DataFrame:
    """Return indices at one pose of each design of a family, one row per design.

    Parameters
    ----------
    make : function of a number
        Returns the design, such as `lambda rho: lee.separated_to_centre(1.0, 2.0, rho)`.
    name : str
        Name of the parameter, and of the first column.
    values : (n,) array_like [unit of the parameter]
    pose : Pose of batch shape (), or function of a design
        Where each design is evaluated.
    indices : str or iterable of str
        Names or symbols of indices; see `sweep`.
    length : float or None [unit of the designs]
        Characteristic length; see `sweep`.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; see `sweep`.

    Returns
    -------
    pandas.DataFrame
        One row per design: the parameter, then the indices. `attrs["pose"]` is the pose, where
        all designs have the same; see `sweep`.

    Raises
    ------
    InvalidInput
        If `make` is not a function, returns no design, `pose` is not a single pose, or `name` is
        that of an index.
    UnknownIndex, MissingParameter
    """
    import pandas as pd

    names, name = index_names(indices), check_text("name", name)
    steps, rows = _checked(make, name, values, names), []
    for step in steps:
        design = _made(make, step)
        at = pose(design) if callable(pose) else pose
        check_single(at)
        stay = Path({name: np.array([step])}, at.reshape(1), "", {}, None if callable(pose) else at)
        rows.append(sweep(design, stay, names, length=length, ellipsoid=ellipsoid))
    frame = pd.concat([row[[name, *names]] for row in rows], ignore_index=True)
    if not callable(pose):
        frame.attrs["pose"] = rows[0].attrs["pose"]
    frame.attrs.update(coordinates=[name], shape=[len(steps)], motion=f"design parameter {name}")
    return frame


def maxima(
    make: Callable[[float], Design],
    name: str,
    values: ArrayLike,
    *,
    progress: Progress = None,
) -> pd.DataFrame:
    """Return the maximum of |det J| of each design of a family, one row per design.

    Parameters
    ----------
    make : function of a number
        Returns the design.
    name : str
        Name of the parameter, and of the first column.
    values : (n,) array_like [unit of the parameter]
    progress : function (done, total), bool or None
        Called after each design. By default a bar is drawn where standard error is a terminal,
        unless the search is short; False draws none.

    Returns
    -------
    pandas.DataFrame
        One row per design: the parameter, value, x, y, z of the pose [unit], turn_deg (the whole
        angle of its rotation [degrees]), method, agreed of starts, proven.

    Raises
    ------
    InvalidInput
        If `make` is not a function, returns no design, `values` is not a list of numbers, or `name`
        is that of another column.
    """
    import pandas as pd

    name = check_text("name", name)
    steps, rows = _checked(make, name, values, COLUMNS), []
    with meter(progress, "designs") as report:
        for done, step in enumerate(steps, 1):
            found = determinant.maximum(_made(make, step), progress=False)
            rows.append({name: float(step), **_row(found)})
            report(done, len(steps))
    return pd.DataFrame(rows)


def _row(found: Maximum) -> dict[str, Any]:
    place, angle = np.full(3, np.nan), np.array(np.nan)
    if found.pose is not None:
        place, angle = found.pose.position, angle_of(found.pose.rotation)
    return {
        "value": found.value,
        **dict(zip("xyz", map(float, place), strict=True)),
        "turn_deg": float(np.rad2deg(angle)),
        **{key: getattr(found, key) for key in FACTS},
    }


def _checked(make: Any, name: str, values: ArrayLike, columns: Iterable[str]) -> Array:
    """Return the values of the parameter, if these are the arguments of a family."""
    if name in columns:
        raise InvalidInput(expected("name", "one that no other column has", brief(name)))
    if not callable(make):
        raise InvalidInput(expected("make", "a function that returns a design", brief(make)))
    return check_steps(name, values)


def _made(make: Callable[[float], Design], step: float) -> Design:
    design = make(float(step))
    check_type("what make returns", design, Design)
    return design
