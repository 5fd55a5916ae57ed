"""The quantity of `Viso`: where leg lengths of a nominal machine move the manufactured one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import catalogue
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.kinematics import forward


def manufactured_pose(
    design: str,
    nominal: str,
    position: Sequence[float],
    length: float,
    lengths: Sequence[float],
) -> Array:
    """Pose of a design with the extensions of the nominal one: x, y, z [unit], turns [°].

    `length` is the nominal length of a leg that is not extended, `lengths` those of the legs as
    manufactured. The turns are about moving x, y and z.
    """
    wanted = Pose(position)
    extensions = catalogue.design(nominal).at(wanted).joints - length
    found = forward(catalogue.design(design), extensions + np.asarray(lengths), wanted).pose
    return np.concatenate((found.position, found.angles("XYZ", degrees=True)))


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {"manufactured_pose": manufactured_pose}
)
