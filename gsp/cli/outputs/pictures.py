"""Pictures and films that commands write."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

from gsp.cli.outputs.console import say
from gsp.errors import InvalidInput
from gsp.progress import during

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from gsp.plots import Film


def check_picture(path: Path, *, overwrite: bool = False) -> None:
    """Raise an error if a picture could not be written to `path`, before any work is done."""
    from gsp.plots.common.style import check_picture

    try:
        check_picture(path, overwrite=overwrite)
    except InvalidInput as error:
        raise InvalidInput(str(error).replace("picture:", "--plot:", 1)) from error


def check_film(path: Path, *, overwrite: bool = False) -> None:
    """Raise an error if a film could not be written to `path`, before any work is done."""
    from gsp.plots.films import check_film

    try:
        check_film(path, overwrite=overwrite)
    except InvalidInput as error:
        raise InvalidInput(str(error).replace("film:", "--film:", 1)) from error


class Renderer(StrEnum):
    """What draws the mechanism of a film."""

    matplotlib = "matplotlib"
    mujoco = "mujoco"


def save_film(film: Film, path: Path, *, overwrite: bool = False) -> None:
    """Write a film, close its figure, and print its name."""
    import matplotlib.pyplot as plt

    film.save(path, overwrite=overwrite)
    plt.close(film.figure)
    say(f"Film       {path}")


def save_picture(figure: Figure | Axes, path: Path, *, overwrite: bool = False) -> None:
    """Write a figure, close it, and print its name."""
    import matplotlib.pyplot as plt

    from gsp.plots import save

    with during("picture"):
        save(figure, path, overwrite=overwrite)
    plt.close(figure.figure)  # type: ignore[arg-type]
    say(f"Picture    {path}")
