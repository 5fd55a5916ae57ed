"""Steps of tracks with drives at the base, each proven to be regular.

The locked drives of a sample hold the tips of the rods, and compiled forward kinematics of these
rods finds its pose. The proof is for the straight step from the pose before, on which the drives
move: as in `gsp.travel`, no drive and no posture is singular on it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.frames import log3
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.vectors import Array, Mask, norm
from gsp.kinematics.driven.locked import scales_of_held
from gsp.kinematics.newton import reference
from gsp.kinematics.newton.centred import Centred
from gsp.kinematics.newton.control import (
    CONVERGED,
    NEAR_SINGULAR,
    NOT_CONVERGED,
    PROVEN_SHARE,
    SINGULAR,
    UNDEFINED,
)
from gsp.model.legs import LEG, LEGS
from gsp.model.rods import TIPS

# How a track ends, beside the numbers of `control`.
AT_GAP, SINGULAR_DRIVE = 5, 6
TURN = 2.0 * np.pi
# Halvings of the way between two samples.
DRIVEN_HALVINGS = 20
_WHOLE_FRAME = np.array([1.0, *[0.0] * 6])


class Place(NamedTuple):
    """A pose of the centred design, of batch shape (1,), with its joint values (6,)."""

    pose: Pose
    joints: Array
    residual: float = 0.0
    steps: int = 0
    pieces: int = 1
    margin: float = 0.0


class DrivenTrack:
    """Steps of a centred design with six actuators, some of which drive rods at the base.

    Parameters
    ----------
    design : Centred
    tolerance : float [1, rad]
    most : int
        Steps of forward kinematics for each sample.
    """

    def __init__(self, design: Centred, tolerance: float, most: int) -> None:
        self.design, self.tolerance, self.most = design, tolerance, most
        small = design.design
        self.drives = [
            (row, leg, drive)
            for row, (leg, constraint) in enumerate(small.rows)
            if constraint.driven and (drive := small.drives[leg]) is not None
        ]
        self.rows = [row for row, _, _ in self.drives]
        self.cranks = [row for row in self.rows if small.angular[row]]
        self.kinds = design.kinds.copy()
        self.kinds[[leg for _, leg, _ in self.drives]] = LEGS.index(LEG["D1"])
        self.angular = small.angular.copy()
        self.angular[self.rows] = False
        self.rods = np.array([drive.rod for _, _, drive in self.drives])

    def solved(self, near: Pose, joints: Array) -> Place | None:
        """Return the pose of joint values (6,) that forward kinematics of the rods finds."""
        from gsp.kinematics.newton.compiled import solve

        small = self.design.design
        geometry = self.design.geometry.reshape(-1, 13).copy()
        paths = self.design.paths.reshape(-1, 18).copy()
        for row, leg, drive in self.drives:
            point, line = small.base_points[leg], small.base_directions[leg]
            tip = TIPS[type(drive)](drive, point, line, float(joints[row]))[0]
            geometry[leg, :3], paths[leg, :3] = tip, tip
            size = float(norm(tip))
            geometry[leg, 12] += size - paths[leg, 12]
            paths[leg, 12] = size
        values = joints.copy()
        values[self.rows] = self.rods
        position, rotation, numbers = np.empty((1, 3)), np.empty((1, 9)), np.empty((1, 3))
        solve(
            values[None],
            np.ascontiguousarray(near.position),
            np.ascontiguousarray(near.rotation).reshape(1, 9),
            self.kinds,
            geometry.ravel(),
            paths.ravel(),
            self.angular,
            _WHOLE_FRAME,
            self.tolerance,
            self.most,
            position,
            rotation,
            numbers,
        )
        if numbers[0, 0] != CONVERGED:
            return None
        pose = unchecked(Pose, position, rotation.reshape(1, 3, 3))
        return Place(pose, joints, float(numbers[0, 1]), int(numbers[0, 2]))

    def proven(self, places: list[Place]) -> tuple[Mask, Array]:
        """Return whether the steps between k + 1 places are proven regular, (k,), and margins.

        Parameters
        ----------
        places : list of k + 1

        Returns
        -------
        (k,) bool array, and the margins (k + 1,) of the places.
        """
        position, rotation = (
            np.concatenate([getattr(place.pose, name) for place in places])
            for name in ("position", "rotation")
        )
        poses = unchecked(Pose, position, rotation)
        points = self._points(poses)
        with np.errstate(all="ignore"):
            here, there = (reference.part(points, at) for at in _both(len(places)))
            # The rows of lines that meet keep the sign that they have before.
            turned = (there.signs * here.signs)[..., None]
            there.rows, there.inverse = there.rows * turned, there.inverse * turned.swapaxes(1, 2)
            turn = log3(there.pose.rotation @ here.pose.rotation.swapaxes(-1, -2))
            move = np.hstack((there.pose.position - here.pose.position, turn))
            bends = reference.row_bends(self.design, here.pose, move)
            change = there.rows - here.rows
            reach = np.maximum(
                reference.change_bound(here, change, bends),
                reference.change_bound(there, change, bends),
            )
            regular = (points.undefined == 0.0) & self._on_branches(places)
            margins = self._margins(points)
        return np.asarray((reach < PROVEN_SHARE) & regular[1:] & regular[:-1]), margins

    def _margins(self, points: reference.Points) -> Array:
        """Return 1 / ‖J⁻¹‖ of the rods, or the least cosine of a drive if that is less."""
        square = (points.inverse**2).sum(axis=(-2, -1))
        regular = np.where(points.undefined == 0.0, 1.0 / np.sqrt(square), 0.0)
        return np.asarray(np.fmin(regular, self._cosines(points).min(axis=-1)))

    def _cosines(self, points: reference.Points) -> Array:
        """Return |cosine| of rods and velocities of tips, (m, number of drives)."""
        sizes = [norm(np.array(self._slope(row, leg, drive))) for row, leg, drive in self.drives]
        return np.asarray(np.abs(points.scale[:, self.rows]) / np.array(sizes))

    def _slope(self, row: int, leg: int, drive: object) -> Array:
        small = self.design.design
        point, line = small.base_points[leg], small.base_directions[leg]
        return TIPS[type(drive)](drive, point, line, 0.0)[1]

    def _on_branches(self, places: list[Place]) -> Mask:
        found = [
            (scales_of_held(self.design.design, place.joints, place.pose)[1] > 0.0).all()
            for place in places
        ]
        return np.array(found)

    def batch(self, here: Place, targets: Array) -> list[Place]:
        """Return the places of some samples (k, 6), up to the first step without a proof."""
        places = [here]
        for joints in targets:
            there = self.solved(places[-1].pose, joints)
            if there is None:
                break
            places.append(there)
        sure, margins = self.proven(places)
        count = len(sure) if sure.all() else int(sure.argmin())
        return [
            place._replace(margin=float(margin))
            for place, margin in zip(places[1 : count + 1], margins[1:], strict=False)
        ]

    def followed(self, start: Place, joints: Array, least: float) -> tuple[Place | None, int]:
        """Follow the straight line from the joint values of a place to others, in pieces.

        Parameters
        ----------
        start : Place
        joints : (6,) array
        least : float [1]
            Margin below which it ends.

        Returns
        -------
        The place at its end or none, and how it ended.
        """
        here, done, width, halvings, pieces, steps = start, 0.0, 1.0, 0, 0, 0
        while done < 1.0:
            end = min(1.0, done + width)
            target = joints if end == 1.0 else start.joints + end * (joints - start.joints)
            there = self.batch(here, target[None])
            steps += there[0].steps if there else 1
            if there:
                here, done, pieces = there[0], end, pieces + 1
                width, halvings = 2.0 * width, max(0, halvings - 1)
                if here.margin < least:
                    return None, self.below(here, least)
            elif halvings == DRIVEN_HALVINGS:
                return None, self._reason(here)
            else:
                width, halvings = 0.5 * (end - done), halvings + 1
        return here._replace(pieces=pieces, steps=steps), CONVERGED

    def start(self, pose: Pose, first: Array) -> Place:
        """Return the start, with angles of cranks within a half turn of those of the first sample.

        Parameters
        ----------
        pose : Pose of batch shape (1,)
        first : (6,) array
        """
        joints = self.design.design.at(pose).joints[0].copy()
        turns = np.round((joints - first)[self.cranks] / TURN)
        joints[self.cranks] -= TURN * turns
        return Place(pose, joints)

    def below(self, place: Place, margin: float) -> int:
        """Return how a track ends whose margin is too small."""
        points = self._points(place.pose)
        return SINGULAR_DRIVE if self._cosines(points).min() < margin else SINGULAR

    def _points(self, pose: Pose) -> reference.Points:
        with np.errstate(all="ignore"):
            return reference.points_at(self.design, pose, np.zeros((pose.size, 6)), None)

    def _reason(self, here: Place) -> int:
        """Return how a track ends that gets no further."""
        points = self._points(here.pose)
        if not self.design.design.at(here.pose).defined[0]:
            return UNDEFINED
        if points.undefined[0] or self._cosines(points).min() < NEAR_SINGULAR:
            return SINGULAR_DRIVE
        near = (points.inverse**2).sum() * NEAR_SINGULAR**2 > 1.0
        return SINGULAR if near else NOT_CONVERGED


def _both(places: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the numbers of the first and of the last of each two places that follow each other."""
    numbers = np.arange(places)
    return numbers[:-1], numbers[1:]
