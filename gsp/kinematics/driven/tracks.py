"""Tracking with drives at the base: from each sample of joint values to the next."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.kinematics.driven.steps import AT_GAP, DrivenTrack, Place
from gsp.kinematics.newton.centred import Centred
from gsp.kinematics.newton.control import CONVERGED, UNDEFINED
from gsp.model.design import Design

# Greatest number of samples whose poses are found before their steps are proven together, and that
# after a step without a proof.
SAMPLES_PER_PROOF, FIRST_SAMPLES = 256, 4


class Filled(NamedTuple):
    """Arrays that a track fills, as `gsp.kinematics.newton.tracking` does.

    Attributes
    ----------
    position, rotation : (m, 3) and (m, 9) arrays
    numbers : (m, 5) array
    ends : (2,) int array
    """

    position: Array
    rotation: Array
    numbers: Array
    ends: NDArray[np.int64]


def unwrapped(design: Design, samples: Array) -> Array:
    """Return joint values (m, n) with angles of cranks that do not jump by full turns.

    Parameters
    ----------
    design : Design
    samples : (m, n) array [unit of the design, rad]
    """
    result = samples.copy()
    known = np.flatnonzero(np.isfinite(samples).all(axis=1))
    for row, (_, constraint) in enumerate(design.rows):
        if constraint.driven and constraint.quantity == "angle":
            result[known, row] = np.unwrap(samples[known, row])
    return result


def track_driven(
    design: Centred,
    samples: Array,
    start: Pose,
    limits: Array,
    most: int,
    skip: bool,
    filled: Filled,
) -> None:
    """Track m samples of a design with drives at the base.

    Parameters
    ----------
    design : Centred
        With six actuators.
    samples : (m, 6) array [unit of the design, rad]
        Unwrapped.
    start : Pose of batch shape () [unit of the design]
    limits : (3,) array
        Tolerance, largest change between samples, least margin.
    most : int
        Steps of forward kinematics for each sample.
    skip : bool
        Whether impossible samples are skipped.
    filled : Filled
    """
    tolerance, gap, margin = limits.tolist()
    track = DrivenTrack(design, tolerance, most)
    values = design.joints_from(samples)
    order, at, ending = _order(design, values, gap, skip)
    filled.ends[:] = at, ending
    if not len(order):
        return
    here = track.start(design.pose_from(start.reshape(1)), values[order[0]])
    if not np.isfinite(here.joints).all():
        filled.ends[:] = int(order[0]), UNDEFINED
        return
    k, size = 0, 0
    while k < len(order):
        batch = track.batch(here, values[order[k : k + size]])
        reached: list[Place | None] = [*batch]
        if len(batch) == size > 0 or k + len(batch) == len(order):
            size = min(2 * size, SAMPLES_PER_PROOF)
        else:
            reached.append(None)
        for one in reached:
            sample, stop = int(order[k]), CONVERGED
            if one is None:
                one, stop = track.followed(here, values[sample], margin)
                size = FIRST_SAMPLES
            elif one.margin < margin:
                stop = track.below(one, margin)
            if one is None or stop != CONVERGED:
                filled.ends[:] = sample, stop
                return
            pose = design.pose_to(one.pose)
            filled.position[sample], filled.rotation[sample] = pose.position, pose.rotation.ravel()
            filled.numbers[sample] = CONVERGED, one.residual, one.steps, one.pieces, one.margin
            here, k = one, k + 1


def _order(
    design: Centred, values: Array, gap: float, skip: bool
) -> tuple[NDArray[np.int64], int, int]:
    """Return the samples to track, and where and how the track ends if it reaches all of them."""
    possible = design.possible(values)
    order, at, ending = np.flatnonzero(possible), len(values), CONVERGED
    if not skip and not possible.all():
        at = int(possible.argmin())
        order = order[order < at]
        ending = AT_GAP if np.isnan(values[at]).any() else UNDEFINED
    far = np.abs(np.diff(values[order], axis=0)).max(axis=1, initial=0.0) > gap
    if far.any():
        first = int(far.argmax()) + 1
        at, ending, order = int(order[first]), AT_GAP, order[:first]
    return order, at, ending
