"""Codes of cells and points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Codes = NDArray[np.int8]
Numbers = NDArray[np.int64]

INSIDE, UNDECIDED, OUTSIDE = 1, 0, -1
