"""Compiled vectors of a leg between two points, for code that takes one pose or cell at a time.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

from pathlib import Path
from zlib import crc32

from numba import njit

from gsp.geometry.vectors import Array


@njit(error_model="numpy", nogil=True)
def leg_vectors(p: Array, leg: Array, r: Array) -> tuple[float, float, float, float, float, float]:
    """Return p − a and R b of a leg; their sum d is the vector of the leg, and |d| its length.

    Six numbers and no array, so that the compiler keeps them in registers.

    Parameters
    ----------
    p : (3,) array [length]
    leg : (≥ 6,) array [length]
        a in base axes, b in platform axes.
    r : (≥ 9,) array
        The rotation by rows.
    """
    return (
        p[0] - leg[0],
        p[1] - leg[1],
        p[2] - leg[2],
        r[0] * leg[3] + r[1] * leg[4] + r[2] * leg[5],
        r[3] * leg[3] + r[4] * leg[4] + r[5] * leg[5],
        r[6] * leg[3] + r[7] * leg[4] + r[8] * leg[5],
    )


def checksum_of_code(number: int = 0) -> int:
    """Return a checksum of this file: numba's cache depends only on the file of the caller."""
    return crc32(Path(__file__).read_bytes(), number)
