"""Gradients of indices with respect to the dimensions of a design."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp import determinant
from gsp.arguments import optional, positive, text, validated
from gsp.checks import check_type
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array, frozen
from gsp.indices.record import Index
from gsp.indices.requirements import require_posture
from gsp.indices.table import INDICES, index_name
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Directions, Slopes

# Poses whose derivatives along all directions of six legs take some tens of MB.
POSES_PER_GRADIENT = 512


@dataclass(frozen=True, eq=False, kw_only=True)
class Gradient(ReadOnly):
    """Derivatives of an index by the dimensions of a design, at a fixed pose.

    Attributes
    ----------
    base_points, platform_points : (..., n_legs, 3) arrays [unit of the index / unit of the design]
        By a_i in base axes and b_i in platform axes.
    base_directions, platform_directions : (..., n_legs, 3) arrays [unit of the index]
        By s_i and t_i, which stay unit vectors: the parts across them. 0 where a leg has no line.

    NaN where the index has no derivative.
    """

    base_points: Array
    platform_points: Array
    base_directions: Array
    platform_directions: Array


@validated(index=text, length=optional(positive), maximum=optional(positive))
def gradient(
    posture: Posture,
    index: str,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | None = None,
) -> Gradient:
    """Return the gradient of an index with respect to anchor points and lines.

    Poses, length, ellipsoid and a given maximum are fixed. It is computed in closed form: from
    dual numbers in the formulas of the legs, and the derivatives of singular values and
    determinants.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    index : str
        Name or symbol: all but SD.
    length : float or None [unit of the design]
    ellipsoid : Ellipsoid or None
        As the index needs them.
    maximum : float or None [unit of |det J|]
        Of λ. None takes `gsp.determinant.maximum`, which changes with the dimensions as well; of
        symmetric designs, whose maximum several poses have, along with the pose that was found.

    Returns
    -------
    Gradient
        NaN where the index is not differentiable: singular and undefined postures; where two
        extreme singular values are equal and would separate; CDN_3P where several triangles of
        platform anchors are the largest.

    Raises
    ------
    UnknownIndex, MissingParameter
        On another name, or a parameter that the index needs.
    InvalidInput
        On SD, arguments of a wrong type, and λ without a maximum where |det J| has no bound over
        all poses.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> gsp.indices.gradient(d.at(d.home), "CTN", length=95.0).base_points.shape
    (6, 3)

    *Source: ours; d|det J| = |det J| tr(J⁻¹ dJ), dσ = uᵀ dJ v*
    """
    require_posture(posture)
    if ellipsoid is not None:
        check_type("ellipsoid", ellipsoid, Ellipsoid)
    given = {"length": length, "ellipsoid": ellipsoid, "maximum": maximum}
    directions = Directions.of_anchors(posture.design.n_legs)
    found = index_slopes(index_name(index), posture, directions, given)
    parts = found.reshape(*posture.shape, posture.design.n_legs, 4, 3)
    names = ("base_points", "platform_points", "base_directions", "platform_directions")
    return Gradient(**{name: frozen(parts[..., i, :]) for i, name in enumerate(names)})


def index_slopes(
    name: str, posture: Posture, directions: Directions, given: dict[str, Any]
) -> Array:
    """Return the derivatives (..., k) of an index along k directions.

    Parameters
    ----------
    name : str
        Of an index.
    posture : Posture, batch shape (...)
    directions : Directions
    given : dict
        length, ellipsoid and maximum; None for those that are not given.

    Raises
    ------
    As `gradient`.
    """
    index = INDICES[name]
    there = [key for key, value in given.items() if value is not None]
    needed = [need for need in index.missing(posture.design, there) if need != "maximum"]
    if needed:
        raise MissingParameter(index.missing_message(needed[0], posture.design))
    if index.share_of:
        return _share_slopes(index, posture, directions, given["maximum"])
    if index.slope is None:
        known = ", ".join(i.symbol for i in INDICES.values() if i.slope or i.share_of)
        raise InvalidInput(expected("index", f"one with a gradient: {known}", index.symbol))
    options = {key: given[key] for key in index.parameters if given[key] is not None}
    flat, size = posture.pose.reshape(posture.pose.size), POSES_PER_GRADIENT
    parts = [
        index.slope(Slopes(posture.design.at(flat[i : i + size]), directions), **options)
        for i in range(0, flat.size, size)
    ]
    none = np.empty((0, len(directions)))
    return np.concatenate([none, *parts]).reshape(*posture.shape, len(directions))


def _share_slopes(
    index: Index, posture: Posture, directions: Directions, maximum: float | None
) -> Array:
    """Return the derivatives of |det J| / |det J|max.

    That of a maximum over all poses is the derivative at its pose.
    """
    none = dict.fromkeys(("length", "ellipsoid", "maximum"))
    rises = index_slopes(index.share_of, posture, directions, none)
    if maximum is not None:
        return rises / maximum
    design = posture.design
    found = determinant.reference(design)
    if found.domain is not None:
        wanted = "a number, as |det J| is bounded by the domain of its maximum alone"
        raise InvalidInput(expected("maximum", wanted, "none"))
    if found.pose is None or not found.attained:
        return np.full(rises.shape, np.nan)
    top = index_slopes(index.share_of, design.at(found.pose), directions, none)
    share = INDICES[index.share_of].function(posture)[..., None] / found.value
    return (rises - share * top) / found.value
