"""`read_task`: a task from its file."""

from __future__ import annotations

from os import PathLike

from gsp.checks import plain_text
from gsp.errors import InvalidInput, MalformedFile, UnknownIndex
from gsp.exploration.task import Task, Wanted
from gsp.exploration.toml import TaskReader
from gsp.files.writing import read_text

# Bytes of the longest task file that is read: a million poses of twelve numbers.
BYTES_PER_TASK = 256 * 2**20


def read_task(path: str | PathLike[str]) -> Task:
    """Return the task of a TOML file, which `Task.write` writes.

    Parameters
    ----------
    path : path of a file

    Returns
    -------
    Task

    Raises
    ------
    MalformedFile
        If the file cannot be read, is not TOML, or has a wrong key or value; the message gives
        the path, and where there is one the line and the key.

    Examples
    --------
    A file such as this one; angles of a box are `angles` [rad] or `angles_deg`:

    ```toml
    name = "assembly"
    unit = "mm"
    samples = 500

    [[wanted]]
    index = "CTN"
    of = "worst"

    [box]
    position = [[-10.0, 30.0], [-30.0, 10.0], [120.0, 150.0]]
    angles_deg = [[-5.0, 5.0], [-5.0, 5.0], 0.0]
    ```
    """
    path = plain_text(path)
    text = read_text(path, most=BYTES_PER_TASK)
    origin = str(path)
    given = TaskReader(text, origin).arguments()
    try:
        wanted = [Wanted(**wish) for wish in given.pop("wanted")]
        return Task(wanted=wanted, **given)
    except (InvalidInput, UnknownIndex) as error:
        raise MalformedFile(f"{origin}: {error}") from error
