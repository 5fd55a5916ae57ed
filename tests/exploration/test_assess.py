"""Designs assessed for a task: columns, score, proofs, resumption, and bad input."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.evaluation.parts import Parts
from gsp.exploration import Wanted, assess
from gsp.exploration.toml import record_of

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
DESIGNS = [
    TEMPLATE,
    *gsp.catalogue.placements(gsp.catalogue.mechanism("D1^4 D2^2"), TEMPLATE)[:4],
    gsp.catalogue.instantiate(gsp.catalogue.mechanism("D1 D2 D3 D4 A1^2"), TEMPLATE),
]
BOX = gsp.PoseBox.around(TEMPLATE.home, [5, 5, 5, 0.03, 0.03, 0.03])
WANTED = {"mean CTN": 2.0, "worst CDN_CL": 1.0}
TASK = gsp.Task(poses=BOX, wanted=WANTED, samples=50, seed=4, length=80.0)


def same(one, other):
    pd.testing.assert_frame_equal(one, other, check_exact=True)
    assert one.attrs == other.attrs


def test_columns_are_those_of_single_evaluations():
    table = assess(DESIGNS, TASK)
    assert sorted(table["design"]) == sorted(design.name for design in DESIGNS)
    for design in DESIGNS:
        row = table.set_index("design").loc[design.name]
        values = gsp.evaluate(design, BOX.sample(50, rng=4), ["CTN", "CDN_CL"], length=80.0)
        assert row["control_number_mean"] == pytest.approx(values["control_number"].mean())
        assert row["condition_number_max"] == values["condition_number"].max()
    assert table.attrs["task"] == record_of(TASK)
    assert table.attrs["library"].startswith("gsp ")
    assert (table.attrs["by"], table.attrs["length"]) == ("score", 80.0)


def test_the_score_is_the_weighted_geometric_mean():
    table = assess(DESIGNS, TASK)
    ctn = table["control_number_mean"] / table["control_number_mean"].max()
    cdn = table["condition_number_max"].min() / table["condition_number_max"]
    np.testing.assert_allclose(table["score"], (ctn**2 * cdn) ** (1 / 3), rtol=1e-12)
    assert table["score"].is_monotonic_decreasing
    assert list(table["rank"]) == sorted(table["rank"])
    few = assess(DESIGNS[1:4], TASK)
    kept = table[table["design"].isin(few["design"])]
    assert list(kept["design"]) == list(few["design"])  # whatever the others are


def test_units_do_not_change_the_order():
    small = gsp.PoseBox.around(TEMPLATE.home.scaled(0.001), [0.005] * 3 + [0.03] * 3)
    task = gsp.Task(poses=small, wanted=["mean σ_min", "worst CTN"], samples=20, unit="m")
    large = gsp.Task(poses=BOX, wanted=["mean σ_min", "worst CTN"], samples=20, unit="mm")
    in_metres = assess([gsp.ranking.in_unit(d, "m") for d in DESIGNS], task)
    table = assess(DESIGNS, large)
    assert list(in_metres["design"]) == list(table["design"])
    np.testing.assert_allclose(in_metres["score"], table["score"], rtol=1e-9)


def test_proven_worst_values_are_those_of_the_proof():
    task = gsp.Task(
        poses=BOX, wanted=[Wanted("CTN", "proven worst"), Wanted("CDN_CL", "proven worst"),
                           "mean CTN"],
        samples=50, length=80.0,
    )  # fmt: skip
    table = assess(DESIGNS[1:4], task, budget=300, tolerance=0.1).set_index("design")
    for name, bound, found in (("CTN", "low", "high"), ("CDN_CL", "high", "low")):
        wanted = gsp.proof.worst(DESIGNS[1:4], BOX, name, 0.1, length=80.0, budget=300)
        index = {"CTN": "control_number", "CDN_CL": "condition_number"}[name]
        mine = table.loc[wanted["design"]]
        np.testing.assert_array_equal(mine[f"{index}_proven"], wanted[bound])
        np.testing.assert_array_equal(mine[f"{index}_found"], wanted[found])
        np.testing.assert_array_equal(mine[f"{index}_closed"], wanted["closed"])
    # No pose of the sample is worse than what is proven.
    assert (table["control_number_proven"] <= table["control_number_min"]).all()
    assert (table["condition_number_proven"] >= table["condition_number_max"]).all()


@pytest.mark.parametrize("kept", [3, 8])
def test_an_interrupted_run_resumes_to_the_same_bits(kept, tmp_path, monkeypatch):
    """Stopped while the statistics of 4 designs are stored, and while their proofs are."""
    task = gsp.Task(
        poses=BOX, wanted=["mean CTN", "proven worst CTN", "proven worst CDN_CL"], samples=30
    )
    whole = assess(DESIGNS[:4], task, budget=50)
    out, write, stored = tmp_path / "t.parquet", Parts.write_row, []

    def stop(parts, number, row):
        if len(stored) == kept:
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    monkeypatch.setattr(Parts, "write_row", stop)
    with pytest.raises(KeyboardInterrupt):
        assess(DESIGNS[:4], task, budget=50, out=out, workers=1)
    monkeypatch.undo()
    with pytest.raises(InvalidInput, match="those of another run"):
        assess(DESIGNS[:4], task, budget=51, out=out, resume=True)
    resumed = assess(DESIGNS[:4], task, budget=50, out=out, resume=True)
    same(resumed, whole)
    same(pd.read_parquet(out), whole)
    same(assess(DESIGNS[:4], task, budget=50, out=out, resume=True), whole)
    assert [path.name for path in tmp_path.iterdir()] == ["t.parquet"]


def test_workers_and_executors_change_nothing():
    task = gsp.Task(poses=BOX, wanted=["worst CTN", "proven worst CTN"], samples=30)
    alone = assess(DESIGNS[:3], task, budget=50, workers=1)
    same(assess(DESIGNS[:3], task, budget=50, workers=3), alone)
    with ThreadPoolExecutor(2) as pool:
        same(assess(DESIGNS[:3], task, budget=50, executor=pool), alone)


def test_limits_leave_poses_out():
    joints = TEMPLATE.at(BOX.sample(200, rng=0)).joints
    strokes = np.stack([np.full(6, 0.0), np.quantile(joints, 0.9, axis=0)], axis=1)
    limits = gsp.Limits(strokes=strokes)
    task = gsp.Task(poses=BOX, wanted=WANTED, limits=limits, samples=200)
    row = assess(TEMPLATE, task).iloc[0]
    pose = task.pose()
    ok = gsp.feasible(TEMPLATE, pose, limits).ok
    values = gsp.evaluate(TEMPLATE, pose[ok], ["CTN", "CDN_CL"])
    assert 0.1 < row["feasible"] == ok.mean() < 0.9
    assert row["control_number_mean"] == pytest.approx(values["control_number"].mean())
    assert row["condition_number_max"] == values["condition_number"].max()


def test_violations_are_counted_per_kind_of_limit():
    low, high = TEMPLATE.home.position - 1.0, TEMPLATE.home.position + 4.0
    joints = TEMPLATE.at(BOX.sample(200, rng=0)).joints
    strokes = np.stack([np.full(6, 0.0), np.quantile(joints, 0.9, axis=0)], axis=1)
    limits = gsp.Limits(strokes=strokes, position=np.stack((low, high), axis=1))
    row = assess(TEMPLATE, gsp.Task(poses=BOX, wanted=WANTED, limits=limits, samples=200)).iloc[0]
    position = BOX.sample(200, rng=0).position
    outside = ((position < low) | (position > high)).any(axis=1)
    beyond = (joints > strokes[:, 1]).any(axis=1)
    assert row["violated_position"] == outside.mean() > 0.1
    assert row["violated_joint"] == beyond.mean() > 0.1
    assert row["feasible"] == (~(outside | beyond)).mean()
    assert {name for name in row.index if name.startswith("violated")} == {
        "violated_joint",
        "violated_position",
    }
    assert not any(name.startswith("violated") for name in assess(TEMPLATE, TASK))


def test_the_greatest_actuator_forces_balance_the_loads():
    """By solving Jᵀ f = −w at each pose, with the weight as a force at its arm."""
    centre, wrench = np.array([3.0, -2.0, 40.0]), np.array([10.0, 0.0, -50.0, 0.0, 300.0, 0.0])
    masses = gsp.statics.Masses(platform=60.0, centre=centre)
    task = gsp.Task(poses=BOX, wanted=WANTED, samples=50, payload=masses, wrench=wrench)
    table = assess(DESIGNS, task).set_index("design")
    pose = task.pose()
    weight = np.array([0.0, 0.0, -9.81 * 60.0])
    arms = np.einsum("nij,j->ni", pose.rotation, centre)
    loads = wrench + np.hstack((np.tile(weight, (50, 1)), np.cross(arms, weight)))
    for design in DESIGNS:
        transposed = np.swapaxes(design.at(pose).jacobian, -1, -2)
        forces = np.abs(np.linalg.solve(transposed, -loads[..., None])[..., 0])
        row = table.loc[design.name]
        linear = design.angular.astype(bool)
        assert row["actuator_force"] == pytest.approx(forces[:, ~linear].max(), rel=1e-9)
        if linear.any():
            assert row["actuator_torque"] == pytest.approx(forces[:, linear].max(), rel=1e-9)
        else:
            assert np.isnan(row["actuator_torque"])
    assert "actuator_force" not in assess(TEMPLATE, TASK)


def test_forces_at_poses_that_are_singular_or_violate_limits():
    flat = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    poses = gsp.Pose([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    wrench = [0.0, 0.0, -60.0, 0.0, 0.0, 0.0]
    task = gsp.Task(poses=poses, wanted="mean CTN", wrench=wrench)
    assert assess(flat, task)["actuator_force"][0] == np.inf
    above = gsp.Limits(position=[None, None, (0.5, 2.0)])
    task = gsp.Task(poses=poses, wanted="mean CTN", wrench=wrench, limits=above)
    row = assess(flat, task).iloc[0]
    # Six equal legs, each with a sixth of the force along z.
    length = flat.at(poses[1]).joints[0]
    assert row["actuator_force"] == pytest.approx(10.0 * length)
    nowhere = gsp.Limits(position=[None, None, (5.0, 6.0)])
    task = gsp.Task(poses=poses, wanted="mean CTN", wrench=wrench, limits=nowhere)
    assert np.isnan(assess(flat, task)["actuator_force"][0])


def test_masses_that_do_not_fit_the_legs_are_refused_before_the_work():
    masses = gsp.statics.Masses(lower=[1.0, 2.0, 3.0])
    task = gsp.Task(poses=BOX, wanted=WANTED, payload=masses)
    with pytest.raises(InvalidInput, match=r"masses\.lower: expected one number, or 6"):
        assess(DESIGNS, task)


def test_a_task_that_no_design_meets():
    task = gsp.Task(poses=BOX, wanted=WANTED, limits=gsp.Limits(strokes=[[1, 2]] * 6), samples=20)
    table = assess(DESIGNS[:3], task)
    assert (table["feasible"] == 0.0).all()
    assert table["score"].isna().all()
    assert table["rank"].isna().all()
    own = gsp.Task(poses=BOX, wanted=WANTED, limits=gsp.Limits(), samples=20)
    few = [DESIGNS[i].replace(strokes=[[1.0, top]] * 6) for i, top in enumerate((2.0, 900.0))]
    some = assess(few, own)
    assert some["rank"].fillna(0.0).tolist() == [1.0, 0.0]
    assert some["score"].isna().tolist() == [False, True]


def test_singular_designs_have_score_zero():
    flat = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    pose = gsp.Pose([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    task = gsp.Task(poses=pose, wanted=["worst CTN"])
    good = gsp.Task(poses=pose[1:], wanted=["worst CTN"])
    assert assess(flat, task)["score"].tolist() == [0.0]
    assert assess(flat, good)["score"].tolist() == [1.0]


def test_paths_and_batches():
    end = gsp.Pose(TEMPLATE.home.position + [0.0, 0.0, 10.0], TEMPLATE.home.rotation)
    nodes = gsp.Pose(
        np.stack((TEMPLATE.home.position, end.position)),
        np.stack((TEMPLATE.home.rotation, end.rotation)),
    )
    path = gsp.Task(poses=gsp.PosePath.through(nodes), wanted="mean CTN", samples=3)
    batch = gsp.Task(poses=path.pose(), wanted="mean CTN")
    one, other = (assess(DESIGNS, task)["control_number_mean"] for task in (path, batch))
    np.testing.assert_array_equal(one, other)


def test_bad_input():
    with pytest.raises(InvalidInput, match=r"task: expected a gsp\.Task"):
        assess(DESIGNS, BOX)
    with pytest.raises(InvalidInput, match=r"the unit of the task, 'm' \(.*\), received 'mm'"):
        assess(DESIGNS, gsp.Task(poses=BOX, wanted="mean CTN", unit="m"))
    with pytest.raises(InvalidInput, match="designs: expected at least one design"):
        assess([], TASK)
    with pytest.raises(InvalidInput, match="one unit for all designs"):
        assess(DESIGNS, gsp.Task(poses=BOX, wanted="mean |det J|"))
    lineless = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    with pytest.raises(MissingParameter):
        assess(lineless, gsp.Task(poses=gsp.Pose([[0, 0, 1.0]]), wanted="mean CDN_CL"))
    with pytest.raises(InvalidInput, match="budget"):
        assess(DESIGNS, TASK, budget=0)
    with pytest.raises(InvalidInput, match="resume: expected out="):
        assess(DESIGNS, TASK, resume=True)
