"""What a report states of a design: each part is computed by public functions when it is read."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.app.report.others import ranked
from gsp.app.state import curves
from gsp.app.state.curves import on_template
from gsp.app.state.reading import Reading, read
from gsp.app.state.session import Session, started, with_length
from gsp.determinant.maxima import known_maximum
from gsp.errors import GspError, InvalidInput
from gsp.exploration import Task, assess
from gsp.geometry.pose import Pose, PoseBox, PosePath
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, Index
from gsp.limits import Feasibility, Limits, feasible
from gsp.model.design import Design
from gsp.model.posture import Posture
from gsp.proof import certify, certify_path, largest_box, singularity_distance
from gsp.proof.certificate import Certificate
from gsp.proof.distance import SingularityDistance
from gsp.proof.largest import LargestBox
from gsp.proof.paths import PathCertificate
from gsp.workspace import Region, fixed_orientation

if TYPE_CHECKING:
    import pandas as pd

# Half-widths of the box whose multiple is proven: a share of the size of the design, and radians.
BOX_SHARE, BOX_ANGLE = 0.1, 0.1
# Boxes of one of its proofs, and the gap at which its search ends: some seconds.
REPORT_BOXES, REPORT_GAP = 20_000, 0.05
# Boxes of the proof for a task.
TASK_BOXES = 500_000
# Sections of the workspace: name, and the two directions of the plane through the platform origin.
PLANES = (
    ("xy", ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))),
    ("xz", ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))),
    ("yz", ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0))),
)
# Relative difference below which two values of an index share a place, and below which a force
# counts as zero beside the greatest one.
SAME = 1e-9


@dataclass(frozen=True, kw_only=True)
class Place:
    """The place of the design among the mechanisms of the catalogue on its own anchor lines.

    Those that are singular at the pose do not count.

    Attributes
    ----------
    better : int
        How many of them have a better value.
    total : int
        How many have a value, the design itself among them.
    best : str
        The first of them.
    """

    better: int
    total: int
    best: str

    @property
    def verdict(self) -> str:
        """In the best quarter "good", in the last one "poor", else "medium"."""
        share = self.better / max(self.total, 1)
        return "good" if share < 0.25 else "poor" if share > 0.75 else "medium"


@dataclass(frozen=True, eq=False)
class Study:
    """What is computed for a report; a part that a design does not have raises a `GspError`.

    Attributes
    ----------
    state : Session
        Design, pose, a characteristic length, and the maximum of |det J| if it is known.
    task : Task or None
        With the length of the state.
    length_of : str
        Where the length is from: "design", "task", or "report" for another one.
    """

    state: Session
    task: Task | None
    length_of: str

    @cached_property
    def reading(self) -> Reading:
        """Joints, Jacobian and indices at the pose."""
        return read(self.shown, slow=True)

    @cached_property
    def shown(self) -> Session:
        """The state with the strokes and the ellipsoid of the task, if it has some.

        Limits of indices take the ellipsoid of the design, unless they have their own.
        """
        design = self.state.design.replace(strokes=self.strokes)
        if self.task is not None and self.task.ellipsoid is not None:
            design = design.replace(ellipsoid=self.task.ellipsoid)
        return replace(self.state, design=design)

    @property
    def strokes(self) -> ArrayLike | None:
        """The strokes of the task, else those of the design."""
        stated = self.limits.strokes if self.limits is not None else None
        return self.state.design.strokes if stated is None else stated

    @cached_property
    def posture(self) -> Posture:
        """The design at the pose."""
        return self.state.design.at(self.state.pose)

    @cached_property
    def limits(self) -> Limits | None:
        """The limits of the task, else the strokes of the design; None without either."""
        if self.task is not None and self.task.limits is not None:
            return self.task.limits
        return None if self.state.design.strokes is None else Limits()

    @property
    def length(self) -> float:
        """The characteristic length."""
        return self.state.length or self.state.size

    @property
    def unit(self) -> str:
        """The unit of length in words."""
        return self.state.design.unit or "units of length"

    @cached_property
    def around(self) -> LargestBox:
        """The largest box around the pose that is proven, of fixed proportions."""
        wide = float(f"{BOX_SHARE * self.state.size:.1g}")
        half_widths = [wide] * 3 + [BOX_ANGLE] * 3
        return largest_box(
            self.state.design,
            self.state.pose,
            half_widths,
            self.limits,
            tolerance=REPORT_GAP,
            budget=REPORT_BOXES,
        )

    @cached_property
    def certificate(self) -> Certificate | PathCertificate:
        """The proof for the poses of the task."""
        design, task = self.state.design, self.task
        if task is None:
            raise InvalidInput("No task was given.")
        if isinstance(task.poses, PoseBox):
            return certify(design, task.poses, self.limits, budget=TASK_BOXES)
        if isinstance(task.poses, PosePath):
            return certify_path(design, task.poses, self.limits, budget=TASK_BOXES)
        raise InvalidInput("The task lists single poses, which are evaluated.")

    @cached_property
    def poses(self) -> Pose:
        """The poses of the task; of a box or path a sample."""
        if self.task is None:
            raise InvalidInput("No task was given.")
        return self.task.pose()

    @cached_property
    def within(self) -> Feasibility | None:
        """Which poses of the task are within the limits; None if there are no limits."""
        if self.limits is None:
            return None
        return feasible(self.state.design, self.poses, self.limits)

    def violation(self, i: int) -> str:
        """Return which limits the i-th pose of the task violates, "" if none."""
        if self.limits is None:
            return ""
        return feasible(self.state.design, self.poses[i], self.limits).reason

    @cached_property
    def unusable(self) -> NDArray[np.str_]:
        """Why the design cannot be used at poses of the task, "" where it can, limits aside."""
        posture = self.state.design.at(self.poses)
        reasons = np.where(posture.singular(), "singular", "").astype(object)
        for entry in posture.undefined:
            reasons[entry.pose] = f"{entry.joint}: {entry.reason}"
        return reasons.astype(np.str_)

    @cached_property
    def distance(self) -> SingularityDistance:
        """The distance from the pose to the nearest singular pose."""
        return singularity_distance(self.state.design, self.state.pose, self.length)

    @cached_property
    def sections(self) -> dict[str, Region]:
        """The positions in planes through the pose at which its rotation is feasible."""
        return {name: self._region(name) for name, _ in PLANES}

    @cached_property
    def space(self) -> Region:
        """The positions in space at which the rotation of the pose is feasible."""
        return self._region("")

    def _region(self, plane: str) -> Region:
        place = None if not plane else (self.state.pose.position, dict(PLANES)[plane])
        rotation = self.state.pose.rotation
        return fixed_orientation(self.state.design, rotation, self.limits, plane=place)

    @cached_property
    def forces(self) -> Array:
        """Actuator forces for a unit load along −x, −y and −z at the platform origin, by rows."""
        forces = self.posture.actuator_forces(-np.eye(6)[:3])
        return np.where(np.abs(forces) < SAME * np.abs(forces).max(), 0.0, forces)

    @cached_property
    def others(self) -> frozenset[str]:
        """Mechanisms on the anchor lines of the design that are not singular at the pose."""
        found = on_template(self.state.design)
        return frozenset(d.mechanism.name for d in found if not d.at(self.state.pose).singular())

    def place(self, index: Index) -> Place | None:
        """Return the place of the design by an index at the pose; None where it has none."""
        own = self.reading.index(index.name)
        if np.isnan(own.value) or index.unit_power not in ("1", "length"):
            return None
        if index.share_of or index.slow or self.reading.singular:
            return None
        found = curves.ranking(self.shown, index.name, self.shown.design)
        some = [one for one in found if one.name in self.others and not np.isnan(one.value)]
        if not some:
            return None
        merits = np.asarray(index.merit(np.array([one.value for one in some])))
        mine = float(index.merit(np.asarray(own.value)))
        better = int((merits > mine + SAME * abs(mine)).sum())
        others = sum(one.name != self.state.design.mechanism.name for one in some)
        return Place(better=better, total=1 + others, best=some[0].name)

    @cached_property
    def places(self) -> dict[str, Place | None]:
        """The place of the design by each index."""
        return {name: self.place(index) for name, index in INDICES.items()}

    @cached_property
    def assessed(self) -> dict[str, Any]:
        """The row of the design in the table of its task."""
        if self.task is None:
            raise InvalidInput("No task was given.")
        table = assess(self.state.design, self.task, progress=False)
        return dict(table.iloc[0])

    @cached_property
    def ranked(self) -> pd.DataFrame:
        """The design and the mechanisms on its anchor lines, ranked for the task, best first."""
        if self.task is None:
            raise InvalidInput("No task was given.")
        return ranked(self.state.design.replace(name=self.name), self.task)

    @property
    def name(self) -> str:
        """The name of the design in the table of its task."""
        return self.state.design.name or "design"


def study_of(design: Design, pose: Pose | None, task: Task | None, length: float | None) -> Study:
    """Return the study of a design at a pose, by default its home pose.

    The length is the one that is given, else that of the task, of the design, or its size.
    """
    state = started(design, pose)
    given = length or (task.length if task is not None else None)
    try:
        state = with_length(state, given or state.length or state.size)
    except InvalidInput as error:
        if length or given is None:
            raise
        raise InvalidInput(f"task, length: {error}") from error
    state = replace(state, maximum=attempted(lambda: known_maximum(design))[0])
    own = "design" if design.characteristic_length else "report"
    origin = "report" if length else "task" if given else own
    return Study(state, None if task is None else replace(task, length=state.length), origin)


def attempted(part: Any) -> tuple[Any, str]:
    """Return what a function returns and "", or None and the reason why there is nothing."""
    try:
        return part(), ""
    except GspError as error:
        return None, str(error)
