"""The formulas of legs on every kind of number: floats, arrays, complex, 50 digits, symbols."""

import math
from itertools import chain, pairwise

import mpmath
import numpy as np
import pytest

from gsp.geometry.ellipsoid import Ellipsoid, ellipsoid_frame, ellipsoid_row
from gsp.geometry.scalars import arc, choose, cross, dot, less, norm, root
from gsp.geometry.vectors import EPS
from gsp.kernels.trace import Graph, Traced, needed
from gsp.model.formulas import normals, placement
from gsp.model.legs import LEGS
from tests.screws import exact
from tests.support import LEG_NAMES, random_design, random_pose

LENGTH, WEIGHT = 0.8, 1.25
NAMES = pytest.mark.parametrize("name", LEG_NAMES)


def geometry(name, seed):
    """Pose and anchors of one leg as 3 + 9 + 3 + 3 + 3 + 3 + 1 floats; lines on both bodies."""
    rng = np.random.default_rng(seed)
    design, pose = random_design(rng, ("D1",) * 5 + (name,)), random_pose(rng)
    a, b = design.base_points[5], design.platform_points[5]
    s, t = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
    scale = sum(map(np.linalg.norm, (pose.position, a, b)))
    parts = (pose.position, pose.rotation.ravel(), a, b, s, t, [scale])
    return [float(x) for x in np.concatenate(parts)]


def segment(kind, numbers):
    p, r, a, b, s, t = (numbers[i:j] for i, j in pairwise(STARTS))
    return kind.segment(placement(p, r, (a, b), (s, t), numbers[24]))


STARTS = (0, 3, 12, 15, 18, 21, 24)


def everything(name, numbers, length=LENGTH, weight=WEIGHT):
    """Direction, length, arm, values, rows and passive rates of a leg: a flat list of scalars."""
    kind = next(leg for leg in LEGS if leg.name == name)
    seen = segment(kind, numbers)
    values = [c.measure(seen) for c in kind.constraints]
    rows = [c.row(seen, weight) for c in kind.constraints]
    passive = [rate.row for rate in kind.passive(seen, length)]
    return [*seen.direction, seen.length, *seen.arm, *values, *chain(*rows, *passive)]


def evaluated(values, inputs):
    """Run what was recorded, on floats."""
    number = {}

    def of(x):
        return number[x.number] if isinstance(x, Traced) else x

    operations = {
        "+": lambda x, y: x + y, "-": lambda x, y: x - y, "*": lambda x, y: x * y,
        "/": lambda x, y: x / y, "<": lambda x, y: x < y, "sqrt": math.sqrt, "atan2": math.atan2,
        "choose": lambda c, x, y: x if c else y, "lane": lambda array, k: inputs[k],
    }  # fmt: skip
    for node in needed(values):
        number[node.number] = operations[node.op](*map(of, node.args))
    return [of(x) for x in values]


def at_least_one(x):
    return np.maximum(1.0, np.abs(x))


@NAMES
@pytest.mark.parametrize("seed", range(5))
def test_arrays_and_floats_have_the_same_bits(name, seed):
    """But for the arctangent, of which numpy claims 4 units in the last place."""
    cases = [geometry(name, seed + 10 * i) for i in range(7)]
    floats = np.array([everything(name, case) for case in cases])
    arrays = everything(name, list(np.array(cases).T.copy()))
    stacked = np.stack(np.broadcast_arrays(*arrays), axis=1)
    angle = 7 + LEG_NAMES_WITH_ANGLE.get(name, 0)
    same = np.ones(floats.shape[1], dtype=bool)
    if name in LEG_NAMES_WITH_ANGLE:
        same[angle] = False
        np.testing.assert_allclose(stacked[:, angle], floats[:, angle], rtol=4 * EPS)
    np.testing.assert_array_equal(stacked[:, same], floats[:, same])


LEG_NAMES_WITH_ANGLE = {"A1": 0, "D4 A1": 1}


@NAMES
@pytest.mark.parametrize("seed", range(5))
def test_what_is_recorded_gives_the_same_bits_as_floats(name, seed):
    """That it can be recorded shows that the formulas do not branch."""
    numbers = geometry(name, seed)
    symbols = Graph().lanes("leg", 25)
    assert evaluated(everything(name, symbols), numbers) == everything(name, numbers)


@NAMES
@pytest.mark.parametrize("seed", range(5))
def test_floats_agree_with_50_digits(name, seed):
    numbers = geometry(name, seed)
    with mpmath.workdps(50):
        wanted = everything(name, list(exact(numbers)), mpmath.mpf(LENGTH), mpmath.mpf(WEIGHT))
        error = [float(abs(x - y)) for x, y in zip(everything(name, numbers), wanted, strict=True)]
    assert (error <= 1e-12 * at_least_one([float(x) for x in wanted])).all()


@NAMES
@pytest.mark.parametrize("seed", range(3))
def test_complex_numbers_continue_the_real_ones(name, seed):
    numbers = geometry(name, seed)
    real = np.array(everything(name, numbers))
    for values in (
        everything(name, [complex(x) for x in numbers]),
        [x[0] for x in np.broadcast_arrays(*everything(name, list(np.array([numbers]).T + 0j)))],
        [complex(x) for x in everything(name, [mpmath.mpc(x) for x in numbers])],
    ):
        error = np.abs(np.array(values, dtype=complex) - real)
        assert (error <= 1e-13 * at_least_one(real)).all()


