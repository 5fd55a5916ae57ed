"""Values and rows of postures in space and in the plane, and which elements are undefined."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.errors import UndefinedPosture
from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.vectors import Array, Mask
from gsp.model.posture.assembly import (
    POSES_PER_ASSEMBLY,
    Part,
    in_places,
    joints_and_rows,
    parts,
    passive_places,
    put,
)

if TYPE_CHECKING:
    from gsp.model.design.anchored import AnchoredDesign


class Undefined(NamedTuple):
    """One element of a posture that has no value, and why.

    Attributes
    ----------
    pose : tuple of int
        Place of the pose in the batch; () of a single pose.
    joint : str
        Name of the actuated joint, such as "d1".
    reason : str
    """

    pose: tuple[int, ...]
    joint: str
    reason: str


class SingularDrive(NamedTuple):
    """A drive of a posture that is singular, and why: the row of its joint is infinite.

    Attributes
    ----------
    pose : tuple of int
        Place of the pose in the batch; () of a single pose.
    joint : str
        Name of the actuated joint, such as "theta1".
    reason : str
    """

    pose: tuple[int, ...]
    joint: str
    reason: str


class Assembled(ReadOnly):
    """A design at poses, with the attributes that `Evaluated` documents: values and rows."""

    design: AnchoredDesign[Any]
    pose: Any

    # Not read-only, which would take as long as the assembly: nothing gives these arrays to a user.
    @cached_property
    def _few_parts(self) -> tuple[Part, ...]:
        return tuple(self._new_parts())

    def _new_parts(self) -> Iterator[Part]:
        return parts(self.design.groups, self.pose.position, self.pose.rotation)

    def _parts(self) -> Iterable[Part]:
        """Legs and segments by kind and by poses; kept if the poses are few."""
        return self._few_parts if self.pose.size <= POSES_PER_ASSEMBLY else self._new_parts()

    def _batch(self, array: Array) -> Array:
        """Return an array with the batch shape in the place of its first axis, read-only."""
        result = array.reshape(*self.shape, *array.shape[1:])
        result.flags.writeable = False
        return result

    @property
    def _columns(self) -> int:
        """Components of a twist."""
        return 6 if self.design.dimension == 3 else 3

    @kept_property
    def _assembled(self) -> tuple[Array, Array]:
        """Joints (..., n) and Jacobian (..., n, c)."""
        joints, jacobian = joints_and_rows(
            self._parts(), self.pose.size, len(self.joint_names), self._columns
        )
        return self._batch(joints), self._batch(jacobian)

    def _passive_rates(self, length: float) -> Array:
        """Rows of `passive_rates`."""
        starts, total = passive_places(self.design.groups)
        first = dict(zip(self.design.groups, starts, strict=True))
        rows = np.empty((self.pose.size, total, self._columns))
        with np.errstate(all="ignore"):
            for poses, group, _, segment, undefined in self._parts():
                (start, step), kind = first[group], group.kind
                rates = in_places(kind, kind.passive(segment, length), self._columns)
                for i, row in enumerate(rates):
                    places = slice(start + i, start + group.count * step, step)
                    put(rows, poses, places, row, undefined)
        return self._batch(rows)

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch shape of the poses."""
        shape: tuple[int, ...] = self.pose.shape
        return shape

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the actuated joints, in row order."""
        return self.design.joint_names

    @property
    def angular(self) -> Mask:
        """Which rows belong to A1 constraints, shape (n,).

        *Source: TozKucuk2016, §2, for A1*
        """
        return self.design.angular

    @property
    def joints(self) -> Array:
        """Actuated distances and angles, shape (..., n) [unit of the design, rad].

        *Source: TozKucuk2016, eqs. (2)–(6) in space; docs/planar.md in the plane*
        """
        return self._assembled[0]

    @property
    def jacobian(self) -> Array:
        """Inverse Jacobian, shape (..., n, c): actuator rates = J · twist [mixed].

        Distances: 1 for v and the unit of length for ω. Angles: 1/unit for v and 1 for ω.

        *Source: TozKucuk2016, eqs. (8), (12)–(16) in space; docs/planar.md in the plane*
        """
        return self._assembled[1]

    @kept_property
    def defined(self) -> Mask:
        """Whether all elements of a pose are defined, shape (...).

        *Source: docs/conventions.md, "Undefined and singular"*
        """
        return np.asarray(~np.isnan(self.joints).any(axis=-1))

    @property
    def undefined(self) -> tuple[Undefined, ...]:
        """The elements that are NaN, each with pose, joint and reason; () when there are none."""
        return tuple(
            Undefined(pose, joint, constraint.undefined)
            for pose, joint, constraint in self._named(np.isnan(self.joints))
        )

    def _named(self, marked: Mask) -> Iterator[tuple[tuple[int, ...], str, Any]]:
        """Yield pose, name of the joint and constraint of the elements (..., n) that are marked."""
        for where in np.argwhere(marked):
            place = tuple(int(i) for i in where[:-1])
            yield place, self.joint_names[where[-1]], self.design.rows[where[-1]].constraint

    def check_defined(self) -> None:
        """Raise an error, with joint and reason, if an element has no value.

        Raises
        ------
        UndefinedPosture
        """
        if not self.defined.all():
            raise UndefinedPosture(self.design.name, self.undefined)


def finite_rows(posture: Assembled, rows: Array) -> Array:
    """Return rows (..., n, c) with NaN in place of infinite ones, whose sums are not defined.

    Only rows of drives at the base are infinite, where the drive is singular.

    Parameters
    ----------
    posture : Posture or PlanarPosture
    rows : (..., n, c) array
        Its Jacobian, or a multiple of it.
    """
    return np.where(np.isinf(rows), np.nan, rows) if posture.design.driven else rows
