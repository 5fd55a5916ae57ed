"""`Task`: the poses of a task, their limits, and what is wanted of which index."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from os import PathLike
from typing import Any, Literal, get_args

import numpy as np

from gsp import arguments
from gsp.checks import check_items, check_line, check_positive, check_type, is_a
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.toml import toml_from_task
from gsp.files.writing import write_text
from gsp.geometry.copies import ReadOnly
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox, PosePath
from gsp.geometry.vectors import frozen
from gsp.indices import INDICES, index_name
from gsp.limits import Limits
from gsp.model.units import check_unit
from gsp.proof.boxes import check_box
from gsp.proof.extremes import bounded_name
from gsp.statics import Masses

Statistic = Literal["mean", "worst", "proven worst", "volume"]
STATISTICS: tuple[Statistic, ...] = get_args(Statistic)
_WANTED = re.compile(rf"^\s*({'|'.join(STATISTICS[::-1])})\s+(.+?)\s*$")
EXAMPLE = '"mean CTN", "worst CDN_CL", "proven worst σ_min" or "volume reachable"'
# Workspaces of which the volume may be wanted, and the ends of the names of its columns.
WORKSPACES = ("reachable", "dextrous")
LOW, HIGH, RESOLUTION = "volume_low", "volume_high", "volume_resolution"


@dataclass(frozen=True)
class Wanted:
    """What is wanted of an index, or of a workspace, and how much it counts.

    Parameters
    ----------
    index : str
        Name or symbol. As an attribute the name. For a volume "reachable" or "dextrous".
    of : "mean", "worst", "proven worst" or "volume"
        The mean over the poses; the worst value at one of the poses; a proven bound of the worst
        value over all poses of a box; or the volume of the positions at which some orientation of
        the box ("reachable"), or each of them ("dextrous"), is within the limits.
    weight : float [1]
        > 0: the exponent of the value in the score.

    Raises
    ------
    UnknownIndex
        If there is no such index, or none with proven bounds where these are wanted.
    InvalidInput
        On another word or weight.

    Examples
    --------
    >>> Wanted("CTN", "worst").column
    'control_number_min'
    """

    index: str
    of: Statistic = "mean"
    weight: float = 1.0

    def __post_init__(self) -> None:
        of = arguments.one_of(*STATISTICS)("wanted.of", self.of)
        find = bounded_name if of == "proven worst" else index_name
        if of == "volume":
            find = partial(arguments.one_of(*WORKSPACES), "wanted.index")
        object.__setattr__(self, "index", find(arguments.text("wanted.index", self.index)))
        object.__setattr__(self, "weight", check_positive("wanted.weight", self.weight))

    @property
    def column(self) -> str:
        """The column of a table of designs with its value."""
        worst = "min" if self.better == "higher" else "max"
        ends = {"mean": "mean", "worst": worst, "proven worst": "proven", "volume": LOW}
        return f"{self.index}_{ends[self.of]}"

    @property
    def better(self) -> Literal["higher", "lower"]:
        """Which side of the values is better, "higher" or "lower"."""
        return "higher" if self.of == "volume" else INDICES[self.index].better

    @property
    def label(self) -> str:
        """What is wanted, with the symbol of the index, such as "worst CTN"."""
        return f"{self.of} {self.index if self.of == 'volume' else INDICES[self.index].symbol}"


@dataclass(frozen=True, eq=False, kw_only=True)
class Task(ReadOnly):
    """What designs are compared for: poses, limits, and what is wanted of which index.

    Parameters
    ----------
    poses : PoseBox, PosePath or Pose of batch shape (n,)
        A box is sampled, a path at equal steps of time with both ends; a batch is taken as it is.
    wanted : sequence of Wanted or str, mapping from str to weight, or str
        Such as "mean CTN", "worst CDN_CL", "proven worst σ_min", "volume reachable" or "volume
        dextrous"; the last three need a box.
    limits : Limits or None
        If given, means and worst values are over the poses that satisfy them, and the share of
        these poses is stated; `gsp.Limits()` stands for the strokes of each design. Proven worst
        values are over all poses of the box.
    samples : int
        Number of poses of a box or path.
    seed : int
        Seed of the Halton sample of a box.
    length : float or None [unit]
        Characteristic length of all designs; default the one that each records.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid of all designs; default the one that each records.
    payload : Masses or None
        Masses that the actuators hold at rest: of the platform with its payload, and of the links.
    wrench : (6,) array_like or None [N, N · unit]
        Another force and moment on the platform, about its origin, in base axes.
    resolution : float or None [unit]
        Longest side of the cells of a workspace that may stay undecided, where a volume is wanted
        or required by `optimise`; otherwise it has no effect. Default: cells are halved until the
        bracket is within ±6 % (dextrous 3 %), or the budget ends.
    unit : str
        Unit of length of the numbers; "" for that of the designs.
    name : str

    Attributes
    ----------
    wanted : tuple of Wanted

    Raises
    ------
    InvalidInput
        On arguments of a wrong type or value, nothing wanted, the same wanted twice, a proven
        worst value, a volume or a resolution without a box.
    UnknownIndex
        On the name of no index, or of one without proven bounds where these are wanted.

    Examples
    --------
    >>> import gsp
    >>> box = gsp.PoseBox([(-10, 10), (-10, 10), 130], [0, 0, 0])
    >>> task = gsp.Task(poses=box, wanted={"mean CTN": 2.0, "worst CDN_CL": 1.0}, samples=100)
    >>> task.pose().shape
    (100,)
    """

    poses: PoseBox | PosePath | Pose
    wanted: Any
    limits: Limits | None = None
    samples: int = 1000
    seed: int = 0
    length: float | None = None
    ellipsoid: Ellipsoid | None = None
    payload: Masses | None = None
    wrench: Any = None
    resolution: float | None = None
    unit: str = ""
    name: str = ""

    def __post_init__(self) -> None:
        poses = self.poses
        flat = is_a(poses, Pose) and len(poses.shape) == 1 and poses.size
        if not flat and not is_a(poses, PoseBox | PosePath):
            wish = "a PoseBox, a PosePath, or a Pose of batch shape (n,), not empty"
            raise InvalidInput(expected("task.poses", wish, brief(poses)))
        wanted = _all_wanted(self.wanted)
        kinds = {wish.of for wish in wanted}
        for kind, text in (("proven worst", "proven worst value"), ("volume", "volume")):
            if kind in kinds and not isinstance(poses, PoseBox):
                wish = f"a PoseBox, as a {text} is wanted"
                raise InvalidInput(expected("task.poses", wish, type(poses).__name__))
        if "proven worst" in kinds and isinstance(poses, PoseBox):
            check_box(poses)
        if self.resolution is not None:
            resolution = check_positive("task.resolution", self.resolution)
            object.__setattr__(self, "resolution", resolution)
            if not isinstance(poses, PoseBox):
                got = f"{resolution} and a {type(poses).__name__}"
                wish = "none without a PoseBox, over whose angles volumes are"
                raise InvalidInput(expected("task.resolution", wish, got))
        if self.limits is not None:
            check_type("task.limits", self.limits, Limits)
        if self.ellipsoid is not None:
            check_type("task.ellipsoid", self.ellipsoid, Ellipsoid)
        if self.payload is not None:
            check_type("task.payload", self.payload, Masses, "a gsp.statics.Masses")
        if self.wrench is not None:
            wrench = frozen(arguments.bounded_array("task.wrench", self.wrench, (6,)))
            if wrench.ndim != 1:
                got = f"shape {wrench.shape}"
                raise InvalidInput(expected("task.wrench", "six numbers, shape (6,)", got))
            object.__setattr__(self, "wrench", wrench)
        if self.length is not None:
            object.__setattr__(self, "length", check_positive("task.length", self.length))
        for name, value in (
            ("wanted", wanted),
            ("samples", arguments.integer(1)("task.samples", self.samples)),
            ("seed", arguments.integer(0)("task.seed", self.seed)),
            ("unit", check_unit("task.unit", self.unit)),
            ("name", check_line("task.name", self.name)),
        ):
            object.__setattr__(self, name, value)

    @property
    def indices(self) -> tuple[str, ...]:
        """Names of the indices of which something is wanted, each once."""
        return tuple(dict.fromkeys(w.index for w in self.wanted if w.of != "volume"))

    def pose(self) -> Pose:
        """Return the poses at which designs are evaluated, batch shape (n,).

        Returns
        -------
        Pose of batch shape (samples,), or the batch of the task

        Raises
        ------
        InvalidInput
            If so many poses do not fit into the memory.
        """
        if isinstance(self.poses, PoseBox):
            return self.poses.sample(self.samples, rng=self.seed)
        if isinstance(self.poses, PosePath):
            start, end = float(self.poses.times[0]), float(self.poses.times[-1])
            return self.poses.pose(np.linspace(start, end, self.samples))
        return self.poses

    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the task as TOML; `gsp.read_task` gives the same numbers, bit by bit.

        Parameters
        ----------
        path : path of a file
        overwrite : bool
            Whether a file that exists is replaced.

        Raises
        ------
        UnwritableOutput
            If the file exists and `overwrite` is not set, or the folder cannot be written.
        """
        allowed = arguments.flag("overwrite", overwrite)
        write_text(arguments.path("path", path), toml_from_task(self), overwrite=allowed)