def stepped(numbers, twist, step):
    """Numbers of a leg that has moved by `step` times a twist, to first order."""
    p, r = np.array(numbers[:3]), np.array(numbers[3:12]).reshape(3, 3)
    turned = r + step * np.cross(twist[3:], r, axisb=0, axisc=0)
    return [*(p + step * twist[:3]), *turned.ravel(), *numbers[12:]]


@NAMES
@pytest.mark.parametrize("seed", range(5))
def test_rows_are_complex_step_derivatives_of_values(name, seed):
    numbers = geometry(name, seed)
    kind = next(leg for leg in LEGS if leg.name == name)
    seen = segment(kind, numbers)
    for constraint in kind.constraints:
        row = constraint.row(seen, 1.0)
        for i, twist in enumerate(np.eye(6)):
            moved = segment(kind, [complex(x) for x in stepped(numbers, twist, 1e-30j)])
            slope = constraint.measure(moved).imag / 1e-30
            assert slope == pytest.approx(row[i], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("z", [1.0, -1.0, 0.6, -0.6, 0.0])
def test_normals_complete_a_frame(z):
    x = 0.6 * math.sqrt(1.0 - z * z)
    u = [x, math.sqrt(max(1.0 - z * z - x * x, 0.0)), z]
    e1, e2 = normals(u)
    for v, w in ((u, e1), (u, e2), (e1, e2)):
        assert abs(dot(v, w)) < 1e-15
    assert np.allclose([norm(e1), norm(e2)], 1.0, rtol=1e-15)
    assert np.allclose(cross(e1, e2), u, atol=1e-15) or np.allclose(cross(e2, e1), u, atol=1e-15)


def test_the_ellipsoid_on_every_kind_of_number():
    rng = np.random.default_rng(3)
    whole = Ellipsoid([0.5, 0.3, 0.2], [0.1, -0.2, 0.3], random_pose(rng).rotation)
    turn, row = random_pose(rng).rotation.ravel().tolist(), rng.normal(size=6).tolist()
    given = whole.scalars.tolist()
    floats = ellipsoid_row(row, ellipsoid_frame(turn, given[:3], given[3:]))
    symbols = Graph().lanes("all", 27)
    recorded = ellipsoid_row(
        symbols[:6], ellipsoid_frame(symbols[6:15], symbols[15:18], symbols[18:])
    )
    assert evaluated(recorded, [*row, *turn, *given]) == floats
    array = whole.whiten(np.array(row)[None], np.array(turn).reshape(3, 3))
    np.testing.assert_array_equal(array[0], floats)
    with mpmath.workdps(50):
        r, q, g = (list(exact(x)) for x in (row, turn, given))
        digits = ellipsoid_row(r, ellipsoid_frame(q, g[:3], g[3:]), 1 / mpmath.sqrt(6))
    np.testing.assert_allclose(floats, [float(x) for x in digits], rtol=1e-13, atol=1e-14)


class Range:
    """A least and a greatest value; it is not known on which side of others within them it is."""

    def __init__(self, low, high):
        self.low, self.high = low, high

    def __lt__(self, other):
        return Unknown() if self.low < other <= self.high else self.high < other

    def sqrt(self):
        return Range(math.sqrt(self.low), math.sqrt(self.high))

    def atan2(self, cosine):
        return Range(math.atan2(self.low, cosine), math.atan2(self.high, cosine))


class Unknown:
    def choose(self, yes, no):
        return Range(min(yes, no), max(yes, no))


def test_a_new_kind_of_number_needs_only_its_methods():
    assert root(Range(4.0, 9.0)).high == 3.0
    assert arc(Range(0.0, 1.0), 1.0).high == math.pi / 4
    assert choose(less(Range(-2.0, -1.0), 0.0), "below", "above") == "below"
    both = choose(less(Range(-1.0, 1.0), 0.0), 5.0, 3.0)
    assert (both.low, both.high) == (3.0, 5.0)


def test_an_invalid_condition_is_not_taken_for_false():
    with pytest.raises(AttributeError):
        choose(None, 1.0, 2.0)


@pytest.mark.parametrize("angle", [1e-8, 0.5, math.pi / 2, 2.5, math.pi - 1e-8])
def test_arc_of_all_numbers(angle):
    sine, cosine = math.sin(angle), math.cos(angle)
    assert arc(sine, cosine) == pytest.approx(angle, rel=1e-15)
    assert arc(complex(sine), complex(cosine)) == pytest.approx(angle, abs=1e-15)
    assert arc(np.array([sine]), np.array([cosine]))[0] == pytest.approx(angle, rel=1e-15)
    assert arc(np.array([sine + 0j]), np.array([cosine]))[0] == pytest.approx(angle, abs=1e-15)
    with mpmath.workdps(30):
        exactly = mpmath.mpf(angle)
        parts = mpmath.sin(exactly), mpmath.cos(exactly)
        assert abs(arc(*parts) - exactly) < 1e-28
        assert abs(arc(*map(mpmath.mpc, parts)) - exactly) < 1e-28
    step = arc(sine + 1e-30j * cosine, cosine - 1e-30j * sine)
    assert step.imag == pytest.approx(1e-30, rel=1e-12)
