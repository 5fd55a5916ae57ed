"""Figures that Jupyter shows once."""

from __future__ import annotations

from matplotlib.figure import Figure


class ShownOnce(Figure):
    """A figure that a cell of a notebook shows once, also where it is the value of the cell.

    Jupyter shows the figures of pyplot at the end of a cell, and the value of its last line. A
    figure that is both would be shown twice.
    """

    def _ipython_display_(self) -> None:
        """Remove the figure from those of pyplot if it is about to be displayed as a value."""
        import matplotlib as mpl
        import matplotlib.pyplot as plt

        if "inline" in mpl.get_backend():
            plt.close(self)
        raise NotImplementedError  # IPython then displays it like every figure
