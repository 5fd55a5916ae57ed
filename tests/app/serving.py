"""`gsp app` in a process of its own, for tests with a real browser."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]


@contextmanager
def server(tmp_path, design, *, killed=False, port=None):
    """The address of `gsp app` in a process of its own; `killed` ends it without a warning."""
    port = port or free_port()
    words = ["-W", "error", "-m", "gsp", "app", design, "--port", str(port)]
    environment = {**os.environ, "GSP_STORE": str(tmp_path / "maxima.sqlite")}
    environment.pop("NICEGUI_USER_SIMULATION", None)
    # In a session of its own: Linux shares processors between sessions, and reports, which have a
    # low priority, would wait for all other tests.
    process = subprocess.Popen(
        [sys.executable, *words], cwd=ROOT, env=environment, start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    try:
        for line in process.stdout:
            if "http://" in line:
                break
        else:
            raise AssertionError("the server has ended")
        address = f"http://127.0.0.1:{port}"
        for _ in range(600):
            try:
                urllib.request.urlopen(address + "/api").close()
                break
            except urllib.error.URLError:
                if process.poll() is not None:
                    raise
                time.sleep(0.05)
        yield address
    finally:
        process.kill() if killed else process.terminate()
        output, _ = process.communicate(timeout=30)
        print(output)
    # Of a process that was being started when the server was killed Python prints one itself.
    assert killed or "Traceback" not in output


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]
