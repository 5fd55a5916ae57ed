"""How near to their bounds quantities come over small boxes, by adversarial search.

`python -m tests.proof.tightness` writes the table of `docs/proofs.md`.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from gsp.variation.layout import HIGH, INDEX_ORDER, LOW, MID_HIGH, MID_LOW
from tests.proof.measured import CORNERS, bounds, commensurable, measured, random_box
from tests.proof.proofs import KINDS
from tests.support import random_design

# Half-widths of the boxes, at most: lengths of about 1, angles in rad.
SIZE = 0.02
# Points around the best one of each quantity, and how often they are drawn nearer to it.
CROWD, ROUNDS = 8, 4
SYMBOLS = dict(zip(INDEX_ORDER, ("σ_min", "CDN_CL", "|det J|", "CDN_OE", "CTN"), strict=True))
NAMES = ("d", "θ", "base cone", "platform cone", *SYMBOLS.values(), "clearance")
DESIGNS = 24


def watched(design, names):
    """Quantities of the first leg, and the indices: places, and their names in the table."""
    result = {}
    for i, name in enumerate(names):
        if name in ("d1", "theta1"):
            result[i] = "d" if name == "d1" else "θ"
        elif name in ("base cone 1", "platform cone 1"):
            result[i] = name.removesuffix(" 1")
        elif name in SYMBOLS and (name != "manipulability" or commensurable(design)):
            result[i] = SYMBOLS[name]
        elif name == "clearance 1-2":
            result[i] = "clearance"
    return result


def extremes(design, box, places, rng):
    """Greatest and least values that a search finds, and those at the centre: (places,) each."""
    half, middle = 0.5 * (box.high - box.low), 0.5 * (box.high + box.low)

    def values(points):
        return measured(design, box.pose(middle + points * half))[:, places]

    points, reach = np.concatenate((np.zeros((1, 6)), CORNERS)), 1.0
    found = values(points)
    centre, least, most = found[0], found.min(axis=0), found.max(axis=0)
    best = points[np.concatenate((found.argmin(axis=0), found.argmax(axis=0)))]
    for _ in range(ROUNDS):
        reach *= 0.5
        steps = reach * rng.uniform(-1.0, 1.0, (CROWD, *best.shape))
        points = np.clip(best + steps, -1.0, 1.0)
        found = values(points.reshape(-1, 6)).reshape(CROWD, 2, len(places), len(places))
        own = np.arange(len(places))
        for side, sign in ((0, -1.0), (1, 1.0)):
            mine = sign * found[:, side, own, own]
            top, limit = mine.argmax(axis=0), (least, most)[side]
            better = mine[top, own] > sign * limit
            limit[better] = sign * mine[top, own][better]
            rows = side * len(places) + own
            best[rows[better]] = points[top, rows][better]
    return least, most, centre


def ratios(kind, rng):
    """Ratios of the variation that occurs to the bound, by the names of the table: up and down."""
    design = random_design(rng, [kind] * 2 + ["D1"] * 4)
    box = random_box(rng, SIZE)
    names, found = bounds(design, box)
    places = watched(design, names)
    least, most, centre = extremes(design, box, list(places), rng)
    result = defaultdict(list)
    for (i, name), low, high, value in zip(places.items(), least, most, centre, strict=True):
        # The centre is known to rounding.
        margin = found[i, MID_HIGH] - found[i, MID_LOW] + 1e-12 * abs(value)
        for occurs, bound in ((high - value, found[i, HIGH]), (value - low, found[i, LOW])):
            reach = abs(bound - value)
            if np.isfinite(reach) and reach > 1e6 * margin:
                result[name].append(float(occurs / reach))
    return result


def table():
    """Median and least ratio for each kind of leg, as Markdown."""
    lines = ["| leg | " + " | ".join(NAMES) + " |", "|---" * (len(NAMES) + 1) + "|"]
    for kind in KINDS:
        rng, every = np.random.default_rng([1, KINDS.index(kind)]), defaultdict(list)
        for _ in range(DESIGNS):
            for name, some in ratios(kind, rng).items():
                every[name] += some
        cells = [
            f"{np.median(every[name]):.2f} ({min(every[name]):.2f})" if every[name] else "–"
            for name in NAMES
        ]
        lines.append(f"| {kind} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
