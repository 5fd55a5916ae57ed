"""The store of known maxima, with real processes, on SQLite and on PostgreSQL."""

from __future__ import annotations

import os
import subprocess
import sys
import time
import types
import warnings
from pathlib import Path

import numpy as np
import pytest

import gsp
from gsp.determinant import (
    MaximumInProgress,
    Store,
    StoreError,
    StoreWarning,
    maximum,
    open_store,
)
from gsp.determinant.canonical import canonical
from gsp.determinant.store import location
from gsp.families import lee

WORKER = Path(__file__).with_name("workers.py")


def start(*arguments: object) -> subprocess.Popen[str]:
    root = str(Path(gsp.__file__).parents[1])
    environment = {**os.environ, "PYTHONPATH": root, "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, str(WORKER), *map(str, arguments)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
    )  # fmt: skip


def output(process: subprocess.Popen[str]) -> str:
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    return out


def octahedron():
    return lee.octahedral_3_3(1.0, 1.0)


def test_a_maximum_is_searched_once_and_then_known(any_store):
    first, second = maximum(octahedron()), maximum(octahedron().scaled(25.4).exchanged())
    assert (first.method, second.method) == ("search", "store")
    assert second.value == pytest.approx(first.value * 25.4**3, rel=1e-12)
    assert second.value == pytest.approx(float(lee.central_maximum(25.4, 25.4)), rel=1e-12)
    assert (second.starts, second.agreed, second.seed) == (first.starts, first.agreed, first.seed)
    value = gsp.indices.manipulability(octahedron().scaled(25.4).exchanged().at(second.pose))
    assert value == pytest.approx(second.value, rel=1e-12)


def test_closed_forms_and_store_false_touch_no_store(sqlite_store):
    assert maximum(lee.octahedral_3_3(1.0, 2.0)).method == "closed form"
    assert maximum(octahedron(), store=False).method == "search"
    assert not sqlite_store.exists()


def test_a_box_and_a_singular_design_are_stored_too(any_store):
    box = gsp.PoseBox([(-0.2, 0.2), (-0.2, 0.2), (0.3, 0.5)], [(-0.2, 0.2)] * 3)
    first, second = (maximum(octahedron(), box) for _ in range(2))
    assert (first.method, second.method) == ("search", "store")
    assert second.value == pytest.approx(first.value, rel=1e-12)
    assert second.domain is box
    flat = [lee.platform_3_6(1.0, 2.0, 0.5) for _ in range(2)]
    assert [(m.method, m.value, m.pose) for m in map(maximum, flat)] == [
        ("search", 0.0, None),
        ("store", 0.0, None),
    ]


def test_many_processes_compute_once_and_the_others_wait(any_store):
    workers = [start("find", 1.0) for _ in range(4)]
    outputs = [output(w).split() for w in workers]
    assert sum("searching" in words for words in outputs) == 1
    assert sorted(words[-2] for words in outputs) == ["search", "store", "store", "store"]
    values = [float(words[-1]) for words in outputs]
    assert np.ptp(values) < 1e-12


def test_without_waiting_it_is_processing(any_store):
    other = open_store()
    assert other.claim(canonical(octahedron()).key, 60.0)
    with pytest.raises(MaximumInProgress, match="processing"):
        maximum(octahedron(), wait=False)
    other.release(canonical(octahedron()).key)
    assert maximum(octahedron(), wait=False).method == "search"


def test_the_claim_of_a_killed_process_expires(any_store):
    key = canonical(octahedron()).key
    worker = start("claim", key, 3.0)
    assert worker.stdout.readline().strip() == "True"
    claimed = time.time()
    worker.kill()
    worker.communicate()
    assert open_store().get(key)["value"] is None
    found = maximum(octahedron())
    assert found.method == "search"
    assert time.time() - claimed >= 2.5
    assert open_store().get(key)["value"] is not None


def test_a_process_killed_while_searching_leaves_nothing_wrong(any_store):
    worker = start("find", 60.0)
    assert worker.stdout.readline().strip() == "searching"
    worker.kill()
    worker.communicate()
    key = canonical(octahedron()).key
    store = open_store()
    with store.engine.begin() as connection:  # thirty seconds pass
        connection.execute(store.table.update().values(expires=time.time() - 1.0))
    assert maximum(octahedron()).method == "search"
    assert store.get(key)["value"] is not None


def test_a_failed_search_gives_its_claim_back(any_store, monkeypatch):
    module = sys.modules["gsp.determinant.maximum"]

    def broken(*args):
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "search", broken)
    with pytest.raises(KeyboardInterrupt):
        maximum(octahedron())
    monkeypatch.undo()
    assert Store(any_store).get(canonical(octahedron()).key) is None


