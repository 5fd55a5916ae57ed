"""The store of known maxima, with real processes, on SQLite and on PostgreSQL."""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
import subprocess
import sys
import time
import types
import warnings
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.determinant import (
    Maximum,
    MaximumInProgress,
    MaximumWarning,
    Store,
    StoreError,
    StoreWarning,
    maximum,
    open_store,
)
from gsp.determinant.canonical import canonical
from gsp.determinant.record import METHOD
from gsp.determinant.search import search
from gsp.determinant.store import damage as damage_of
from gsp.determinant.store import export_maxima, import_maxima, location
from gsp.determinant.store.connection import without_password
from gsp.determinant.store.database import LONGEST_CLAIM_SECONDS
from gsp.determinant.store.entries import COUNTS, entry_of
from gsp.determinant.store.validity import checked_entry
from gsp.errors import GspError, InvalidInput, MalformedFile
from gsp.families import lee

WORKER = Path(__file__).with_name("workers.py")


@pytest.fixture(autouse=True)
def _searched_once(monkeypatch):
    """A search with one seed has one result: tests of the store need not repeat it."""
    module = import_module("gsp.determinant.maxima")  # not the function of that name
    searches = module.search

    def once(form, seed, report):
        if not (seed is None or isinstance(seed, int)):
            return searches(form, seed, report)
        key = form.key, seed
        if key not in SEARCHES:
            SEARCHES[key] = searches(form, seed, report)
        return SEARCHES[key]

    monkeypatch.setattr(module, "search", once)


SEARCHES: dict[tuple[str, int | None], Maximum] = {}


