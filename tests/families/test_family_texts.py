"""Designs of families by texts: the same as by their functions, and what cannot be read."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.families import lee, nawratil
from gsp.families.texts import FAMILIES, design_of_family

HEXAPOD = {
    "base_radius": 2.0, "base_angle": 20.0, "platform_radius": 1.0, "platform_angle": 10.0,
    "height": 1.5,
}  # fmt: skip


@pytest.mark.parametrize(
    ("text", "design"),
    [
        ("lee-3-3(a=15, b=30)", lee.octahedral_3_3(15.0, 30.0)),
        ("lee-3-6 (b=30,a=15, beta=2e-1)", lee.platform_3_6(15.0, 30.0, 0.2)),
        ("lee-6-6(a=1, b=2, alpha=0.1, beta=.2)", lee.platform_6_6(1.0, 2.0, 0.1, 0.2)),
        ("lee-centre(a=1, b=2, rho=0.3)", lee.separated_to_centre(1.0, 2.0, 0.3)),
        ("lee-side(a=1, b=2, rho=0.3)", lee.separated_along_side(1.0, 2.0, 0.3)),
        (
            "lee-centre-side(a=1, b=2, alpha=0.1, beta=0.3)",
            lee.separated_by_kinds(1.0, 2.0, 0.1, 0.3, top="centre", base="side"),
        ),
        (
            "hexapod(" + ", ".join(f"{k}={v}" for k, v in HEXAPOD.items()) + ")",
            gsp.hexapod(**HEXAPOD, degrees=True),
        ),
        ("nawratil-example(alpha_deg=4, h=0.8)", nawratil.example_design(np.deg2rad(4.0))),
        ("nawratil-isotropic(g=3, p=0.7, mu_deg=10)", nawratil.isotropic(3, 0.7, np.deg2rad(10.0))),
        (
            "nawratil-control(g=4, ratio=1.5, rise_deg=20, phase_deg=50, mu_deg=10)",
            nawratil.control_optimum(4, 1.5, *np.deg2rad([20.0, 50.0, 10.0])),
        ),
    ],
)
def test_they_are_those_of_the_functions(text, design):
    found = design_of_family(text)
    assert found.name == design.name
    np.testing.assert_array_equal(found.base_points, design.base_points)
    np.testing.assert_array_equal(found.platform_points, design.platform_points)
    assert found.home is not None
    assert text.split("(")[0].strip() in FAMILIES


@pytest.mark.parametrize("name", [name for name in FAMILIES if name.startswith("lee")])
def test_the_home_of_lees_platforms_is_a_best_one(name):
    """Any other height near it has a smaller |det J|."""
    shares = "".join(f", {word}=0.1" for word in FAMILIES[name].parameters[2:])
    design = design_of_family(f"{name}(a=1, b=2{shares})")
    steps = np.linspace(-0.05, 0.05, 11)
    moved = design.home.moved(np.stack([[0, 0, step, 0, 0, 0] for step in steps]))
    values = np.abs(np.linalg.det(design.at(moved).jacobian))
    assert values.argmax() == 5


@pytest.mark.parametrize("name", [name for name in FAMILIES if name.startswith("lee")])
@pytest.mark.parametrize("share", [0.5, 1.0])
def test_the_home_of_a_singular_one_has_legs(name, share):
    """Shares of 1/2 and 1 are singular in every pose in some families."""
    shares = "".join(f", {word}={share}" for word in FAMILIES[name].parameters[2:])
    design = design_of_family(f"{name}(a=1, b=1{shares})")
    assert (design.at(design.home).joints > 1e-9).all()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("lee-3-3(a=1)", r"expected lee-3-3\(a=…, b=…\)"),
        ("lee-3-3()", r"expected lee-3-3\(a=…, b=…\)"),
        ("lee-3-3(a=1, b=2, c=3)", r"expected lee-3-3\(a=…, b=…\)"),
        ("lee-3-3(a=1, a=1, b=2)", "expected each parameter once, received a twice"),
        ("lee-3-3(a=1e400, b=2)", "lee-3-3, a: expected a finite number, at most 1.8e308"),
        ("lee-3-3(1, 2)", r"expected lee-3-3\(a=…, b=…\)"),
        ("lee-3-3(a=one, b=2)", "lee-3-3, a: expected a number, received 'one'"),
        ("lee-3-3(a=1_0, b=2)", "lee-3-3, a: expected a number"),
        ("lee-3-3(a=-1, b=2)", "a: expected a positive number"),
        ("lee-3-3(a=1e400, b=2)", "expected"),
        ("nawratil-isotropic(g=2.5, p=1, mu_deg=0)", "g: expected an integer"),
        ("lee-9-9(a=1, b=2)", "unknown family 'lee-9-9'"),
        ("__import__(a=1)", "unknown family"),
    ],
)
def test_texts_that_are_none(text, words):
    with pytest.raises(gsp.GspError, match=words):
        design_of_family(text)
