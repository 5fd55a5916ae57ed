"""The equations as printed on pages and in the terminal, evaluated as they stand."""

from __future__ import annotations

import re

import numpy as np
import pytest

import gsp
from gsp.catalogue.equations import EQUATIONS
from gsp.model.constraints import CONSTRAINT
from gsp.model.legs import LEG

rng = np.random.default_rng(11)


class Vector:
    """Enough of vector algebra to evaluate a printed equation: × is @, · is &."""

    def __init__(self, value):
        self.value = np.asarray(value, dtype=float)

    def __matmul__(self, other):
        return Vector(np.cross(self.value, other.value))

    def __and__(self, other):
        return float(self.value @ other.value)

    def __abs__(self):
        return float(np.linalg.norm(self.value))

    def __sub__(self, other):
        return Vector(self.value - other.value)

    def __mul__(self, factor):
        return Vector(self.value * factor)

    def __truediv__(self, factor):
        return Vector(self.value / factor)

    def __neg__(self):
        return Vector(-self.value)


def evaluate(text: str, names: dict[str, Vector]):
    """Evaluate an equation: bars are norms, ± is the sign of d · n, (x) t is t times x."""
    either, text = text.startswith("±"), text.removeprefix("± ").removesuffix(", + where d · n ≥ 0")
    text = text.replace("R b", "Rb").replace("−", "-").replace("²", "**2")
    text = re.sub(r"\|([^|]+)\|", r"abs(\1)", text).replace("×", "@").replace("·", "&")
    if text.endswith(") t"):
        point, slide = text.removesuffix(" t").split(" - ", 1)
        text = f"{point} - t * {slide}"
    value = eval(text, {"__builtins__": {"abs": abs}}, {**names, "atan2": np.arctan2})
    return value * names["side"] if either else value


@pytest.fixture(scope="module")
def legs():
    """Six legs of each constraint at random lines and a random pose."""
    made = {}
    for name in CONSTRAINT:
        design = gsp.Design(
            [LEG[name].name] * 6,
            rng.normal(size=(6, 3)),
            rng.normal(size=(6, 3)),
            rng.normal(size=(6, 3)),
            rng.normal(size=(6, 3)),
        )
        made[name] = design.at(gsp.Pose.from_rpy(rng.normal(size=3), rng.normal(size=3)))
    return made


@pytest.mark.parametrize("name", list(CONSTRAINT))
def test_printed_equations_are_those_computed(legs, name):
    posture, equation = legs[name], EQUATIONS[name]
    design, pose = posture.design, posture.pose
    for i in range(6):
        arm = pose.rotation @ design.platform_points[i]
        d = pose.position + arm - design.base_points[i]
        s, t = design.base_directions[i], pose.rotation @ design.platform_directions[i]
        n = np.cross(t, s)
        names = {k: Vector(v) for k, v in {"d": d, "s": s, "t": t, "n": n, "Rb": arm}.items()}
        names["side"] = 1.0 if d @ n >= 0 else -1.0
        assert evaluate(equation.value, names) == pytest.approx(posture.joints[i], rel=1e-12)
        np.testing.assert_allclose(row(equation, names), posture.jacobian[i], atol=1e-12)


def row(equation, names) -> np.ndarray:
    if not equation.direction:
        head, tail = equation.row.strip("()").split(", ")
        assert head == "0"
        return np.concatenate((np.zeros(3), evaluate(tail, names).value))
    assert equation.row == "(u, r × u)"
    u, r = evaluate(equation.direction, names), evaluate(equation.arm, names)
    return np.concatenate((u.value, (r @ u).value))
