"""Volumes of workspaces that a task asks for: brackets, scores, optimisation, and bad input."""

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.errors import InvalidInput, MissingParameter
from gsp.evaluation.parts import Parts
from gsp.exploration import Wanted, assess, explore, optimise, pareto
from gsp.exploration.toml import record_of

HEXAPOD = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=[1.4, 2.4])
LEVEL = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (1.4, 1.6)], [0, 0, 0])
TILTED = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (1.4, 1.6)], [(-0.1, 0.1)] * 3)


def task(box=LEVEL, wanted="volume dextrous", resolution=0.4, **given):
    return gsp.Task(poses=box, wanted=wanted, samples=5, resolution=resolution, **given)


def hexapods(longest):
    return gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=[1.4, longest])


SPACE = gsp.Space(hexapods, {"longest": (1.9, 2.4)})


@pytest.mark.parametrize("workspace", ["reachable", "dextrous"])
def test_a_bracket_holds_the_exact_volume_of_one_orientation(workspace):
    """Spherical shells, on the side of the base on which the box is."""
    angles = [0.1, -0.2, 0.3]
    turned = gsp.PoseBox(LEVEL.low[:3].tolist(), angles)
    exact = gsp.workspace.exact_shells(HEXAPOD, gsp.Pose.from_rpy([0, 0, 0], angles).rotation)
    volume = exact.volume((0.0, np.inf)).value
    rows = [
        assess(HEXAPOD, task(turned, f"volume {workspace}", resolution)).iloc[0]
        for resolution in (0.4, 0.2)
    ]
    for row, resolution in zip(rows, (0.4, 0.2), strict=True):
        low, high = row[f"{workspace}_volume_low"], row[f"{workspace}_volume_high"]
        assert low <= volume <= high
        assert 0.0 < row[f"{workspace}_volume_resolution"] <= resolution
    ends = np.array([[row[f"{workspace}_volume_{end}"] for end in ("low", "high")] for row in rows])
    assert ends[1, 1] - ends[1, 0] < ends[0, 1] - ends[0, 0]


def test_samples_of_positions_agree_with_the_brackets():
    """Positions of a box, each with a grid of orientations, of which all or some are feasible."""
    rng = np.random.default_rng(2)
    low, high = np.array([-1.5, -1.5, 0.0]), np.array([1.5, 1.5, 2.5])
    position = rng.uniform(low, high, (4000, 3))
    angles = np.stack(np.meshgrid(*[[-0.1, 0.0, 0.1]] * 3), axis=-1).reshape(-1, 3)
    poses = gsp.Pose.from_rpy(np.repeat(position, len(angles), axis=0), np.tile(angles, (4000, 1)))
    ok = gsp.feasible(HEXAPOD, poses).ok.reshape(4000, -1)
    row = assess(HEXAPOD, task(TILTED, ["volume dextrous", "volume reachable"])).iloc[0]
    size = float(np.prod(high - low))
    sides = (
        (ok.all(axis=1), "dextrous_volume_low", 1),
        (ok.any(axis=1), "reachable_volume_high", -1),
    )
    for found, end, sign in sides:
        share, error = found.mean(), found.std() / np.sqrt(len(found))
        assert sign * (row[end] - size * share) <= 4.0 * size * error
    assert row["dextrous_volume_high"] <= row["reachable_volume_high"]


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_a_change_of_the_unit_multiplies_volumes_by_its_cube(factor):
    low, high = factor * LEVEL.low[:3], factor * LEVEL.high[:3]
    box = gsp.PoseBox(np.stack((low, high), axis=1), [0, 0, 0])
    one = assess(HEXAPOD, task()).iloc[0]
    other = assess(HEXAPOD.scaled(factor), task(box, resolution=0.4 * factor)).iloc[0]
    for end in ("low", "high"):
        column = f"dextrous_volume_{end}"
        assert other[column] == pytest.approx(one[column] * factor**3, rel=1e-6)


def test_the_side_of_the_base_is_that_of_the_box():
    below = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (-1.6, -1.4)], [0, 0, 0])
    one, other = assess(HEXAPOD, task()).iloc[0], assess(HEXAPOD, task(below)).iloc[0]
    for end in ("low", "high"):  # the mirror image in the plane of the base
        column = f"dextrous_volume_{end}"
        assert other[column] == pytest.approx(one[column], rel=1e-6)


def test_the_score_takes_the_least_volume():
    wanted = {"volume dextrous": 2.0, "mean CTN": 1.0}
    table = assess([hexapods(2.0), hexapods(2.3)], task(wanted=wanted)).set_index("design")
    volume, index = table["dextrous_volume_low"], table["control_number_mean"]
    best = (volume / volume.max()) ** (2 / 3) * (index / index.max()) ** (1 / 3)
    np.testing.assert_allclose(table["score"], best, rtol=1e-12)
    assert table.attrs["task"]["resolution"] == 0.4
    assert table.attrs["cells"] == 6_000_000
    assert {wish["of"] for wish in table.attrs["task"]["wanted"]} == {"volume", "mean"}


def test_limits_of_the_task_count():
    strokes = gsp.Limits(strokes=[[1.5, 2.2]] * 6)
    free, limited = assess(HEXAPOD, task()).iloc[0], assess(HEXAPOD, task(limits=strokes)).iloc[0]
    assert limited["dextrous_volume_high"] <= free["dextrous_volume_high"]


