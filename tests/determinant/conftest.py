"""Temporary stores: one SQLite file per test, and a PostgreSQL server where there is one."""

from __future__ import annotations

import os
import pwd
import shutil
import socket
import subprocess
import tempfile
from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def sqlite_store(tmp_path, monkeypatch) -> Path:
    path = tmp_path / "store" / "maxima.sqlite"
    monkeypatch.setenv("GSP_STORE", str(path))
    return path


def binaries() -> Path | None:
    """The folder of PostgreSQL's programs."""
    found = shutil.which("initdb")
    if found:
        return Path(found).resolve().parent
    places = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    return places[-1].parent if places else None


@pytest.fixture(scope="session")
def postgres():
    """URL of a temporary PostgreSQL server, run by an unprivileged user."""
    programs = binaries()
    pytest.importorskip("psycopg")
    if programs is None:
        pytest.skip("no PostgreSQL server programs here")
    user = "nobody" if os.geteuid() == 0 else pwd.getpwuid(os.geteuid()).pw_name
    as_user = {"user": user} if os.geteuid() == 0 else {}
    folder = Path(tempfile.mkdtemp(prefix="gsp-pg-", dir="/tmp"))
    if os.geteuid() == 0:
        shutil.chown(folder, user)
    data = folder / "data"
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    made = subprocess.run(
        [programs / "initdb", "-D", data, "-U", "gsp", "-A", "trust", "--no-sync"],
        check=False, **quiet, **as_user,
    )  # fmt: skip
    if made.returncode:
        shutil.rmtree(folder, ignore_errors=True)
        pytest.skip("initdb does not run here")
    options = f"-p {port} -k {folder} -h 127.0.0.1 -F"
    control = [programs / "pg_ctl", "-D", data, "-w", "-t", "60"]
    started = subprocess.run(
        [*control, "-o", options, "-l", folder / "log", "start"], check=False, **quiet, **as_user
    )
    try:
        if started.returncode:
            pytest.skip("the PostgreSQL server does not start here")
        yield f"postgresql+psycopg://gsp@127.0.0.1:{port}/postgres"
    finally:
        subprocess.run([*control, "-m", "immediate", "stop"], check=False, **quiet, **as_user)
        shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(params=["sqlite", "postgres"])
def any_store(request, sqlite_store, monkeypatch) -> str:
    """URL of an empty store, of both kinds."""
    if request.param == "sqlite":
        return f"sqlite:///{sqlite_store}"
    from gsp.determinant import Store

    url = request.getfixturevalue("postgres")
    monkeypatch.setenv("GSP_STORE", url)
    Store(url).remove()
    return url