def start(*arguments: object) -> subprocess.Popen[str]:
    root = str(Path(gsp.__file__).parents[1])
    environment = {**os.environ, "PYTHONPATH": root, "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, str(WORKER), *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    )


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
    workers = [start("find", 1.0) for _ in range(3)]
    outputs = [output(w).split() for w in workers]
    assert sum("searching" in words for words in outputs) == 1
    assert sorted(words[-2] for words in outputs) == ["search", "store", "store"]
    values = [float(words[-1]) for words in outputs]
    assert np.ptp(values) < 1e-12


def test_without_waiting_it_is_processing(any_store):
    other = open_store()
    assert other.claim(canonical(octahedron()).key, 60.0)
    with pytest.raises(MaximumInProgress, match="processing"):
        maximum(octahedron(), wait=False)
    other.release(canonical(octahedron()).key)
    assert maximum(octahedron(), wait=False).method == "search"


def test_the_claim_of_a_killed_process_expires(any_store, monkeypatch):
    """Others wait, and sleep meanwhile, until the claim has expired; then they search."""
    key = canonical(octahedron()).key
    worker = start("claim", key, 60.0)
    assert worker.stdout.readline().strip() == "True"
    worker.kill()
    worker.communicate()
    store, waits = open_store(), []

    def sleep(seconds):
        waits.append(seconds)
        assert store.get(key)["value"] is None
        if len(waits) == 3:
            with store.engine.begin() as connection:  # a minute passes
                connection.execute(store.table.update().values(expires=time.time() - 1.0))

    clock = types.SimpleNamespace(sleep=sleep, monotonic=time.monotonic)
    monkeypatch.setattr("gsp.determinant.store.known.time", clock)
    assert maximum(octahedron()).method == "search"
    assert len(waits) == 3
    assert store.get(key)["value"] is not None


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


def test_a_failed_search_releases_its_claim(any_store, monkeypatch):
    def broken(*args):
        raise KeyboardInterrupt

    monkeypatch.setattr("gsp.determinant.maxima.search", broken)
    with pytest.raises(KeyboardInterrupt):
        maximum(octahedron())
    monkeypatch.undo()
    assert Store(any_store).get(canonical(octahedron()).key) is None


def test_claims_are_exclusive_renewable_and_expire(any_store):
    one, two = Store(any_store), Store(any_store)
    assert one.claim("k", 60.0)
    assert not two.claim("k", 60.0)
    assert one.claim("k", 1e-9)
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
    workers = [start("put", "k", value) for value in (3.0, 2.0)]
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


DAMAGE = {
    "no counts": {"starts": None},
    "a count that is not a number": {"starts": "many"},
    "a count below zero": {"agreed": -1},
    "a flag that is none": {"converged": "no"},
    "a seed that is none": {"seed": "x"},
    "a value that is a text": {"value": "large"},
    "a value that is bytes": {"value": b"\x00\xff"},
    "an infinite value": {"value": np.inf},
    "a value below zero": {"value": -1.0},
    "zero without a pose": {"value": 0.0, "position": None, "rotation": None},
    "no position": {"position": None},
    "no rotation": {"rotation": None},
    "half a position": {"position": "[1.0, 2.0"},
    "nested lists": {"position": "[" * 5000},
    "a position far out": {"position": "[1e200, 1.0, 1.0]"},
    "two poses": {"position": "[[0, 0, 1], [0, 0, 1]]"},
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_entry_is_replaced(sqlite_store, monkeypatch, damage):
    """Whatever SQLite lets into a column, the maximum is searched anew and stored."""
    form, true = searched()
    monkeypatch.setattr("gsp.determinant.maxima.search", lambda *a: true)
    store = open_store()
    assert store.put(entry_of(true, form))
    sets = ", ".join(f"{name} = ?" for name in DAMAGE[damage])
    with contextlib.closing(sqlite3.connect(sqlite_store)) as database, database:
        database.execute(f"UPDATE gsp_maxima SET {sets}", tuple(DAMAGE[damage].values()))
    (row,) = store.rows()
    assert damage_of(row)
    assert maximum(octahedron(), wait=False).method == "search"
    assert not damage_of(store.rows()[0])
    again = maximum(octahedron(), wait=False)
    assert (again.method, again.value) == ("store", pytest.approx(27 / 32, rel=1e-12))


@cache
def searched():
    form = canonical(octahedron())
    return form, search(form)


MORE_DAMAGE = {
    "another value": {"value": 0.85},
    "another design": {"design": "[]"},
    "another domain": {"domain": '["box"]'},
    "an empty domain": {"domain": "[]"},
    "an empty text as domain": {"domain": ""},
    "a domain of texts": {"domain": '["near home", "a", "b"]'},
    "an object as domain": {"domain": "{}"},
    "a design that is a text": {"design": "text"},
    "a time that is none": {"found": "xyz"},
    "a time in millions of years": {"found": 1e300},
    "a version that is none": {"version": "x"},
}


@pytest.mark.parametrize("changed", {**DAMAGE, **MORE_DAMAGE})
def test_a_damaged_entry_is_not_exported_and_an_import_replaces_it(sqlite_store, tmp_path, changed):
    values = {**DAMAGE, **MORE_DAMAGE}[changed]
    store = open_store()
    form, true = searched()
    assert store.put(entry_of(true, form))
    assert export_maxima(store, tmp_path / "good.json") == (1, 0)
    sets = ", ".join(f"{name} = ?" for name in values)
    with contextlib.closing(sqlite3.connect(sqlite_store)) as database, database:
        database.execute(f"UPDATE gsp_maxima SET {sets}", tuple(values.values()))
    for name in ("bad.json", "bad.csv"):
        assert export_maxima(store, tmp_path / name) == (0, 1)
    assert import_maxima(store, tmp_path / "good.json") == (1, 1, 0)
    (row,) = store.rows()
    assert (damage_of(row), row["value"]) == ("", pytest.approx(true.value, rel=1e-12))


def test_a_search_replaces_a_value_that_is_damaged_and_too_large(sqlite_store):
    maximum(octahedron())
    store = open_store()
    true = store.rows()[0]["value"]
    with store.engine.begin() as connection:
        connection.execute(store.table.update().values(value=99.0))
    maximum(octahedron(), seed=1)
    assert store.rows()[0]["value"] == pytest.approx(true, rel=1e-12)


def test_an_export_keeps_all_digits_of_integers(sqlite_store, tmp_path):
    form, other = canonical(octahedron()), canonical(lee.octahedral_3_3(1.0, 1.3))
    store = open_store()
    store.put({**entry_of(search(form), form), "seed": 2**62 + 1})
    store.put({**entry_of(search(other), other), "seed": None})
    for name in ("maxima.csv", "maxima.json"):
        export_maxima(store, tmp_path / name)
        fresh = Store(f"sqlite:///{tmp_path / name}.sqlite")
        assert import_maxima(fresh, tmp_path / name) == (2, 2, 0)
        assert {row["seed"] for row in fresh.rows()} == {2**62 + 1, None}


def test_an_entry_with_a_pose_outside_of_the_domain_is_rejected(sqlite_store):
    """A larger |det J| somewhere else is not the maximum over the domain."""
    box = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), (1.3, 1.5)], [(-0.1, 0.1)] * 3)
    form = canonical(octahedron(), box)
    true = maximum(octahedron(), box)
    other = maximum(octahedron(), store=False)
    pose = form.inward(other.pose)
    value = float(gsp.indices.manipulability(form.design.at(pose)))
    assert open_store().put(entry_of(replace(true, value=value, pose=pose), form))
    again = maximum(octahedron(), box)
    assert (again.method, again.value) == ("search", pytest.approx(true.value, rel=1e-12))


