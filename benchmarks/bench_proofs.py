"""Proofs over boxes: boxes and times on the hexapod, beside two other methods.

One is bounds of first order in plain numpy; the other, if codac is installed, preconditioned
interval matrices: see `interval_library`. Times are CPU times of one core for the whole call, the
least of some rounds; that of the first row, which takes one box, is spent outside of the search.

`python -m benchmarks.bench_proofs`
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from importlib.util import find_spec

import numpy as np

import gsp
from benchmarks import interval_library
from benchmarks.timing import line, markdown
from gsp.geometry.rotations import rotation_from_angles

RADII, HEIGHT = (2.0, 1.0), 1.5
ANGLES = ([-10, 10, 110, 130, 230, 250], [-50, 50, 70, 170, 190, 290])
CASES = (
    (0.1, 5.0, None),
    (0.2, 10.0, None),
    (0.3, 15.0, None),
    (0.3, 15.0, 20.0),
    (0.4, 20.0, None),
)
ROUNDS = 5
# Boxes after which the method in numpy is stopped.
MOST_BOXES = 200_000
# Seconds after which the interval library is stopped.
SECONDS = 60.0


def hexapod() -> gsp.Design:
    """Return the hexapod with base radius 2, platform radius 1, joints in pairs."""
    base, platform = (
        radius * np.stack((np.cos(a), np.sin(a), 0 * a), axis=1)
        for radius, a in zip(RADII, np.deg2rad(ANGLES), strict=True)
    )
    return gsp.Design(["D1"] * 6, base, platform, characteristic_length=1.0)


def box_of(half: float, degrees: float) -> gsp.PoseBox:
    pairs = [(-half, half), (-half, half), (HEIGHT - half, HEIGHT + half)]
    return gsp.PoseBox(pairs, [(-degrees, degrees)] * 3, degrees=True)


def first_order(design: gsp.Design, box: gsp.PoseBox) -> tuple[int, float]:
    """Regularity by Weyl's inequality with bounds of first order, in numpy, breadth first."""
    start = time.process_time()
    a, b = design.base_points, design.platform_points
    size = np.linalg.norm(b, axis=1)
    middle = 0.5 * (box.low + box.high)[None]
    half, boxes = 0.5 * (box.high - box.low)[None], 0
    while len(middle):
        boxes += len(middle)
        if boxes > MOST_BOXES:
            return boxes, np.nan
        arm = b @ np.swapaxes(rotation_from_angles(middle[:, 3:]), 1, 2)
        d = middle[:, None, :3] + arm - a
        length = np.linalg.norm(d, axis=-1)
        u = d / length[..., None]
        turn = 2.0 * size * np.sin(np.minimum(half[:, 3:].sum(axis=1), np.pi) / 2.0)[:, None]
        q = (np.linalg.norm(half[:, :3], axis=1)[:, None] + turn) / length
        tilt = np.where(q < 1.0, 2.0 * np.sin(np.arcsin(np.minimum(q, 1.0)) / 2.0), 2.0)
        change = np.sqrt((tilt**2 + (turn + size * tilt) ** 2).sum(axis=1))
        rows = np.concatenate((u, np.cross(arm, u)), axis=-1)
        left = np.linalg.svd(rows, compute_uv=False)[:, -1] <= change
        middle, half = middle[left], half[left]
        k, i = half.argmax(axis=1), np.arange(len(half))
        half = half.copy()
        half[i, k] /= 2.0
        step = np.zeros_like(half)
        step[i, k] = half[i, k]
        middle, half = np.concatenate((middle - step, middle + step)), np.concatenate((half, half))
    return boxes, time.process_time() - start


def interval_matrices(design: gsp.Design, box: gsp.PoseBox) -> tuple[int, float]:
    """Boxes and seconds of the interval library; NaN where it is not installed, or takes longer."""
    if find_spec("codac") is None:
        return 0, np.nan
    return interval_library.regular(design, box, SECONDS)


def ours(
    design: gsp.Design, box: gsp.PoseBox, limit: float | None
) -> tuple[gsp.Certificate, float]:
    """Return the certificate and the least time of some rounds, on one core."""
    limits = None if limit is None else gsp.Limits(indices=[f"CDN_CL <= {limit}"])
    best = np.inf
    for _ in range(ROUNDS):
        start = time.process_time()
        done = gsp.certify(design, box, limits, workers=1, progress=False)
        best = min(best, time.process_time() - start)
    return done, best


HEAD = (
    "box",
    "requirement",
    "boxes",
    "ms",
    "1e6 boxes/s",
    "boxes, numpy",
    "times faster than numpy",
    "boxes, codac",
    "times faster than codac",
)


def table() -> Iterator[tuple[str, ...]]:
    """Yield the rows of boxes and times, with the ratios to the other methods."""
    design = hexapod()
    gsp.certify(design, box_of(0.01, 1.0))  # compiled code is loaded
    for half, degrees, limit in CASES:
        box = box_of(half, degrees)
        done, seconds = ours(design, box, limit)
        if done.status != "proven":
            raise SystemExit(f"expected a proof, received {done}")
        others = [(0, np.nan)] * 2
        if not limit:
            others = [first_order(design, box), interval_matrices(design, box)]
        what = "regular" if limit is None else f"and CDN_CL ≤ {limit:g}"
        yield (
            f"±{half}, ±{degrees:g}°",
            what,
            f"{done.n_boxes:,}",
            f"{1e3 * seconds:.2f}",
            f"{1e-6 * done.n_boxes / seconds:.2f}",
            *_beside(others, seconds),
        )


def section() -> str:
    """Return the whole table."""
    return markdown(HEAD, list(table()))


def _beside(others: list[tuple[int, float]], seconds: float) -> list[str]:
    """Return boxes and the ratio of times of each other method; dashes where it did not end."""
    result = []
    for boxes, other in others:
        ended = np.isfinite(other)
        result += [f"{boxes:,}", f"{other / seconds:,.0f}"] if ended else ["–", "–"]
    return result


if __name__ == "__main__":
    # Each row when it is measured: the other methods take up to a minute of CPU time each.
    print(markdown(HEAD, []), flush=True)
    for row in table():
        print(line(row), flush=True)
