"""Sensitivities: gradients against differences, Sobol indices against closed forms."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.exploration import sensitivities, sobol_indices
from gsp.indices import gradient
from tests.support import random_design, random_pose

HEXAPOD = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
SPACE = gsp.Space(
    gsp.hexapod,
    {"platform_radius": (0.5, 1.5), "platform_angle": (0.1, 1.0)},
    fixed={"base_radius": 2.0, "base_angle": 0.3, "height": 1.5},
)
POSES = gsp.PoseBox.around(HEXAPOD.home, [0.2] * 6).sample(3, rng=1)
TASK = gsp.Task(poses=POSES, wanted=["mean CTN", "worst CDN_CL", "mean |det J|"], length=0.8)
AT = {"platform_radius": 0.9, "platform_angle": 0.5}
ONE_POSE = gsp.Pose([[0.0, 0.0, 1.0]])


# --- local ---


def value(design, column):
    table = gsp.exploration.assess(design, TASK)
    return float(table[column].iloc[0])


def test_sensitivities_of_a_space_are_differences():
    table = sensitivities(SPACE, TASK, AT)
    assert list(table.columns) == ["wanted", "parameter", "value", "derivative", "relative"]
    assert len(table) == 6
    for row in table.itertuples():
        ends = [
            value(SPACE.design(**{**AT, row.parameter: AT[row.parameter] + h}), row.wanted)
            for h in (1e-6, -1e-6)
        ]
        np.testing.assert_allclose(row.value, value(SPACE.design(**AT), row.wanted), rtol=1e-12)
        np.testing.assert_allclose(row.derivative, (ends[0] - ends[1]) / 2e-6, rtol=1e-6)
        share = row.derivative * AT[row.parameter] / row.value
        np.testing.assert_allclose(row.relative, share, rtol=1e-14)


def test_sensitivities_of_a_design_are_its_gradient():
    rng = np.random.default_rng(2)
    design, pose = random_design(rng, ["D1", "D2", "D3", "D4", "D4 A1"]), random_pose(rng, (1,))
    task = gsp.Task(poses=pose, wanted="mean CTN", length=0.8)
    table = sensitivities(design, task).set_index("parameter")
    found = gradient(design.at(pose[0]), "CTN", length=0.8)
    for side in ("base", "platform"):
        for leg in range(5):
            names = [f"{side}_{axis}{leg + 1}" for axis in "xyz"]
            wanted = getattr(found, f"{side}_points")[leg]
            np.testing.assert_allclose(table.loc[names, "derivative"], wanted, rtol=1e-10)
    # Turns of a line: both derivatives together have the size of the gradient across it.
    turns = table.loc[["base_line3a", "base_line3b"], "derivative"]
    size = np.linalg.norm(found.base_directions[2])
    np.testing.assert_allclose(np.linalg.norm(turns), size, rtol=1e-10)
    relative = table["derivative"] / table["value"]
    lengths = ~table.index.str.contains("line")
    relative[lengths] *= design.rms_radius
    np.testing.assert_allclose(table["relative"], relative, rtol=1e-12)
    assert "base_line1a" not in table.index


def test_relative_sensitivities_have_no_unit():
    theirs = gsp.Task(poses=POSES.scaled(1000.0), wanted=TASK.wanted, length=800.0)
    ours = sensitivities(HEXAPOD, TASK)
    longer = sensitivities(HEXAPOD.scaled(1000.0), theirs)
    np.testing.assert_allclose(longer["relative"], ours["relative"], rtol=1e-7, atol=1e-12)


# --- Sobol indices ---


@pytest.fixture
def salib():
    """Skip a test where SALib, the extra `sensitivity`, is not installed."""
    pytest.importorskip("SALib")


# With the origin of the platform at the pose that is studied: both bodies scale about one point, so
# that |det J| is that of the unit 1, times f = 1 + x + y z.
RAISED = HEXAPOD.with_origin([0.0, 0.0, -1.5])
CLOSED = gsp.Space(
    lambda x, y, z: RAISED.scaled((1.0 + x + y * z) ** (1 / 3)),
    {"x": (-0.5, 0.5), "y": (-0.5, 0.5), "z": (-0.5, 0.5)},
)
CLOSED_TASK = gsp.Task(poses=gsp.Pose([[0.0, 0.0, 0.0]]), wanted="mean |det J|")


@pytest.mark.usefixtures("salib")
def test_sobol_indices_of_a_closed_form():
    """f = 1 + x + y z, x, y, z uniform in (−1/2, 1/2): variances 1/12 of x and 1/144 of y z."""
    table = sobol_indices(CLOSED, CLOSED_TASK, 512, seed=3).set_index("parameter")
    total = 1 / 12 + 1 / 144
    first = {"x": (1 / 12) / total, "y": 0.0, "z": 0.0}
    whole = {"x": (1 / 12) / total, "y": (1 / 144) / total, "z": (1 / 144) / total}
    for name in "xyz":
        row = table.loc[name]
        assert abs(row["first"] - first[name]) < 0.02
        assert abs(row["total"] - whole[name]) < 0.02
        assert 0.0 < row["total_confidence"] < 0.1


def test_local_sensitivity_of_the_closed_form():
    """∂f/∂x = 1, ∂f/∂y = z, ∂f/∂z = y, times |det J| of the unit 1."""
    at = {"x": 0.2, "y": 0.3, "z": -0.4}
    table = sensitivities(CLOSED, CLOSED_TASK, at)
    one = gsp.indices.manipulability(RAISED.at(gsp.Pose([0.0, 0.0, 0.0])))
    np.testing.assert_allclose(table["value"], one * (1.2 - 0.12), rtol=1e-12)
    np.testing.assert_allclose(table["derivative"], one * np.array([1.0, -0.4, 0.3]), rtol=1e-9)


@pytest.mark.usefixtures("salib")
def test_sobol_indices_of_a_family_with_a_closed_form():
    """Lee's eq. for |det J| of the 3-3 platform at the height 1, integrated by quadrature.

    |det J| ∝ a³ b³ / ((a² − a b + b²)/3 + 1)³.
    """
    space = gsp.Space(
        lambda a, b: gsp.families.lee.octahedral_3_3(a, b), {"a": (1.0, 1.4), "b": (2.0, 3.6)}
    )
    task = gsp.Task(poses=ONE_POSE, wanted="mean |det J|")
    table = sobol_indices(space, task, 256, seed=1).set_index("parameter")

    def f(a, b):
        return a**3 * b**3 / ((a**2 - a * b + b**2) / 3 + 1.0) ** 3

    nodes, weights = np.polynomial.legendre.leggauss(8)
    values = np.array([[f(1.2 + 0.2 * x, 2.8 + 0.8 * y) for y in nodes] for x in nodes])
    weights = weights / 2.0
    mean = weights @ values @ weights
    variance = weights @ values**2 @ weights - mean**2
    exact = {
        "a": (weights @ (values @ weights) ** 2 - mean**2) / variance,
        "b": (weights @ (weights @ values) ** 2 - mean**2) / variance,
    }
    ratios = [
        float(gsp.indices.manipulability(space.design(a=a, b=b).at(ONE_POSE))[0]) / f(a, b)
        for a, b in ((1.0, 2.0), (1.4, 2.5), (1.2, 3.6))
    ]
    np.testing.assert_allclose(ratios, ratios[0], rtol=1e-12)
    assert 0.05 < min(exact.values()) < max(exact.values()) < 0.95
    for name, other in (("a", "b"), ("b", "a")):
        np.testing.assert_allclose(table.loc[name, "first"], exact[name], atol=0.02)
        np.testing.assert_allclose(table.loc[name, "total"], 1.0 - exact[other], atol=0.02)


@pytest.mark.usefixtures("salib")
def test_sobol_indices_are_seeded_and_say_how_they_were_made():
    tables = [sobol_indices(SPACE, TASK, 8, seed=seed) for seed in (1, 1, 2)]
    assert tables[0].equals(tables[1])
    assert not tables[0].equals(tables[2])
    attrs = tables[0].attrs
    assert (attrs["seed"], attrs["n"], attrs["designs"]) == (1, 8, 32)
    assert attrs["version"] == gsp.__version__
    assert attrs["space"]["ranges"] == {k: list(v) for k, v in SPACE.ranges.items()}


@pytest.mark.usefixtures("salib")
def test_a_value_that_does_not_change_has_no_indices():
    space = gsp.Space(lambda k: HEXAPOD, {"k": (1.0, 2.0)})
    table = sobol_indices(space, gsp.Task(poses=ONE_POSE, wanted="mean CTN"), 8)
    assert table[["first", "total"]].isna().all(axis=None)


@pytest.mark.usefixtures("salib")
def test_a_value_that_differs_by_rounding_has_no_indices():
    """No scale of both bodies changes CTN, and |det J| is proportional to its third power."""
    space = gsp.Space(lambda k: RAISED.scaled(k), {"k": (0.5, 2.0)})
    task = gsp.Task(poses=gsp.Pose([[0.0, 0.0, 0.0]]), wanted=["mean CTN", "mean |det J|"])
    table = sobol_indices(space, task, 8).set_index("wanted")
    assert table.loc["control_number_mean", ["first", "total"]].isna().all()
    assert table.loc["manipulability_mean", ["first", "total"]].notna().all()


def failing(k):
    return gsp.hexapod(2.0, 0.3, 1.0 if k > 0.5 else -1.0, 0.4, 1.5)


CHOICES = gsp.Space(
    gsp.hexapod, {"platform_radius": (0.5, 1.5)}, {"arrangement": ["pairs", "zigzag"]},
    {"base_radius": 2.0, "base_angle": 0.3, "platform_angle": 0.4, "height": 1.5},
)  # fmt: skip
PROVEN = gsp.Task(poses=gsp.PoseBox.around(HEXAPOD.home, [0.1] * 6), wanted="proven worst CTN")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sobol_indices(CHOICES, TASK, 8), "space: expected ranges only"),
        (lambda: sobol_indices(SPACE, TASK, 12), "n: expected a power of two, received 12"),
        (lambda: sobol_indices(SPACE, TASK, 2**40), "n: .* of memory"),
        (lambda: sobol_indices(SPACE, TASK, 8, confidence=1.0), "confidence: expected"),
        (lambda: sobol_indices(SPACE, PROVEN, 8), "task.wanted: expected means"),
        (lambda: sobol_indices(gsp.Space(failing, {"k": (0.0, 1.0)}), TASK, 8),
         "space: expected a design for all parameters in the ranges, received none for"),
        (lambda: sensitivities(SPACE, TASK), "parameters: expected a value for each"),
        (lambda: sensitivities(SPACE, TASK, {1: 2}), r"parameters: expected \w+.*, received \[1\]"),
        (lambda: sensitivities(HEXAPOD, TASK, {"a": 1.0}), "parameters: expected none"),
        (lambda: sensitivities(3, TASK), "of: expected a gsp.Space or a gsp.Design"),
        (lambda: sensitivities(HEXAPOD, PROVEN), "task.wanted: expected means and worst"),
        (lambda: sensitivities(HEXAPOD, gsp.Task(poses=POSES, wanted="mean SD", length=1.0)),
         "indices with a gradient, received mean SD"),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("salib")
def test_wrong_arguments(call, message):
    with pytest.raises(InvalidInput, match=message):
        call()
