"""The two backends that evaluate a block of poses: compiled, and numpy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from gsp.checks import is_a, plain_text
from gsp.errors import InvalidInput, brief, expected
from gsp.evaluation.settings import Settings
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask, norm
from gsp.indices import INDICES
from gsp.kernels.problems import (
    CONTROL_PROBLEM,
    CONTROL_RECIPROCAL,
    ELLIPSOID_PROBLEM,
    ELLIPSOID_RECIPROCAL,
    HOMOGENEOUS_PROBLEM,
    LEAST,
    RECIPROCAL,
    RESULTS,
    VOLUME,
)
from gsp.model.design import Design
from gsp.model.legs import LEGS
from gsp.model.posture import Posture

# Poses that numpy works on at once: the matrices of so many fit in the cache.
POSES_PER_CHUNK = 2048
# Lengths, in sizes of the design, with which |det J| is read from the homogeneous Jacobian.
LENGTH_SIZES = (1e-3, 1e3)
# Distance of the platform origin from its anchors, in the same sizes, up to which that is done.
FARTHEST_ORIGIN_SIZES = 30.0


Check = Callable[[Design, Pose], Any]


class Block(NamedTuple):
    """Some poses of a design, and the requested results.

    Attributes
    ----------
    design, settings, pose, backend :
    names : tuple of str
        Indices.
    singular : bool
        Whether singular poses are marked.
    checks : tuple of functions (design, pose) -> (n,) or (k, n) bool array
        Other conditions that are evaluated at each pose, such as whether it is within the strokes.
    """

    design: Design
    settings: Settings
    names: tuple[str, ...]
    singular: bool
    pose: Pose
    backend: str
    checks: tuple[Check, ...] = ()


class Values(NamedTuple):
    """Values of the n poses of a block.

    Attributes
    ----------
    columns : (n_names, n) array
        Values of the indices.
    singular : (n,) bool array
        Empty if it was not requested.
    checked : (k, n) bool array or None
        The conditions of all checks, one after the other.
    """

    columns: Array
    singular: Mask
    checked: Mask | None = None


@dataclass(frozen=True)
class Compiled:
    """How an index is read from the results of the compiled evaluation.

    Attributes
    ----------
    problem : int
        The problem that is solved for it.
    read : results (5, n), design, settings -> (n,) array
    covers : design, settings -> bool
        Whether it can be read from these results; otherwise numpy computes it.
    """

    problem: int
    read: Callable[[Array, Design, Settings], Array]
    covers: Callable[[Design, Settings], bool]


def _always(design: Design, settings: Settings) -> bool:
    return True


def _inverse(row: int) -> Callable[[Array, Design, Settings], Array]:
    def read(results: Array, design: Design, settings: Settings) -> Array:
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / results[row])

    return read


def _row(row: int) -> Callable[[Array, Design, Settings], Array]:
    return lambda results, design, settings: results[row]


def _with_unit(results: Array, design: Design, settings: Settings) -> Array:
    """|det J| from that of the homogeneous Jacobian, whose rows and columns L has scaled."""
    return np.asarray(results[VOLUME] * length_of(design, settings) ** design.determinant_power)


def _quality(results: Array, design: Design, settings: Settings) -> Array:
    maximum = settings.for_index(INDICES["quality_index"])["maximum"]
    if maximum is None:
        return np.full_like(results[VOLUME], np.nan)
    return np.asarray(_with_unit(results, design, settings) / maximum)


def _scales(design: Design, settings: Settings) -> bool:
    """Whether |det J| can be read from the homogeneous Jacobian.

    Scaled rows do not scale a determinant without a unit. And a length far from the
    size of the design, or a platform origin far from the anchors, makes regular postures singular
    in double precision.
    """
    size = design.rms_radius
    near = LENGTH_SIZES[0] <= length_of(design, settings) / size <= LENGTH_SIZES[1]
    near &= bool(norm(design.platform_points.mean(axis=0)) <= FARTHEST_ORIGIN_SIZES * size)
    return near and design.determinant_has_unit


COMPILED = MappingProxyType(
    {
        "condition_number": Compiled(HOMOGENEOUS_PROBLEM, _inverse(RECIPROCAL), _always),
        "minimum_singular_value": Compiled(HOMOGENEOUS_PROBLEM, _row(LEAST), _always),
        "manipulability": Compiled(HOMOGENEOUS_PROBLEM, _with_unit, _scales),
        "quality_index": Compiled(HOMOGENEOUS_PROBLEM, _quality, _scales),
        "condition_number_ellipsoid": Compiled(
            ELLIPSOID_PROBLEM, _inverse(ELLIPSOID_RECIPROCAL), _always
        ),
        "control_number": Compiled(CONTROL_PROBLEM, _row(CONTROL_RECIPROCAL), _always),
    }
)


def with_numpy(block: Block) -> Values:
    """Evaluate a block by the functions of the indices, POSES_PER_CHUNK poses at a time."""
    columns = np.empty((len(block.names), block.pose.size))
    singular = np.empty(block.pose.size if block.singular else 0, dtype=bool)
    for start in range(0, block.pose.size, POSES_PER_CHUNK):
        part = slice(start, start + POSES_PER_CHUNK)
        posture = block.design.at(block.pose[part])
        columns[:, part] = _by_functions(posture, block.names, block.settings)
        if block.singular:
            singular[part] = posture.singular(block.settings.length)
    return Values(columns, singular)


def _by_functions(posture: Posture, names: Sequence[str], settings: Settings) -> Array:
    values = [INDICES[n].function(posture, **settings.for_index(INDICES[n])) for n in names]
    return np.array(values).reshape(len(names), posture.pose.size)


def with_compiled(block: Block) -> Values:
    """Evaluate a block in compiled code; what it does not cover is left to numpy.

    It covers no design with a leg that is driven at the base.
    """
    design, settings = block.design, block.settings
    if design.driven:
        return with_numpy(block)
    read = {
        name: COMPILED[name]
        for name in block.names
        if name in COMPILED and COMPILED[name].covers(design, settings)
    }
    rest = tuple(name for name in block.names if name not in read)
    problems = HOMOGENEOUS_PROBLEM if block.singular else 0
    for index in read.values():
        problems |= index.problem
    results = compiled_results(design, settings, block.pose, problems)
    left = with_numpy(block._replace(names=rest, singular=False)).columns if rest else np.empty(0)
    columns = np.empty((len(block.names), block.pose.size))
    for column, name in zip(columns, block.names, strict=True):
        column[:] = (
            read[name].read(results, design, settings) if name in read else left[rest.index(name)]
        )
    singular = results[RECIPROCAL] == 0.0 if block.singular else np.empty(0, dtype=bool)
    return Values(columns, singular)


def compiled_results(design: Design, settings: Settings, pose: Pose, problems: int) -> Array:
    """Rows of `gsp.kernels.compiled.evaluation.evaluate_block`, shape (5, n)."""
    results = np.empty((RESULTS, pose.size))
    if problems:
        from gsp.kernels.compiled.evaluation import evaluate_block

        kinds, geometry = flat_design(design)
        evaluate_block(
            np.ascontiguousarray(pose.position).reshape(-1, 3),
            np.ascontiguousarray(pose.rotation).reshape(-1, 9),
            kinds,
            geometry,
            flat_ellipsoid(settings.ellipsoid),
            length_of(design, settings),
            problems,
            results,
            np.empty((0, 0)),
        )
    return results


@lru_cache(maxsize=256)
def flat_design(design: Design) -> tuple[np.ndarray, Array]:
    """Kinds of the legs, and a, b, s, t, |a| + |b| of each, for compiled code."""
    a, b = design.base_points, design.platform_points
    reach = (norm(a) + norm(b))[:, None]
    geometry = np.hstack((a, b, design.base_directions, design.platform_directions, reach)).ravel()
    geometry[np.isnan(geometry)] = 0.0  # directions of legs that have no line
    return np.array([LEGS.index(leg) for leg in design.legs], dtype=np.int64), geometry


def flat_ellipsoid(ellipsoid: Ellipsoid | None) -> Array:
    """Return `Ellipsoid.scalars`, or zeros, which are not read, where there is none."""
    if ellipsoid is None:
        return np.zeros(12)
    return ellipsoid.scalars


def length_of(design: Design, settings: Settings) -> float:
    """Return the length that the compiled evaluation homogenises with."""
    return design.rms_radius if settings.length is None else settings.length


BACKENDS = MappingProxyType({"compiled": with_compiled, "numpy": with_numpy})


def check_backend(name: str) -> str:
    """Return the name of a backend, or raise InvalidInput."""
    name = plain_text(name)
    if not is_a(name, str) or name not in BACKENDS:
        raise InvalidInput(expected("backend", " or ".join(map(repr, BACKENDS)), brief(name)))
    return name


def run_block(block: Block) -> Values:
    """Evaluate a block by the backend that it names; works in any process."""
    values = BACKENDS[block.backend](block)
    if not block.checks:
        return values
    return values._replace(checked=np.vstack([c(block.design, block.pose) for c in block.checks]))
