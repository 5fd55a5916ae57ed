"""What all figures share: settings, new axes, their names, numbers and titles."""

from gsp.figures.lengths import name_coordinates, name_lengths
from gsp.figures.settings import INK, new_axes, require_matplotlib, style
from gsp.figures.ticks import set_space_ticks
from gsp.figures.titles import wrapped, write_title

__all__ = [
    "INK",
    "name_coordinates",
    "name_lengths",
    "new_axes",
    "require_matplotlib",
    "set_space_ticks",
    "style",
    "wrapped",
    "write_title",
]
