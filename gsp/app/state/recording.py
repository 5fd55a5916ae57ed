"""A recorded motion: poses at times, kept while the platform is moved, or read from a table."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from io import StringIO

import numpy as np

from gsp.app.state.session import FARTHEST_SIZES, Session
from gsp.checks import reading
from gsp.errors import InvalidInput, brief, expected
from gsp.files.cells import number_of
from gsp.geometry.frames import log3
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.geometry.vectors import Array
from gsp.kinematics.tracks import track
from gsp.model.design import Design
from gsp.model.design.toml import toml_from_design

# Samples of a motion; the oldest ones are kept.
MOST_SAMPLES = 2000
# Letters of a table of a motion.
LARGEST_TABLE = 400_000
# Column of a table before those of the pose, which `gsp certify` reads as well.
TIME = "time"
# Seconds between samples of a table without times, and those of a film.
TABLE_STEP, FILM_STEP = 0.1, 0.05
# Frames of a film.
MOST_FRAMES = 400


@dataclass(frozen=True, eq=False, kw_only=True)
class Recording:
    """Poses of a design at times.

    Attributes
    ----------
    design : Design
    times : tuple of float [s]
        From 0, increasing.
    poses : tuple of Pose of batch shape ()
    """

    design: Design
    times: tuple[float, ...] = field(default=())
    poses: tuple[Pose, ...] = field(default=())

    @property
    def seconds(self) -> float:
        """Duration [s]."""
        return self.times[-1] if self.times else 0.0

    def moves(self, design: Design) -> bool:
        """Whether a design is that of the recording but for the strokes."""
        texts = (toml_from_design(one.replace(strokes=None)) for one in (self.design, design))
        return len(set(texts)) == 1

    def with_sample(self, time: float, pose: Pose) -> Recording:
        """Return the recording with a pose at a later time; none beyond `MOST_SAMPLES`."""
        later = not self.times or time > self.times[-1]
        if not later or len(self.times) >= MOST_SAMPLES:
            return self
        return replace(self, times=(*self.times, time), poses=(*self.poses, pose))

    def pose(self, time: float) -> Pose:
        """Return the pose at a time: on the straight motion between two samples."""
        if time >= self.seconds:
            return self.poses[-1]
        i = max(int(np.searchsorted(self.times, time, side="right")) - 1, 0)
        start, end = self.poses[i], self.poses[i + 1]
        share = (max(time, 0.0) - self.times[i]) / (self.times[i + 1] - self.times[i])
        turn = log3(end.rotation @ start.rotation.T)
        return start.moved(share * np.concatenate((end.position - start.position, turn)))

    def frames(self) -> Pose:
        """Return poses evenly in time, from the first to the last, shape (n,), for a film."""
        count = min(max(int(self.seconds / FILM_STEP), 1) + 1, MOST_FRAMES)
        poses = [self.pose(float(time)) for time in np.linspace(0.0, self.seconds, count)]
        return Pose([pose.position for pose in poses], [pose.rotation for pose in poses])

    def table(self) -> str:
        """Return the motion as a table: time, position, roll, pitch and yaw in degrees."""
        out = StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow((TIME, *POSE_COLUMNS))
        for time, pose in zip(self.times, self.poses, strict=True):
            angles = pose.angles("rpy", degrees=True)
            writer.writerow([repr(float(x)) for x in (time, *pose.position, *angles)])
        return out.getvalue()


def from_table(state: Session, text: str, name: str) -> Recording:
    """Return the motion of a table of poses, or of joint values from the present pose on.

    Parameters
    ----------
    state : Session
    text : str
        Comma-separated, with a row of names: x, y, z, angle_1, angle_2, angle_3 (roll, pitch, yaw
        in degrees), or the joints of the design [unit, rad]; "time" [s] may be given.
    name : str
        Of the file, for messages.

    Raises
    ------
    InvalidInput
        On other columns, on cells that are no finite numbers, times that do not increase, too many
        rows, positions far away, or joint values that cannot be followed.
    """
    if len(text) > LARGEST_TABLE:
        raise InvalidInput(expected(name, f"at most {LARGEST_TABLE} letters", len(text)))
    with reading(name, "a table with commas between cells", brief(text)):
        lines = [row for row in csv.reader(StringIO(text)) if row]
    if not 2 <= len(lines) - 1 <= MOST_SAMPLES:
        raise InvalidInput(expected(name, f"2 to {MOST_SAMPLES} rows", max(len(lines) - 1, 0)))
    header = [cell.strip() for cell in lines[0]]
    if twice := [column for column in header if column and header.count(column) > 1]:
        raise InvalidInput(expected(f"{name}, column {brief(twice[0])}", "one of its name", "two"))
    joints = tuple(state.design.joint_names)
    by_pose = set(POSE_COLUMNS) <= set(header)
    if not by_pose and not set(joints) <= set(header):
        wanted = f"columns {', '.join(POSE_COLUMNS)}; or {', '.join(joints)}"
        raise InvalidInput(expected(name, wanted, brief(", ".join(header))))
    values = _columns(name, lines, header, POSE_COLUMNS if by_pose else joints)
    times = _times(name, lines, header)
    poses = _poses(state, name, values) if by_pose else _tracked(state, name, values)
    return Recording(design=state.design, times=tuple(times.tolist()), poses=tuple(poses))


def _columns(
    name: str, lines: Sequence[Sequence[str]], header: list[str], columns: Sequence[str]
) -> Array:
    places = [header.index(column) for column in columns]
    found = np.empty((len(lines) - 1, len(columns)))
    for i, row in enumerate(lines[1:]):
        for j, place in enumerate(places):
            cell = row[place] if place < len(row) else ""
            found[i, j] = number_of(cell)
            if not np.isfinite(found[i, j]):
                where = f"{name}, row {i + 1}, column {columns[j]!r}"
                raise InvalidInput(expected(where, "a finite number", brief(cell) or "nothing"))
    return found


def _times(name: str, lines: Sequence[Sequence[str]], header: list[str]) -> Array:
    if TIME not in header:
        return TABLE_STEP * np.arange(float(len(lines) - 1))
    times = _columns(name, lines, header, (TIME,))[:, 0]
    if not (np.diff(times) > 0.0).all():
        raise InvalidInput(expected(f"{name}, column 'time'", "increasing times", "others"))
    return np.asarray(times - times[0])


def _poses(state: Session, name: str, values: Array) -> list[Pose]:
    farthest = float(np.abs(values[:, :3] - state.pose.position).max())
    if farthest > FARTHEST_SIZES * state.size:
        wanted = f"positions within {FARTHEST_SIZES * state.size:.3g} of the present one"
        raise InvalidInput(expected(name, wanted, f"{farthest:.3g}"))
    return [Pose.from_rpy(row[:3], row[3:], degrees=True) for row in values]


def _tracked(state: Session, name: str, joints: Array) -> list[Pose]:
    found = track(state.design, joints, state.pose)
    if found.reached < len(joints):
        got = f"{found.status} at row {found.reached + 1}"
        raise InvalidInput(expected(name, "joint values that lead on from the present pose", got))
    return [Pose(p, r) for p, r in zip(found.pose.position, found.pose.rotation, strict=True)]