def _all_wanted(given: Any) -> tuple[Wanted, ...]:
    """Return what is wanted as records, each of them once."""
    wish = f"texts such as {EXAMPLE}, or gsp.exploration.Wanted"
    if is_a(given, str | Wanted):
        given = (given,)
    if is_a(given, Mapping):
        pairs: Iterable[Any] = arguments.mapping("task.wanted", given).items()
    else:
        pairs = ((one, None) for one in check_items("task.wanted", given, wish))
    found = tuple(_one_wanted(one, weight, wish) for one, weight in pairs)
    if not found:
        raise InvalidInput(expected("task.wanted", wish, "none"))
    columns = [one.column for one in found]
    for column in columns:
        if columns.count(column) > 1:
            raise InvalidInput(expected("task.wanted", "each value once", f"twice {column}"))
    return found


def _one_wanted(one: Any, weight: Any, wish: str) -> Wanted:
    if is_a(one, Wanted) and weight is None:
        return one
    return wanted_value("task.wanted", one, wish, 1.0 if weight is None else weight)


def wanted_value(what: str, text: Any, wish: str = EXAMPLE, weight: float = 1.0) -> Wanted:
    """Return what a text such as "worst CTN" names; `what` and `wish` are those of the error.

    Raises
    ------
    InvalidInput, UnknownIndex
    """
    match = _WANTED.match(text) if is_a(text, str) else None
    if match is None:
        raise InvalidInput(expected(what, wish, brief(text)))
    of: Any = match[1]
    return Wanted(match[2], of, weight)
