"""Tables of indices along a path."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from gsp import arguments, determinant
from gsp.checks import check_integer, check_positive, check_type, is_a
from gsp.errors import InvalidInput, apart, expected
from gsp.evaluation.evaluations import evaluate
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.indices import INDICES, index_names, manipulability
from gsp.model.design import Design
from gsp.sweeps.paths import Path

if TYPE_CHECKING:
    import pandas as pd

# Largest relative difference of |det J| at the pose of a maximum from its value.
SAME_VALUE = 1e-6


def sweep(
    design: Design,
    path: Path,
    indices: Iterable[str] | str = ("quality_index",),
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | determinant.Maximum | None = None,
) -> pd.DataFrame:
    """Return indices of a design along a path, one row per pose.

    Parameters
    ----------
    design : Design
    path : Path
        As `translation`, `plane` or `turn` make it.
    indices : str or iterable of str
        Names or symbols of indices; see `gsp.evaluate`.
    length : float or None [unit of the design]
        Characteristic length; see `gsp.evaluate`.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; see `gsp.evaluate`.
    maximum : float, Maximum or None [unit of |det J|]
        |det J|max for λ; None searches it with `gsp.determinant.maximum`. A Maximum has to be
        that of the design; λ refers to its domain.

    Returns
    -------
    pandas.DataFrame
        One row per pose: the coordinates of the path, then the indices. `attrs` holds what
        `gsp.evaluate` states, the motion, the shape of the path, in "pose" the position and the
        angles (roll, pitch, yaw in degrees) of the pose that is moved, and in "maximum" the facts
        of the maximum, if one was found.

    Raises
    ------
    InvalidInput, UnknownIndex, MissingParameter
        As `gsp.evaluate` does, and if `path` is not a path.

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> path = gsp.sweeps.translation(gsp.Pose([0.0, 0.0, 1.0]), "z", [0.0, 0.5, 1.0])
    >>> gsp.sweeps.sweep(octahedron, path).round(3)
       distance  quality_index
    0       0.0          1.000
    1       0.5          0.787
    2       1.0          0.512

    *Source: Lee2000, chapters 4 and 8, draws λ along such paths.*
    """
    import pandas as pd

    check_type("design", design, Design)
    check_type("path", path, Path, "a path of gsp.sweeps")
    names = index_names(indices)
    if maximum is not None and not is_a(maximum, determinant.Maximum):
        maximum = check_positive("maximum", maximum)
    known = maximum if isinstance(maximum, determinant.Maximum) else None
    if known is not None:
        _check_maximum(design, known)
    number = maximum.value if isinstance(maximum, determinant.Maximum) else maximum
    # A design that is singular in every pose has the maximum 0, and no λ.
    asked = [name for name in names if not INDICES[name].share_of or number != 0.0]
    values = pd.DataFrame(index=range(path.pose.size))
    if asked:
        values = evaluate(
            design,
            path.pose.reshape(path.pose.size),
            asked,
            length=length,
            ellipsoid=ellipsoid,
            maximum=number or None,
        )
    frame = pd.DataFrame({name: c.ravel() for name, c in path.coordinates.items()})
    frame = frame.assign(**{n: values[n] if n in values else np.nan for n in names})
    frame.attrs.update(
        {
            **values.attrs,
            "design": design.name,
            "unit": design.unit,
            "motion": path.motion,
            "shape": list(path.pose.shape),
            "coordinates": list(path.coordinates),
            "labels": dict(path.labels),
        }
    )
    if path.start is not None:
        frame.attrs["pose"] = _numbers(path.start)
    searched = frame.attrs.pop("maxima", {}).get(design.name)
    if known is not None or searched is not None:
        frame.attrs["maximum"] = searched if known is None else known.facts()
    return frame


def _numbers(pose: Pose) -> dict[str, list[float]]:
    """Return a pose as lists of numbers, as files of attributes hold them."""
    angles = pose.angles(degrees=True)
    return {"position": pose.position.tolist(), "roll_pitch_yaw_deg": angles.tolist()}


def _check_maximum(design: Design, found: determinant.Maximum) -> None:
    """Raise InvalidInput if a design does not have |det J| as stated at the pose of a maximum."""
    if found.pose is None or not found.attained:
        return
    value = float(manipulability(design.at(found.pose)))
    if not abs(value - found.value) <= SAME_VALUE * found.value:
        there, given = apart(value, found.value)
        wanted = f"that of this design, which has {there} at its pose"
        raise InvalidInput(expected("maximum", wanted, given))


def check_sweep(frame: pd.DataFrame, number: int) -> list[str]:
    """Return the names of the coordinates of a sweep.

    Parameters
    ----------
    frame : pandas.DataFrame
        As `sweep` returns it.
    number : int
        How many coordinates there should be.

    Raises
    ------
    InvalidInput
        If `frame` is not a table of a sweep over so many coordinates.
    """
    arguments.frame("sweep", frame, "a table of gsp.sweep")
    number = check_integer("number", number)
    names = arguments.attribute(frame, "coordinates", arguments.names, ())
    if len(names) != number or any(name not in frame for name in names):
        wanted = f"a table of gsp.sweep over {number} coordinate" + "s" * bool(number > 1)
        raise InvalidInput(expected("sweep", wanted, f"coordinates {list(names)}"))
    return list(names)


def index_columns(frame: pd.DataFrame) -> list[str]:
    """Return the names of the columns of a sweep that are indices.

    Parameters
    ----------
    frame : pandas.DataFrame

    Raises
    ------
    InvalidInput
        If `frame` is not a table.
    """
    arguments.frame("sweep", frame, "a table of gsp.sweep")
    return [name for name in frame.columns if name in INDICES]
