"""Tasks: their poses, what is wanted, and their files."""

import copy
import pickle

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, MalformedFile, UnknownIndex, UnwritableOutput
from gsp.exploration import Wanted
from gsp.exploration.toml import record_of, toml_from_task
from gsp.statics import Masses

BOX = gsp.PoseBox([(-10, 30), (-30.1, 10), 130], [(-5, 5), (-5, 5), 0.1], degrees=True)
NODES = gsp.Pose([[0, 0, 130.0], [10, 0, 130], [10, 10, 140]])
PATH = gsp.PosePath.through(NODES, [0.0, 0.3, 1.0])
LIMITS = gsp.Limits(
    strokes=[[100, 200.1]] * 5 + [[np.nan, 150]],
    base_cone=0.7,
    platform_cone=[0.3, 0.4, np.nan, 0.5, 0.5, 0.5],
    position=[None, (0, 1.1), (None, 200)],
    leg_radius=3.3,
    indices=["CTN >= 0.1", "λ ≥ 0.2"],
    ellipsoid=gsp.Ellipsoid([1, 2, 3]),
    maximum=1e7,
)
TASKS = {
    "box": gsp.Task(poses=BOX, wanted="mean CTN"),
    "path": gsp.Task(poses=PATH, wanted=["worst CDN_CL"], samples=7, length=0.1),
    "batch": gsp.Task(poses=NODES, wanted={"mean λ": 0.3}, unit="mm", name='a "b"\\ é'),
    "all": gsp.Task(
        poses=BOX,
        wanted=["mean CTN", Wanted("CTN", "proven worst", 2.5), "worst CDN_CL"],
        limits=LIMITS,
        ellipsoid=gsp.Ellipsoid([1, 2, 3], [0.1, 0, 0]),
        payload=Masses(12.5, [0, 0, 30.1], lower=[1, 2, 3, 4, 5, 6.1], lower_centre=20),
        wrench=[0, 0, -100.1, 0, 5, 0],
        seed=3,
    ),
    "strokes": gsp.Task(poses=BOX, wanted="worst σ_min", limits=gsp.Limits()),
}


@pytest.mark.parametrize("name", TASKS)
def test_files_give_the_same_numbers(name, tmp_path):
    task = TASKS[name]
    task.write(tmp_path / "task.toml")
    again = gsp.read_task(tmp_path / "task.toml")
    # As texts: NaN differs from NaN as a number.
    assert repr(record_of(again)) == repr(record_of(task))
    assert again.wanted == task.wanted
    assert type(again.poses) is type(task.poses)
    np.testing.assert_array_equal(again.pose().position, task.pose().position)
    np.testing.assert_array_equal(again.pose().rotation, task.pose().rotation)
    with pytest.raises(UnwritableOutput):
        task.write(tmp_path / "task.toml")


def test_all_limits_are_written(tmp_path):
    TASKS["all"].write(tmp_path / "task.toml")
    limits = gsp.read_task(tmp_path / "task.toml").limits
    for part in ("strokes", "base_cone", "platform_cone", "position"):
        np.testing.assert_array_equal(getattr(limits, part), getattr(LIMITS, part))
    assert limits.thresholds == LIMITS.thresholds
    assert (limits.leg_radius, limits.maximum) == (3.3, 1e7)
    np.testing.assert_array_equal(limits.ellipsoid.semi_axes, [1, 2, 3])


def test_loads_are_written(tmp_path):
    TASKS["all"].write(tmp_path / "task.toml")
    task = gsp.read_task(tmp_path / "task.toml")
    assert task.wrench.tolist() == [0, 0, -100.1, 0, 5, 0]
    assert (task.payload.platform, task.payload.centre.tolist()) == (12.5, [0, 0, 30.1])
    assert task.payload.lower.tolist() == [1, 2, 3, 4, 5, 6.1]
    assert task.payload.lower_centre == 20
    assert gsp.Task(poses=BOX, wanted="mean CTN").payload is None


def test_copies_of_a_task_cannot_be_changed():
    task = gsp.Task(poses=BOX, wanted="mean CTN", wrench=np.arange(6.0))
    for copied in (task, copy.deepcopy(task), pickle.loads(pickle.dumps(task))):
        with pytest.raises(ValueError, match="read-only"):
            copied.wrench[0] = 1.0


def test_poses():
    assert TASKS["box"].pose().shape == (1000,)
    np.testing.assert_array_equal(TASKS["all"].pose().position, BOX.sample(1000, rng=3).position)
    path = TASKS["path"].pose()
    assert path.shape == (7,)
    np.testing.assert_allclose(path.position[[0, -1]], NODES.position[[0, -1]], atol=1e-12)
    np.testing.assert_allclose(path.position[3], PATH.pose(0.5).position)
    assert TASKS["batch"].pose() is NODES


