"""Optimisation: known optima, bounds, mixed spaces, fronts, resumption, bad input."""

import re

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.evaluation.parts import Parts
from gsp.exploration import optimise, pareto
from gsp.families import lee
from gsp.families.nawratil import example_set, symmetric_sets
from gsp.proof.branching import search

AT_ORIGIN = gsp.Pose([[0.0, 0.0, 0.0]])
BOTH = ("gradient", "evolution")
DESIGNS = {"gradient": 20, "evolution": 1200}


def raised(design, position):
    """A design whose pose at a position is at the origin: poses of a task are fixed."""
    return design.replace(base_points=design.base_points - position, home=None)


def octahedron(b, height):
    return raised(lee.octahedral_3_3(1.0, b), [0.0, 0.0, height])


def of_s_k(alpha, h):
    return raised(example_set.example_design(alpha), example_set.example_pose(h).position)


def of_m(z, x, y, w):
    """Two legs that the inversion exchanges, each turned three times: a part of the set M."""
    first = np.array([[1.0, 0.0, z], [x, y, w]])
    return symmetric_sets.set_m(first, -first, 3)


def best(space, wanted, method, n=None, **given):
    task = gsp.Task(poses=AT_ORIGIN, wanted=wanted, **given)
    how = {"method": method, "evaluations": n or DESIGNS[method], "starts": 2}
    table = optimise(space, task, **how)
    assert len(table) == 1
    return table.iloc[0]


@pytest.mark.parametrize("method", BOTH)
def test_gamma_of_the_octahedral_family_is_two(method):
    """Lee2000: |det J| is greatest for b = 2a, at the height a."""
    space = gsp.Space(octahedron, {"b": (1.1, 4.0), "height": (0.3, 2.0)})
    row = best(space, "mean |det J|", method)
    assert (row["b"], row["height"]) == pytest.approx((2.0, 1.0), abs=1e-6)
    assert row["manipulability_mean"] == pytest.approx(0.75 * 3**0.5, rel=1e-12)


@pytest.mark.parametrize("method", BOTH)
def test_the_best_design_of_s_k_is_k_plus(method):
    """At its maximum the control number has a kink."""
    space = gsp.Space(of_s_k, {"alpha": (0.01, 0.51), "h": (0.1, 1.0)})
    row = best(space, "mean CTN", method)
    wanted = (example_set.BEST_ALPHA, example_set.BEST_H, example_set.BEST_CONTROL_NUMBER)
    assert tuple(row[["alpha", "h", "control_number_mean"]]) == pytest.approx(wanted, abs=1e-6)


def test_the_isotropic_family_is_found():
    p = 0.8
    wanted = symmetric_sets.isotropic_parameters(p)
    ranges = {"r": (0.2, 1.0), "h": (0.3, 1.5), "t": (0.3, 1.5)}
    fixed = {"g": 3, "a": wanted["a"], "b": wanted["b"]}
    space = gsp.Space(symmetric_sets.set_n, ranges, fixed=fixed)
    row = best(space, "mean CDN_OE", "gradient", ellipsoid=gsp.Ellipsoid((1.0, 1.0, p)))
    assert row["condition_number_ellipsoid_mean"] == pytest.approx(1.0, abs=1e-6)
    assert [row[key] for key in ranges] == pytest.approx([wanted[key] for key in ranges], abs=1e-6)


def test_control_number_one_in_the_set_m():
    space = gsp.Space(of_m, {key: (-1.5, 1.5) for key in "zxyw"})
    row = best(space, "mean CTN", "gradient", n=60)
    assert row["control_number_mean"] == pytest.approx(1.0, abs=1e-6)
    # Legs of six directions in general position: not the cubic hexapod or another special one.
    design = space.design(**{key: row[key] for key in "zxyw"})
    assert gsp.indices.condition_number_plain(design.at(AT_ORIGIN)) > 1.001


@pytest.mark.parametrize("method", BOTH)
def test_the_cubic_hexapod_has_orthogonal_legs(method):
    """σ_t is at most √2; for b = a the octahedron is then a cube that stands on a vertex."""
    space = gsp.Space(octahedron, {"height": (0.2, 1.0)}, fixed={"b": 1.0})
    row = best(space, "mean σ_t", method, n=None if method == "gradient" else 600)
    assert row["height"] == pytest.approx(6**-0.5, abs=1e-6)
    directions = octahedron(1.0, row["height"]).at(AT_ORIGIN).jacobian[0, :, :3]
    cosines = abs(directions @ directions.T)
    assert np.minimum(cosines, 1.0 - cosines).max() < 1e-6


