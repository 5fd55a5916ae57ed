"""Each rule of jets where its bounds are attained: a term that is left out would violate them.

Operands move along X(τ) = c + v τ + q τ²/2 with |v| of the order of a small ε and |q| of ε², turned
by an angle of the same orders. Derivatives of the results are by differences of 50 digits.
"""

import mpmath
import numpy as np
import pytest

from gsp.variation import jets
from gsp.variation.jets import Jet
from gsp.variation.legs import Patch, across

E = 1e-3
I, J, _ = np.eye(3)  # noqa: E741 - axes
ZERO = np.zeros(3)


def path(c, v=ZERO, q=ZERO):
    """A vector with linear speed, as a function of τ, and its jet; its bounds are attained."""
    c, v, q = (np.atleast_1d(np.asarray(x, dtype=float)) for x in (c, v, q))
    first = max(np.linalg.norm(v), np.linalg.norm(v + q))
    slopes = [v.tolist()] + [[0.0] * len(c)] * 5
    most = np.linalg.norm(c) + first
    jet = Jet(c.tolist(), slopes, 0.0, first, float(np.linalg.norm(q)), most)
    return (lambda s: [x + y * s + z * s * s / 2 for x, y, z in zip(c, v, q, strict=True)]), jet


def dot(x, y):
    return sum(a * b for a, b in zip(x, y, strict=True))


def times(factor, x):
    return [factor * a for a in x]


def size(x):
    return mpmath.sqrt(dot(x, x))


def turned(angle, x):
    """Turn a vector about z."""
    c, s = mpmath.cos(angle), mpmath.sin(angle)
    return [c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]]


def cross(x, y):
    return [x[i - 2] * y[i - 1] - x[i - 1] * y[i - 2] for i in range(3)]


def sum_of(x, y):
    return [a + b for a, b in zip(x, y, strict=True)]


GROWING = path(I, E * I, E * E * I)
SIDE = path(J, E * J, E * E * J)
FACTOR = path(1, E, E * E)
# The operation on jets, the same on vectors, the operands, and which bounds they attain.
BOTH = ("first", "second")
RULES = {
    "total": (jets.total, sum_of, (GROWING, GROWING), BOTH),
    "scaled": (lambda x: jets.scaled(2.5, x), lambda x: times(2.5, x), (GROWING,), BOTH),
    "inner": (jets.inner, lambda x, y: [dot(x, y)], (GROWING, GROWING), BOTH),
    "outer": (jets.outer, cross, (GROWING, SIDE), BOTH),
    "multiple": (jets.multiple, lambda f, x: times(f[0], x), (FACTOR, GROWING), BOTH),
    "joined": (jets.joined, lambda x, y: [*x, *y], (GROWING, SIDE), BOTH),
    "inverse": (jets.inverse, lambda x: [1 / x[0]], (path(1, -E, -E * E),), BOTH),
    "square root": (
        jets.square_root, lambda x: [mpmath.sqrt(x[0])], (path(1, -E, -E * E),), BOTH
    ),
    "image": (
        lambda x: jets.image(x, [[2.0, 0.0, 0.0], [0.0, -2.0, 0.0]], 2.0),
        lambda x: [2 * x[0], -2 * x[1]], (GROWING,), BOTH,
    ),
    "length, radial": (jets.length, lambda x: [size(x)], (GROWING,), ("first",)),
    "length, across": (jets.length, lambda x: [size(x)], (path(I, E * J, E * E * I),), ("second",)),
    "unit, across": (jets.unit, lambda x: times(1 / size(x), x), (path(I, E * J),), ("first",)),
    "unit, speed": (
        jets.unit,
        lambda x: times(1 / size(x), x),
        (path(I, E * np.sqrt([1 / 3, 2 / 3, 0])),),
        ("second",),
    ),
    "unit, bend": (
        jets.unit, lambda x: times(1 / size(x), x), (path(I, ZERO, E * J),), ("second",)
    ),
}  # fmt: skip


def check(jet, function, attained):
    """The derivatives on the path are within the bounds of the jet, which exceed them by 10 ε."""
    with mpmath.workdps(50):
        moved = [
            [
                [
                    mpmath.diff(lambda s, i=i: function(s)[i], at, order)
                    for i in range(len(jet.value))
                ]
                for order in (1, 2)
            ]
            for at in (mpmath.mpf(0), mpmath.mpf(1) / 2, mpmath.mpf(1))
        ]
        start = [float(x - y) for x, y in zip(moved[0][0], jet.slopes[0], strict=True)]
        greatest = {name: max(float(size(at[k])) for at in moved) for k, name in enumerate(BOTH)}
        assert np.allclose(jet.value, [float(x) for x in function(mpmath.mpf(0))], atol=1e-15)
        assert max(float(size(function(at))) for at in (0, mpmath.mpf(1))) <= jet.most
    assert np.linalg.norm(start) <= jet.slack
    for name, found in greatest.items():
        bound = getattr(jet, name)
        assert found <= bound * (1.0 + 1e-12), name
        if name in attained:
            assert bound <= found * (1.0 + 10.0 * E), name


@pytest.mark.parametrize("rule", RULES)
def test_bounds_of_a_rule_hold_and_are_attained(rule):
    operation, exact, operands, attained = RULES[rule]
    paths, given = zip(*operands, strict=True)
    check(operation(*given), lambda s: exact(*(p(s) for p in paths)), attained)


def turning(speed, bend):
    """An angle about z as a function of τ, and bounds of its first and second derivatives."""
    return lambda s: speed * s + bend * s * s / 2, speed + bend, bend


@pytest.mark.parametrize(
    ("d", "angle", "attained"),
    [
        (path(-J, -E * I, E * E * J), turning(E, 0.0), ("second",)),
        (path(I, ZERO, -E * E * J), turning(0.0, E * E), ("second",)),
        (path(I, -E * J), turning(E, 0.0), ("first",)),
    ],
    ids=["turn", "start of a turn", "speed"],
)
def test_bounds_of_the_part_across_a_line_hold_and_are_attained(d, angle, attained):
    theta, spin, twist = angle
    speed = float(mpmath.diff(theta, 0))
    t = Jet(I.tolist(), [[0.0, speed, 0.0], *[[0.0] * 3] * 5], 0.0, spin, spin**2 + twist, 1.0)

    def part(s):
        x, line = d[0](s), turned(theta(s), [1, 0, 0])
        return sum_of(x, times(-dot(x, line), line))

    check(across(d[1], t, spin, twist), part, attained)


@pytest.mark.parametrize(
    ("angle", "off", "attained"),
    [
        (turning(E, 0.0), E * J, BOTH),
        (turning(0.0, E * E), ZERO, ("second",)),
    ],
    ids=["turn", "start of a turn"],
)
def test_bounds_of_a_vector_of_the_platform_hold_and_are_attained(angle, off, attained):
    """Also of one that is off by a tolerance, which grows along the path."""
    theta, spin, twist = angle
    speed = float(mpmath.diff(theta, 0))
    still = [[0.0] * 3] * 2
    turns = [[0.0, 0.0, speed], *still]
    patch = Patch(ZERO.tolist(), np.eye(3).ravel().tolist(), [0.0] * 3, turns, 0, 0, spin, twist, 0)
    jet = patch.carried(I.tolist(), 1.0, float(np.linalg.norm(off)))
    # The angles are the last three coordinates; `check` takes the first one.
    jet = Jet(jet.value, jet.slopes[3:], jet.slack, jet.first, jet.second, jet.most)
    check(
        jet, lambda s: turned(theta(s), [x + y * s for x, y in zip(I, off, strict=True)]), attained
    )
