"""Designs of the set M of `Nawratil` with a control number of 1, and legs clear of an ellipsoid.

N and T are sums over turns about the z-axis. With a factor λ, α = 2/(λ l²) of leg length l, q = 1
+ α and the sine s and cosine c of the rise of each of the two kinds of lines, T = λ N says that

- α₁ + α₂ = 1 and q₁s₁² + q₂s₂² = 1;
- Σ q r c s = 0, with the distances r of the lines from the z-axis;
- Σ q c² h = 0 for the heights h of the feet, where the origin makes Σ α z = 0 for the heights z of
  the middles of the legs;
- two equations that are linear in 1/(2λ) and in the square of the size of (Z, H), if the ratio of Z
  = z₁ − z₂ and H = (h₁ − h₂)/2 is given.

So l₁/l₂, s₁ and the ratio H/Z are free, besides size and turn.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, expected
from gsp.families.nawratil.symmetric_sets import LEGS_OF_A_KIND, set_m
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array
from gsp.indices.requirements import require_posture
from gsp.model.design import SETTINGS, Design, check_keywords, check_undriven
from gsp.model.posture import Posture

# Of the ratio of the lengths: beyond, legs have next to no length, and digits of CTN are lost.
RATIO = arguments.within(1e-3, 1e3, "a ratio from 1e-3 to 1e3")
# Of the sines of the rises of both kinds of lines: all of the design is divided by them.
LEAST_RISE = 1e-3
PHASE = arguments.within(-np.pi / 2.0, np.pi / 2.0, "an angle in [-π/2, π/2]")


class _Kind(NamedTuple):
    """The two kinds of legs: arrays (2,); along the lines from the feet, unit directions."""

    cosine: Array
    sine: Array
    distance: Array
    foot: Array
    middle: Array
    length: Array


@arguments.validated(
    g=LEGS_OF_A_KIND,
    ratio=arguments.one(RATIO),
    rise=arguments.number,
    phase=arguments.one(PHASE),
    mu=arguments.number,
    radius=arguments.size,
)
def control_optimum(
    g: int = 3,
    ratio: float = 1.0,
    rise: float = float(np.arcsin(np.sqrt(1.0 / 3.0))),
    phase: float = np.pi / 4.0,
    mu: float = 0.0,
    *,
    radius: float = float(np.sqrt(1.0 / 3.0)),
    swap: Iterable[bool] | None = None,
    **settings: Any,
) -> Design:
    """Return a design of the set M with a control number of 1 at its home.

    Three parameters are free besides g, size and turn: ratio, rise and phase. The defaults give the
    isotropic design with p = sqrt(1/2); with ratio 1 and its rise, phases from 26.6° to 90° give
    those of all p.

    Parameters
    ----------
    g : int
        From 3 to 1000; the design has 2g legs.
    ratio : float [1]
        Length of the first g legs over that of the others, from 1e-3 to 1e3.
    rise : float [rad]
        Angle of the first legs with the xy-plane, from 1e-3 to where that of the others is about
        1e-3: the greatest sine is about sqrt(1/q) with q = 1 + 1/(1 + ratio²).
    phase : float [rad]
        In [-π/2, π/2]. Its tangent is half the difference of the heights of the feet of the lines
        over that of the middles of the legs. Some phases have no real design.
    mu : float [rad]
        Turn of the other legs against the first ones.
    radius : float [unit]
        Distance of the lines of the first legs from the z-axis.
    swap : 2g booleans or None
        See `set_n`.
    settings : other parameters of `Design`

    Returns
    -------
    Design
        With 2g UPS legs and its home at the origin.

    Raises
    ------
    InvalidInput
        On numbers outside of their range, or for which there is no real design.

    Examples
    --------
    >>> import gsp
    >>> design = control_optimum(g=3, ratio=1.5, rise=0.4, phase=1.0)
    >>> round(float(gsp.indices.control_number(design.at(design.home))), 9)
    1.0

    *Source: Nawratil, §4.1, of whose solution set in the set M the three parameters are stated;
    the solution is ours*
    """
    check_keywords("control_optimum", settings, SETTINGS)
    kinds = _solved(ratio, rise, phase)
    pairs = []
    for k, turn in enumerate((0.0, mu)):
        radial = np.array([np.cos(turn), np.sin(turn), 0.0])
        along = np.array([-np.sin(turn), np.cos(turn), 0.0]) * kinds.cosine[k]
        along[2] = kinds.sine[k]
        foot = kinds.distance[k] * radial + [0.0, 0.0, kinds.foot[k]]
        ends = kinds.middle[k] + kinds.length[k] * np.array([[-0.5], [0.5]])
        pairs.append(radius * (foot + ends * along))
    defaults: dict[str, Any] = {
        "name": f"nawratil-control-g{g}-{ratio:.4g}-{rise:.4g}-{phase:.4g}",
        "source": "Nawratil, §4.1; control_optimum",
    }
    return set_m(pairs[0], pairs[1], g, swap=swap, **{**defaults, **settings})


def _solved(ratio: float, rise: float, phase: float) -> _Kind:
    """Return the two kinds of legs with distance 1 of the first lines from the axis."""
    part = 1.0 / (1.0 + ratio**2)
    alpha = np.array([part, ratio**2 * part])
    q = 1.0 + alpha
    most = float(np.arcsin(np.sqrt((1.0 - q[1] * LEAST_RISE**2) / q[0])))
    if not LEAST_RISE <= rise <= most:
        raise InvalidInput(expected("rise", f"an angle in [{LEAST_RISE}, {most:.9g}] rad", rise))
    square = (1.0 - q[0] * np.sin(rise) ** 2) / q[1]
    sine = np.array([np.sin(rise), -np.sqrt(square)])
    cosine = np.array([np.cos(rise), np.sqrt(1.0 - square)])
    # Σ q r c s = 0.
    distance = np.array([1.0, -(q * cosine * sine)[0] / (q * cosine * sine)[1]])
    beta = q * cosine**2
    middles = np.cos(phase) * alpha[::-1] * [1.0, -1.0]
    feet = np.sin(phase) * beta[::-1] * [1.0, -1.0]
    along = (middles - feet) / sine
    # The two equations, linear in the square of the size of (Z, H) and in 1/(2λ).
    slides = (alpha * cosine**2 * along**2).sum()
    heights = 2.0 * (alpha * middles**2).sum() - (beta * feet**2).sum()
    squares = (sine**2).sum()
    left = np.array([[slides, 2.0 - squares], [slides + heights, 2.0 + squares]])
    right = np.array(
        [
            (distance**2 * (cosine**2 - alpha * sine**2)).sum(),
            (distance**2 * (sine**2 - alpha * cosine**2)).sum(),
        ]
    )
    determinant = left[0, 0] * left[1, 1] - left[0, 1] * left[1, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        size2 = (right[0] * left[1, 1] - left[0, 1] * right[1]) / determinant
        inverse = (left[0, 0] * right[1] - left[1, 0] * right[0]) / determinant
    if not (0.0 <= size2 < np.inf and 0.0 < inverse < np.inf):
        wanted = "a phase at which there is a real design, for ratio and rise"
        raise InvalidInput(expected("phase", wanted, phase))
    size = np.sqrt(size2)
    length = 2.0 * np.sqrt(inverse / alpha)
    return _Kind(cosine, sine, distance, size * feet, size * along, length)


def leg_levels(posture: Posture, ellipsoid: Ellipsoid) -> Array:
    """Return by which factor an ellipsoid grows about its centre until it touches each leg.

    Parameters
    ----------
    posture : Posture, batch shape (...)
        Of legs between two points.
    ellipsoid : Ellipsoid [unit]
        In platform axes, such as the operation ellipsoid.

    Returns
    -------
    (..., n) array [1]
        > 1 for legs that are clear of the ellipsoid, < 1 for those that penetrate it.

    Raises
    ------
    InvalidInput
        On arguments of other types, or legs of other kinds.

    Examples
    --------
    >>> import gsp
    >>> design = control_optimum()
    >>> level = leg_levels(design.at(design.home), gsp.Ellipsoid((1, 1, 0.5**0.5)))
    >>> bool((level < 1.0).all())
    True

    *Source: ours; Nawratil, §4.1, asks for legs that do not penetrate*
    """
    require_posture(posture)
    arguments.kind(Ellipsoid, "a gsp.Ellipsoid")("ellipsoid", ellipsoid)
    design, pose = posture.design, posture.pose
    check_undriven("posture", design)
    if not design.between_points:
        raise InvalidInput(expected("posture", "legs between two points", design.name))
    low = (design.base_points - pose.position[..., None, :]) @ pose.rotation
    start, end = (
        (points - ellipsoid.center) @ ellipsoid.rotation / ellipsoid.semi_axes
        for points in (low, np.broadcast_to(design.platform_points, low.shape))
    )
    leg = end - start
    share = -(start * leg).sum(axis=-1) / (leg * leg).sum(axis=-1)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * leg
    return np.asarray(np.sqrt((nearest * nearest).sum(axis=-1)))