def test_claims_are_exclusive_renewable_and_expire(any_store):
    one, two = Store(any_store), Store(any_store)
    assert one.claim("k", 60.0)
    assert not two.claim("k", 60.0)
    assert one.claim("k", 0.0)
    time.sleep(0.01)
    assert two.claim("k", 60.0)
    assert not one.claim("k", 60.0)
    one.release("k")
    assert two.get("k")["worker"] == two.worker
    two.put({"key": "k", "value": 1.0})
    assert not one.claim("k", 60.0)
    two.release("k")
    assert two.get("k")["value"] == 1.0


def test_better_replaces_worse_and_never_the_other_way(any_store):
    store = Store(any_store)
    assert store.put({"key": "k", "value": 1.0, "seed": 1})
    assert not store.put({"key": "k", "value": 0.5, "seed": 2})
    assert not store.put({"key": "k", "value": 1.0 + 1e-14, "seed": 3})
    assert (store.get("k")["value"], store.get("k")["seed"]) == (1.0, 1)
    assert store.put({"key": "k", "value": 2.0, "seed": 4})
    assert (store.get("k")["value"], store.get("k")["seed"]) == (2.0, 4)


def test_better_wins_among_processes(any_store):
    workers = [start("put", "k", value) for value in (1.0, 3.0, 2.0)]
    for worker in workers:
        output(worker)
    assert Store(any_store).get("k")["value"] == 3.0


def test_a_seeded_search_improves_the_store(any_store):
    maximum(octahedron())
    store, key = Store(any_store), canonical(octahedron()).key
    with store.engine.begin() as connection:
        connection.execute(store.table.update().values(value=1e-3))
    found = maximum(octahedron(), seed=3)
    assert (found.method, found.seed) == ("search", 3)
    assert store.get(key)["value"] == pytest.approx(
        found.value / canonical(octahedron()).scale(octahedron())
    )


def test_an_entry_that_its_pose_contradicts_is_replaced(any_store):
    true = maximum(octahedron()).value
    store = Store(any_store)
    with store.engine.begin() as connection:
        connection.execute(store.table.update().values(value=1e9))
    again = maximum(octahedron().scaled(1.0))
    assert (again.method, again.value) == ("search", pytest.approx(true, rel=1e-12))


def test_a_damaged_file_gives_a_warning_and_computing_goes_on(sqlite_store):
    sqlite_store.parent.mkdir()
    sqlite_store.write_text("no database at all, but a text that is long enough to be one" * 50)
    with pytest.warns(StoreWarning, match=r"maxima.sqlite.*not a database.*goes on"):
        found = maximum(octahedron())
    assert found.value == pytest.approx(27 / 32, rel=1e-12)
    assert sqlite_store.read_text().startswith("no database")
    with pytest.raises(StoreError, match="not a database"):
        open_store()


def test_a_read_only_store_is_read_and_computing_goes_on(sqlite_store, monkeypatch):
    maximum(octahedron())
    monkeypatch.setenv("GSP_STORE", f"sqlite:///file:{sqlite_store}?mode=ro&uri=true")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert maximum(octahedron()).method == "store"
    with pytest.warns(StoreWarning, match="readonly"):
        assert maximum(lee.octahedral_3_3(1.0, 1.1)).method == "search"


def test_an_unreachable_server_or_driver_gives_a_warning(monkeypatch):
    for url, reason in (
        ("postgresql+psycopg://gsp:secret@127.0.0.1:1/none", "refused|failed"),
        ("nonsense://somewhere", "nonsense"),
    ):
        monkeypatch.setenv("GSP_STORE", url)
        with pytest.warns(StoreWarning, match=reason) as caught:
            assert maximum(octahedron()).method == "search"
        assert "secret" not in str(caught[0].message)


def test_location(monkeypatch, tmp_path):
    for value in ("", "off", "OFF"):
        monkeypatch.setenv("GSP_STORE", value)
        assert location() is None
        assert open_store() is None
    monkeypatch.setenv("GSP_STORE", "some/where.sqlite")
    assert location() == f"sqlite:///{Path.cwd() / 'some/where.sqlite'}"
    monkeypatch.delenv("GSP_STORE")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert location() == f"sqlite:///{tmp_path / 'gsp' / 'maxima.sqlite'}"


def test_the_table_may_appear_between_look_and_creation(tmp_path, monkeypatch):
    """What another process does at that moment: the table is there, though it was not seen."""
    url = f"sqlite:///{tmp_path / 'maxima.sqlite'}"
    Store(url)
    unseen = types.SimpleNamespace(has_table=lambda name: False)
    monkeypatch.setattr("sqlalchemy.inspect", lambda engine: unseen)
    assert Store(url).entries().empty
