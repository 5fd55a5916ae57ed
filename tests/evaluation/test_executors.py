"""User-supplied executors: the same bits, failures, processes that end."""

import os
import pickle
import signal
import threading
import warnings
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import get_context

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.evaluation import scheduling
from gsp.evaluation.request import SLOW_POSES_PER_BLOCK
from gsp.evaluation.scheduling import pool_of
from gsp.proof.branching.search import runner

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
BOX = gsp.PoseBox([(-60, 60), (-60, 60), (90, 190)], [(-30, 30)] * 3, degrees=True)
DESIGNS = [instantiate(m, TEMPLATE) for m in mechanisms()[::40]]
POSE = BOX.sample(400, rng=1)


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    monkeypatch.setattr("gsp.evaluation.request.POSES_PER_BLOCK", 100)


@pytest.fixture(scope="module")
def processes():
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        yield pool


def test_a_pickled_design_is_unchanged():
    design = pickle.loads(pickle.dumps(DESIGNS[3]))
    assert all(a is b for a, b in zip(design.legs, DESIGNS[3].legs, strict=True))
    assert (design.at(POSE).jacobian == DESIGNS[3].at(POSE).jacobian).all()


def test_processes_give_the_same_bits(processes):
    alone = gsp.evaluate(DESIGNS[1], POSE, workers=1)
    assert gsp.evaluate(DESIGNS[1], POSE, executor=processes).equals(alone)
    assert gsp.rank(DESIGNS, POSE, executor=processes, workers=2).equals(gsp.rank(DESIGNS, POSE))


class Flaky(ThreadPoolExecutor):
    """An executor of which every third submission fails for a reason of its own."""

    count = 0

    def submit(self, function, /, *args, **kwargs):
        self.count += 1
        if self.count % 3:
            return super().submit(function, *args, **kwargs)
        future = Future()
        future.set_exception(OSError("the node is gone"))
        return future


def test_failed_items_of_an_executor_are_resubmitted():
    with Flaky(2) as pool:
        assert gsp.rank(DESIGNS, POSE, executor=pool).equals(gsp.rank(DESIGNS, POSE))
        assert pool.count > 4 * len(DESIGNS)


class Hopeless(ThreadPoolExecutor):
    """An executor that always fails."""

    def submit(self, function, /, *args, **kwargs):
        future = Future()
        future.set_exception(OSError("no network"))
        return future


class Refusing(ThreadPoolExecutor):
    """An executor that takes no item."""

    def submit(self, function, /, *args, **kwargs):
        raise ValueError("no items")


def closed(workers):
    pool = ThreadPoolExecutor(workers)
    pool.shutdown()
    return pool


@pytest.mark.parametrize("kind", [Hopeless, Refusing, closed])
def test_items_of_an_executor_that_always_fails_are_computed_in_this_process(kind):
    pool, box = kind(1), gsp.PoseBox.around(DESIGNS[0].home, [5, 5, 5, 0.05, 0.05, 0.05])
    with pytest.warns(RuntimeWarning, match="the executor failed"):
        frame = gsp.evaluate(DESIGNS[0], POSE, executor=pool)
    assert frame.equals(gsp.evaluate(DESIGNS[0], POSE))
    with pytest.warns(RuntimeWarning, match="the executor failed"):
        proof = gsp.certify(DESIGNS[0], box, executor=pool)
    assert proof.record() == gsp.certify(DESIGNS[0], box).record()


def test_an_error_of_the_library_is_not_tried_again():
    calls = []

    def fail(item):
        calls.append(item)
        raise gsp.GspError("wrong")

    with ThreadPoolExecutor(1) as pool, pytest.raises(gsp.GspError, match="wrong"):
        list(scheduling.run_all(fail, iter([1]), 1, executor=pool))
    assert calls == [1]


def test_items_of_a_broken_pool_are_computed_in_this_process():
    pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"))
    killed = pool.submit(os.kill, pool.submit(os.getpid).result(), signal.SIGKILL)
    with pytest.raises(BrokenProcessPool):
        killed.result()
    with pytest.warns(RuntimeWarning, match="the executor failed .BrokenProcessPool"):
        frame = gsp.evaluate(DESIGNS[2], POSE, executor=pool)
    pool.shutdown()
    assert frame.equals(gsp.evaluate(DESIGNS[2], POSE))


