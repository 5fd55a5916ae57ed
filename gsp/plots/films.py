"""`Film`: pictures of a motion, shown by Jupyter or written to a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from io import BytesIO
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, MissingSoftware, expected
from gsp.figures import require_matplotlib, style
from gsp.files.writing import check_writable, write_file
from gsp.geometry.copies import ReadOnly
from gsp.progress import Progress, Report, meter

if TYPE_CHECKING:
    from matplotlib.animation import AbstractMovieWriter, FuncAnimation
    from matplotlib.figure import Figure

# Dots per inch of a film.
FILM_DPI = 100
# Megabytes of the pictures in a page, of which matplotlib drops what is beyond.
LARGEST_PAGE = 500.0
# Programs show a picture of less than this for 0.1 s [s], and a GIF can state no longer time than
# that, in hundredths of a second, of one picture, or of all of them if they are equal.
GIF_LEAST, GIF_MOST = 0.02, 655.35
GIF_DIGITS = 9  # of a time per picture
# The writer of matplotlib for each kind of file.
WRITERS = MappingProxyType({".gif": "pillow", ".html": "html", ".mp4": "ffmpeg"})


@dataclass(frozen=True, eq=False)
class Film(ReadOnly):
    """Pictures of a design that moves along a path.

    Jupyter shows it with buttons, and `save` writes a file.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        Shows one of the pictures, at first the first one.
    frames : int
        Number of pictures.
    seconds : float [s]
        How long the film lasts.
    show : function
        Called with the number of a picture, from 0: the figure shows it.
    """

    figure: Figure
    frames: int
    seconds: float
    show: Callable[[int], None] = field(repr=False)

    def save(
        self, path: str | PathLike[str], *, overwrite: bool = False, progress: Progress = None
    ) -> None:
        """Write the film as GIF, as a page with buttons that needs no other file, or as video.

        Parameters
        ----------
        path : str or path
            Ending in .gif, .html or .mp4.
        overwrite : bool
            Whether a file of this name may be replaced.
        progress : function (done, total), bool or None
            Called after each picture. None or True: a progress bar; False: no output.

        Raises
        ------
        InvalidInput
            On another suffix, or for a GIF of more than 655.35 s, or with less than 0.02 s for each
            picture.
        UnwritableOutput
            If the file exists and `overwrite` is not set, or it cannot be written.
        MissingSoftware
            For .mp4 without ffmpeg.
        """
        path, overwrite = arguments.path("path", path), arguments.flag("overwrite", overwrite)
        check_film(path, overwrite=overwrite)
        self._check_rate(Path(path).suffix.lower())
        with meter(progress, "drawing") as report:
            write_file(path, lambda temporary: self._write(temporary, report), overwrite=overwrite)

    def _check_rate(self, suffix: str) -> None:
        """Raise InvalidInput for a GIF in which pictures would last for another time."""
        short = round(self.seconds / self.frames, GIF_DIGITS) < GIF_LEAST
        if suffix == ".gif" and (short or self.seconds > GIF_MOST):
            ends = f"{GIF_LEAST * self.frames:g} to {GIF_MOST:g}"
            wanted = f"{ends} for a GIF of {self.frames} pictures"
            raise InvalidInput(expected("seconds", wanted, f"{self.seconds:g}"))

    def _write(self, path: Path, report: Report) -> None:
        suffix = path.suffix.lower()

        def drawn(frame: int, total: int) -> None:
            report(frame + 1, total)

        with style():
            if suffix == ".gif":
                self._write_gif(path, report)
            else:
                writer = _writer(suffix, self.frames / self.seconds)
                self._animation().save(path, writer, dpi=FILM_DPI, progress_callback=drawn)

    def _write_gif(self, path: Path, report: Report) -> None:
        """Write a GIF, which has times in hundredths of a second, that lasts as long as the film.

        The writer of matplotlib gives all pictures the same time, rounded down.
        """
        import matplotlib.pyplot as plt
        from PIL import Image

        pictures = []
        for frame in range(self.frames):
            self.show(frame)
            with plt.rc_context({"savefig.bbox": None}), BytesIO() as buffer:
                self.figure.savefig(buffer, format="png", dpi=FILM_DPI)
                pictures.append(Image.open(buffer).convert("RGB"))
            report(frame + 1, self.frames)
        ends = np.round(np.linspace(0.0, 100.0 * self.seconds, self.frames + 1))
        times = (10.0 * np.diff(ends)).astype(int).tolist()  # ms
        pictures[0].save(
            path, "GIF", save_all=True, append_images=pictures[1:], duration=times, loop=0
        )

    def _animation(self) -> FuncAnimation:
        from matplotlib.animation import FuncAnimation

        def show(frame: int) -> Sequence[Any]:
            self.show(frame)
            return ()

        interval = 1000.0 * self.seconds / self.frames
        return FuncAnimation(
            self.figure, show, self.frames, interval=interval, cache_frame_data=False
        )

    def _repr_html_(self) -> str:
        """Return the film with buttons, as Jupyter shows it; its figure is not shown besides."""
        import matplotlib.pyplot as plt

        plt.close(self.figure)
        with style():
            return str(self._animation().to_jshtml(embed_frames=True))


def check_film(path: str | PathLike[str], *, overwrite: bool = False) -> None:
    """Raise an error if a film could not be written to `path`, before any work is done for it.

    Raises
    ------
    InvalidInput, UnwritableOutput, MissingSoftware
    """
    require_matplotlib()
    suffix = Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise InvalidInput(expected("film", "a name ending in " + ", ".join(WRITERS), str(path)))
    from matplotlib.animation import writers

    if not writers.is_available(WRITERS[suffix]):
        raise MissingSoftware(WRITERS[suffix], f"a film as {suffix}", hint="write .gif or .html")
    check_writable(path, overwrite=overwrite)


def _writer(suffix: str, rate: Any) -> AbstractMovieWriter:
    """Return the writer of matplotlib for a kind of file, and a number of pictures per second."""
    from matplotlib.animation import FFMpegWriter, HTMLWriter

    if suffix == ".html":
        return HTMLWriter(fps=rate, embed_frames=True, embed_limit=LARGEST_PAGE)
    return FFMpegWriter(fps=rate)
