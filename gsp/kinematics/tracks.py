"""Tracking: the poses that belong to a log of joint values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp import arguments
from gsp.checks import check_array, check_integer, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.vectors import Array, Mask
from gsp.kinematics.driven.tracks import Filled, track_driven, unwrapped
from gsp.kinematics.newton.centred import Centred, centred
from gsp.model.design import Design

# How a track ends, by the numbers of `gsp.kinematics.newton.tracking`, and with drives at the base.
ENDS = ("", "complete", "not converged", "singular", "undefined", "gap", "singular drive")
# The distance of two lines may have changed its sign between two samples if the sum of both values
# is below this times the changes around them: motions do not double their speed within a sample.
SPEED_CHANGE = 2.0


@dataclass(frozen=True, eq=False)
class Track(ReadOnly):
    """Result of `track`, for m samples.

    Attributes
    ----------
    pose : Pose of batch shape (m,)
        NaN for samples that were not reached or were skipped.
    status : str
        "complete": all samples. "singular": a singular posture stopped the track, or `margin` is
        below `least_margin`. "ambiguous": the lines of a D4 leg may have met before the next
        sample. "gap": a sample is NaN or too far from the one before. "undefined": a sample is none
        that the joints can have, or a leg is undefined at the start. "not converged": none of
        these.
    reached : int
        Number of samples before the track ended; m if it is complete.
    residual : (m,) array [1, rad]
        Largest joint error, distances as a share of `design.rms_radius`; of a drive at the base
        the error of the length of its rod.
    pieces : (m,) array of int
        Number of pieces into which the path from the previous sample was divided.
    iterations : (m,) array of int
        Numbers of postures evaluated.
    margin : (m,) array [1]
        1 / ‖J⁻¹‖ (Frobenius) of the dimensionless Jacobian about the centre of the platform
        anchors, at most its least singular value: how near the track comes to singular postures.
        With drives at the base J is that of their rods, and the margin at most the least magnitude
        of the cosine of a rod and the velocity of its tip.
    """

    pose: Pose
    status: str
    reached: int
    residual: Array
    pieces: NDArray[np.int64]
    iterations: NDArray[np.int64]
    margin: Array

    @property
    def complete(self) -> bool:
        """Whether all samples were reached."""
        return self.status == "complete"


@arguments.validated(skip=arguments.flag)
def track(
    design: Design,
    joints: ArrayLike,
    start: Pose,
    *,
    largest_gap: float = 0.2,
    least_margin: float = 1e-3,
    skip: bool = False,
    tolerance: float = 1e-12,
    max_iterations: int = 100,
) -> Track:
    """Return the poses of a log of joint values, such as encoders give.

    Each sample is found from the pose of the one before, by the steps of `gsp.forward`: on the
    whole path no leg is undefined and det J is not zero. Between two samples the joint values are
    taken to change linearly. Where Newton's method needs a shorter step than its own, or more than
    six, the path is divided, down to 2⁻²⁰, so that the poses follow that line. If the log passes
    a singular posture between two samples, poses on both sides have its joint values; `margin`
    and `least_margin` detect this if a sample is near that posture. Where samples are few the log
    may pass it undetected: `least_margin` should exceed what `margin` changes by from one sample
    to the next.

    The distance of the two lines of a D4 leg has no sign in the log. Where the lines meet, the
    platform may go through or turn back with the same joint values, and the track ends as
    "ambiguous" before the next sample: where the sum of the distances at both samples is less
    than twice the largest change of a joint from one to the other, or of this distance in the
    intervals before and after. (Distances as a share of `design.rms_radius`, angles in rad.) A
    motion that is faster in one interval only is not detected. To continue, track the samples that
    are left from a start on the side that is meant.

    With drives at the base, forward kinematics of the rods from their tips finds the pose of a
    sample. Then it is proven that on the straight step from the pose before, on which the drives
    move, no posture and no drive is singular, as in `gsp.travel`; where there is no proof the path
    is divided as above, also that from the start, whose joint values are known. The drives stay on
    their branches. Angles of cranks may be counted beyond π, or jump by full turns.

    Parameters
    ----------
    design : Design
        With six actuators.
    joints : (m, 6) array_like [unit of the design, rad]
        Samples in the order of `design.joint_names`; NaN where there is none.
    start : Pose of batch shape ()
        Near the pose of the first sample.
    largest_gap : float [1, rad]
        Largest change of a joint from one sample to the next, distances as a share of
        `design.rms_radius`; what is more ends the track as a gap.
    least_margin : float [1]
        `Track.margin` below which the track ends as singular.
    skip : bool
        Whether samples that are NaN or impossible are skipped instead of ending the track; the
        change of a joint is then counted from the last valid sample.
    tolerance : float [1, rad]
    max_iterations : int
        For the first sample and the smallest pieces, as for `gsp.forward`.

    Returns
    -------
    Track

    Raises
    ------
    InvalidInput
        On other types or shapes, a design with more than six actuators, or numbers out of range.

    *Source: ours, with the steps of `gsp.forward`.*

    Examples
    --------
    >>> import numpy as np
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> path = d.home.moved(np.linspace(0, 1, 50)[:, None] * [20, 10, -5, 0.1, 0.2, 0.1])
    >>> found = gsp.track(d, d.at(path).joints, d.home)
    >>> found.status, bool(np.abs(found.pose.position - path.position).max() < 1e-8)
    ('complete', True)
    """
    samples = _samples(design, joints)
    check_type("start", start, Pose)
    if start.shape:
        raise InvalidInput(expected("start", "a single pose", f"{start!r}"))
    limits = np.array(
        [
            check_positive("tolerance", tolerance),
            check_positive("largest_gap", largest_gap),
            check_positive("least_margin", least_margin),
        ]
    )
    most = check_integer("max_iterations", max_iterations)
    c = centred(design)
    if design.driven:
        samples = unwrapped(design, samples)
    last = _first_crossing(c, samples, limits[1])
    return _tracked(c, samples, last, start, limits, most, skip)


def _tracked(
    c: Centred, samples: Array, last: int, start: Pose, limits: Array, most: int, skip: bool
) -> Track:
    """Return the track of all samples, of which those from `last` on are ambiguous."""
    position, rotation, numbers = (np.full((len(samples), k), np.nan) for k in (3, 9, 5))
    ends = np.zeros(2, dtype=np.int64)
    filled = Filled(position[:last], rotation[:last], numbers[:last], ends)
    if c.design.driven:
        track_driven(c, samples[:last], start, limits, most, skip, filled)
    else:
        _with_compiled(c, samples[:last], start, limits, most, skip, filled)
    complete = ENDS[ends[1]] == "complete"
    counts = np.nan_to_num(numbers[:, 2:4]).astype(np.int64)
    return Track(
        pose=unchecked(Pose, position, rotation.reshape(-1, 3, 3)),
        status="ambiguous" if complete and last < len(samples) else ENDS[ends[1]],
        reached=int(ends[0]),
        residual=numbers[:, 1],
        pieces=counts[:, 1],
        iterations=counts[:, 0],
        margin=numbers[:, 4],
    )


def _with_compiled(
    c: Centred,
    samples: Array,
    start: Pose,
    limits: Array,
    most: int,
    skip: bool,
    filled: Filled,
) -> None:
    from gsp.kinematics.newton.tracking import track_samples

    track_samples(
        samples,
        np.ascontiguousarray(start.position).reshape(1, 3),
        np.ascontiguousarray(start.rotation).reshape(1, 9),
        c.kinds,
        c.geometry,
        c.paths,
        c.design.angular,
        c.frame,
        limits,
        most,
        skip,
        *filled,
    )


def _first_crossing(design: Centred, samples: Array, gap: float) -> int:
    """Return the first sample before which the lines of a leg may have met; m if there is none."""
    values = design.joints_from(samples)
    valid = np.flatnonzero(design.possible(values))
    values = values[valid]
    changes = np.abs(np.diff(values, axis=0))
    around = np.pad(changes, ((1, 1), (0, 0)))
    nearby = np.maximum(around[:-2], around[2:])
    reach = np.maximum(changes.max(axis=1, initial=0.0, keepdims=True), nearby)
    met = (values[1:] + values[:-1] < SPEED_CHANGE * reach) & _of_two_lines(design.design)
    met &= changes.max(axis=1, initial=0.0, keepdims=True) <= gap  # others end as a gap
    first = np.flatnonzero(met.any(axis=1))
    return int(valid[first[0] + 1]) if first.size else len(samples)


def _of_two_lines(design: Design) -> Mask:
    """Whether actuators measure the distance of two lines, shape (n,)."""
    legs = [(design.legs[row.leg], row.constraint.quantity) for row in design.rows]
    return np.array([x.base_line and x.platform_line and q == "distance" for x, q in legs])


def _samples(design: Design, joints: ArrayLike) -> Array:
    check_type("design", design, Design)
    n = len(design.joint_names)
    if n != 6:
        raise InvalidInput(expected("design", "six actuators", n))
    samples = check_array("joints", joints, (None, 6), finite=False)
    if samples.ndim != 2:
        raise InvalidInput(expected("joints", "shape (m, 6)", f"shape {samples.shape}"))
    return np.ascontiguousarray(samples)
