"""What all figures share: settings, new axes, and figures that Jupyter shows once."""

from gsp.figures.settings import INK, new_axes, require_matplotlib, style

__all__ = ["INK", "new_axes", "require_matplotlib", "style"]
