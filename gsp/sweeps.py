"""Sweeps: indices along translations and turns, over planes, and over design parameters.

A `Path` is a batch of poses with the coordinates that number them. A path starts from one pose and
does not depend on a design; `sweep` evaluates indices along it.

Turns are about a line in base axes: through the platform's own centre (its origin, which then
stays where it is), through the base origin, or through any point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import determinant
from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, expected
from gsp.evaluation.evaluate import evaluate
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.screws import exp3
from gsp.geometry.vectors import Array, norm, unit
from gsp.indices import INDICES
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd

OWN_CENTRE, BASE_ORIGIN = "own centre", "base origin"
AXES = MappingProxyType({"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)})


@dataclass(frozen=True, eq=False)
class Path:
    """Poses along a line, or over a plane, of motions.

    Attributes
    ----------
    coordinates : mapping from name to (...) array
        What numbers the poses, such as "turn_deg" or "u" and "v".
    pose : Pose, batch shape (...)
    motion : str
        What moves, in words.
    labels : mapping from name to str
        What each coordinate measures, for the axes of figures; the unit is not part of it.
    """

    coordinates: Mapping[str, Array]
    pose: Pose
    motion: str
    labels: Mapping[str, str] = field(default_factory=dict)


def translation(start: Pose, direction: ArrayLike, distances: ArrayLike) -> Path:
    """Return the poses at distances from a pose along a direction of the base.

    Parameters
    ----------
    start : Pose
    direction : "x", "y", "z" or (3,) array_like
        In base axes; normalised.
    distances : (n,) array_like [unit of the design]

    Returns
    -------
    Path
        With the coordinate "distance".
    """
    way, steps = _direction("direction", direction), _steps("distances", distances)
    _single(start)
    pose = Pose(start.position + steps[:, None] * way, start.rotation)
    name = _name(direction)
    labels = {"distance": f"displacement along {name}"}
    return Path({"distance": steps}, pose, f"translation along {name}", labels)


def plane(
    start: Pose,
    u: ArrayLike,
    v: ArrayLike,
    directions: tuple[ArrayLike, ArrayLike] = ("x", "y"),
) -> Path:
    """Return the poses at distances u × v from a pose along two directions of the base.

    Parameters
    ----------
    start : Pose
    u, v : (n,) and (m,) array_like [unit of the design]
    directions : two of "x", "y", "z" or (3,) array_like
        In base axes; normalised.

    Returns
    -------
    Path
        Batch shape (n, m), with the coordinates "u" and "v".
    """
    ways = [_direction(f"directions[{i}]", way) for i, way in enumerate(directions)]
    _single(start)
    first, second = np.meshgrid(_steps("u", u), _steps("v", v), indexing="ij")
    moved = first[..., None] * ways[0] + second[..., None] * ways[1]
    names = [_name(direction) for direction in directions]
    motion = f"translation over the plane of {names[0]} and {names[1]}"
    labels = {key: f"displacement along {n}" for key, n in zip("uv", names, strict=True)}
    pose = Pose(start.position + moved, start.rotation)
    return Path({"u": first, "v": second}, pose, motion, labels)


def turn(
    start: Pose, axis: ArrayLike, angles_deg: ArrayLike, through: ArrayLike = OWN_CENTRE
) -> Path:
    """Return the poses that turns about a line make of a pose.

    Parameters
    ----------
    start : Pose
    axis : "x", "y", "z" or (3,) array_like
        Direction of the line in base axes; normalised.
    angles_deg : (n,) array_like [degrees]
    through : "own centre", "base origin" or (3,) array_like [unit of the design]
        A point of the line: the platform's origin (figures 6, 8 and 9 of `Lee2000`), the base
        origin (its figures 25–27 and 35–37), or any point in base axes.

    Returns
    -------
    Path
        With the coordinate "turn_deg".

    Examples
    --------
    >>> quarter = turn(Pose([1.0, 0.0, 2.0]), "z", [90.0], through="base origin")
    >>> quarter.pose.position.round(9) + 0.0
    array([[0., 1., 2.]])
    """
    line, steps = _direction("axis", axis), _steps("angles_deg", angles_deg)
    _single(start)
    if isinstance(through, str):
        points = {OWN_CENTRE: start.position, BASE_ORIGIN: np.zeros(3)}
        if through not in points:
            wanted = ", ".join(map(repr, points)) + " or a point"
            raise InvalidInput(expected("through", wanted, repr(through)))
        point, place = points[through], f"the {through}"
    else:
        point = check_array("through", through, (3,))
        place = f"the point {point.tolist()}"
    turned = exp3(np.deg2rad(steps)[:, None] * line)
    position = point + turned @ (start.position - point)
    motion = f"turn about {_name(axis)} through {place}"
    labels = {"turn_deg": f"rotation about {_name(axis)}"}
    return Path({"turn_deg": steps}, Pose(position, turned @ start.rotation), motion, labels)


def sweep(
    design: Design,
    path: Path,
    indices: Iterable[str] | str = ("quality_index",),
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | determinant.Maximum | None = None,
) -> pd.DataFrame:
    """Evaluate indices of a design along a path.

    Parameters
    ----------
    design : Design
    path : Path
        As `translation`, `plane` or `turn` make it.
    indices : names in `gsp.indices.INDICES`
    length, ellipsoid : see `gsp.evaluate`
    maximum : float, Maximum or None
        |det J|max for λ; None finds it with `gsp.determinant.maximum`.

    Returns
    -------
    pandas.DataFrame
        One row per pose: the coordinates of the path, then the indices. `attrs` holds what
        `gsp.evaluate` states, the motion, the shape of the path, and in "maximum" the facts of
        the maximum, if one was found.

    Raises
    ------
    InvalidInput, UnknownIndex, MissingParameter

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> path = translation(gsp.Pose([0.0, 0.0, 1.0]), "z", [0.0, 0.5, 1.0])
    >>> sweep(octahedron, path).round(3)
       distance  quality_index
    0       0.0          1.000
    1       0.5          0.787
    2       1.0          0.512

    *Source: Lee2000, chapters 4 and 8, draws λ along such paths.*
    """
    import pandas as pd

    check_type("design", design, Design)
    check_type("path", path, Path, "a path of gsp.sweeps")
    names = (indices,) if isinstance(indices, str) else tuple(indices)
    if maximum is None and "quality_index" in names:
        maximum = determinant.maximum(design)
    known = maximum if isinstance(maximum, determinant.Maximum) else None
    number = maximum.value if isinstance(maximum, determinant.Maximum) else maximum
    # A design that is singular in every pose has the maximum 0, and no λ.
    asked = [name for name in names if name != "quality_index" or number]
    values = pd.DataFrame(index=range(path.pose.size))
    if asked:
        values = evaluate(
            design, path.pose.reshape(path.pose.size), asked,
            length=length, ellipsoid=ellipsoid, maximum=number or None,
        )  # fmt: skip
    frame = pd.DataFrame({name: c.ravel() for name, c in path.coordinates.items()})
    frame = frame.assign(**{n: values[n] if n in values else np.nan for n in names})
    frame.attrs.update(
        {**values.attrs, "design": design.name, "unit": design.unit, "motion": path.motion,
         "shape": list(path.pose.shape), "coordinates": list(path.coordinates),
         "labels": dict(path.labels)}
    )  # fmt: skip
    if known is not None:
        frame.attrs["maximum"] = known.facts()
    return frame


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
    """Evaluate indices at one pose of each design of a family.

    Parameters
    ----------
    make : function of a number
        Returns the design, such as `lambda rho: lee.separated_to_centre(1.0, 2.0, rho)`.
    name : str
        Of the parameter: the first column.
    values : (n,) array_like
    pose : Pose, or function of a design
        Where each design is evaluated.
    indices, length, ellipsoid : see `sweep`

    Returns
    -------
    pandas.DataFrame
        One row per design: the parameter, then the indices.
    """
    import pandas as pd

    steps = _steps(name, values)
    names = (indices,) if isinstance(indices, str) else tuple(indices)
    rows = []
    for step in steps:
        design = make(float(step))
        at = pose(design) if callable(pose) else pose
        _single(at)
        stay = Path({name: np.array([step])}, at.reshape(1), "")
        rows.append(sweep(design, stay, names, length=length, ellipsoid=ellipsoid))
    frame = pd.concat([row[[name, *names]] for row in rows], ignore_index=True)
    frame.attrs.update(coordinates=[name], shape=[len(steps)], motion=f"design parameter {name}")
    return frame


def maxima(
    make: Callable[[float], Design],
    name: str,
    values: ArrayLike,
    *,
    progress: Callable[[int, int], object] | None = None,
) -> pd.DataFrame:
    """Find the maximum of |det J| of each design of a family.

    Parameters
    ----------
    make, name, values : see `over_designs`
    progress : function (done, total) or None

    Returns
    -------
    pandas.DataFrame
        One row per design: the parameter, value, x, y, z of the pose [unit], turn_deg (the whole
        angle of its rotation [degrees]), method, agreed of starts, proven.
    """
    import pandas as pd

    steps, rows = _steps(name, values), []
    for done, step in enumerate(steps, 1):
        found = determinant.maximum(make(float(step)))
        place = np.full(3, np.nan) if found.pose is None else found.pose.position
        rows.append(
            {
                name: float(step),
                "value": found.value,
                **dict(zip("xyz", map(float, place), strict=True)),
                "turn_deg": float("nan") if found.pose is None else _angle_deg(found.pose),
                **{key: getattr(found, key) for key in ("method", "agreed", "starts", "proven")},
            }
        )
        if progress is not None:
            progress(done, len(steps))
    return pd.DataFrame(rows)


def check_sweep(frame: pd.DataFrame, number: int) -> list[str]:
    """Return the names of the coordinates of a sweep, or raise if there are not so many."""
    names = frame.attrs.get("coordinates", [])
    if len(names) != number or any(name not in frame for name in names):
        wanted = f"a table of gsp.sweep over {number} coordinate" + "s" * (number > 1)
        raise InvalidInput(expected("sweep", wanted, f"coordinates {names}"))
    return list(names)


def index_columns(frame: pd.DataFrame) -> list[str]:
    """Return the columns of a sweep that are indices."""
    return [name for name in frame.columns if name in INDICES]


def _angle_deg(pose: Pose) -> float:
    """Angle of a rotation: from the sine and the cosine, so that no digits are lost near 0."""
    r = pose.rotation
    sine = norm(np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])) / 2.0
    return float(np.rad2deg(np.arctan2(sine, (np.trace(r) - 1.0) / 2.0)))


def _direction(what: str, value: ArrayLike) -> Array:
    if isinstance(value, str):
        if value not in AXES:
            raise InvalidInput(expected(what, '"x", "y", "z" or three numbers', repr(value)))
        return np.array(AXES[value])
    vector = check_array(what, value, (3,))
    if vector.ndim != 1 or not norm(vector) > 0.0:
        raise InvalidInput(expected(what, "one direction that is not zero", vector.tolist()))
    return unit(vector)


def _name(direction: ArrayLike) -> str:
    if isinstance(direction, str):
        return direction
    return f"({', '.join(f'{x:g}' for x in np.asarray(direction, dtype=np.float64))})"


def _steps(what: str, values: ArrayLike) -> Array:
    steps = np.atleast_1d(check_array(what, values, ()))
    if steps.ndim != 1 or not steps.size:
        raise InvalidInput(expected(what, "a list of numbers", f"shape {steps.shape}"))
    return steps


def _single(start: Any) -> None:
    check_type("start", start, Pose)
    if start.shape:
        raise InvalidInput(expected("start", "a single pose", f"a batch of shape {start.shape}"))
