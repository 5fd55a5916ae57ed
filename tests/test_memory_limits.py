"""Numbers of poses, rays and points that do not fit into memory are refused before any is made."""

import itertools

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp import checks
from gsp.errors import InvalidInput
from gsp.geometry.pose import Pose, PoseBox
from gsp.workspace.boundary.mapping import ray_angles

DESIGN = gsp.catalogue.design("toz-kucuk-2016-d3-6")
SIX = gsp.catalogue.design("workspace-6-3")
BOX = PoseBox([(0, 1)] * 3, [(0, 1)] * 3)
MANY = 10**15


def test_the_limit_is_the_memory_of_the_machine(monkeypatch):
    monkeypatch.setattr(checks, "_memory", lambda: 1000)
    assert checks.check_memory("n", 10, 100, "poses") == 10
    with pytest.raises(InvalidInput) as error:
        checks.check_memory("n", 11, 100, "poses")
    message = (
        "n: expected at most 10 poses (each needs about 100 bytes, and this machine has 1e-06 GB"
    )
    assert str(error.value) == f"{message} of memory), received 11"


def test_where_the_system_does_not_state_it(monkeypatch):
    monkeypatch.delattr(checks.os, "sysconf", raising=False)
    assert checks._memory() == checks.ASSUMED_MEMORY


@pytest.mark.parametrize(
    "make",
    [
        lambda: BOX.sample(MANY, rng=0),
        lambda: BOX.sample(MANY, rng=0, method="sobol"),
        lambda: BOX.grid([10**5] * 3 + [1] * 3),
        lambda: Pose.sample([(0, 1)] * 3, [(0, 1)] * 3, MANY, rng=0),
        lambda: gsp.sweeps.plane(DESIGN.home, np.zeros(10**6), np.zeros(10**6)),
        lambda: ray_angles(MANY),
        lambda: gsp.workspace.section(SIX, rays=MANY),
        lambda: gsp.workspace.surface(SIX, counts=(MANY, 1)),
        lambda: gsp.workspace.surface(SIX, counts=(1, 10**7)),
        lambda: gsp.nearest(DESIGN, DESIGN.home, gsp.Limits(strokes=[[1, 2]] * 6), starts=MANY),
    ],
)  # fmt: skip
def test_library(make):
    with pytest.raises(InvalidInput, match=r"at most \d+ [a-z ]+ \(each needs"):
        make()


FRONT = pd.DataFrame({"x": [0.0, 1.0], "y": [1.0, 0.0]})


@pytest.mark.parametrize("many", [range(10**9), range(10**30)], ids=["9", "30"])
@pytest.mark.parametrize(
    "make",
    [
        lambda many: gsp.exploration.pareto(FRONT, many),
        lambda many: gsp.exploration.knee(FRONT, many),
        lambda many: gsp.exploration.losses(FRONT, many),
        lambda many: gsp.families.lee.best_height(many, 30.0, 0.0, 0.2),
        lambda many: gsp.Pose(many),
        lambda many: gsp.Pose([many]),
        lambda many: gsp.Space(gsp.hexapod, {"platform_radius": [many]}),
        lambda many: gsp.rank(many, gsp.Pose(np.zeros(3))),
        lambda many: gsp.geometry.frames.act_twist(many, np.zeros(6)),
    ],
)  # fmt: skip
def test_long_sequences_are_refused_by_their_length(make, many):
    with pytest.raises(InvalidInput, match=r"at most 10000000 items, received \[?range\(0"):
        make(many)


LOOP = []
LOOP.append(LOOP)


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ([range(10**12)], "at most 10000000 items"),
        ([[1.0, 2.0, 3.0], range(10**12)], "at most 10000000 items"),
        ([range(10**6)] * 11, "at most 10000000 items"),
        ([range(10**6)], r"expected shape \(\.\.\., 3\), received shape \(1, 1000000\)"),
        ([[[0.0] * 3] * 10**6] * 10**6, "expected at most .* GB of memory"),
        ([np.broadcast_to(1.0, 10**13)], "expected at most .* GB of memory"),
        (np.broadcast_to(1.0, (10**12, 6)), r"received shape \(1000000000000, 6\)"),
        (np.broadcast_to(1.0, (10**12, 3)), "expected at most .* GB of memory"),
        (np.broadcast_to(np.array(1.0, dtype=object), (10**12, 3)), "expected at most .* GB"),
        (LOOP, "expected real numbers"),
        (bytearray(3), "expected real numbers"),
    ],
)
def test_long_arrays_are_refused_before_they_are_copied(value, reason):
    with pytest.raises(InvalidInput, match=f"pose.position: .*{reason}"):
        gsp.Pose(value)


def test_many_items_of_arrays_are_refused_by_their_number():
    long = np.broadcast_to(1.0, 10**12)
    with pytest.raises(InvalidInput, match=r"objectives: .* at most 10000000 items"):
        gsp.exploration.pareto(FRONT, long)
    with pytest.raises(InvalidInput, match=r"maximum: .* at most 10000000 items"):
        gsp.evaluate(DESIGN, DESIGN.home, "λ", maximum=long)


def test_rows_of_many_items_and_arrays_within_lists_are_read():
    rows = [np.arange(3.0), range(3), (0, 1, 2), [0.0, np.float64(1.0), 2]]
    np.testing.assert_array_equal(gsp.Pose(rows * 9).position, [[0.0, 1.0, 2.0]] * 36)
    many = checks.MANY_ITEMS
    assert gsp.Pose([range(3)] * many).shape == (many,)
    assert gsp.Pose(np.broadcast_to(1.0, (many, 3))).shape == (many,)


def test_what_numpy_cannot_hold_is_an_error_of_the_library(monkeypatch):
    def none(*_, **__):
        raise MemoryError("Unable to allocate 7.28 TiB")

    monkeypatch.setattr(checks.np, "asarray", none)
    with pytest.raises(InvalidInput, match="x: expected real numbers that fit into the memory"):
        checks.check_array("x", [1.0], (1,))


def test_the_words_of_a_leg_are_counted_before_they_are_read():
    with pytest.raises(InvalidInput, match=r"legs\[0\]: expected one of"):
        gsp.Design([range(10**12)] * 6, DESIGN.base_points, DESIGN.platform_points)


def test_an_iterable_without_an_end_is_refused(monkeypatch):
    monkeypatch.setattr(checks, "MOST_ITEMS", 1000)
    with pytest.raises(InvalidInput, match=r"at most 1000 items, received count\("):
        gsp.exploration.pareto(FRONT, itertools.count())


def test_more_than_a_machine_word():
    with pytest.raises(InvalidInput, match="n: expected an integer ≤ 9223372036854775807"):
        BOX.sample(10**20, rng=0)
