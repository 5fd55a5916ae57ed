"""`read_task` and `read_space`: a task and a space of designs from their files."""

from __future__ import annotations

from os import PathLike

from gsp.checks import plain_text
from gsp.errors import InvalidInput, UnknownIndex
from gsp.exploration.space import Space
from gsp.exploration.space_reading import space_from_toml
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
    reader = TaskReader(text, str(path))
    given = reader.arguments()
    wanted = []
    for number, wish in enumerate(given.pop("wanted")):
        try:
            wanted.append(Wanted(**wish))
        except (InvalidInput, UnknownIndex) as error:
            reader.fail_of_wanted(error, number)
    try:
        return Task(wanted=wanted, **given)
    except (InvalidInput, UnknownIndex) as error:
        reader.fail_of_task(error)


def read_space(path: str | PathLike[str]) -> Space:
    """Return the space of designs of a TOML file, which `Space.write` writes.

    Parameters
    ----------
    path : path of a file

    Returns
    -------
    Space

    Raises
    ------
    MalformedFile
        If the file cannot be read, is not TOML, or has a wrong key or value; the message gives
        the path, and where there is one the line and the key.

    Examples
    --------
    A file such as this one. `make` is a family of designs that commands take, such as "hexapod",
    with angles in degrees; "gsp.hexapod", with the arguments of the function; or "place", with a
    choice of `legs` and a design as the fixed `template`:

    ```toml
    make = "hexapod"

    [ranges]
    platform_radius = [0.5, 1.5]
    platform_angle = [5.0, 60.0]

    [fixed]
    base_radius = 2.0
    base_angle = 20.0
    height = 1.5
    ```
    """
    path = plain_text(path)
    return space_from_toml(read_text(path), str(path))
