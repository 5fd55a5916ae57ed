"""Workspaces by Monte Carlo, from the joint values alone: nothing of gsp.workspace or gsp.limits.

`python -m tests.reference.workspace_samples` compares brackets with samples for 60 designs on both
sides of the base and on one; `… 34 40` takes those of these numbers only.
"""

from __future__ import annotations

import sys

import numpy as np

import gsp


def rotations(rng, n):
    """Random rotations from normal quaternions, (n, 3, 3)."""
    w, x, y, z = np.moveaxis(rng.standard_normal((n, 4)), 1, 0)
    s = 2.0 / (w * w + x * x + y * y + z * z)
    rows = [
        [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def feasible(design, position, rotation, low, high):
    """Whether all joint values are within bounds; undefined ones are not."""
    joints = design.at(gsp.Pose(position, rotation)).joints
    with np.errstate(invalid="ignore"):
        return ((joints >= low) & (joints <= high)).all(axis=-1)


def violation(design, position, rotation, low, high):
    """How far the worst joint is beyond its bounds."""
    joints = design.at(gsp.Pose(position, rotation)).joints
    return np.nan_to_num(np.maximum(low - joints, joints - high).max(axis=-1), nan=np.inf)


def small_turns(rng, n, size):
    """Rotations near the identity, to first order and made orthogonal."""
    v = size * rng.standard_normal((n, 3))
    x = np.zeros((n, 3, 3))
    x[:, 0, 1], x[:, 0, 2], x[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    x -= np.swapaxes(x, 1, 2)
    q, r = np.linalg.qr(np.eye(3) + x)
    return q * np.sign(np.diagonal(r, axis1=1, axis2=2))[:, None, :]


def reachable(design, points, low, high, rng, starts=400, rounds=60):
    """Whether some rotation is feasible at points: random starts, then random descent of the best.

    A point that is found is reachable; one that is not is probably out of reach: `compared` seeks
    longer at one that is proven inside.
    """
    found = np.zeros(len(points), dtype=bool)
    for k, point in enumerate(points):
        turns = rotations(rng, starts)
        worst = violation(design, np.repeat(point[None], starts, 0), turns, low, high)
        turns, worst = turns[np.argsort(worst)[:20]], np.sort(worst)[:20]
        size = 0.3
        for _ in range(rounds):
            if worst.min() <= 0.0:
                break
            tried = np.repeat(turns, 8, 0)
            tried = small_turns(rng, len(tried), size) @ tried
            value = violation(design, np.repeat(point[None], len(tried), 0), tried, low, high)
            best = value.reshape(-1, 8).argmin(1)
            value = value.reshape(-1, 8)[np.arange(len(turns)), best]
            better = value < worst
            turns[better] = tried.reshape(-1, 8, 3, 3)[np.arange(len(turns)), best][better]
            worst[better] = value[better]
            size *= 1.0 if better.any() else 0.8
        found[k] = worst.min() <= 0.0
    return found


def reachable_within(design, points, box, low, high, rng, starts=400, rounds=60):
    """Whether some rotation of a range of angles is feasible at points, as in `reachable`.

    Angles are drawn in the range and descend in it; the rotations are products of single turns.
    """
    least, most = box.low[3:], box.high[3:]
    found = np.zeros(len(points), dtype=bool)

    def worst_at(point, angles):
        turns = product_of_turns(angles, box.order)
        return violation(design, np.repeat(point[None], len(angles), 0), turns, low, high)

    for k, point in enumerate(points):
        angles = rng.uniform(least, most, (starts, 3))
        angles[: starts // 4] = np.where(
            rng.uniform(size=(starts // 4, 3)) < 0.5, angles[: starts // 4], least
        )
        angles[starts // 4 : starts // 2] = np.where(
            rng.uniform(size=(starts // 4, 3)) < 0.5, angles[starts // 4 : starts // 2], most
        )
        worst = worst_at(point, angles)
        angles, worst = angles[np.argsort(worst)[:20]], np.sort(worst)[:20]
        size = 0.3
        for _ in range(rounds):
            if worst.min() <= 0.0:
                break
            tried = np.repeat(angles, 8, 0) + size * rng.standard_normal((160, 3))
            tried = np.clip(tried, least, most)
            value = worst_at(point, tried).reshape(-1, 8)
            best = value.argmin(1)
            value = value[np.arange(20), best]
            better = value < worst
            angles[better] = tried.reshape(20, 8, 3)[np.arange(20), best][better]
            worst[better] = value[better]
            size *= 1.0 if better.any() else 0.8
        found[k] = worst.min() <= 0.0
    return found


def product_of_turns(angles, order):
    """Rotations from angles: "rpy" about fixed axes, capitals about moving ones."""
    sequence = {"rpy": "xyz", "approach-roll": "YXZ"}[order]
    places = (1, 0, 2) if order == "approach-roll" else (0, 1, 2)
    result = np.repeat(np.eye(3)[None], len(angles), 0)
    for letter, place in zip(sequence, places, strict=True):
        c, s = np.cos(angles[:, place]), np.sin(angles[:, place])
        k = "xyz".index(letter.lower())
        i, j = (k + 1) % 3, (k + 2) % 3
        turn = np.repeat(np.eye(3)[None], len(angles), 0)
        turn[:, i, i] = turn[:, j, j] = c
        turn[:, i, j], turn[:, j, i] = -s, s
        result = result @ turn if letter.isupper() else turn @ result
    return result


def designs(rng, n):
    """Designs of several families with strokes, one after the other."""
    for k in range(n):
        legs = [("D1",) * 6, ("D1",) * 7, ("D1",) * 8][k % 9 // 7 + (k % 9 == 8)]
        m = len(legs)
        a, b = rng.normal(size=(m, 3)), rng.uniform(-0.7, 0.7, (m, 3))
        if k % 3 == 1 and m == 6:
            angle = np.repeat(np.arange(3), 2) * 2 * np.pi / 3
            spread = np.tile([-1.0, 1.0], 3)
            one, two = angle + 0.2 * spread, angle + np.pi / 3 * spread - 0.2 * spread
            a = 1.5 * np.stack([np.cos(one), np.sin(one), 0 * one], 1)
            b = 0.8 * np.stack([np.cos(two), np.sin(two), 0 * two], 1)
        if k % 3 == 2 and m == 6:
            b = 0.5 * a
        home = gsp.Pose([0.1, -0.1, 1.5])
        plain = gsp.Design(legs, a, b)
        lengths = plain.at(home).joints
        wide = 0.15 if k % 2 else 0.5
        strokes = np.stack([lengths * (1 - wide), lengths * (1 + wide)], 1)
        yield gsp.Design(legs, a, b, strokes=strokes, home=home, name=f"design {k}")


def main(first=0, last=60, points=150):
    """Compare designs of these numbers, with z ≥ 0 and on both sides of the base."""
    wrong = 0
    for k, design in enumerate(designs(np.random.default_rng(13), last)):
        if k < first:
            continue
        for side, least in (("both sides", -np.inf), ("z ≥ 0", 0.0)):
            wrong += compared(design, side, least, points, np.random.default_rng((13, k)))
    print("wrong:", wrong)


def compared(design, side, least, points, rng):
    """Print a bracket beside samples of one design; return how many samples it leaves out."""
    low, high = design.strokes.T
    limits = gsp.Limits(strokes=design.strokes, position=[None, None, (least, None)])
    region = gsp.workspace.reachable(design, limits, budget=300_000, progress=False)
    reach = (design.strokes[:, 1] + np.linalg.norm(design.platform_points, axis=1))[:, None]
    first = np.maximum((design.base_points - reach).max(0), [-np.inf, -np.inf, least])
    last = (design.base_points + reach).min(0)
    sample = rng.uniform(first, last, (points, 3))
    truth = reachable(design, sample, low, high, rng)
    codes = region.contains(sample)
    unseen = ~truth & (codes > 0)
    truth[unseen] = reachable(design, sample[unseen], low, high, rng, starts=20_000, rounds=300)
    bad = int((truth & (codes < 0)).sum()), int((~truth & (codes > 0)).sum())
    value = (last - first).prod() * truth.mean()
    error = (last - first).prod() * np.sqrt(truth.mean() * (1 - truth.mean()) / points)
    print(
        f"{design.name}, {side}: [{region.volume[0]:.4g}, {region.volume[1]:.4g}], Monte Carlo "
        f"{value:.4g} ± {error:.2g}; found but outside {bad[0]}, inside but not found "
        f"{bad[1]}, undecided {int((codes == 0).sum())}",
        flush=True,
    )
    return bad[0]


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
