"""Measure what a figure shows: pixels that its data change within the boxes of its axes."""

from __future__ import annotations

import io

import numpy as np


def pixels(figure) -> np.ndarray:
    """Return the rendered figure, (height, width, 3) integers."""
    import matplotlib.pyplot as plt

    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=60)
    buffer.seek(0)
    return np.round(255 * plt.imread(buffer)[..., :3]).astype(int)


def drawn(ax) -> list:
    """Return the artists that show data: not the frame, the ticks, labels or the grid."""
    artists = [*ax.lines, *ax.collections, *ax.images, *ax.patches, *ax.texts]
    return [artist for artist in artists if artist.get_visible()]


def ink(figure) -> list[int]:
    """Return for each axes with a frame how many pixels within its box its data change."""
    panels = [ax for ax in figure.axes if ax.axison or ax.name == "3d"]
    whole = pixels(figure)
    height = whole.shape[0]
    scale = 60 / figure.dpi
    boxes = [np.round(ax.get_window_extent().extents * scale).astype(int) for ax in panels]
    # All data are hidden at once: one rendering more, however many panels there are.
    artists = [artist for ax in panels for artist in drawn(ax)]
    for artist in artists:
        artist.set_visible(False)
    changed = np.abs(pixels(figure) - whole).max(axis=-1) > 24
    for artist in artists:
        artist.set_visible(True)
    counts = [
        int(changed[height - top : height - bottom, left:right].sum())
        for left, bottom, right, top in boxes
    ]
    return counts


def assert_ink(figure, least: int = 8) -> None:
    """Fail if there are no axes with a frame, or one of them shows nothing."""
    counts = ink(figure)
    assert counts, "no axes"
    assert min(counts) >= least, counts
