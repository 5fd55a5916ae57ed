"""What all figures share: settings, new axes and their names, figures that Jupyter shows once."""

from gsp.figures.lengths import name_coordinates, name_lengths
from gsp.figures.settings import INK, new_axes, require_matplotlib, style

__all__ = ["INK", "name_coordinates", "name_lengths", "new_axes", "require_matplotlib", "style"]
