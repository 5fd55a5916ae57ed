"""Invalid arguments of the public functions of the families raise a GspError."""

import inspect
import re
import warnings

import numpy as np
import pytest

import gsp
from gsp.errors import GspError
from gsp.families import lee
from gsp.families.nawratil import control_optima, example_set, motion, symmetric_sets

GOOD = {
    "a": 1.3, "b": 2.1, "h": 0.7, "x": 0.1, "y": -0.2, "z": 0.7, "alpha": 0.15, "beta": 0.2,
    "rho": 0.15, "theta": 0.3, "r": 0.5, "cosine": 0.4, "height_ratio": 0.8, "g": 3, "t": 0.7,
    "mu": 0.2, "p": 0.6, "turn": (0.0, 0.0, 0.1), "axis": "x", "angle": [0.9, 1.0], "swap": None,
    "function": lambda posture: posture.joints[..., 0], "closed_form": lee.to_centre,
    "start": (0.0, 0.0, 1.0), "end": (1.0, 0.0, 2.0), "base": np.eye(3), "platform": np.eye(3) + 1,
    "first": np.eye(3)[:2], "second": np.eye(3)[1:] + 1, "unit": "mm", "family": "lee-6-6",
    "base_radius": 2.0, "base_angle": 0.3, "platform_radius": 1.0, "platform_angle": 0.4,
    "height": 1.5, "ratio": 1.2, "rise": 0.5, "phase": 0.9, "radius": 2.0,
    "posture": gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5).at(gsp.Pose([0.0, 0.0, 1.5])),
    "ellipsoid": gsp.Ellipsoid((1.0, 1.0, 0.5)),
}  # fmt: skip
KINDS = {"alpha": 0.1, "beta": 0.2, "top": "centre", "base": "side"}
OTHERS = {
    "over_example_set": {"alpha": [0.1, 0.2], "h": [0.5, 0.7]},
    "set_n": {"a": -0.3, "b": 0.4},
    **{name: KINDS for name in ("separated_by_kinds", "by_kinds", "best_pose_by_kinds")},
}
INVALID = (
    None, "text", b"bytes", 1j, float("nan"), float("inf"), [], [1.0, 2.0, 3.0, 4.0, 5.0], {},
    object(), np.ma.masked_array([1.0], [True]), [[1.0], [2.0, 3.0]], True, np.array("x"), -1e400,
)  # fmt: skip
FUNCTIONS = {
    **{name: getattr(lee, name) for name in lee.__all__ if name not in ("FAMILIES", "Separated")},
    **{
        name: getattr(module, name)
        for module in (control_optima, example_set, symmetric_sets, motion)
        for name, value in vars(module).items()
        if inspect.isfunction(value) and value.__module__ == module.__name__ and name[0] != "_"
    },
}


def given(name, function):
    if name == "bracket":
        return ([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]), {}
    if name == "between_axes":
        some = motion.instantaneous_motion(motion.turned("x", 0.9))
        return (), {"one": some, "other": some}
    known = {**GOOD, **OTHERS.get(name, {})}
    names = [
        p.name for p in inspect.signature(function).parameters.values() if p.kind != p.VAR_KEYWORD
    ]
    return (), {key: known[key] for key in names if key in known}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_good_arguments_are_taken(name):
    positional, keywords = given(name, FUNCTIONS[name])
    FUNCTIONS[name](*positional, **keywords)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_invalid_arguments_raise_an_error_of_the_library(name):
    function = FUNCTIONS[name]
    positional, keywords = given(name, function)
    for value in INVALID:
        calls = [(positional, {**keywords, key: value}) for key in keywords] + [
            ((*positional[:i], value, *positional[i + 1 :]), keywords)
            for i in range(len(positional))
        ]
        for args, kwargs in calls:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    function(*args, **kwargs)
                except GspError:
                    pass


EXTREME = (
    1e-320, 1e-300, 1e-100, 1e-33, 1e33, 1e99, 1e150, 1e308, -1.0, -1e150, 0.0, 2 / 3, 5.0,
    np.array(1e150), np.array([0.3, 0.4]), np.array([0.3, 1e150]),
)  # fmt: skip


def numbers(result):
    """Return all numbers of a result."""
    if isinstance(result, gsp.Design):
        return [result.base_points, result.platform_points]
    if isinstance(result, gsp.Pose):
        return [result.position]
    if isinstance(result, dict):
        return [np.array(list(result.values()))]
    if isinstance(result, tuple):
        return [number for part in result for number in numbers(part)]
    return [np.asarray(result)]


@pytest.mark.parametrize("name", [*FUNCTIONS, "hexapod"])
def test_extreme_numbers_are_refused_or_have_a_finite_result(name):
    function = {**FUNCTIONS, "hexapod": gsp.hexapod}[name]
    positional, keywords = given(name, function)
    numeric = [k for k, v in keywords.items() if np.isscalar(v) and not isinstance(v, str)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for key in numeric:
            for value in EXTREME:
                try:
                    found = function(*positional, **{**keywords, key: value})
                except GspError:
                    continue
                for values in numbers(found):
                    assert np.isfinite(values).all(), f"{key}: {value!r}"


@pytest.mark.parametrize(
    ("name", "arguments", "range_"),
    [
        ("best_ratio", {"alpha": 0.5, "beta": 2 / 3}, "3αβ < 1"),
        ("best_ratio", {"alpha": 1.0, "beta": [0.1, 0.9]}, "3αβ < 1"),
        ("leg_length", {"a": -1.0}, "positive number from 1e-100 to 1e+100"),
        ("leg_length", {"alpha": 1.5}, "in [0, 1]"),
        ("central_maximum", {"b": [1.0, 1e150]}, "positive number from 1e-100 to 1e+100"),
        ("quality_at_height", {"height_ratio": -0.1}, "in [0, 1e+100]"),
        ("octahedron_volume", {"h": -1.0}, "in [0, 1e+100]"),
        ("quality_polar_bound", {"cosine": 1.1}, "in [-1, 1]"),
        ("quality_polar", {"r": 1e26}, "in [0, 1e+25]"),
        ("turned_determinant", {"a": 1e34}, "from 1e-33 to 1e33"),
        ("to_centre", {"a": np.array([1.0, 2.0])}, "a positive number"),
        ("best_central_pose", {"rho": -0.1}, "in [0, 1]"),
        ("example_determinant", {"alpha": 0.6}, "in [0, π/6]"),
        ("set_n", {"g": 1001}, "≤ 1000"),
    ],
)
def test_the_range_is_stated(name, arguments, range_):
    positional, keywords = given(name, FUNCTIONS[name])
    with pytest.raises(GspError, match=re.escape(range_)):
        FUNCTIONS[name](*positional, **{**keywords, **arguments})


def test_shapes_that_do_not_broadcast_are_errors():
    for call in (
        lambda: lee.leg_length([1.0, 2.0], [1.0, 2.0, 3.0], 1.0),
        lambda: lee.bracket(np.zeros((2, 3)), np.zeros((3, 3)), np.zeros(3), np.zeros(3)),
        lambda: lee.bracket(np.zeros(3)),
        lambda: lee.line_coordinates(np.zeros((2, 3)), np.zeros((4, 3))),
        lambda: lee.shear(0.1, 0.2, 0.0),
    ):
        with pytest.raises(GspError):
            call()