def test_an_interrupted_exploration_resumes_to_the_same_bits(tmp_path, monkeypatch):
    wish = task(wanted=["mean CTN", "volume dextrous", "volume reachable"], resolution=0.8)
    whole, out = explore(SPACE, wish, 3, seed=1), tmp_path / "t.parquet"
    write, stored = Parts.write_row, []

    def stop(parts, number, row):
        if len(stored) == 5:  # the rows of three designs, and the volumes of two
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    monkeypatch.setattr(Parts, "write_row", stop)
    with pytest.raises(KeyboardInterrupt):
        explore(SPACE, wish, 3, seed=1, out=out, workers=1)
    monkeypatch.undo()
    with pytest.raises(InvalidInput, match="those of another run"):
        explore(SPACE, task(wanted=wish.wanted, resolution=0.3), 3, seed=1, out=out, resume=True)
    found = explore(SPACE, wish, 3, seed=1, out=out, resume=True)
    pd.testing.assert_frame_equal(found, whole, check_exact=True)
    assert found.attrs == whole.attrs


def test_volumes_are_objectives_and_bounds_of_an_optimisation():
    """The volume grows with the stroke, and so do the bounds of the bracket."""
    wish = task(resolution=0.6)
    table = explore(SPACE, wish, 4, seed=1).sort_values("longest")
    assert table["dextrous_volume_high"].is_monotonic_increasing
    best = optimise(SPACE, wish, evaluations=8, seed=1)
    assert best["score"].iloc[0] == 1.0
    assert best["dextrous_volume_low"].iloc[0] >= table["dextrous_volume_low"].median()
    bound = 2.0 * float(best["dextrous_volume_high"].iloc[0])
    other = gsp.Task(poses=LEVEL, wanted="mean CTN", samples=5)
    with pytest.raises(InvalidInput, match="a space and bounds that a design"):
        optimise(SPACE, other, require={"volume dextrous": bound}, evaluations=2, budget=500)


class Counting(ThreadPoolExecutor):
    """Counts the tasks that it gets, and states what they compute."""

    def __init__(self):
        super().__init__(1)
        self.done = []

    def submit(self, function, /, *given):
        self.done.append(function.__name__)
        return super().submit(function, *given)


def test_volumes_and_certificates_run_on_an_executor():
    """One task per design, with arguments that other processes can take."""
    wish = task(wanted=["mean CTN", "volume dextrous"], resolution=0.8)
    whole = explore(SPACE, wish, 3, seed=1)
    with Counting() as executor:
        found = explore(SPACE, wish, 3, seed=1, executor=executor)
        pd.testing.assert_frame_equal(found, whole, check_exact=True)
        assert executor.done.count("_volume") == 3
        limits = gsp.Limits()
        sure = gsp.Task(poses=LEVEL, wanted="mean CTN", samples=5, limits=limits)
        options = {"certify": True, "method": "evolution", "evaluations": 10, "seed": 1}
        best = optimise(SPACE, sure, executor=executor, **options)
        assert executor.done.count("_proved") > 1
    again = optimise(SPACE, sure, **options)
    pd.testing.assert_frame_equal(best, again, check_exact=True)
    assert best["certified"].all()
    assert record_of(pickle.loads(pickle.dumps(wish))) == record_of(wish)


def test_a_bound_on_a_volume_has_the_resolution_of_the_task():
    """Also where no volume is among what is wanted."""
    for resolution in (0.4, 0.2):
        wish = task(wanted="mean CTN", resolution=resolution)
        bound = {"volume reachable": 1e-5}
        row = optimise(SPACE, wish, method="evolution", evaluations=2, require=bound).iloc[0]
        assert resolution / 2 < row["reachable_volume_resolution"] <= resolution
        assert row["reachable_volume_low"] >= 1e-5


def test_volumes_are_objectives_of_fronts():
    columns = {"reachable_volume_low": [1.0, 2.0, 1.5], "control_number_mean": [0.3, 0.1, 0.05]}
    table = pd.DataFrame(columns)
    assert pareto(table, list(table)).index.tolist() == [0, 1]


def test_a_task_with_a_volume_is_written_and_read(tmp_path):
    wish = task(wanted={"volume reachable": 2.0, "worst CTN": 1.0}, unit="m")
    wish.write(tmp_path / "task.toml")
    again = gsp.read_task(tmp_path / "task.toml")
    assert record_of(again) == record_of(wish)
    assert again.wanted == (Wanted("reachable", "volume", 2.0), Wanted("CTN", "worst"))
    assert (again.resolution, again.indices) == (0.4, ("control_number",))
    assert [one.label for one in again.wanted] == ["volume reachable", "worst CTN"]


def test_bad_input():
    with pytest.raises(InvalidInput, match="a PoseBox, as a volume is wanted"):
        task(gsp.Pose([[0.0, 0.0, 1.5]]))
    with pytest.raises(InvalidInput, match=r"none without a PoseBox, .* received 0.4 and a Pose"):
        task(gsp.Pose([[0.0, 0.0, 1.5]]), wanted="mean CTN")
    for value in (0.0, -1.0, np.inf, "fine"):
        with pytest.raises(InvalidInput, match="resolution"):
            task(resolution=value)
    with pytest.raises(InvalidInput, match=r"wanted\.index: expected reachable or dextrous"):
        task(wanted="volume CTN")
    with pytest.raises(MissingParameter, match="expected strokes or other limits"):
        assess(HEXAPOD.replace(strokes=None), task())
    with pytest.raises(InvalidInput, match=r"method='gradient': .* received volume dextrous"):
        optimise(SPACE, task(), method="gradient")
    with pytest.raises(InvalidInput, match="received volume dextrous"):
        gsp.exploration.sensitivities(HEXAPOD, task())
    errors = gsp.exploration.Deviations(base_points=1e-3)
    with pytest.raises(InvalidInput, match="received a volume"):
        gsp.exploration.index_tolerance(HEXAPOD, task(), errors)