@pytest.mark.parametrize("expires", [None, "never", 1e300])
def test_a_claim_without_a_valid_end_does_not_block_others(sqlite_store, expires):
    assert open_store().claim("k")
    with contextlib.closing(sqlite3.connect(sqlite_store)) as database, database:
        database.execute("UPDATE gsp_maxima SET expires = ?", (expires,))
    assert open_store().claim("k")


@pytest.mark.parametrize(
    "entry",
    [{}, {"key": "k"}, {"key": 1, "value": 1.0}]
    + [{"key": "k", "value": value} for value in (None, "1", np.nan, np.inf, -1.0)]
    + [{"key": "k", "value": 1.0, "column": 2}],
)
def test_an_invalid_entry_is_an_error(sqlite_store, entry):
    store = open_store()
    with pytest.raises(InvalidInput, match="entry"):
        store.put(entry)
    assert store.get("k") is None


@pytest.mark.parametrize("seconds", [-1.0, LONGEST_CLAIM_SECONDS + 1.0, np.nan])
def test_a_claim_lasts_an_hour_at_most(sqlite_store, seconds):
    with pytest.raises(InvalidInput, match="seconds"):
        open_store().claim("k", seconds)


def test_a_damaged_file_gives_a_warning_and_the_computation_continues(sqlite_store):
    sqlite_store.parent.mkdir()
    sqlite_store.write_text("no database at all, but a text that is long enough to be one" * 50)
    with pytest.warns(StoreWarning, match=r"maxima.sqlite.*not a database.*continues"):
        found = maximum(octahedron())
    assert found.value == pytest.approx(27 / 32, rel=1e-12)
    assert sqlite_store.read_text().startswith("no database")
    with pytest.raises(StoreError, match="not a database"):
        open_store()


def test_a_read_only_store_is_read_and_the_computation_continues(sqlite_store, monkeypatch):
    maximum(octahedron())
    monkeypatch.setenv("GSP_STORE", f"sqlite:///file:{sqlite_store}?mode=ro&uri=true")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert maximum(octahedron()).method == "store"
    with pytest.warns(StoreWarning, match="readonly"):
        assert maximum(lee.octahedral_3_3(1.0, 1.1)).method == "search"


@pytest.mark.parametrize(
    ("url", "reason"),
    [
        # The second reason is given where the extra `postgres` is not installed.
        ("postgresql+psycopg://gsp:secret@127.0.0.1:1/none", "refused|failed|No module"),
        ("unknown://somewhere", "unknown"),
    ],
    ids=["server", "driver"],
)
def test_an_unreachable_server_or_driver_gives_a_warning(monkeypatch, url, reason):
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


