"""Results on disk while a run lasts: streaming, resuming, being killed."""

import os
import signal
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.catalogue import instantiate, mechanisms
from gsp.files.claims import Claim, InUse

pq = pytest.importorskip("pyarrow.parquet")

TEMPLATE = gsp.catalogue.design("toz-kucuk-2016-d3-6")
BOX = gsp.PoseBox([(-60, 60), (-60, 60), (90, 190)], [(-30, 30)] * 3, degrees=True)
DESIGNS = [instantiate(m, TEMPLATE) for m in mechanisms()[::40]]
POSE = BOX.sample(450, rng=1)


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    monkeypatch.setattr("gsp.evaluation.request.POSES_PER_BLOCK", 100)


class Stop(Exception):
    """Stands for whatever ends a run."""


def stop_at(number, error=Stop):
    def count(done, total):
        if done == number:
            raise error

    return count


def counter():
    calls = []
    return calls, lambda done, total: calls.append((done, total))


def test_the_file_holds_the_table_in_row_groups(tmp_path):
    out = tmp_path / "values.parquet"
    frame = gsp.evaluate(DESIGNS[0], POSE, out=out)
    assert frame.equals(gsp.evaluate(DESIGNS[0], POSE))
    pd.testing.assert_frame_equal(pd.read_parquet(out), pd.DataFrame(frame), check_exact=True)
    assert pq.ParquetFile(out).num_row_groups == 5
    assert [p.name for p in tmp_path.iterdir()] == [out.name]


@pytest.mark.parametrize("shape", [(), (3,), (2, 3), (5, 9, 10)], ids=str)
@pytest.mark.parametrize("maximum", [None, 4e6, "sample"], ids=str)
def test_the_file_of_values_is_the_table_with_its_index_and_attributes(tmp_path, shape, maximum):
    pose = POSE[: int(np.prod(shape))].reshape(*shape)
    out, names = tmp_path / "values.parquet", ["CTN", "λ" if maximum else "|det J|"]
    frame = gsp.evaluate(TEMPLATE, pose, names, length=30.0, maximum=maximum, out=out)
    for read in (
        pd.read_parquet(out),
        gsp.evaluate(TEMPLATE, pose, names, length=30.0, maximum=maximum, out=out, resume=True),
    ):
        pd.testing.assert_frame_equal(read, frame, check_exact=True)
        assert read.index.names == frame.index.names
        assert read.attrs == frame.attrs
    assert frame.attrs["units"]
    assert frame.attrs["length"] == 30.0


def test_the_file_of_a_ranking_keeps_units_limits_and_maxima(tmp_path):
    out = tmp_path / "ranking.parquet"
    given = {"indices": "CTN, λ", "maximum": 4e6, "limits": gsp.Limits(strokes=[[50, 300]] * 6)}
    frame = gsp.rank(DESIGNS[:2], POSE[:20], out=out, **given)
    assert frame.attrs["units"]
    for read in (
        pd.read_parquet(out),
        gsp.rank(DESIGNS[:2], POSE[:20], out=out, resume=True, **given),
    ):
        pd.testing.assert_frame_equal(read, frame, check_exact=True)
        assert read.attrs == frame.attrs


@pytest.mark.parametrize("error", [Stop, KeyboardInterrupt])
@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupted_run_continues_from_its_parts(tmp_path, error, workers):
    out = tmp_path / "values.parquet"
    with pytest.raises(error):
        gsp.evaluate(DESIGNS[0], POSE, out=out, progress=stop_at(3, error), workers=workers)
    assert not out.exists()
    stored = sorted((tmp_path / "values.parquet.parts").glob("*.parquet"))
    assert len(stored) >= 2
    assert sum(len(pd.read_parquet(part)) for part in stored) >= 150
    calls, count = counter()
    frame = gsp.evaluate(DESIGNS[0], POSE, out=out, resume=True, progress=count)
    assert calls[0] == (len(stored) + 1, 5)
    assert frame.equals(gsp.evaluate(DESIGNS[0], POSE))
    assert [p.name for p in tmp_path.iterdir()] == [out.name]


