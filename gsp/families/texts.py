"""Designs of families by texts such as "lee-3-6(a=15, b=30, beta=0.2)"."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from gsp.errors import InvalidInput, UnknownDesign, brief, expected
from gsp.families.circular import hexapod
from gsp.families.lee import FAMILIES as LEE
from gsp.families.lee import (
    along_side,
    best_central_pose,
    best_height,
    best_pose_by_kinds,
    separated_by_kinds,
    to_centre,
)
from gsp.families.lee.platforms import EDGES, KINDS
from gsp.families.nawratil import (
    control_optimum,
    example_design,
    example_pose,
    isotropic,
)
from gsp.files.cells import number_of
from gsp.geometry.pose import Pose
from gsp.model.design import Design

_TEXT = re.compile(r"^\s*([A-Za-z][\w-]*)\s*\((.*)\)\s*$", re.DOTALL)
# Height over the side of the platform below which a best central pose has none: anchors are above
# each other, or each pose is singular.
NO_HEIGHT = 1e-9


class Family(NamedTuple):
    """A function of numbers that returns a design, and the names of its parameters."""

    make: Callable[..., Design]
    parameters: tuple[str, ...]


def best_placed(family: str, a: float, b: float, *shares: float) -> Design:
    """Return a platform of Lee's dissertation with its best central pose as home.

    Parameters
    ----------
    family : str
        A key of `gsp.families.lee.FAMILIES`.
    a, b : float [unit]
    *shares : float [1]
        The other parameters of the family.

    *Source: Lee2000, eqs. (16), (54), (63) for the height, (71), (76) for the separated ones*
    """
    design = LEE[family](a, b, *shares)
    closed = {"lee-centre": to_centre, "lee-side": along_side}.get(family)
    if closed is not None:
        return design.replace(home=_raised(best_central_pose(closed, a, b, *shares)[2], a))
    alpha, beta = (0.0, 0.0, *shares)[-2:]
    height = float(best_height(a, b, alpha, beta))
    return design.replace(home=_raised(Pose([0.0, 0.0, height]), a))


def best_placed_by_kinds(
    a: float, b: float, alpha: float, beta: float, *, top: str, base: str
) -> Design:
    """Return `gsp.families.lee.separated_by_kinds` with its best central pose as home."""
    design = separated_by_kinds(a, b, alpha, beta, top=top, base=base)
    pose = best_pose_by_kinds(a, b, alpha, beta, top=top, base=base)[2]
    return design.replace(home=_raised(pose, a))


def _raised(pose: Pose, a: float) -> Pose:
    """Return a pose, or one at the height a where it has no height."""
    return pose if pose.position[2] > NO_HEIGHT * a else Pose([0.0, 0.0, a], pose.rotation)


def _lee(name: str) -> Callable[..., Design]:
    return lambda a, b, **shares: best_placed(name, a, b, *shares.values())


def _by_kinds(top: str, base: str) -> Callable[..., Design]:
    return lambda **numbers: best_placed_by_kinds(**numbers, top=top, base=base)


def _hexapod(**numbers: Any) -> Design:
    return hexapod(**numbers, degrees=True)


def _example(alpha_deg: float, h: float) -> Design:
    return example_design(np.deg2rad(alpha_deg)).replace(home=example_pose(h))


def _isotropic(g: int, p: float, mu_deg: float) -> Design:
    return isotropic(g, p, np.deg2rad(mu_deg))


def _control(g: int, ratio: float, rise_deg: float, phase_deg: float, mu_deg: float) -> Design:
    return control_optimum(g, ratio, *np.deg2rad([rise_deg, phase_deg, mu_deg]).tolist())


# Lengths without a unit; angles in degrees; shares of sides.
FAMILIES: Mapping[str, Family] = MappingProxyType(
    {
        "lee-3-3": Family(_lee("lee-3-3"), ("a", "b")),
        "lee-3-6": Family(_lee("lee-3-6"), ("a", "b", "beta")),
        "lee-6-6": Family(_lee("lee-6-6"), ("a", "b", "alpha", "beta")),
        "lee-centre": Family(_lee("lee-centre"), ("a", "b", "rho")),
        "lee-side": Family(_lee("lee-side"), ("a", "b", "rho")),
        **{
            f"lee-{top}-{base}": Family(_by_kinds(top, base), ("a", "b", "alpha", "beta"))
            for top in KINDS
            for base in KINDS
            if (top, base) != (EDGES, EDGES)  # lee-6-6
        },
        "hexapod": Family(
            _hexapod,
            ("base_radius", "base_angle", "platform_radius", "platform_angle", "height"),
        ),
        "nawratil-example": Family(_example, ("alpha_deg", "h")),
        "nawratil-isotropic": Family(_isotropic, ("g", "p", "mu_deg")),
        "nawratil-control": Family(_control, ("g", "ratio", "rise_deg", "phase_deg", "mu_deg")),
    }
)


def is_family(text: str) -> bool:
    """Whether a text has the form of a family with parameters."""
    return _TEXT.match(text) is not None


def design_of_family(text: str) -> Design:
    """Return the design of a text: a family, and its parameters by name.

    Raises
    ------
    UnknownDesign
        If there is no such family.
    InvalidInput
        On other parameters, or values out of range.

    Examples
    --------
    >>> design = design_of_family("lee-3-3(a=15, b=30)")
    >>> design.name, design.home.position.round(9).tolist()
    ('lee-3-3 (a=15, b=30)', [0.0, 0.0, 15.0])
    """
    match = _TEXT.match(text)
    if match is None or match[1] not in FAMILIES:
        name = text if match is None else match[1]
        raise UnknownDesign("family", name, tuple(FAMILIES))
    family = FAMILIES[match[1]]
    pairs = [[word.strip() for word in part.partition("=")[::2]] for part in match[2].split(",")]
    names = [name for name, _ in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice in family.parameters:
        raise InvalidInput(expected(match[1], "each parameter once", f"{twice} twice", brief(text)))
    if sorted(names) != sorted(family.parameters):
        wanted = ", ".join(f"{name}=…" for name in family.parameters)
        raise InvalidInput(expected(match[1], f"{match[1]}({wanted})", brief(text)))
    given = {name: _number(f"{match[1]}, {name}", value) for name, value in pairs}
    return function_of_family(match[1])(**given)


@cache
def function_of_family(name: str) -> Callable[..., Design]:
    """Return the function of a family of `FAMILIES`, which takes its parameters by name."""
    family = FAMILIES[name]

    def make(**given: Any) -> Design:
        return family.make(**{key: given[key] for key in family.parameters})

    kind = inspect.Parameter.KEYWORD_ONLY
    named = [inspect.Parameter(key, kind) for key in family.parameters]
    make.__qualname__, make.__signature__ = name, inspect.Signature(named)  # type: ignore[attr-defined]
    return make


def _number(what: str, text: str) -> float:
    """Return the number of a text; an integer where it is written as one."""
    value = number_of(text)
    if not np.isfinite(value):
        wanted = "a number" if np.isnan(value) else "a finite number, at most 1.8e308"
        raise InvalidInput(expected(what, wanted, brief(text)))
    return int(text) if text.isdecimal() else value
