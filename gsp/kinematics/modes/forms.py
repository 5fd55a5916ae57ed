"""The polynomial equation of each kind of constraint, for numbers of any type.

With d = p + R b − a and t' = R t the equations are

    D1:  d · d = k
    D2:  (d · d) (t · t) − (d · t')² = k (t · t)
    D3:  (d · d) (s · s) − (d · s)² = k (s · s)
    D4:  (d · n)² = k (n · n),  n = s × t'
    A1:  s · t' = k

For unit vectors s and t, k is the square of a distance, or the cosine of an angle. They are
multiplied so that s and t may have any length: parameters (a, b, s, t, k) on a straight line then
stay parameters of equations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

from gsp.geometry.scalars import Scalar, Vector, cross, dot


@dataclass(frozen=True, kw_only=True)
class Form:
    """The equation of one kind of constraint.

    Attributes
    ----------
    constraint : str
        Name of the constraint in `gsp.model.constraints.CONSTRAINTS`.
    residual : d, s, t', k -> scalar
        Left minus right side.
    keeps_infinity : bool
        Whether k moves no solution to or from infinity. The trace test moves the k of such rows.
    """

    constraint: str
    residual: Callable[[Vector, Vector, Vector, Scalar], Scalar]
    keeps_infinity: bool


def _points(d: Vector, s: Vector, t: Vector, k: Scalar) -> Scalar:
    return dot(d, d) - k


def _from_line(d: Vector, line: Vector, k: Scalar) -> Scalar:
    along = dot(d, line)
    return (dot(d, d) - k) * dot(line, line) - along * along


def _platform_line(d: Vector, s: Vector, t: Vector, k: Scalar) -> Scalar:
    return _from_line(d, t, k)


def _base_line(d: Vector, s: Vector, t: Vector, k: Scalar) -> Scalar:
    return _from_line(d, s, k)


def _lines(d: Vector, s: Vector, t: Vector, k: Scalar) -> Scalar:
    normal = cross(s, t)
    along = dot(d, normal)
    return along * along - dot(normal, normal) * k


def _angle(d: Vector, s: Vector, t: Vector, k: Scalar) -> Scalar:
    return dot(s, t) - k


# Compiled code gets a form as its place in this tuple; `NUMBER` has the places by name.
FORMS = (
    Form(constraint="D1", residual=_points, keeps_infinity=True),
    Form(constraint="D2", residual=_platform_line, keeps_infinity=True),
    Form(constraint="D3", residual=_base_line, keeps_infinity=True),
    Form(constraint="D4", residual=_lines, keeps_infinity=False),
    Form(constraint="A1", residual=_angle, keeps_infinity=False),
)

# By the name of the constraint; a constraint without an equation is a KeyError with its name.
NUMBER = MappingProxyType({form.constraint: number for number, form in enumerate(FORMS)})