@pytest.mark.parametrize("call", [gsp.evaluate, gsp.rank])
def test_a_run_that_is_stopped_before_its_first_part_leaves_no_folder(tmp_path, call):
    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        call(DESIGNS[0], POSE, out=tmp_path / "values.parquet", progress=stop, workers=1)
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_is_stopped_while_it_makes_its_folder_leaves_none(tmp_path, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("gsp.files.claims.write_text", stop)
    with pytest.raises(KeyboardInterrupt):
        gsp.evaluate(DESIGNS[0], POSE, out=tmp_path / "values.parquet")
    assert list(tmp_path.iterdir()) == []


def test_a_finished_run_is_read_back(tmp_path):
    out = tmp_path / "values.parquet"
    frame = gsp.evaluate(DESIGNS[0], POSE, out=out, maximum="sample")
    calls, count = counter()
    again = gsp.evaluate(DESIGNS[0], POSE, out=out, resume=True, progress=count, maximum="sample")
    assert again.equals(frame)
    assert not calls


def test_an_interrupted_ranking_continues_from_its_designs(tmp_path):
    out = tmp_path / "ranking.parquet"
    with pytest.raises(Stop):
        gsp.rank(DESIGNS, POSE, out=out, progress=stop_at(12), workers=1)
    calls, count = counter()
    frame = gsp.rank(DESIGNS, POSE, out=out, resume=True, progress=count)
    assert calls[0] == (11, 5 * len(DESIGNS))
    plain = gsp.rank(DESIGNS, POSE)
    pd.testing.assert_frame_equal(frame, plain, check_exact=True)
    pd.testing.assert_frame_equal(pd.read_parquet(out), plain, check_exact=True)
    assert gsp.rank(DESIGNS, POSE, out=out, resume=True).equals(plain)


def test_nothing_is_overwritten(tmp_path):
    out = tmp_path / "values.parquet"
    with pytest.raises(Stop):
        gsp.evaluate(DESIGNS[0], POSE, out=out, progress=stop_at(2), workers=1)
    with pytest.raises(gsp.GspError, match="interrupted; resume it"):
        gsp.evaluate(DESIGNS[0], POSE, out=out)
    gsp.evaluate(DESIGNS[0], POSE, out=out, resume=True)
    with pytest.raises(gsp.GspError, match="exists already"):
        gsp.evaluate(DESIGNS[0], POSE, out=out)


@pytest.mark.parametrize(
    "change",
    [
        {"pose": BOX.sample(450, rng=2)},
        {"design": DESIGNS[1]},
        {"length": 3.0},
        {"backend": "numpy"},
        {"indices": ["condition_number"]},
    ],
    ids=str,
)
def test_parts_of_another_run_are_errors(tmp_path, change):
    out = tmp_path / "values.parquet"
    with pytest.raises(Stop):
        gsp.evaluate(DESIGNS[0], POSE, out=out, progress=stop_at(2), workers=1)
    given = {"design": DESIGNS[0], "pose": POSE, **change}
    with pytest.raises(gsp.GspError, match="another run"):
        gsp.evaluate(**given, out=out, resume=True)


def test_only_parquet_is_streamed(tmp_path):
    with pytest.raises(gsp.GspError, match=r"ends in \.parquet"):
        gsp.evaluate(DESIGNS[0], POSE, out=tmp_path / "values.csv")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("resume", [False, True])
def test_a_folder_is_used_by_one_run_at_a_time(tmp_path, resume):
    """A second run is refused at its start, and leaves the parts of the first as they are."""
    out = tmp_path / "values.parquet"
    refused = []

    def start_another(done, total):
        if not refused:
            with pytest.raises(InUse, match="another process or thread is writing there") as info:
                gsp.evaluate(DESIGNS[0], POSE, out=out, resume=resume)
            refused.append(info.value)

    frame = gsp.evaluate(DESIGNS[0], POSE, out=out, progress=start_another, workers=1)
    assert len(refused) == 1
    assert frame.equals(gsp.evaluate(DESIGNS[0], POSE))
    assert [p.name for p in tmp_path.iterdir()] == [out.name]


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_child_process_does_not_keep_the_folder_of_one_that_has_ended(tmp_path):
    heard, told = os.pipe()
    started, ready = os.pipe()
    process = os.fork()
    if not process:
        try:
            os.close(told)
            claim = Claim(tmp_path / "parts")
            claim.begin("a job")
            if os.fork():
                os.read(started, 1)
            else:
                os.write(ready, b".")
                os.read(heard, 1)  # until the other end is closed
        finally:
            os._exit(0)
    try:
        os.waitpid(process, 0)
        claim = Claim(tmp_path / "parts")
        assert claim.record() == {"job": "a job"}
        claim.release()
    finally:
        for end in (told, heard, started, ready):
            os.close(end)


def test_without_locks_a_run_is_not_said_to_be_interrupted(tmp_path, monkeypatch):
    monkeypatch.setattr("gsp.files.claims.lock", lambda handle: None)
    out = tmp_path / "values.parquet"
    with pytest.raises(Stop):
        gsp.evaluate(DESIGNS[0], POSE, out=out, progress=stop_at(2), workers=1)
    with pytest.raises(gsp.GspError, match="interrupted or is in progress; resume it"):
        gsp.evaluate(DESIGNS[0], POSE, out=out)
    gsp.evaluate(DESIGNS[0], POSE, out=out, resume=True)
    assert [p.name for p in tmp_path.iterdir()] == [out.name]


def test_other_files_in_the_folder_of_parts_stay(tmp_path):
    (tmp_path / "part-of-mine.json").write_text("mine")
    gsp.rank(DESIGNS, POSE, parts=tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["part-of-mine.json"]


# Sends itself a signal at any moment after it has written some parts.
SLOW = """
import os, pathlib, signal, sys, threading, time, gsp, gsp.evaluation.request
out, number, kind = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores it
def send():
    while len(list(pathlib.Path(out + ".parts").glob("part-*.parquet"))) < number:
        time.sleep(0.005)
    os.kill(os.getpid(), kind)
threading.Thread(target=send, daemon=True).start()
gsp.evaluation.request.POSES_PER_BLOCK = 100
design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
box = gsp.PoseBox([(-60, 60), (-60, 60), (90, 190)], [(-30, 30)] * 3, degrees=True)
gsp.evaluate(
    design, box.sample(20000, rng=1), ["manipulability"], out=out, workers=1,
    progress=lambda done, total: time.sleep(0.01),
)
"""


@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGINT])
def test_a_process_that_is_killed_leaves_parts_that_can_be_read(tmp_path, kind):
    words = (str(tmp_path / "values.parquet"), "5", str(int(kind)))
    environment = {**os.environ, "PYTHONPATH": os.getcwd()}
    done = subprocess.run(
        [sys.executable, "-c", SLOW, *words], env=environment, capture_output=True, check=False
    )
    assert done.returncode != 0
    parts = tmp_path / "values.parquet.parts"
    stored = list(parts.glob("part-*.parquet"))
    assert len(stored) >= 5, done.stderr
    assert all(len(pd.read_parquet(part)) == 100 for part in stored)
    assert not (tmp_path / "values.parquet").exists()
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    pose = BOX.sample(20000, rng=1)
    out = tmp_path / "values.parquet"
    frame = gsp.evaluate(design, pose, ["manipulability"], out=out, resume=True)
    assert np.array_equal(frame, gsp.evaluate(design, pose, ["manipulability"]))
    assert not parts.exists()


def test_a_run_is_resumed_only_where_its_results_are():
    with pytest.raises(gsp.GspError, match="resume: expected out="):
        gsp.evaluate(DESIGNS[0], POSE, resume=True)
    with pytest.raises(gsp.GspError, match="resume: expected out="):
        gsp.rank(DESIGNS, POSE, resume=True)