def test_the_end_of_a_range_may_be_the_end_of_the_designs():
    """α of S_K is at least 0, where it is the octahedron of side √3; Lee2000 states its |det J|."""
    space = gsp.Space(of_s_k, {"alpha": (0.0, np.pi / 6), "h": (0.8, 1.0)})
    row = best(space, "mean |det J|", "gradient")
    assert (row["alpha"], row["h"]) == pytest.approx((0.0, 0.8), abs=1e-12)
    assert row["manipulability_mean"] == pytest.approx(0.75 * 3**0.5 * (3 * 1.6 / 3.56) ** 3)
    task = gsp.Task(poses=AT_ORIGIN, wanted="mean CDN_CL", length=0.7)
    for alpha in (0.0, 0.3):
        slope = gsp.exploration.gradient(space, task, {"alpha": alpha, "h": 0.9})["alpha"].iloc[0]
        near = [
            gsp.indices.condition_number(of_s_k(alpha + s, 0.9).at(AT_ORIGIN), 0.7)[0]
            for s in (0.0, 1e-5, 2e-5)
        ]
        assert slope == pytest.approx((4 * near[1] - 3 * near[0] - near[2]) / 2e-5, rel=1e-6)


# --- several poses, bounds ---

FIXED = {"base_radius": 2.0, "base_angle": 0.3, "height": 1.5}
RANGES = {"platform_radius": (0.5, 1.5), "platform_angle": (0.1, 1.0)}
SPACE = gsp.Space(gsp.hexapod, RANGES, fixed=FIXED)
BOX = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (1.4, 1.6)], [(-0.1, 0.1)] * 3)
TASK = gsp.Task(poses=BOX, wanted={"mean CTN": 1.0, "worst CDN_CL": 2.0}, samples=20, length=0.8)


def grid_best(task, require=lambda row: True):
    """The best score on a fine grid, by `assess`."""
    ends = [np.linspace(*pair, 21) for pair in RANGES.values()]
    designs = [
        gsp.hexapod(**FIXED, platform_radius=r, platform_angle=a) for r in ends[0] for a in ends[1]
    ]
    table = gsp.exploration.assess(designs, task)
    allowed = table[[require(row) for _, row in table.iterrows()]]
    return max(merit_of(row) for _, row in allowed.iterrows())


def merit_of(row):
    return np.log(row["control_number_mean"]) - 2.0 * np.log(row["condition_number_max"])


@pytest.mark.parametrize("bound", [None, 0.335])
def test_no_design_of_a_grid_is_better(bound):
    require = None if bound is None else {"worst CTN": bound}
    watched = gsp.Task(
        poses=BOX, wanted=[*TASK.wanted, "worst CTN"], samples=20, length=0.8
    )  # fmt: skip
    grid = grid_best(watched, lambda row: bound is None or row["control_number_min"] >= bound)
    found = {}
    for method in BOTH:
        n = {"gradient": 20, "evolution": 300}[method]
        row = optimise(SPACE, TASK, method=method, require=require, evaluations=n).iloc[0]
        found[method] = merit_of(row)
        assert found[method] >= grid
        assert found[method] < grid + 0.02
        if bound is not None:
            assert bound <= row["control_number_min"] < bound + 1e-6
    assert found["gradient"] == pytest.approx(found["evolution"], abs=1e-6)


def strokes(platform_radius, platform_angle):
    design = gsp.hexapod(platform_radius=platform_radius, platform_angle=platform_angle, **FIXED)
    return design.replace(strokes=[(1.6 + 0.6 * platform_radius, 2.6)] * 6)


def test_strokes_that_change_with_the_design_hold_at_all_poses():
    space = gsp.Space(strokes, RANGES)
    task = gsp.Task(poses=BOX, wanted="worst CDN_CL", samples=20, length=0.8, limits=gsp.Limits())
    free = gsp.Task(poses=BOX, wanted="worst CDN_CL", samples=20, length=0.8)
    found = {m: optimise(space, task, method=m, evaluations=60).iloc[0] for m in BOTH}
    for row in found.values():
        assert row["feasible"] == 1.0
    values = [row["condition_number_max"] for row in found.values()]
    assert values[0] == pytest.approx(values[1], rel=1e-6)
    # The bound is active.
    best_free = optimise(space, free, evaluations=20)["condition_number_max"][0]
    assert best_free < values[0] * 0.99
    design = space.design(**found["gradient"][list(RANGES)])
    gaps = design.at(task.pose()).joints - design.strokes[:, 0]
    assert 0.0 <= gaps.min() < 1e-6


