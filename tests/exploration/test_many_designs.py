"""Many designs at few poses, several at a time: the bits of each alone."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.evaluation import request as requests
from gsp.evaluation.parts import Parts
from gsp.exploration import assess, assessing, explore
from gsp.exploration.exploring import designs_of
from gsp.limits import feasible
from gsp.model.design.anchored import PARAMETERS
from gsp.ranking import restrictions

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")


def mixed(platform_radius, legs):
    """A placement on anchors of another size, with strokes where it has no angles."""
    points = TEMPLATE.platform_points * platform_radius
    return gsp.catalogue.place(legs, TEMPLATE.replace(platform_points=points))


SPACE = gsp.Space(
    mixed,
    {"platform_radius": (0.8, 1.2)},
    {"legs": ["D1-D1-D1-D1-D1-D1", "D1-D2-D1-D4A1-D3-0", "A1-A1-A1-D4-D4-D4"]},
)
AROUND = gsp.PoseBox.around(TEMPLATE.home, [9, 9, 9, 0.2, 0.2, 0.2]).sample(40, rng=1)
# One pose is singular: all legs are vertical, as the platform is above the base without a turn.
POSES = gsp.Pose(
    np.concatenate((AROUND.position, [[0.0, 0.0, 1e6]])),
    np.concatenate((AROUND.rotation, [np.eye(3)])),
)
WANTED = ["mean CTN", "worst CDN_CL", "worst σ_min", "mean |det J|"]
TASK = gsp.Task(
    poses=POSES, wanted=WANTED[:3], length=80.0, limits=gsp.Limits(indices="CDN_CL <= 1e4")
)


def same(one, other):
    pd.testing.assert_frame_equal(one, other, check_exact=True)
    assert one.attrs == other.attrs


def test_statistics_are_those_of_single_evaluations():
    """To the last bit, of designs of several kinds of legs, with undefined and singular poses."""
    table = explore(SPACE, TASK, 24, seed=3)
    for _, row in table.iterrows():
        design = SPACE.design(platform_radius=row["platform_radius"], legs=row["legs"])
        used = gsp.feasible(design, POSES, TASK.limits).ok
        values = gsp.evaluate(design, POSES, list(TASK.indices), length=80.0)[used]
        for name in TASK.indices:
            known = np.sort(values[name].dropna().to_numpy())
            places = np.rint(np.multiply((0.0, 0.05, 0.5, 0.95, 1.0), len(known) - 1)).astype(int)
            found = [row[f"{name}_{end}"] for end in ("min", "q05", "median", "q95", "max")]
            assert found == known[places].tolist()
            assert row[f"{name}_mean"] == values[name].dropna().to_numpy().mean()
        assert row["feasible"] == used.mean()


@pytest.mark.parametrize("together", [1, 100, 10**6])
def test_the_number_that_is_evaluated_at_once_changes_no_bit(together, monkeypatch):
    whole = explore(SPACE, TASK, 7, seed=3, workers=1)
    monkeypatch.setattr(requests, "LEAST_POSES_PER_BLOCK", together)
    same(explore(SPACE, TASK, 7, seed=3, workers=3), whole)
    with ThreadPoolExecutor(2) as pool:
        same(explore(SPACE, TASK, 7, seed=3, executor=pool), whole)


def mark(workers=None):
    designs, _ = designs_of(SPACE, SPACE.sample(5, seed=3))
    chosen, proofs = assessing.checked(designs, TASK, 1e-3, None)
    run = assessing.Run(workers=workers, executor=None, out=None, parts=None, resume=False)
    request, _ = assessing.requested(chosen, TASK, run, False)
    return assessing.fingerprint(request, TASK, proofs, {})


def test_tables_are_known_by_their_data_and_not_by_how_they_are_computed(monkeypatch):
    alone = mark(workers=1)
    monkeypatch.setattr(requests, "POSES_PER_BLOCK", 7)
    monkeypatch.setattr(requests, "LEAST_POSES_PER_BLOCK", 3)
    assert mark(workers=2) == alone


def test_an_interrupted_exploration_resumes_with_other_blocks(tmp_path, monkeypatch):
    whole, out = explore(SPACE, TASK, 7, seed=3), tmp_path / "t.parquet"
    write, stored = Parts.write_row, []

    def stop(parts, number, row):
        if len(stored) == 3:
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    monkeypatch.setattr(Parts, "write_row", stop)
    with pytest.raises(KeyboardInterrupt):
        explore(SPACE, TASK, 7, seed=3, out=out, workers=1)
    monkeypatch.undo()
    assert len(stored) == 3
    monkeypatch.setattr(requests, "POSES_PER_BLOCK", 16)
    same(explore(SPACE, TASK, 7, seed=3, out=out, resume=True, workers=2), whole)


def test_limits_are_evaluated_once_for_each_design(monkeypatch):
    """For the shares of all kinds and for the forces, also where some designs have no strokes."""
    evaluated = []

    def counted(design, pose, limits=None):
        evaluated.append(design.name)
        return feasible(design, pose, limits)

    monkeypatch.setattr(restrictions, "feasible", counted)
    one = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=[1.6, 2.4])
    designs = [one, one.replace(name="free", strokes=None)]
    limits = gsp.Limits(platform_cone=0.3, position=[[-0.1, 0.2], [-1, 1], [0, 9]])
    task = gsp.Task(
        poses=gsp.PoseBox([(-0.3, 0.3), (-0.3, 0.3), (1.3, 1.7)], [(-0.3, 0.3)] * 3),
        wanted="mean CTN", samples=60, limits=limits, payload=gsp.statics.Masses(platform=5.0),
    )  # fmt: skip
    table = assess(designs, task, workers=1).set_index("design")
    assert sorted(evaluated) == sorted(design.name for design in designs)
    for design in designs:
        found, row = feasible(design, task.pose(), limits), table.loc[design.name]
        assert 0.0 < row["feasible"] == found.ok.mean() < 1.0
        for kind in ("joint", "position", "cone"):
            values = found.values[:, [k == kind for k in found.kinds]]
            low, high = (end[[k == kind for k in found.kinds]] for end in (found.low, found.high))
            wrong = ((values < low) | (values > high)).any(axis=1)
            assert row[f"violated_{kind}"] == wrong.mean()
        forces = design.at(task.pose()[found.ok]).actuator_forces([0, 0, 5.0 * 9.81, 0, 0, 0])
        np.testing.assert_allclose(row["actuator_force"], np.abs(forces).max(), rtol=1e-12)
    assert table.loc[one.name, "within_strokes"] == gsp.feasible(one, task.pose()).ok.mean()
    assert np.isnan(table.loc["free", "within_strokes"])
    assert table.loc["free", "violated_joint"] == 0.0
    # Other strokes than those of the design are another question.
    evaluated.clear()
    other = replace(task, limits=gsp.Limits(strokes=[[1.65, 2.3]] * 6))
    row = assess(one, other, workers=1).iloc[0]
    assert len(evaluated) == 2
    ends = feasible(one, task.pose()), feasible(one, task.pose(), other.limits)
    assert [row["within_strokes"], row["feasible"]] == [found.ok.mean() for found in ends]
    assert row["feasible"] < row["within_strokes"]


def test_designs_are_made_once_each():
    made = []

    def make(platform_radius):
        made.append(platform_radius)
        return gsp.hexapod(2.0, 0.3, platform_radius, 0.4, 1.5)

    space = gsp.Space(make, {"platform_radius": (0.5, 1.5)})
    box = gsp.PoseBox([(-0.1, 0.1), 0, (1.4, 1.6)], [0, 0, 0])
    table = explore(space, gsp.Task(poses=box, wanted="mean CTN", samples=5), 6, seed=0)
    assert made == table["platform_radius"].tolist()


def test_a_renamed_design_is_the_same_in_all_else():
    design = gsp.catalogue.instantiate(gsp.catalogue.mechanism("D1 D2 D3 D4 A1^2"), TEMPLATE)
    before = design.rows, design.rms_radius
    other = design.replace(name="other")
    again = gsp.Design(
        **{key: getattr(design, key) for key in PARAMETERS if key != "name"}, name="other"
    )
    for key in PARAMETERS:
        one, two = getattr(other, key), getattr(again, key)
        np.testing.assert_array_equal(one, two, err_msg=key)
    assert design.name != other.name == "other"
    assert (other.rows, other.rms_radius) == before
    assert not other.base_points.flags.writeable
    with pytest.raises(gsp.GspError, match="name"):
        design.replace(name=3)
