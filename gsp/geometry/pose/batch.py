"""The common part of poses in space and in the plane: batch shapes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Self, TypeVar

import numpy as np

from gsp import arguments
from gsp.checks import is_a, reading
from gsp.errors import InvalidIndex, brief, expected
from gsp.geometry.copies import ReadOnly, made
from gsp.geometry.vectors import Array

Record = TypeVar("Record", bound="Batched")


class Batched(ReadOnly):
    """A record of read-only arrays with the same leading axes; the first holds positions.

    A subclass is made from its arrays in the order of `ARRAYS`.
    """

    # Names of the arrays, with the number of axes that a single pose has.
    ARRAYS: ClassVar[Mapping[str, int]]

    def inverse(self) -> Self:
        """Return the poses of the base in the platform."""
        raise NotImplementedError

    @property
    def _arrays(self) -> list[tuple[Array, int]]:
        return [(getattr(self, name), axes) for name, axes in self.ARRAYS.items()]

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch shape; () for a single pose."""
        positions: Array = getattr(self, next(iter(self.ARRAYS)))
        return positions.shape[:-1]

    @property
    def size(self) -> int:
        """Number of poses."""
        return int(np.prod(self.shape, dtype=np.int64))

    def __bool__(self) -> bool:
        return self.size > 0

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single pose has no length")
        return self.shape[0]

    def __iter__(self) -> Iterator[Self]:
        if not self.shape:
            raise TypeError("a single pose has no items")
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Self:
        """Return some of the poses, by numpy indexing of the batch axes."""
        axes = self._axes(index)
        some = (array[(*axes, *[slice(None)] * own)] for array, own in self._arrays)
        return unchecked(type(self), *some)

    def _axes(self, index: Any) -> tuple[Any, ...]:
        """Return an index of the batch axes with an ellipsis, or raise InvalidIndex."""
        axes = tuple.__getitem__(index, slice(None)) if is_a(index, tuple) else (index,)
        if not any(axis is Ellipsis for axis in axes):
            axes = (*axes, Ellipsis)
        try:
            np.broadcast_to(np.False_, self.shape)[axes]
        except Exception as error:  # also what an object raises itself
            wanted = f"an index of poses of batch shape {self.shape}"
            raise InvalidIndex(expected("pose[…]", wanted, brief(index))) from error
        return axes

    def reshape(self, *shape: int) -> Self:
        """Return the same poses in another batch shape.

        Parameters
        ----------
        *shape : int
            Lengths of the axes; -1 stands for what is left.

        Returns
        -------
        The same type, of batch shape `shape`

        Raises
        ------
        InvalidInput
            If the poses do not fill that shape.
        """
        given: Any = shape if len(shape) != 1 else shape[0]
        with reading("shape", f"the axes of a batch of {self.size} poses", shape):
            new = np.empty(self.shape, dtype=bool).reshape(given).shape
        n = len(self.shape)
        some = (array.reshape((*new, *array.shape[n:])) for array, _ in self._arrays)
        return unchecked(type(self), *some)

    @arguments.validated(factor=arguments.positive)
    def scaled(self, factor: float) -> Self:
        """Return the poses with positions multiplied by a factor (a change of unit).

        Parameters
        ----------
        factor : float [1]
            > 0

        Returns
        -------
        The same type and batch shape

        Raises
        ------
        InvalidInput
            On another factor.
        """
        (positions, _), *others = self._arrays
        make: Any = type(self)
        return make(positions * factor, *(array for array, _ in others))  # type: ignore[no-any-return]


def unchecked(kind: type[Record], *arrays: Array) -> Record:
    """Return a record of arrays that are known to be right; they become read-only.

    Parameters
    ----------
    kind : type
        `gsp.Pose` or `gsp.planar.PlanarPose`.
    *arrays : (..., n) or (..., n, n) arrays [unit or 1]
        New arrays or views that nothing else writes to, in the order of `kind.ARRAYS`.

    Returns
    -------
    A record of type `kind`
        Its batch shape is that of the arrays without the axes of a single pose.

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.geometry.pose import Pose, unchecked
    >>> unchecked(Pose, np.zeros((7, 3)), np.tile(np.eye(3), (7, 1, 1))).shape
    (7,)
    """
    for array in arrays:
        array.setflags(write=False)
    return made(kind, **dict(zip(kind.ARRAYS, arrays, strict=True)))