def test_certificates_as_bounds():
    task = gsp.Task(poses=BOX, wanted="mean CTN", samples=20, length=0.8)
    table = optimise(SPACE, task, certify=True, evaluations=60)
    assert table["certified"].tolist() == [True]
    design = SPACE.design(**table.iloc[0][list(RANGES)])
    assert gsp.certify(design, BOX).status == "proven"
    wide = gsp.PoseBox([(-3, 3), (-3, 3), (-1.0, 1.0)], [(-0.5, 0.5)] * 3)
    singular = gsp.Task(poses=wide, wanted="mean CTN", samples=20, length=0.8)
    with pytest.raises(InvalidInput, match=r"none; the nearest is \{'platform_radius'"):
        optimise(SPACE, singular, certify=True, evaluations=20)


def test_designs_that_cannot_be_decided_are_not_certified():
    """A box of one singular pose cannot be halved: no interrupt, and no certificate."""
    flat = gsp.PoseBox([0, 0, 0], [0, 0, 0])
    certificate = gsp.certify(SPACE.design(platform_radius=1.0, platform_angle=0.3), flat)
    assert (certificate.status, certificate.n_boxes) == ("undecided", 1)
    with pytest.raises(InvalidInput, match="none; the nearest is"):
        optimise(SPACE, gsp.Task(poses=flat, wanted="mean CTN"), certify=True, evaluations=5)


@pytest.mark.parametrize("kept", [1, 3])
def test_an_interrupted_certificate_ends_the_search(kept, tmp_path, monkeypatch):
    """`gsp.certify` returns an undecided one then, which is no verdict on the design."""
    task = gsp.Task(poses=BOX, wanted="mean CTN", samples=5, length=0.8)
    given = {"certify": True, "evaluations": 10, "workers": 1}
    whole = optimise(SPACE, task, **given)
    out, run, certificates = tmp_path / "t.parquet", search._search, []

    def stop(*words, **names):
        if len(certificates) == kept:
            raise KeyboardInterrupt
        certificates.append(1)
        return run(*words, **names)

    monkeypatch.setattr(search, "_search", stop)
    with pytest.raises(KeyboardInterrupt):
        optimise(SPACE, task, out=out, **given)
    monkeypatch.undo()
    assert not out.exists()
    again = optimise(SPACE, task, out=out, resume=True, **given)
    pd.testing.assert_frame_equal(again, whole, check_exact=True)


def test_proven_worst_values_are_required():
    task = gsp.Task(poses=BOX, wanted="mean CTN", samples=20, length=0.8)
    given = {"evaluations": 40, "budget": 200}
    free = optimise(SPACE, task, **given).iloc[0]
    row = optimise(SPACE, task, require={"proven worst CDN_CL": 3.5}, **given).iloc[0]
    box = gsp.proof.worst(SPACE.design(**row[list(RANGES)]), BOX, "CDN_CL", length=0.8, budget=200)
    assert row["condition_number_max"] <= row["condition_number_proven"] <= 3.5
    assert row["condition_number_proven"] == box["high"][0]
    assert row["control_number_mean"] <= free["control_number_mean"]


def kind(platform_radius, legs):
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    points = template.platform_points * platform_radius
    return gsp.catalogue.place(legs, template.replace(platform_points=points))


def test_mechanisms_placements_and_dimensions_together():
    names = ["D3-D3-D3-D3-D3-D3", "D1-D1-D1-D1-D1-D1", "D1-D2-D1-D2-D1-D2"]
    space = gsp.Space(kind, {"platform_radius": (0.6, 1.4)}, {"legs": names})
    home = gsp.catalogue.design("toz-kucuk-2016-d3-6").home
    task = gsp.Task(poses=home.reshape(1), wanted="mean CTN", length=95.0)
    row = optimise(space, task, method="evolution", evaluations=200).iloc[0]
    each = {
        name: optimise(gsp.Space(kind, space.ranges, fixed={"legs": name}), task, evaluations=10)
        for name in names
    }
    values = {name: table["control_number_mean"][0] for name, table in each.items()}
    assert row["legs"] == max(values, key=values.get)
    assert row["control_number_mean"] == pytest.approx(max(values.values()), rel=1e-6)


# --- fronts ---


