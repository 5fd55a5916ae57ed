"""Invalid arguments of forward kinematics and bridges raise an error of the library."""

from contextlib import nullcontext

import pytest

import gsp
from gsp import bridges
from gsp.bridges.proof import prove
from gsp.errors import GspError, InvalidInput
from tests.test_public_boundary import INVALID, SHAPES

DESIGN = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
HERE = DESIGN.home
JOINTS = DESIGN.at(HERE).joints
ONE = [gsp.catalogue.mechanism("D1^6")]

EXPORTS = (bridges.to_pinocchio, bridges.to_mjcf, bridges.to_urdf, bridges.to_sdf)

CALLS = {
    "forward design": lambda x: gsp.forward(x, JOINTS, HERE),
    "forward joints": lambda x: gsp.forward(DESIGN, x, HERE),
    "forward guess": lambda x: gsp.forward(DESIGN, JOINTS, x),
    "forward tolerance": lambda x: gsp.forward(DESIGN, JOINTS, HERE, tolerance=x),
    "forward iterations": lambda x: gsp.forward(DESIGN, JOINTS, HERE, max_iterations=x),
    **{
        f"{f.__name__} {what}": lambda x, f=f, what=what: (
            f(x, HERE) if what == "design" else f(DESIGN, x)
        )
        for f in EXPORTS + (bridges.masses, bridges.agreement)
        for what in ("design", "pose")
    },
    **{f"{f.__name__} solids": lambda x, f=f: f(DESIGN, HERE, x) for f in EXPORTS},
    **{f"{f.__name__} drives": lambda x, f=f: f(DESIGN, HERE, drives=x) for f in EXPORTS},
    "Drives efforts": lambda x: bridges.Drives(efforts=x),
    "Drives speeds": lambda x: bridges.Drives(speeds=x),
    "floating": lambda x: bridges.to_urdf(DESIGN, HERE, floating=x),
    **{
        f"Solids {name}": lambda x, name=name: bridges.Solids(**{name: x})
        for name in ("radius", "density", "link_mass", "platform_mass", "metres")
    },
    "gravity": lambda x: bridges.to_mjcf(DESIGN, HERE, gravity=x),
    "servo_frequency": lambda x: bridges.to_mjcf(DESIGN, HERE, servo_frequency=x),
    "program": lambda x: bridges.agreement(DESIGN, HERE, x),
    "export form": lambda x: bridges.export(DESIGN, HERE, x, "out"),
    "prove mechanisms": lambda x: prove(x, poses=1),
    "prove poses": lambda x: prove(ONE, poses=x),
    "prove seed": lambda x: prove(ONE, poses=1, seed=x),
}

# Valid kinds of each argument; all others are errors. "huge" is a positive number.
OPTIONAL = {"None"}
FINE = {
    **{f"{f.__name__} {what}": OPTIONAL for f in EXPORTS for what in ("solids", "drives")},
    "Drives efforts": {"None", "list", "array"}, "Drives speeds": {"None", "list", "array"},
    "floating": {"bool"},
    "Solids radius": OPTIONAL, "Solids link_mass": OPTIONAL, "Solids platform_mass": OPTIONAL,
    "Solids metres": OPTIONAL, "forward tolerance": {"huge"},
    "forward joints": {"view of six", "greatest"},  # six numbers each
    "prove seed": {"zero"}, "prove mechanisms": OPTIONAL,
}  # fmt: skip


@pytest.mark.parametrize("call", CALLS)
def test_invalid_arguments_of_bridges_are_errors(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, value in INVALID.items():
        if name in SHAPES:  # tests/test_public_boundary.py has them
            continue
        if call == "prove mechanisms" and name == "None":
            continue  # all 195: right, and long
        passes = name in FINE.get(call, ())
        with nullcontext() if passes else pytest.raises(GspError) as caught:
            CALLS[call](value)
        assert passes or 10 < len(str(caught.value)) < 500, f"{call}: {name}"
    assert not list(tmp_path.iterdir())


def test_gravity_is_one_vector():
    with pytest.raises(InvalidInput, match=r"gravity: expected shape \(3,\)"):
        bridges.to_mjcf(DESIGN, HERE, gravity=[[0.0, 0.0, -9.81]] * 2)