@pytest.mark.parametrize("name", ["a?b", "a%20b", "a%3Fb", "a#b", "a@b", "a b", "ä+b", "100%"])
def test_a_path_is_the_name_of_a_file_whatever_it_contains(tmp_path, monkeypatch, name):
    """No part of it is read as the escape or the query of a URL; read back without making it."""
    file = tmp_path / name / f"{name}.sqlite"
    monkeypatch.setenv("GSP_STORE", str(file))
    assert open_store().entries().empty
    assert [f for f in tmp_path.rglob("*") if f.is_file()] == [file]
    assert open_store(make=False).entries().empty
    assert without_password(location()) == location()


def test_the_table_may_be_made_between_check_and_creation(tmp_path, monkeypatch):
    """What another process does at that moment: the table is there, though it was not seen."""
    url = f"sqlite:///{tmp_path / 'maxima.sqlite'}"
    Store(url)
    unseen = types.SimpleNamespace(has_table=lambda name: False)
    monkeypatch.setattr("sqlalchemy.inspect", lambda engine: unseen)
    assert Store(url).entries().empty


def test_the_finder_and_later_readers_get_the_same_bits(any_store):
    rng = np.random.default_rng(4)
    design = gsp.Design(["D1"] * 6, *rng.normal(size=(2, 6, 3)))
    without = maximum(design, store=False)
    first, second = maximum(design), maximum(design.replace())
    assert (first.method, second.method) == ("search", "store")
    for one in (second, without):
        assert one.value == first.value
        assert (one.pose.position == first.pose.position).all()
        assert (one.pose.rotation == first.pose.rotation).all()
    facts = [{**m.facts(), "method": ""} for m in (first, second)]
    assert facts[0] == facts[1]
    other = output(start("value", 4)).split()
    assert other == [
        "store",
        repr(first.value),
        repr(first.pose.position.tolist()).replace(" ", ""),
    ]


def test_a_store_in_memory_exists_as_long_as_it_is_open():
    store = Store("sqlite://")
    assert store.put({"key": "x", "value": 1.0})
    assert store.get("x")["value"] == 1.0
    assert store.remove("x") == 1
    assert store.entries().empty
    assert Store("sqlite://").get("x") is None


def test_values_of_an_older_method_are_searched_anew_and_may_be_lowered(any_store):
    key = canonical(octahedron()).key
    store = Store(any_store)
    for version in range(1, METHOD):
        assert store.put({"key": key, "value": 9.0, "version": version})
        assert store.get(key) is None
        assert store.entries().empty
    found = maximum(octahedron())
    assert found.method == "search"
    assert store.get(key)["value"] == pytest.approx(found.value / octahedron_scale(), rel=1e-12)
    assert store.put({"key": "k", "value": 9.0, "version": None})
    assert store.put({"key": "k", "value": 1.0})


def octahedron_scale():
    return canonical(octahedron()).scale(octahedron())


def test_newer_columns_are_added_to_an_old_table(tmp_path):
    url = f"sqlite:///{tmp_path / 'maxima.sqlite'}"
    with contextlib.closing(sqlite3.connect(tmp_path / "maxima.sqlite")) as connection, connection:
        connection.execute(
            "CREATE TABLE gsp_maxima (key VARCHAR(64) PRIMARY KEY, value DOUBLE, worker TEXT, "
            "expires DOUBLE, evaluations BIGINT, seed BIGINT, starts BIGINT, agreed BIGINT, "
            "summits BIGINT, converged BIGINT, position TEXT, rotation TEXT, design TEXT, "
            "domain TEXT, library TEXT, found DOUBLE)"
        )
        connection.execute("INSERT INTO gsp_maxima (key, value) VALUES ('k', 5.0)")
    store = Store(url)
    assert store.get("k") is None
    assert store.claim("k")
    assert store.put({"key": "k", "value": 4.0, "singles": 2})
    assert store.get("k")["singles"] == 2


