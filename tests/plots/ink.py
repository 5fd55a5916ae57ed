"""Measure what a figure shows: pixels that its data change within the boxes of its axes."""

from __future__ import annotations

from contextlib import contextmanager

import numpy as np

# Dots per inch: to count ink, and of pictures that are written.
DPI, PICTURE_DPI = 60, 150


def pixels(figure) -> np.ndarray:
    """Return the figure as it is rendered on its canvas, (height, width, 3) integers."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba())[..., :3].astype(int)


@contextmanager
def settled(figure, dots=DPI):
    """Render at so many dots per inch; the layout is that of the first rendering."""
    dpi, layout = figure.dpi, figure.get_layout_engine()
    figure.set_dpi(dots)
    try:
        yield
    finally:
        figure.set_dpi(dpi)
        figure.set_layout_engine(layout)


def drawn(ax) -> list:
    """Return the artists that show data: not the frame, the ticks, labels or the grid."""
    artists = [*ax.lines, *ax.collections, *ax.images, *ax.patches, *ax.texts]
    return [artist for artist in artists if artist.get_visible()]


def ink(figure) -> list[int]:
    """Return for each axes with a frame how many pixels within its box its data change."""
    panels = [ax for ax in figure.axes if ax.axison or ax.name == "3d"]
    # All data are hidden at once: one rendering more, however many panels there are.
    artists = [artist for ax in panels for artist in drawn(ax)]
    with settled(figure):
        whole = pixels(figure)
        figure.set_layout_engine("none")
        boxes = [np.round(ax.get_window_extent().extents).astype(int) for ax in panels]
        for artist in artists:
            artist.set_visible(False)
        changed = np.abs(pixels(figure) - whole).max(axis=-1) > 24
        for artist in artists:
            artist.set_visible(True)
    height = whole.shape[0]
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


def text_boxes(ax) -> list[tuple[str, object]]:
    """Return texts and their boxes in pixels: labels where they are seen, axis labels, legend."""
    from matplotlib.text import Text
    from mpl_toolkits.mplot3d.proj3d import proj_transform

    ax.figure.canvas.draw()
    renderer, boxes = ax.figure.canvas.get_renderer(), []
    for text in ax.texts:
        if ax.name == "3d":
            # While it is drawn only, a text in space is at its place in the picture.
            x, y, _ = proj_transform(*text.get_position_3d(), ax.get_proj())
            text._x, text._y = x, y
        # Without the line that joins an annotation to its point.
        shown, patch = Text.get_window_extent(text, renderer), text.get_bbox_patch()
        if patch is not None:
            text.update_bbox_position_size(renderer)
            shown = patch.get_window_extent(renderer)
        boxes.append((text.get_text(), shown))
    others = [axis.label for axis in ax._axis_map.values()]
    others += [other for other in (ax.get_legend(), ax.title) if other is not None]
    return boxes + [(str(other), other.get_window_extent(renderer)) for other in others]


def overlaps(ax) -> list[tuple[str, str]]:
    """Return the pairs of texts that share more than half a pixel in both directions."""
    boxes = text_boxes(ax)
    found = []
    for i, (one, a) in enumerate(boxes):
        for other, b in boxes[:i]:
            wide, high = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
            if min(wide, high) > 0.5:
                found.append((other, one))
    return found


def crossing(ax) -> list[str]:
    """Return the texts of plane axes that are not within their frame."""
    frame = ax.get_window_extent()
    return [
        text
        for text, box in text_boxes(ax)[: len(ax.texts)]
        if not (frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 < box.y1 < frame.y1)
    ]


def struck_texts(ax) -> list[tuple[str, str]]:
    """Return pairs of a label and another text that the thin line of the label crosses."""
    boxes, found = text_boxes(ax)[: len(ax.texts)], []
    for i, text in enumerate(ax.texts):
        if text.arrow_patch is None:
            continue
        path = text.arrow_patch.get_transform().transform_path(text.arrow_patch.get_path())
        points = path.interpolated(200).vertices
        for j, (other, box) in enumerate(boxes):
            within = (points > box.min + 0.5).all(axis=1) & (points < box.max - 0.5).all(axis=1)
            if i != j and within.any():
                found.append((boxes[i][0], other))
    return found


def unseen(ax, least: int = 4) -> list[str]:
    """Return the entries of the legend without whose lines no more pixels than that change."""
    found, canvas = [], ax.figure
    legend = ax.get_legend()
    texts, handles = [t.get_text() for t in legend.get_texts()], legend.legend_handles
    notes = [text for text in ax.texts if text.get_visible()]
    with settled(canvas, PICTURE_DPI):
        for text in notes:
            text.set_visible(False)
        whole = pixels(canvas)
        canvas.set_layout_engine("none")
        for text, handle in zip(texts, handles, strict=True):
            same = [line for line in ax.lines if alike(line, handle)]
            for line in same:
                line.set_visible(False)
            if same and (np.abs(pixels(canvas) - whole).max(axis=-1) > 24).sum() < least:
                found.append(text)
            for line in same:
                line.set_visible(True)
        for text in notes:
            text.set_visible(True)
    return found


def alike(line, handle) -> bool:
    """Return whether two lines have one colour and one pattern of dashes."""
    if not hasattr(handle, "get_linestyle") or not hasattr(handle, "get_marker"):
        return False
    patterns = [np.ravel(x._unscaled_dash_pattern[1] or ()) for x in (line, handle)]
    return line.get_marker() in ("None", None, "") and (
        line.get_color() == handle.get_color() and np.array_equal(*patterns)
    )