def test_an_object_that_is_not_an_executor_is_an_error():
    with pytest.raises(gsp.GspError, match=r"executor: expected a concurrent.futures.Executor"):
        gsp.evaluate(DESIGNS[0], POSE, executor="dask")


@pytest.fixture(scope="module")
def cluster():
    """A Dask cluster of two worker processes, which starts another one for one that ends."""
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        local = distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            dashboard_address=None,
            silence_logs=50,
        )
        with local, distributed.Client(local) as client:
            yield local, client


def losing_a_worker(cluster, run, least=5):
    """Return what a function of an executor and of progress returns while a worker is killed."""
    local, client = cluster
    client.wait_for_workers(2)
    killed = []

    def kill_one(done, total):
        if done >= least and not killed:
            pids = [worker.process.pid for worker in local.workers.values() if worker.process]
            os.kill(pids[0], signal.SIGKILL)
            killed.append((done, total))

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = run(client.get_executor(), kill_one)
    assert killed
    assert killed[0][0] < killed[0][1]
    return found


def test_a_dask_cluster_loses_a_worker(cluster):
    ranking = losing_a_worker(
        cluster,
        lambda executor, progress: gsp.rank(
            DESIGNS, POSE, executor=executor, workers=1, progress=progress
        ),
    )
    assert ranking.equals(gsp.rank(DESIGNS, POSE))


def test_a_dask_cluster_loses_a_worker_in_an_exploration(cluster, monkeypatch):
    """Designs are evaluated two at a time."""
    names = ["D1-D1-D1-D1-D1-D1", "D1-D2-D1-D4A1-D3-0", "D3-D3-D3-D3-D3-D3"]
    space = gsp.Space(gsp.catalogue.place, choices={"legs": names}, fixed={"template": TEMPLATE})
    task = gsp.Task(poses=POSE[:90], wanted=["mean CTN", "worst CDN_CL"], length=95.0)
    monkeypatch.setattr("gsp.evaluation.request.LEAST_POSES_PER_BLOCK", 180)
    table = losing_a_worker(
        cluster,
        lambda executor, progress: gsp.exploration.explore(
            space, task, 40, seed=1, executor=executor, workers=1, progress=progress
        ),
    )
    pd.testing.assert_frame_equal(
        table, gsp.exploration.explore(space, task, 40, seed=1), check_exact=True
    )


def test_blocks_of_slow_indices_are_small_and_change_no_value():
    ends = []
    length = 95.0
    few = POSE[:40]
    found = gsp.evaluate(
        DESIGNS[0], few, "SD", length=length, progress=lambda done, total: ends.append(total)
    )
    assert ends[-1] == 1
    ends.clear()
    many = gsp.Pose(np.tile(few.position, (15, 1)), np.tile(few.rotation, (15, 1, 1)))
    again = gsp.evaluate(
        DESIGNS[0], many, "SD", length=length, progress=lambda done, total: ends.append(total)
    )
    assert ends[-1] == -(-600 // SLOW_POSES_PER_BLOCK) > 1
    assert np.array_equal(again["singularity_distance"][:40], found["singularity_distance"])


def test_an_error_does_not_wait_for_threads():
    """Neither does an interrupt: what a thread computes may be compiled first, for a minute."""
    free, begun = threading.Event(), threading.Event()
    with suppress(KeyboardInterrupt), pool_of(1) as pool:
        started = pool.submit(lambda: (begun.set(), free.wait(60.0)))
        waiting = pool.submit(free.wait, 60.0)
        assert begun.wait(60.0)
        raise KeyboardInterrupt
    assert not started.done()
    assert waiting.cancelled()
    free.set()


def test_the_first_search_of_a_proof_runs_in_the_calling_thread():
    """It may compile for a minute, and only there an interrupt stops it."""
    with runner(2, None) as run:
        assert list(run(lambda _: threading.get_ident(), [0])) == [threading.get_ident()]
        assert threading.get_ident() not in list(run(lambda _: threading.get_ident(), [0, 1]))