def test_a_quality_index_above_1_mends_the_store(any_store):
    """With a stored value that is too low, λ is computed with the better one, with a warning."""
    rng = np.random.default_rng(6)
    design = gsp.Design(["D1"] * 6, *rng.normal(size=(2, 6, 3)), name="general")
    best = maximum(design, store=False)
    form = canonical(design)
    near = gsp.Pose(best.pose.position + [0.05, 0.0, 0.02], best.pose.rotation)
    low = Maximum(
        value=float(gsp.indices.manipulability(form.design.at(form.inward(near)))),
        pose=form.inward(near),
        starts=1,
        agreed=1,
        n_local_maxima=1,
        converged=False,
        evaluations=1,
    )
    store = Store(any_store)
    assert store.put(entry_of(low, form))
    poses = gsp.Pose(np.stack([near.position, best.pose.position]), np.stack([near.rotation] * 2))
    with pytest.warns(MaximumWarning, match="was too low"):
        quality = gsp.indices.quality_index(design.at(poses))
    expected = gsp.indices.manipulability(design.at(poses)) / best.value
    np.testing.assert_allclose(quality, expected, rtol=1e-10)
    assert store.get(form.key)["value"] * form.scale(design) == pytest.approx(best.value, rel=1e-10)
    again = design.replace()
    np.testing.assert_allclose(gsp.indices.quality_index(again.at(poses)), expected, rtol=1e-10)


def table_of(way, design, path, folder):
    """Column of λ of a table of two poses, and the facts of its maximum."""
    if way == "sweep":
        table = gsp.sweep(design, path)
        return table["quality_index"], table.attrs["maximum"]
    if way == "rank":
        table = gsp.rank([design], path.pose, ["quality_index"])
        return table["quality_index_max"], table.attrs["maxima"]["general"]
    out = folder / "table.parquet" if way == "out" else None
    table = gsp.evaluate(design, path.pose, ["quality_index"], out=out)
    column = table["quality_index"] if out is None else pd.read_parquet(out)["quality_index"]
    return column, table.attrs["maxima"]["general"]


@pytest.mark.parametrize("way", ["evaluate", "rank", "sweep", "out"])
def test_tables_mend_a_low_maximum_too(sqlite_store, tmp_path, way):
    rng = np.random.default_rng(6)
    design = gsp.Design(["D1"] * 6, *rng.normal(size=(2, 6, 3)), name="general")
    best, form = maximum(design, store=False), canonical(design)
    near = gsp.Pose(best.pose.position + [0.05, 0.0, 0.02], best.pose.rotation)
    low = float(gsp.indices.manipulability(form.design.at(form.inward(near))))
    counts = {"starts": 1, "agreed": 1, "n_local_maxima": 1, "evaluations": 1}
    stored = Maximum(low, form.inward(near), converged=False, **counts)
    assert open_store().put(entry_of(stored, form))
    path = gsp.sweeps.translation(best.pose, "x", [0.0, 0.05])
    with pytest.warns(MaximumWarning, match="was too low"):
        column, facts = table_of(way, design, path, tmp_path)
    assert column[0] == pytest.approx(1.0, rel=1e-9)
    assert facts["value"] == pytest.approx(best.value, rel=1e-10)
    assert facts["outside"] == 0


def test_a_folder_as_store_is_said(tmp_path):
    with pytest.raises(StoreError, match=r"GSP_STORE: expected the path of a file.*the folder"):
        Store(f"sqlite:///{tmp_path}")


