"""Run the command line in this process, in an empty folder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from gsp.cli import main


@dataclass(frozen=True)
class Result:
    """What a command gave."""

    status: int
    out: str
    err: str

    @property
    def error(self) -> str:
        """The one line of an error: checks that there is one, and no traceback."""
        assert self.status == 2, self
        lines = self.err.strip().splitlines()
        assert len(lines) == 1, lines
        assert lines[0].startswith("gsp: ")
        assert "Traceback" not in self.err
        return lines[0]


@pytest.fixture
def gsp(tmp_path, monkeypatch, capsys) -> Callable[..., Result]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("COLUMNS", raising=False)  # processes of a parallel run have it

    def run(*arguments: object) -> Result:
        with pytest.raises(SystemExit) as exit_:
            main([str(a) for a in arguments])
        out, err = capsys.readouterr()
        return Result(int(exit_.value.code or 0), out, err)

    return run