def test_wanted():
    wishes = TASKS["all"].wanted
    assert [(w.index, w.of, w.weight) for w in wishes] == [
        ("control_number", "mean", 1.0),
        ("control_number", "proven worst", 2.5),
        ("condition_number", "worst", 1.0),
    ]
    assert [w.column for w in wishes] == [
        "control_number_mean", "control_number_proven", "condition_number_max",
    ]  # fmt: skip
    assert TASKS["all"].indices == ("control_number", "condition_number")
    assert TASKS["batch"].wanted == (Wanted("quality_index", "mean", 0.3),)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wanted": ()}, "task.wanted: expected texts such as"),
        ({"wanted": None}, "task.wanted: expected texts such as"),
        ({"wanted": "best CTN"}, "task.wanted: expected texts such as"),
        ({"wanted": ["mean CTN", "mean control_number"]}, "each value once, received twice"),
        ({"wanted": {"mean CTN": 0.0}}, "wanted.weight: expected"),
        ({"wanted": {"mean CTN": None, "worst CTN": -1}}, "wanted.weight: expected"),
        ({"poses": NODES[0]}, "task.poses: expected a PoseBox, a PosePath, or a Pose of"),
        ({"poses": NODES[:0]}, "task.poses: expected a PoseBox"),
        ({"poses": "box"}, "task.poses: expected a PoseBox"),
        ({"poses": PATH, "wanted": "proven worst CTN"}, "as a proven worst value is wanted"),
        ({"samples": 0}, "task.samples: expected"),
        ({"seed": -1}, "task.seed: expected"),
        ({"limits": [1, 2]}, "task.limits: expected a gsp.Limits"),
        ({"length": 0.0}, "task.length: expected"),
        ({"unit": 3}, "task.unit: expected"),
        ({"payload": 60.0}, "task.payload: expected a gsp.statics.Masses"),
        ({"wrench": [1, 2, 3]}, "task.wrench: expected"),
        ({"wrench": np.zeros((2, 6))}, r"task.wrench: expected six numbers, shape \(6,\)"),
        ({"wrench": [np.nan] * 6}, "task.wrench .*: expected finite numbers"),
    ],
)
def test_bad_arguments(change, message):
    with pytest.raises(InvalidInput, match=message):
        gsp.Task(**{"poses": BOX, "wanted": "mean CTN", **change})


def test_unknown_indices():
    with pytest.raises(UnknownIndex):
        gsp.Task(poses=BOX, wanted="mean beauty")
    with pytest.raises(UnknownIndex, match="with bounds over boxes"):
        gsp.Task(poses=BOX, wanted="proven worst F_max")


TEXT = toml_from_task(TASKS["box"])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (TEXT.replace("samples", "sample"), "line 3, key 'sample': key: expected one of name"),
        (TEXT.replace("weight", "wight"), "line 9, key 'wight': key: expected one of index"),
        (TEXT.replace("[box]", "[bax]"), "line 11, key 'bax'"),
        (TEXT + "\n[path]\ntimes = [0, 1]\n", r"expected one of the tables \[box\], \[path\]"),
        (TEXT.replace('index = "control_number"\n', ""), "line 6, key 'index': expected this key"),
        (TEXT.replace("mean", "average"), "line 8, key 'of': wanted.of: expected mean or worst"),
        (TEXT.replace("control_number", "beauty"), "line 7, key 'index': unknown index 'beauty'"),
        (TEXT.replace("weight = 1.0", "weight = -1"), "line 9, key 'weight': wanted.weight"),
        ("length = 'a'\n" + TEXT, "line 1, key 'length': task.length: expected"),
        (TEXT + TEXT[TEXT.index("[[w"):TEXT.index("[box]")], "line 6, key 'wanted': task.wanted"),
        (TEXT.replace("mean", "proven worst").split("[box]")[0] + "[poses]\nposition = [[0, 0, 1]]",
         "line 11, key 'poses': task.poses: expected a PoseBox"),
        (TEXT.replace("order = \"rpy\"", "order = 3"), "line 11, key 'box': order"),
        (TEXT.replace("[[wanted]]", "[wanted]"), r"expected tables \[\[wanted\]\]"),
        (TEXT + "[limits]\nstroke = 3\n", "line 16, key 'stroke': key: expected one of strokes"),
        (TEXT + "[limits]\nleg_radius = -3\n", "line 15, key 'limits': limits.leg_radius"),
        (TEXT + "[payload]\nmass = 3\n", "line 16, key 'mass': key: expected one of platform"),
        (TEXT + "[payload]\nplatform = -3\n", "line 15, key 'payload': masses.platform"),
        ("wrench = [1, 2]\n" + TEXT, "line 1, key 'wrench': task.wrench: expected"),
        (TEXT + "angles_deg = [0, 0, 0]\n", "expected angles or angles_deg, received both"),
        ("samples = [", "not TOML"),
        ("", r"expected one of the tables \[box\], \[path\], \[poses\], received none"),
    ],
)  # fmt: skip
def test_mistakes_in_files(text, message, tmp_path):
    path = tmp_path / "task.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(MalformedFile, match=message) as error:
        gsp.read_task(path)
    assert str(error.value).startswith(str(path))


def test_degrees_in_files(tmp_path):
    path = tmp_path / "task.toml"
    path.write_text(
        '[[wanted]]\nindex = "CTN"\n[poses]\nposition = [[0, 0, 1]]\nrpy_deg = [[5, -5, 10]]\n'
    )
    task = gsp.read_task(path)
    np.testing.assert_allclose(task.pose().angles(degrees=True), [[5, -5, 10]], atol=1e-12)
    path.write_text(
        '[[wanted]]\nindex = "CTN"\n[box]\nposition = [0, 0, 1]\nangles_deg = [[-180, 90], 0, 0]\n'
    )
    np.testing.assert_allclose(gsp.read_task(path).poses.low[3:], [-np.pi, 0, 0])