def test_a_file_without_texts_where_they_belong_or_without_keys_is_refused(sqlite_store, tmp_path):
    form, true = searched()
    store = open_store()
    assert store.put(entry_of(true, form))
    export_maxima(store, tmp_path / "maxima.json")
    content = json.loads((tmp_path / "maxima.json").read_text(encoding="utf-8"))
    for name in (10**400, "\ud800", "x" * 201):
        content["maxima"][0]["library"] = name
        (tmp_path / "long.json").write_text(json.dumps(content), encoding="utf-8")
        with pytest.raises(MalformedFile, match="library: expected a text of at most 200"):
            import_maxima(store, tmp_path / "long.json")
    with pytest.raises(InvalidInput, match="library: expected a text"):
        store.put({**entry_of(true, form), "library": 5})
    (tmp_path / "none.csv").write_bytes(b"a,b\n")
    with pytest.raises(MalformedFile, match="the columns of maxima, such as key"):
        import_maxima(store, tmp_path / "none.csv")


@pytest.mark.parametrize("name", ["D1^6", "D1^3 A1^3"])
def test_a_pose_at_which_the_determinant_rises_is_no_stored_maximum(sqlite_store, tmp_path, name):
    """Value and pose of an entry agree, and the pose is not stationary."""
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    rng = np.random.default_rng(2)
    points = rng.normal(size=(4, 6, 3))
    form = canonical(gsp.Design(legs, *points, home=gsp.Pose([0.1, 0.2, 1.5])))
    true = search(form)
    good = entry_of(true, form)
    assert checked_entry(good)["value"] == pytest.approx(true.value, rel=1e-12)
    near = true.pose.moved([0.01, -0.02, 0.01, 0.02, -0.01, 0.02])
    value = float(np.abs(np.linalg.det(form.design.at(near).jacobian)))
    moved = {
        **good, "value": value, "position": json.dumps(near.position.tolist()),
        "rotation": json.dumps(near.rotation.tolist()), "converged": 1,
    }  # fmt: skip
    with pytest.raises(GspError, match=r"converged: expected 0|a pose in the domain"):
        checked_entry(moved)
    assert checked_entry({**moved, "converged": 0})["value"] == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("suffix", [".json", ".csv"])
def test_more_searches_that_agree_than_searches_are_refused(sqlite_store, tmp_path, suffix):
    store = open_store()
    form, true = searched()
    assert store.put(entry_of(true, form))
    good, bad = tmp_path / f"good{suffix}", tmp_path / f"bad{suffix}"
    export_maxima(store, good)
    if suffix == ".json":
        content = json.loads(good.read_text(encoding="utf-8"))
        content["maxima"][0]["agreed"] = content["maxima"][0]["starts"] + 1
        bad.write_text(json.dumps(content), encoding="utf-8")
    else:
        table = pd.read_csv(good, dtype=str)
        table["agreed"] = str(int(table["starts"][0]) + 1)
        table.to_csv(bad, index=False)
    with pytest.raises(MalformedFile, match="agreed: expected at most the"):
        import_maxima(store, bad)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"singles": 5, "summits": 4}, "singles: expected at most the 4 local maxima, received 5"),
        ({"summits": 0, "singles": 0}, "summits: expected an integer ≥ 1"),
        ({"evaluations": 0}, "evaluations: expected an integer ≥ 1, received 0"),
        ({"agreed": 1}, "converged: expected 0, as fewer than two starts"),
        ({"starts": 0, "agreed": 0, "summits": 0, "singles": 0}, "converged: expected 0"),
    ]
    + [({name: True}, f"{name}: expected an integer ≥ 0, received True") for name in COUNTS],
)
def test_numbers_that_no_search_counts_are_refused(sqlite_store, changed, message):
    form, true = searched()
    assert not true.proven
    good = entry_of(true, form)
    assert checked_entry(good)["value"] == pytest.approx(true.value, rel=1e-12)
    with pytest.raises(GspError, match=message):
        checked_entry({**good, **changed})


@pytest.mark.parametrize("given", ["gsp maxima 2", "", 1, None, ["gsp maxima 1"]])
def test_another_format_is_refused(sqlite_store, tmp_path, given):
    path = tmp_path / "maxima.json"
    path.write_text(json.dumps({"format": given, "maxima": []}), encoding="utf-8")
    with pytest.raises(MalformedFile, match="format: expected 'gsp maxima 1', received"):
        import_maxima(open_store(), path)