def test_the_front_has_no_beaten_design_and_both_ends():
    pytest.importorskip("pymoo")
    table = optimise(SPACE, TASK, method="front", evaluations=400, seed=1)
    columns = ["control_number_mean", "condition_number_max"]
    assert len(table) > 5
    assert len(pareto(table, columns)) == len(table)
    for wanted, column in zip(("mean CTN", "worst CDN_CL"), columns, strict=True):
        single = gsp.Task(poses=BOX, wanted=wanted, samples=20, length=0.8)
        end = optimise(SPACE, single, evaluations=20)[column][0]
        found = table[column].max() if column.endswith("mean") else table[column].min()
        assert found == pytest.approx(end, rel=2e-3)
    assert table["rank"].min() == 1
    assert table.attrs["evaluated"] == 400


# --- resumption ---


def same(one, other):
    pd.testing.assert_frame_equal(one, other, check_exact=True)
    assert one.attrs == other.attrs


@pytest.mark.parametrize(
    ("method", "n", "kept"), [("gradient", 8, 2), ("evolution", 80, 3), ("front", 80, 2)]
)
def test_an_interrupted_search_continues_to_the_same_bits(method, n, kept, tmp_path, monkeypatch):
    if method == "front":
        pytest.importorskip("pymoo")
    given = {"method": method, "evaluations": n, "seed": 3, "starts": 2}
    whole = optimise(SPACE, TASK, **given)
    out, write, stored = tmp_path / "t.parquet", Parts.write_row, []

    def stop(parts, number, row):
        if len(stored) == kept:
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    monkeypatch.setattr(Parts, "write_row", stop)
    with pytest.raises(KeyboardInterrupt):
        optimise(SPACE, TASK, out=out, **given)
    monkeypatch.undo()
    with pytest.raises(InvalidInput, match="those of another run"):
        optimise(SPACE, TASK, out=out, resume=True, **{**given, "seed": 4})
    other = gsp.Space(gsp.hexapod, RANGES, fixed={**FIXED, "height": 1.6})
    with pytest.raises(InvalidInput, match="those of another run"):
        optimise(other, TASK, out=out, resume=True, **given)
    same(optimise(SPACE, TASK, out=out, resume=True, **given), whole)
    same(pd.read_parquet(out), whole)
    same(optimise(SPACE, TASK, out=out, resume=True, **given), whole)


def test_workers_do_not_change_the_result():
    given = {"method": "evolution", "evaluations": 60}
    same(optimise(SPACE, TASK, workers=1, **given), optimise(SPACE, TASK, workers=3, **given))


# --- gradients of tasks ---


def test_gradients_of_a_task_are_differences():
    at = {"platform_radius": 1.1, "platform_angle": 0.4}
    found = gsp.exploration.gradient(SPACE, TASK, at)
    assert found.index.tolist() == ["control_number_mean", "condition_number_max"]
    step = 1e-5
    for name in RANGES:
        ends = [
            gsp.exploration.assess(SPACE.design(**{**at, name: at[name] + s}), TASK)
            for s in (step, -step)
        ]
        for column in found.index:
            difference = (ends[0][column][0] - ends[1][column][0]) / (2 * step)
            assert found.loc[column, name] == pytest.approx(difference, rel=1e-7)
            here = gsp.exploration.assess(SPACE.design(**at), TASK)[column][0]
            assert found.loc[column, "value"] == pytest.approx(here, rel=1e-12)


def lengthened(size):
    return gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5).replace(characteristic_length=size)


def test_a_length_of_the_design_may_be_a_parameter():
    space = gsp.Space(lengthened, {"size": (0.2, 2.0)})
    task = gsp.Task(poses=gsp.Pose([[0.1, 0.2, 1.5]]), wanted="mean CDN_CL")
    found = gsp.exploration.gradient(space, task, {"size": 0.7})
    posture = lengthened(0.7).at(task.pose())
    ends = [gsp.indices.condition_number(posture, 0.7 + s)[0] for s in (1e-5, -1e-5)]
    slope = found.loc["condition_number_mean", "size"]
    assert slope == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-8)
    fixed = gsp.Task(poses=task.poses, wanted="mean CDN_CL", length=0.7)
    still = gsp.exploration.gradient(space, fixed, {"size": 0.5})
    assert still.loc["condition_number_mean", "size"] == pytest.approx(0.0, abs=1e-12)


# --- nothing to return ---


