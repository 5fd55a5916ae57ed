"""What is shown of a state: joints with limits, det J, indices, the least controlled motion."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np

from gsp.app.state.choices import named
from gsp.app.state.session import Session, started
from gsp.catalogue.placement import TEMPLATE
from gsp.determinant import outside
from gsp.errors import GspError
from gsp.evaluation.settings import Settings
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, Index
from gsp.indices.motion import instantaneous_motion
from gsp.indices.singularity import singularity_distance
from gsp.model.design.checks import open_strokes
from gsp.model.posture import Posture

# Set once the code of slow indices is compiled.
COMPILED = threading.Event()
# Digits of powers.
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True, kw_only=True)
class JointReading:
    """The value of an actuated joint and what is left of its stroke.

    Attributes
    ----------
    name, unit : str
    number, leg : int
        Number of the joint from 0, of the leg from 1.
    angular : bool
    value, low, high : float [unit of the design, degrees]
        NaN where undefined, ∓inf where there is no limit.
    reason : str
        Why there is no value, or "".
    """

    name: str
    unit: str
    number: int
    leg: int
    angular: bool
    value: float
    low: float
    high: float
    reason: str

    @property
    def left(self) -> float:
        """What is left to the nearer limit, negative outside, inf without one."""
        return min(self.value - self.low, self.high - self.value)

    @property
    def share(self) -> float:
        """Place in the stroke: 0 at the least, 1 at the greatest value; NaN without both limits."""
        width = self.high - self.low
        return (self.value - self.low) / width if 0.0 < width < np.inf else float("nan")

    @property
    def free(self) -> float:
        """What is left as a share of half the stroke: 1 in its middle, 0 at a limit.

        Negative outside; NaN without both limits.
        """
        width = self.high - self.low
        return 2.0 * self.left / width if 0.0 < width < np.inf else float("nan")


@dataclass(frozen=True, kw_only=True)
class IndexReading:
    """The value of an index, or why there is none.

    Attributes
    ----------
    index : Index
    value : float [unit]
    unit : str
    reason : str
        Why there is no value, or what qualifies it; "" as a rule.
    """

    index: Index
    value: float
    unit: str
    reason: str

    @property
    def gauge(self) -> float:
        """The merit as a share of its best value, in [0, 1]; NaN where no best value bounds it."""
        return float(gauges(self.index, np.asarray(self.value)))


@dataclass(frozen=True, eq=False, kw_only=True)
class Reading:
    """What is shown of a state.

    Attributes
    ----------
    joints : tuple of JointReading
    jacobian : (n, 6) array
    determinant : float [unit^(3 − number of A1 rows)]
        det J with its sign; NaN for redundant and undefined postures.
    indices : tuple of IndexReading
    singular : bool
    undefined : tuple of str
        Joints without a value, with the reasons.
    screw : tuple of (3,) arrays and a float, or None
        Point and direction of the axis of the least controlled motion, and its pitch; None for a
        translation, or where it is not defined.
    """

    joints: tuple[JointReading, ...]
    jacobian: Array
    determinant: float
    indices: tuple[IndexReading, ...]
    singular: bool
    undefined: tuple[str, ...]
    screw: tuple[Array, Array, float] | None

    @property
    def least(self) -> JointReading:
        """The joint of which the least of its stroke is left."""
        return min(self.joints, key=lambda joint: joint.left)

    def index(self, name: str) -> IndexReading:
        """Return the reading of an index by its name."""
        return next(one for one in self.indices if one.index.name == name)


def powers(unit: str) -> str:
    """Return a unit for people: nothing for 1, raised digits.

    >>> powers("mm^3"), powers("(ft / s)^-2"), powers("1"), powers("mixed")
    ('mm³', '(ft / s)⁻²', '', 'mixed')
    """
    stem, mark, power = unit.rpartition("^")
    return "" if unit == "1" else stem + power.translate(RAISED) if mark else unit


def gauges(index: Index, values: Array) -> Array:
    """Return merits as shares of the best value, in [0, 1]; NaN where no best value bounds it."""
    best = float(index.merit(np.asarray(index.best)))
    if not np.isfinite(best):
        return np.full(np.shape(values), np.nan)
    return np.clip(np.asarray(index.merit(values)) / best, 0.0, 1.0)


def gauges_at(state: Session, name: str, pose: Pose) -> Array:
    """Return the gauges of an index at a batch of poses; NaN where a parameter is missing."""
    index = INDICES[name]
    if index.slow or missing_words(state, index):
        return np.full(pose.shape, np.nan)
    values = index.function(state.design.at(pose), **settings(state).for_index(index))
    return gauges(index, np.asarray(values))


def compile_slow() -> None:
    """Compile slow indices, or load their code, and set `COMPILED`."""
    state = started(named(TEMPLATE))
    singularity_distance(state.design.at(state.pose), state.design.rms_radius)
    COMPILED.set()


def read(state: Session, *, slow: bool = False) -> Reading:
    """Return what is shown of a state.

    Parameters
    ----------
    state : Session
    slow : bool
        Whether slow indices are computed as well, which takes a millisecond once their code has
        been compiled (`COMPILED`), and seconds before.

    Examples
    --------
    >>> import gsp
    >>> from gsp.app.state.session import started
    >>> shown = read(started(gsp.catalogue.design("lee-2000-3-3")))
    >>> round(shown.determinant, 3), shown.joints[0].name, shown.index("quality_index").reason
    (1.299, 'd1', 'the maximum of |det J| is not known yet')
    """
    posture = state.design.at(state.pose)
    return Reading(
        joints=joint_readings(posture),
        jacobian=posture.jacobian,
        determinant=determinant_of(posture.jacobian),
        indices=tuple(index_reading(state, posture, name, slow) for name in INDICES),
        singular=bool(posture.singular()),
        undefined=tuple(f"{entry.joint}: {entry.reason}" for entry in posture.undefined),
        screw=_screw(state, posture),
    )


def determinant_of(rows: Array) -> float:
    """Return the determinant of a matrix with its sign; NaN where it has none."""
    if rows.shape != (6, 6) or not np.isfinite(rows).all():
        return float("nan")
    return float(np.linalg.det(rows))


def joint_readings(posture: Posture) -> tuple[JointReading, ...]:
    """Return the joints of a single posture, angles in degrees."""
    design = posture.design
    strokes = open_strokes(design.strokes, len(design.joint_names))
    factor = np.where(design.angular, 180.0 / np.pi, 1.0)
    reasons = {entry.joint: entry.reason for entry in posture.undefined}
    return tuple(
        JointReading(
            name=name,
            unit="°" if design.angular[i] else design.unit,
            number=i,
            leg=design.rows[i].leg + 1,
            angular=bool(design.angular[i]),
            value=float(posture.joints[i] * factor[i]),
            low=float(strokes[i, 0] * factor[i]),
            high=float(strokes[i, 1] * factor[i]),
            reason=reasons.get(name, ""),
        )
        for i, name in enumerate(design.joint_names)
    )


def settings(state: Session) -> Settings:
    """Return the parameters of the indices for a state."""
    known = state.maximum.value if state.maximum is not None else None
    return Settings(state.length, state.design.ellipsoid, known or None)


def index_reading(state: Session, posture: Posture, name: str, slow: bool) -> IndexReading:
    """Return the value of an index at a single posture, or why it has none."""
    index = INDICES[name]
    value, reason = float("nan"), missing_words(state, index)
    if not reason and index.slow and not slow:
        reason = "its code is not compiled yet"
    if not reason:
        try:
            value = float(index.function(posture, **settings(state).for_index(index)))
        except GspError as error:
            reason = str(error)
    if index.share_of and value > 1.0 + 1e-9 and state.maximum is not None:
        beyond = outside(state.maximum, posture.pose)
        reason = "outside of the poses of the maximum" if beyond else "above the known maximum"
    if not reason and np.isnan(value):
        reason = "undefined at this pose"
    return IndexReading(index=index, value=value, unit=index.unit(state.design), reason=reason)


def missing_words(state: Session, index: Index) -> str:
    """Return what an index misses for the design of a state, in words, or ""."""
    for need in index.missing(state.design, settings(state).given()):
        if need == "maximum" and state.maximum is not None:
            return "the design is singular in every pose"
        words = {
            "maximum": "the maximum of |det J| is not known yet",
            "length": "needs a characteristic length",
            "ellipsoid": "needs an operation ellipsoid, which a design file can give",
        }
        return words.get(need, f"defined for {need} only")
    return ""


def _screw(state: Session, posture: Posture) -> tuple[Array, Array, float] | None:
    try:
        motion = instantaneous_motion(posture, length=state.length)
    except GspError:  # a length is missing, or the posture is undefined
        return None
    if not np.isfinite(motion.axis).all():
        return None
    return motion.point, motion.axis[:3], float(motion.pitch)
