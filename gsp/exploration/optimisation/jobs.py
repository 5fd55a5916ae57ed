"""Where the result and the steps of a search are stored."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from gsp.evaluation.parts import Output, Parts
from gsp.exploration.assessing import Run

if TYPE_CHECKING:
    import pandas as pd


class Job:
    """The file and the folder of a search, if there are any.

    Parameters
    ----------
    mark : str
        Checksum of the search.
    run : Run
    """

    def __init__(self, mark: str, run: Run) -> None:
        self.mark, self.run = mark, run
        self.output = None if run.out is None else Output(run.out, mark, resume=run.resume)

    @property
    def finished(self) -> bool:
        """Whether the file of the same search is there."""
        return self.output is not None and self.output.finished

    def result(self) -> pd.DataFrame:
        """Return the table of a finished search."""
        assert self.output is not None
        return self.output.result()

    @contextmanager
    def opened(self) -> Iterator[Parts | None]:
        """Yield the folder of the steps; it is deleted, unless the search is stopped."""
        beside = None if self.output is None else self.output.folder
        folder = beside if self.run.parts is None else self.run.parts
        if self.finished or folder is None:
            yield None
            return
        kept = Parts(folder, self.mark, ".json", resume=self.run.resume)
        with kept.removed():
            yield kept

    def written(self, frame: pd.DataFrame) -> pd.DataFrame:
        """Write the table, and return it."""
        if self.output is not None:
            self.output.write(frame)
        return frame