def coincident(x):
    """Without values below x = 0.5, where the anchor points of the legs coincide."""
    points = gsp.hexapod(1.0, 0.3, 0.7, 0.5, 1.0).platform_points
    moved = points if x < 0.5 else points * x + [0.0, 0.0, 1.0]
    return gsp.Design(legs=["D1"] * 6, base_points=points, platform_points=moved)


ORIGIN = gsp.Task(poses=gsp.Pose([[0.0, 0.0, 0.0]]), wanted=["mean CTN", "mean CDN_CL"], length=0.7)


@pytest.mark.parametrize("method", ["gradient", "evolution", "front"])
def test_designs_without_values_are_never_the_best(method):
    if method == "front":
        pytest.importorskip("pymoo")
    low, all_x = (gsp.Space(coincident, {"x": (0.1, top)}) for top in (0.4, 0.9))
    message = r"undefined for all \d+ designs; mean CTN and mean CDN_CL of the first, .*coincide"
    with pytest.raises(InvalidInput, match=message):
        optimise(low, ORIGIN, method=method, evaluations=8)
    table = optimise(all_x, ORIGIN, method=method, evaluations=8)
    assert table[["score", "control_number_mean", "condition_number_mean"]].notna().all(axis=None)


def test_the_nearest_design_says_what_it_misses():
    limits = gsp.Limits(strokes=[[50.0, 60.0]] * 6, leg_radius=1e-3)  # no climb
    space = gsp.Space(coincident, {"x": (0.6, 0.9)})
    task = gsp.Task(poses=ORIGIN.poses, wanted="mean CTN", limits=limits, length=0.7)
    with pytest.raises(InvalidInput) as error:
        optimise(space, task, method="evolution", evaluations=5)
    found = re.search(r"'x': (\S+)}: 0 % .*, of 100 % .*: d\d = (\S+) < 50 at", str(error.value))
    design = coincident(float(found[1]))
    legs = np.linalg.norm(design.platform_points - design.base_points, axis=1)
    assert float(found[2]) == pytest.approx(legs.min(), rel=1e-5)
    with pytest.raises(InvalidInput, match="no pose is within the limits"):
        optimise(space, task, method="evolution", evaluations=5, feasible=0.0)


# --- bad input ---


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"method": "newton"}, "method: expected"),
        ({"feasible": 1.5}, r"feasible: expected a share in \[0, 1\]"),
        ({"evaluations": 0}, "evaluations: expected"),
        ({"starts": 0}, "starts: expected"),
        ({"seed": -1}, "seed: expected"),
        ({"require": {"best CTN": 0.2}}, "require: expected"),
        ({"require": {"worst CTN": -0.2}}, r"require\['worst CTN'\]: expected"),
        ({"require": [0.2]}, "require: expected"),
        ({"method": "gradient", "certify": True}, "certificates have no gradient"),
        ({"method": "gradient", "require": {"proven worst CTN": 0.1}}, "means and worst values"),
        (
            {"require": {"worst CTN": 0.99}, "evaluations": 2, "starts": 1},
            r"none; the nearest is .*}: worst CTN is 0\.\d+, at least 0.99 is required",
        ),
        ({"resume": True}, "resume: expected"),
    ],
)
def test_bad_calls(given, message):
    with pytest.raises(InvalidInput, match=message):
        optimise(SPACE, TASK, **{"evaluations": 20, **given})


def test_what_has_no_gradient_is_named():
    cases = [
        (gsp.Task(poses=BOX, wanted="mean SD", length=1.0), "indices with a gradient"),
        (gsp.Task(poses=BOX, wanted="mean CTN", limits=gsp.Limits(leg_radius=0.1)), "leg_radius"),
        (gsp.Task(poses=BOX, wanted="proven worst CTN"), "means and worst values"),
    ]
    for task, message in cases:
        with pytest.raises(InvalidInput, match=message):
            optimise(SPACE, task, method="gradient")
    choices = gsp.Space(gsp.hexapod, choices={"height": [1.0, 2.0]}, fixed={
        "base_radius": 2.0, "base_angle": 0.3, "platform_radius": 1.0, "platform_angle": 0.4,
    })  # fmt: skip
    with pytest.raises(InvalidInput, match="at least one range"):
        gsp.exploration.gradient(choices, TASK, {"height": 1.0})
    with pytest.raises(MissingParameter):
        optimise(SPACE, gsp.Task(poses=BOX, wanted="mean CDN_CL"), evaluations=5)
    with pytest.raises(InvalidInput, match="a PoseBox, as certificates"):
        optimise(SPACE, gsp.Task(poses=AT_ORIGIN, wanted="mean CTN"), certify=True)
