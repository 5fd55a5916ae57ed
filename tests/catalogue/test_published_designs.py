"""The published designs are what the papers print, to the last bit."""

import re
import tomllib

import mpmath as mp
import numpy as np
import pytest

import gsp
from gsp.files.knowledge import knowledge

EXACT = (
    "basic-robotics-large",
    "basic-robotics-small",
    "dehaeze-cubic-above-large",
    "dehaeze-cubic-above-medium",
    "dehaeze-cubic-above-small",
    "dehaeze-cubic-centred",
    "dehaeze-cubic-large",
    "dehaeze-cubic-low",
    "dehaeze-general",
    "lee-2000-3-3",
    "lee-2000-3-6",
    "lee-2000-6-6",
    "lee-2000-6-6-similar",
    "nawratil-isotropic-3-mu-0",
    "nawratil-isotropic-3-mu-60",
    "nawratil-k-plus",
    "workspace-6-3",
)
SINGULAR = ("lee-2000-6-6-similar",)  # at all poses
NUMBERS = re.compile(r"^(\w+) = (\[.*\])  # (.+)$")
LETTER = re.compile(r"^# where (\w+) = (.+)$")
FUNCTIONS = {"sqrt": mp.sqrt, "cos": mp.cos, "sin": mp.sin, "arctan": mp.atan, "pi": mp.pi}


def text_of(name):
    return knowledge("catalogue", "designs", f"{name}.toml").read_text(encoding="utf-8")


def evaluate(expression, letters):
    """Value of an expression in 40 digits, its integers exact."""
    python = re.sub(r"(?<![\w.])(\d+)", r"mpf(\1)", expression.replace("^", "**"))
    return eval(python, {"mpf": mp.mpf, "__builtins__": {}}, {**FUNCTIONS, **letters})


@pytest.mark.parametrize("name", EXACT)
def test_every_coordinate_is_the_nearest_double_of_its_expression(name):
    mp.mp.dps = 40
    letters, seen = {}, 0
    for line in text_of(name).splitlines():
        if match := LETTER.match(line):
            letters[match[1]] = evaluate(match[2], letters)
        elif match := NUMBERS.match(line):
            numbers = tomllib.loads(f"x = {match[2]}")["x"]
            for number, expression in zip(numbers, match[3].split(", "), strict=True):
                exact = evaluate(expression, letters)
                ulp = np.spacing(abs(number)) if number else mp.mpf("1e-30")
                assert abs(exact - mp.mpf(number)) <= ulp, (line, expression)
                seen += 1
    legs = gsp.catalogue.design(name).n_legs
    ellipsoid = gsp.catalogue.design(name).ellipsoid is not None
    assert seen == 6 * legs + 3 + 3 * ellipsoid


@pytest.mark.parametrize("name", gsp.catalogue.design_names())
def test_names_are_those_of_the_files_and_everything_has_a_source_and_a_home(name):
    design = gsp.catalogue.design(name)
    assert design.name == name
    assert design.source
    assert design.at(design.home).defined
    assert design.at(design.home).singular() == (name in SINGULAR)


def test_the_table_of_designs():
    table = gsp.catalogue.designs().set_index("name")
    assert set(EXACT) < set(table.index)
    assert table.loc["toz-kucuk-2016-d1-d2-d3-d4-a1-2", "class"] == "4D2A"
    assert table.loc["toz-kucuk-2016-d3-6", "pose"] == "(10, -10, 138), rpy (5, -5, -10)°"
    assert table.loc["lee-2000-3-3", "pose"] == "(0, 0, 1)"


@pytest.mark.parametrize(
    ("name", "expression"),
    [
        ("lee-2000-3-3", "3*sqrt(3)/4"),  # eq. (21)
        ("lee-2000-3-6", "3*sqrt(3)/4"),  # eq. (59)
        ("lee-2000-6-6", "21*sqrt(21)/256"),  # after eq. (68)
    ],
)
def test_the_homes_of_lee_are_maxima_of_the_determinant(name, expression):
    design = gsp.catalogue.design(name)
    best = float(evaluate(expression, {}))
    assert gsp.indices.manipulability(design.at(design.home)) == pytest.approx(best, rel=1e-14)
    rng = np.random.default_rng(0)
    position = design.home.position + 1e-2 * rng.standard_normal((500, 3))
    near = gsp.Pose.from_rpy(position, 1e-2 * rng.standard_normal((500, 3)))
    assert (gsp.indices.manipulability(design.at(near)) < best).all()


def test_k_plus_has_the_printed_control_number():
    design = gsp.catalogue.design("nawratil-k-plus")
    value = gsp.indices.control_number(design.at(design.home))
    assert value == pytest.approx(np.sqrt(2.0 * np.sqrt(5.0) - 4.0), abs=1e-12)


@pytest.mark.parametrize("angle", ["0", "60"])
def test_the_isotropic_designs_are_best_in_both_indices(angle):
    design = gsp.catalogue.design(f"nawratil-isotropic-3-mu-{angle}")
    posture = design.at(design.home)
    assert gsp.indices.control_number(posture) == pytest.approx(1.0, abs=1e-12)
    condition = gsp.indices.condition_number_ellipsoid(posture, design.ellipsoid)
    assert condition == pytest.approx(1.0, abs=1e-12)


def test_the_legs_of_the_6_3_platform_are_those_of_the_printed_equations():
    """Workspace-3, eqs. (3.3) and (3.4), at a pose without any symmetry."""
    design = gsp.catalogue.design("workspace-6-3")
    x, y, z = 1.5, -2.5, 7.0
    al, be, ga = 0.3, -0.2, 0.4
    a, b, d = 10.0, 15.0, 1.0
    q, s, c = np.sqrt(3.0), np.sin, np.cos

    def top(sign, angle):
        g = ga + angle
        return (
            x + sign * a / q * (s(al) * s(be) * s(g) + c(be) * c(g)),
            y + sign * a / q * c(al) * s(g),
            z + sign * a / q * (s(al) * c(be) * s(g) - s(be) * c(g)),
        )

    t1, t2, t3 = top(1, np.pi / 3), top(-1, 0.0), top(1, -np.pi / 3)
    legs = [
        (t1[0] - d / (2 * q) - b / q, t1[1] - d / 2, t1[2]),
        (t1[0] - d / (2 * q) + b / (2 * q), t1[1] - d / 2 - b / 2, t1[2]),
        (t2[0] + d / q + b / (2 * q), t2[1] - b / 2, t2[2]),
        (t2[0] + d / q + b / (2 * q), t2[1] + b / 2, t2[2]),
        (t3[0] - d / (2 * q) + b / (2 * q), t3[1] + d / 2 + b / 2, t3[2]),
        (t3[0] - d / (2 * q) - b / q, t3[1] + d / 2, t3[2]),
    ]
    pose = gsp.Pose.from_angles([x, y, z], [al, be, ga], "approach-roll")
    np.testing.assert_allclose(design.at(pose).joints, np.linalg.norm(legs, axis=1), rtol=1e-14)
    assert design.strokes.tolist() == [[8.0, 15.0]] * 6
