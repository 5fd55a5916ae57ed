"""A design that moves along a path, beside its indices on that path."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from gsp import arguments
from gsp.bridges import Solids, render_motion
from gsp.checks import check_integer, check_items, check_type, is_a
from gsp.determinant import Maximum
from gsp.errors import InvalidInput, UndefinedPosture, brief, expected
from gsp.figures import INK, require_matplotlib, style
from gsp.geometry.copies import ReadOnly, read_only
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.plots.common.bodies import enclose
from gsp.plots.common.style import VERMILION, design_label, film_panels, plain
from gsp.plots.films import Film
from gsp.plots.mechanisms import draw_parts, extent, legend_entries, line_ends
from gsp.plots.sweeps import along
from gsp.sweeps import Path, index_columns, sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

RENDERERS = ("matplotlib", "mujoco")
# Pixels of a picture by MuJoCo: those of its place in a film.
WIDTH, HEIGHT = 800, 700
# What numbers the poses of a batch, which is no path of `gsp.sweeps`.
SAMPLE = "sample"


@arguments.validated(
    design=arguments.kind(Design),
    frames=arguments.integer(2),
    seconds=arguments.positive,
    renderer=arguments.one_of(*RENDERERS),
)
def animate(
    design: Design,
    path: Path | Pose,
    indices: Iterable[str] | str = (),
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | Maximum | None = None,
    frames: int = 60,
    seconds: float = 6.0,
    renderer: str = "matplotlib",
    solids: Solids | None = None,
) -> Film:
    """Return a film of a design that moves along a path, beside its indices on that path.

    A dot moves on the curve of each index. The view and the scale stay as they are. Legs that are
    undefined at a pose are left out of its picture.

    Parameters
    ----------
    design : Design
    path : Path, or Pose of batch shape (n,), n ≥ 2
        A translation or a turn of `gsp.sweeps`, or poses in the order of the motion.
    indices : str or iterable of str
        Names or symbols of indices; none draws the mechanism alone.
    length : float or None [unit of the design]
        Characteristic length; see `gsp.evaluate`.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; see `gsp.evaluate`.
    maximum : float, Maximum or None [unit of |det J|]
        |det J|max for λ; see `gsp.sweep`.
    frames : int
        Most pictures, ≥ 2. Of a longer path equally spaced poses are shown; the curves have all.
    seconds : float [s]
        How long the film lasts.
    renderer : "matplotlib" or "mujoco"
        What draws the mechanism: lines in space, or the links of the model of
        `gsp.bridges.to_mjcf`, drawn by MuJoCo without a window (see `gsp.bridges.render_motion`).
    solids : Solids or None
        Sizes of the links for MuJoCo.

    Returns
    -------
    Film

    Raises
    ------
    InvalidInput, UnknownIndex, MissingParameter
        As `gsp.sweep` does, for a path over a plane, or a pose that is not finite; for solids
        without the renderer "mujoco", and for what only indices use if there are none.
    MissingSoftware
        Without matplotlib, or without MuJoCo where it draws.
    GspError, UndefinedPosture
        See `gsp.bridges.render_motion`.

    Examples
    --------
    >>> import gsp
    >>> lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> turn = gsp.sweeps.turn(lift.home, "z", [-30.0, 0.0, 30.0])
    >>> gsp.plots.animate(lift, turn, ["CTN"]).frames
    3
    """
    path = _checked(path)
    drawn = list(check_items("indices", [indices] if is_a(indices, str) else indices, "names"))
    require_matplotlib()
    if solids is not None and renderer != "mujoco":
        raise InvalidInput(expected("solids", 'renderer="mujoco", which draws them', renderer))
    given = {"length": length, "ellipsoid": ellipsoid, "maximum": maximum}
    for name, value in given.items():
        if value is not None and not drawn:
            raise InvalidInput(expected(name, "None for a film without indices", brief(value)))
    table = None
    if drawn:
        table = sweep(design, path, drawn, length=length, ellipsoid=ellipsoid, maximum=maximum)
    with style():
        return _film(design, path, table, frames, seconds, renderer, solids)


def _checked(path: Path | Pose) -> Path:
    """Return a path with one coordinate and finite poses; that of a batch counts its poses."""
    if isinstance(path, Pose):
        path = Path({SAMPLE: np.arange(float(path.size)).reshape(path.shape)}, path, "")
    check_type("path", path, Path, "a path of gsp.sweeps, or a batch of poses")
    if len(path.pose.shape) != 1 or path.pose.size < 2 or len(path.coordinates) != 1:
        wanted = "two poses or more along one line"
        raise InvalidInput(expected("path", wanted, f"poses of shape {path.pose.shape}"))
    finite = np.isfinite(path.pose.position).all(axis=-1)
    finite &= np.isfinite(path.pose.rotation).all(axis=(-2, -1))
    if not finite.all():
        raise InvalidInput(expected("path", "finite poses", f"pose {int(finite.argmin())} is not"))
    return path


def _film(
    design: Design,
    path: Path,
    table: Any,
    most: int,
    seconds: float,
    renderer: str,
    solids: Solids | None,
) -> Film:
    from matplotlib.ticker import MaxNLocator

    n = path.pose.size
    shown = np.unique(np.linspace(0, n - 1, min(most, n)).round().astype(int))
    columns = [] if table is None else index_columns(table)
    solid = renderer == "mujoco"
    pictures = _rendered(design, path.pose, shown, solids) if solid else None
    figure, space, curves = film_panels(len(columns), flat=solid)
    for name, ax in zip(columns, curves, strict=True):
        along(table, name, ax)
        ax.set_title("", loc="left")
        if SAMPLE in path.coordinates:
            ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    if path.motion:
        figure.suptitle(plain(path.motion), fontsize=10)
    scene: _Scene | _Rendered
    if pictures is None:
        scene = _Scene(cast("Axes3D", space), design, path.pose[shown])
    else:
        scene = _Rendered(space, design, pictures)
    show = _Pictures(scene, [_Pointer(ax) for ax in curves if ax.lines], shown)
    show(0)
    # The layout of the first picture is that of all.
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    return Film(figure, len(shown), seconds, show)


def _rendered(
    design: Design, poses: Pose, shown: NDArray[np.int64], solids: Solids | None
) -> NDArray[np.uint8]:
    """Return pictures by MuJoCo of some of the poses; errors have the numbers of these."""
    try:
        return render_motion(design, poses[shown], solids, width=WIDTH, height=HEIGHT)
    except UndefinedPosture as error:
        where = [one._replace(pose=(int(shown[one.pose[0]]),)) for one in error.undefined]
        raise UndefinedPosture(design.name, where) from error


class _Scene:
    """The mechanism in space: its pictures have one box, one scale and one legend."""

    def __init__(self, ax: Axes3D, design: Design, poses: Pose) -> None:
        self.ax, self.design, self.poses = ax, design, poses
        self.size = extent(design.at(poses[0]))[1]
        points = []
        for frame in range(poses.size):
            posture = design.at(poses[frame])
            points += [extent(posture)[0], line_ends(posture, self.size)]
        enclose(ax, np.concatenate(points), design.unit, self.size)
        ax.legend(handles=legend_entries(design), loc="upper left", bbox_to_anchor=(-0.02, 1.0))
        ax.set_title(design_label(design.name), fontsize=11)

    def draw(self, frame: int) -> None:
        """Draw the mechanism at one of the poses, instead of what is drawn."""
        for artist in [*self.ax.lines, *self.ax.collections]:
            artist.remove()
        draw_parts(self.ax, self.design.at(self.poses[frame]), self.size)


class _Rendered:
    """Pictures of the mechanism that were drawn before."""

    def __init__(self, ax: Axes, design: Design, pictures: NDArray[np.uint8]) -> None:
        self.pictures = pictures
        self.image = ax.imshow(pictures[0], interpolation="antialiased")
        ax.set_axis_off()
        ax.set_title(design_label(design.name), fontsize=11)

    def draw(self, frame: int) -> None:
        """Show one of them."""
        self.image.set_data(self.pictures[frame])


class _Pointer:
    """A dot and a line across the axes, on the curve of an index."""

    def __init__(self, ax: Axes) -> None:
        self.x, self.y = read_only(tuple(map(np.asarray, ax.lines[0].get_data())))
        self.line = ax.axvline(self.x[0], color=INK, linewidth=0.8, zorder=2)
        (self.dot,) = ax.plot(
            self.x[:1], self.y[:1], "o", color=VERMILION, markersize=6, zorder=4, clip_on=False
        )

    def move(self, pose: int) -> None:
        self.line.set_xdata([self.x[pose], self.x[pose]])
        self.dot.set_data([self.x[pose]], [self.y[pose]])


@dataclass(frozen=True, eq=False)
class _Pictures(ReadOnly):
    """What a film calls with the number of a picture; an object, so that films can be pickled."""

    scene: _Scene | _Rendered
    pointers: Sequence[_Pointer]  # of the axes with a value
    shown: NDArray[np.int64]  # the pose of each picture

    def __call__(self, frame: int) -> None:
        if check_integer("frame", frame, least=0) >= len(self.shown):
            wanted = f"the number of one of {len(self.shown)} pictures, from 0"
            raise InvalidInput(expected("frame", wanted, brief(frame)))
        self.scene.draw(frame)
        for pointer in self.pointers:
            pointer.move(int(self.shown[frame]))
