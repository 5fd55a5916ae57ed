"""`Deviations`: how much the dimensions of manufactured copies deviate from a design."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.arguments import bounded_array
from gsp.checks import check_memory
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose.intervals import sample_points
from gsp.geometry.vectors import EPS, Array, frozen
from gsp.model.design import Design, check_undriven
from gsp.model.dimensions import ANCHORS, Dimensions

if TYPE_CHECKING:
    import pandas as pd

POINTS = ANCHORS[:2]


@dataclass(frozen=True, eq=False, kw_only=True)
class Deviations(ReadOnly):
    """Sizes of independent errors of the dimensions of a manufactured copy.

    Errors that are normal have the sizes as standard deviations; uniform ones lie between minus and
    plus the size.

    Parameters
    ----------
    base_points, platform_points : float, (n_legs,) or (n_legs, 3) array_like [unit]
        Of each coordinate of an anchor point.
    base_directions, platform_directions : float or (n_legs,) array_like [rad]
        Of each of the two turns of a line across its direction.
    joints : float or (n,) array_like [unit, rad]
        Of the zero points of the joints, or of the lengths of the legs.
    distribution : "normal" or "uniform"

    Raises
    ------
    InvalidInput
        On numbers that are negative or not finite, arrays of other shapes, or another distribution.

    Examples
    --------
    >>> Deviations(base_points=0.1, joints=[0.02] * 6).joints.shape
    (6,)
    """

    base_points: ArrayLike = 0.0
    platform_points: ArrayLike = 0.0
    base_directions: ArrayLike = 0.0
    platform_directions: ArrayLike = 0.0
    joints: ArrayLike = 0.0
    distribution: Literal["normal", "uniform"] = "normal"

    def __post_init__(self) -> None:
        arguments.one_of("normal", "uniform")("deviations.distribution", self.distribution)
        for field in fields(self)[:-1]:
            what = f"deviations.{field.name}"
            axes = 2 if field.name in POINTS else 1
            value = bounded_array(what, getattr(self, field.name), (), axes=axes)
            if (value < 0.0).any():
                wanted = "one number ≥ 0, or one for each"
                raise InvalidInput(expected(what, wanted, brief(value.tolist())))
            object.__setattr__(self, field.name, frozen(value) if value.ndim else float(value))

    @arguments.validated(
        design=check_undriven,
        n=arguments.integer(1),
        seed=arguments.integer(0),
    )
    def sample(self, design: Design, n: int, *, seed: int) -> pd.DataFrame:
        """Return a scrambled Sobol sequence of errors: one row per copy of a design.

        Parameters
        ----------
        design : Design
        n : int
            Number of copies, ≥ 1; a power of two is best.
        seed : int

        Returns
        -------
        pandas.DataFrame, shape (n, p) [unit, rad]
            A column per coordinate, such as "base_x1", "platform_line2a", "zero_d1".

        Raises
        ------
        InvalidInput
            On other types, or sizes that do not fit the design.
        """
        import pandas as pd

        dimensions = Dimensions.of(design)
        values = error_values(self, dimensions, n, seed)
        return pd.DataFrame(values, columns=list(dimensions.names))


def sizes_of(deviations: Deviations, dimensions: Dimensions) -> Array:
    """Return the sizes of the errors of coordinates, shape (p,) [unit, rad].

    Raises
    ------
    InvalidInput
        If there is neither one for all nor one for each.
    """
    design = dimensions.design
    n = design.n_legs
    shapes = {part: (n, 3) if part in POINTS else (n, 2) for part in ANCHORS}
    given = {part: _each(deviations, part, shape) for part, shape in shapes.items()}
    given["joints"] = _each(deviations, "joints", (len(design.joint_names), 1))
    places = {part: iter(values.ravel()) for part, values in given.items()}
    # Coordinates of a part have the order of its legs; legs without a line have none.
    found = []
    for leg, kind in enumerate(design.legs):
        lines = (True, True, kind.base_line, kind.platform_line)
        for part, there in zip(ANCHORS, lines, strict=True):
            sizes = [next(places[part]) for _ in range(shapes[part][1])]
            found += [((part, leg), size) for size in sizes if there]
    found += [(("joints", row.leg), next(places["joints"])) for row in design.rows]
    wanted = {(one.part, one.leg) for one in dimensions.coordinates}
    return np.array([size for key, size in found if key in wanted])


def standard_deviations(deviations: Deviations, dimensions: Dimensions) -> Array:
    """Return the standard deviations of coordinates, shape (p,) [unit, rad].

    Raises
    ------
    InvalidInput
        If there is neither one for all nor one for each.
    """
    normal = deviations.distribution == "normal"
    return sizes_of(deviations, dimensions) * (1.0 if normal else 3.0**-0.5)


def error_values(deviations: Deviations, dimensions: Dimensions, n: int, seed: int) -> Array:
    """Return the errors (n, p) [unit, rad] of copies: a scrambled Sobol sequence.

    Raises
    ------
    InvalidInput
        If there is neither one for all nor one for each, or if they do not fit into the memory.
    """
    from scipy.special import ndtri

    sizes = sizes_of(deviations, dimensions)
    there = np.flatnonzero(sizes)
    check_memory("samples", n, 4 * sizes.nbytes, "copies")
    values = np.zeros((n, len(sizes)))
    if there.size:
        points = sample_points(np.zeros(there.size), np.ones(there.size), n, seed, "sobol")
        inside = np.clip(points, EPS, 1.0 - EPS)
        shapes = ndtri(inside) if deviations.distribution == "normal" else 2.0 * points - 1.0
        values[:, there] = shapes * sizes[there]
    return values


def _each(deviations: Deviations, name: str, shape: tuple[int, int]) -> Array:
    value = np.asarray(getattr(deviations, name), dtype=np.float64)
    own = name in POINTS
    if value.shape not in ((), shape[:1], *((shape,) if own else ())):
        wanted = f"one number or {shape[0]}" + (f", or shape {shape}" if own else "")
        raise InvalidInput(expected(f"deviations.{name}", wanted, f"shape {value.shape}"))
    return np.broadcast_to(value[:, None] if value.ndim == 1 else value, shape)
