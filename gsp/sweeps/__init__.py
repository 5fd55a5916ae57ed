"""Sweeps: indices along translations and turns, over planes, and over design parameters."""

from gsp.sweeps.parameters import maxima, over_designs
from gsp.sweeps.paths import Path, plane, translation, turn
from gsp.sweeps.tables import check_sweep, index_columns, sweep

__all__ = [
    "Path",
    "check_sweep",
    "index_columns",
    "maxima",
    "over_designs",
    "plane",
    "sweep",
    "translation",
    "turn",
]
