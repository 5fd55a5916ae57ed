"""The state of one client: a design at a pose, and the settings of the controls."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from gsp.determinant import Maximum
from gsp.errors import InvalidDesign, InvalidInput, brief, expected
from gsp.files.cells import number_of
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design, check_undriven

BASE, PLATFORM = "base", "platform"
FRAMES = (BASE, PLATFORM)
# Increments of a new design: a share of its size, and an angle.
STEP_SHARE, TURN_DEG = 0.05, 5.0
# Greatest increments and coordinates, in sizes of the design.
FARTHEST_SIZES = 1e4
# Least increments and lengths, in sizes of the design and degrees: smaller ones change no number
# that is shown.
LEAST_SIZES, LEAST_DEGREES = 1e-9, 1e-9
# Angles of an entry: ten turns. The rotation of an angle of 1e17 degrees would be rounding.
MOST_DEGREES = 3600.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Session:
    """The state of one client. Each control returns a new one.

    Attributes
    ----------
    design : Design
    pose : Pose of batch shape () [unit of the design]
    step : float [unit of the design]
        Increment of the buttons of positions.
    turn_deg : float [degrees]
        Increment of the buttons of rotations.
    frame : "base" or "platform"
        The axes along and about which the buttons move.
    stops : bool
        Whether motions end at the strokes of the design.
    length : float or None [unit of the design]
        Characteristic length of the indices.
    maximum : Maximum or None
        The maximum of |det J|, if it is known.
    message : str
        What the last control could not do, or "".
    """

    design: Design
    pose: Pose
    step: float
    turn_deg: float = TURN_DEG
    frame: str = BASE
    stops: bool = True
    length: float | None = None
    maximum: Maximum | None = None
    message: str = ""

    @property
    def size(self) -> float:
        """A length that is typical of the design [unit of the design]."""
        return size_of(self.design)

    def saying(self, message: str) -> Session:
        """Return the same state with a message."""
        return replace(self, message=message)


def size_of(design: Design) -> float:
    """Return a length that is typical of a design, > 0 [unit of the design]."""
    reach = max(float(norm(design.base_points).max()), float(norm(design.platform_points).max()))
    return design.rms_radius or reach or 1.0


def started(design: Design, pose: Pose | None = None) -> Session:
    """Return the state for a design: at a pose, by default its home pose.

    Without a home pose the platform is above the centre of the base anchors, by the size of the
    design.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (), or None [unit of the design]

    Examples
    --------
    >>> import gsp
    >>> start = started(gsp.catalogue.design("lee-2000-3-3"))
    >>> bool((start.pose.position == start.design.home.position).all()), start.frame
    (True, 'base')
    """
    check_undriven("design", design)
    if pose is None:
        pose = design.home
    if pose is None:
        pose = Pose(design.base_points.mean(axis=0) + [0.0, 0.0, size_of(design)])
    step = float(f"{STEP_SHARE * size_of(design):.0e}")
    return Session(design=design, pose=pose, step=step, length=design.characteristic_length)


def check_place(state: Session, position: Array) -> None:
    """Check that a position is not far away from the first one of the design.

    Raises
    ------
    InvalidInput
        Beyond 1e4 sizes of the design.
    """
    most = FARTHEST_SIZES * state.size
    if not np.abs(position - started(state.design).pose.position).max() <= most:
        wanted = f"a position within {most:.3g} of the first one of the design"
        raise InvalidInput(expected("pose", wanted, str(position.tolist())))


def check_angles(degrees: ArrayLike) -> None:
    """Check that angles [degrees] are at most ten turns.

    Raises
    ------
    InvalidInput
    """
    given = np.asarray(degrees, dtype=np.float64)
    if not (np.abs(given) <= MOST_DEGREES).all():
        wanted = f"angles between -{MOST_DEGREES:g}° and {MOST_DEGREES:g}°"
        raise InvalidInput(expected("pose", wanted, str(given.tolist())))


def entered(what: str, text: str) -> float:
    """Return the number of an entry.

    Raises
    ------
    InvalidInput
        If the entry is no finite number.

    Examples
    --------
    >>> entered("increment", "2.5e-1")
    0.25
    """
    value = number_of(text)
    if not np.isfinite(value):
        got = brief(text) if text.strip() else "nothing"
        raise InvalidInput(expected(what, "a finite number, such as 0.5 or -2e3", got))
    return value


def entered_or_none(what: str, text: str) -> float | None:
    """Return the number of an entry, None for one that is empty; see `entered`."""
    return entered(what, text) if text.strip() else None


def with_step(state: Session, step: float) -> Session:
    """Return the state with another increment of positions [unit of the design]."""
    value = _positive("increment of positions", step, *_lengths(state))
    return replace(state, step=value, message="")


def with_turn(state: Session, turn_deg: float) -> Session:
    """Return the state with another increment of rotations [degrees]."""
    value = _positive("increment of rotations", turn_deg, LEAST_DEGREES, 180.0)
    return replace(state, turn_deg=value, message="")


def with_length(state: Session, length: float | None) -> Session:
    """Return the state with another characteristic length [unit of the design]; None for none."""
    if length is None:
        return replace(state, length=None, message="")
    value = _positive("characteristic length", length, *_lengths(state))
    return replace(state, length=value, message="")


def with_frame(state: Session, frame: str) -> Session:
    """Return the state with other axes for the buttons: "base" or "platform"."""
    if frame not in FRAMES:
        raise InvalidInput(expected("axes", " or ".join(FRAMES), repr(frame)))
    return replace(state, frame=frame, message="")


def stopping(state: Session, stops: bool) -> Session:
    """Return the state in which motions stop at limits, or do not."""
    return replace(state, stops=bool(stops), message="")


def with_strokes(state: Session, low: float | None, high: float | None) -> Session:
    """Return the state with one stroke for all actuated distances; None for no limit.

    Limits of angles stay.

    Parameters
    ----------
    state : Session
    low, high : float or None [unit of the design]

    Raises
    ------
    InvalidDesign
        If the least value exceeds the greatest, or one is below zero, as no distance is.
    """
    design = state.design
    if not 0.0 <= (low or 0.0) <= (np.inf if high is None else high):
        got = f"{'none' if low is None else low} … {'none' if high is None else high}"
        raise InvalidDesign(expected("limits of all distances", "0 ≤ least ≤ greatest", got))
    n = len(design.joint_names)
    strokes = np.full((n, 2), np.nan) if design.strokes is None else np.array(design.strokes)
    strokes[~design.angular] = [np.nan if v is None else v for v in (low, high)]
    # The poses over which the maximum is taken may depend on the strokes.
    return replace(state, design=design.replace(strokes=strokes), maximum=None, message="")


def common_strokes(state: Session) -> tuple[float | None, float | None]:
    """Return the least and the greatest value that all distances have as limits [unit].

    None where distances have different ones, or none.
    """
    design = state.design
    if design.strokes is None or design.angular.all():
        return None, None
    strokes = design.strokes[~design.angular]
    same = np.isfinite(strokes).all(axis=0) & (strokes == strokes[0]).all(axis=0)
    low, high = (float(x) if one else None for x, one in zip(strokes[0], same, strict=True))
    return low, high


def _lengths(state: Session) -> tuple[float, float]:
    """Return the least and the greatest length that is taken [unit of the design]."""
    return LEAST_SIZES * state.size, FARTHEST_SIZES * state.size


def _positive(what: str, value: float, least: float, most: float) -> float:
    if not least <= value <= most:
        raise InvalidInput(expected(what, f"a number from {least:.3g} to {most:.3g}", value))
    return float(value)
