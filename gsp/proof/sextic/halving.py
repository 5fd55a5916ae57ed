"""Compiled search: boxes of rotations, each with the boxes of positions that are still open."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from zlib import crc32

import numpy as np
from numba import njit

import gsp.kernels.compiled  # noqa: F401, which logs the first compilation
from gsp.geometry.vectors import Array
from gsp.proof.sextic.excess import excess
from gsp.proof.sextic.expansions import in_position, in_rotation
from gsp.proof.sextic.lengths import (
    BASE,
    LARGEST_EXPANDED_SHARE,
    LARGEST_NORM,
    LENGTH_SUM_ROUNDING,
    NUMBERS,
    PLATFORM,
    SHARE,
    SQUARE,
    TOLERANCE,
    legs,
)
from gsp.proof.sextic.space import MOST_FREE_LEGS, Space, Tables


def _digest() -> int:
    """Checksum of the files that are compiled: numba's cache depends on one of them only."""
    number = 0
    for path in sorted(Path(__file__).parent.glob("*.py")):
        number = crc32(path.read_bytes(), number)
    return number


# Which images of a rotation count: one is left out only if another one is nearer by this.
IMAGE_MARGIN = 1e-7


@njit(error_model="numpy", nogil=True)
def left_out(chart: int, q: Array, width: Array, images: Array) -> bool:
    """Return whether all rotations of a box are nearer to another image than to the first one.

    Nearer is where |q · image| is greater.
    """
    for m in range(1, len(images)):
        for sign in (-1.0, 1.0):
            one, two, vary, other, n = 0.0, 0.0, 0.0, 0.0, 0
            for k in range(4):
                a, b = sign * images[m, k] - images[0, k], sign * images[m, k] + images[0, k]
                one += q[k] * a
                two += q[k] * b
                if k != chart:
                    vary += abs(a) * width[3 + n]
                    other += abs(b) * width[3 + n]
                    n += 1
            if one - vary > IMAGE_MARGIN and two - other > IMAGE_MARGIN:
                return True
    return False


# A leg that varies by more than this share of itself may have any direction, if that proves more.
FREE_LEG_SHARE = 0.1


@njit(error_model="numpy", nogil=True)
def expanded(
    tables: Tables, space: Space, free: int, many: int, lost: float
) -> tuple[Array, Array]:
    """Return P, or all cofactors of some legs, about the middle of a box, with their rests."""
    first = tables.places[free]
    start = space.starts[200 * first : 200 * (first + many)].reshape((20, 10 * many))
    tails = space.tails[20 * first : 20 * (first + many)]
    if space.ready[free] == 0:
        space.ready[free] = 1
        in_rotation(
            tables.coefficients[first : first + many],
            space.x,
            space.width,
            tables.order,
            tables.x_steps,
            tables.rotation,
            space.table,
            start,
            tails,
        )
    values, rests = space.values[: 200 * many].reshape((20, 10 * many)), space.rests[:many]
    in_position(
        start,
        space.p,
        space.width,
        tails,
        tables.majorants[first : first + many],
        lost,
        tables.p_steps,
        tables.position,
        values,
        rests,
    )
    return values, rests


@njit(error_model="numpy", nogil=True)
def proven(tables: Tables, space: Space, chart: int, bound: float) -> bool:
    """Return whether |P| ≤ bound · Π |E_i| in a box; else write how much the coordinates matter."""
    p, q, width, facts, parts = space.p, space.q, space.width, tables.facts, space.parts
    totals, single, order = space.totals, space.single, space.order
    legs(
        tables.anchors,
        p,
        q,
        chart,
        width,
        facts,
        totals,
        single,
        order,
        space.quaternions,
        space.work,
    )
    far = 0.0
    for k in range(3):
        far += (abs(p[k]) + width[k]) ** 2
    reach = np.sqrt(far) + facts[BASE] + facts[PLATFORM]
    # See `docs/proofs.md`: what the tolerance of anchors changes.
    lost = facts[LARGEST_NORM] ** 6 * (1.0 + facts[BASE] ** 2) ** 3
    lost *= 7.0 * facts[TOLERANCE] * (2.0 / reach + 1.0) * reach**6
    worst, free, many = np.inf, 0, 1
    for n in range(1 + MOST_FREE_LEGS):
        # The n legs that vary most may have any direction.
        if n > 0:
            if single[order[n - 1], NUMBERS, SHARE] <= FREE_LEG_SHARE:
                break
            free, many, lost = free + (1 << order[n - 1]), 3 * many, lost / reach
        if tables.places[free] < 0 or totals[n, NUMBERS, SHARE] >= LARGEST_EXPANDED_SHARE:
            continue
        values, rests = expanded(tables, space, free, many, lost)
        weight = bound * np.sqrt(totals[n, NUMBERS, SQUARE])
        least = excess(values, rests, weight, totals[n], space.others, space.work)
        if least == 0.0:
            return True
        if least < worst:
            worst = least
            parts[:] = space.others
    if worst == np.inf:
        # Too many legs are short: the displacements of an anchor are halved.
        for k in range(3):
            parts[k] = width[k]
            parts[3 + k] = 2.0 * facts[PLATFORM] / facts[LARGEST_NORM] * width[3 + k]
    return False


@njit(error_model="numpy", nogil=True)
def closest(x: Array, width: Array, first: int) -> float:
    """Return the least square of the distance of a box of three coordinates from zero."""
    total = 0.0
    for k in range(3):
        gap = abs(x[k]) - width[first + k]
        if gap > 0.0:
            total += gap * gap
    return total


@njit(error_model="numpy", nogil=True)
def greatest(parts: Array, first: int) -> int:
    """Return which of three parts is the greatest one."""
    k = first
    for m in range(first + 1, first + 3):
        if parts[m] > parts[k]:
            k = m
    return k


@njit(error_model="numpy", nogil=True)
def halve(centre: Array, width: Array, k: int, sign: float, out: Array) -> None:
    """Write centre and half-widths of one half of a box of three coordinates."""
    for i in range(3):
        out[i], out[3 + i] = centre[i], width[i]
    out[3 + k] *= 0.5
    out[k] += sign * out[3 + k]


def _searcher(digest: int) -> Callable[..., int]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def search(
        tables: Tables,
        radius: float,
        bound: float,
        box: Array,
        chart: int,
        budget: int,
        pool: Array,
        space: Space,
    ) -> int:
        """Halve a box of poses, of which those within a radius count, until all are proven.

        Parameters
        ----------
        box : (12,) array
            Centre (p, x) and half-widths of the poses; x are the coordinates of q but number
            `chart`, which is 1.
        pool : (n, 6) array
            Space for boxes of positions.
        space : Space
            Made by the caller: numba frees arrays of a named tuple that it makes itself.

        Returns
        -------
        int
            Number of boxes tried; negative if not all are proven.
        """
        boxes, lists, depth = np.empty((256, 6)), np.empty((256, 2), np.int64), 1
        stack, weights, count = np.empty((1024, 6)), np.empty(3), 0 * digest
        q, x, p, width, parts = space.q, space.x, space.p, space.width, space.parts
        for k in range(6):
            boxes[0, k] = box[3 + k + (k // 3) * 3]
            pool[0, k] = box[k + (k // 3) * 3]
        lists[0, 0], lists[0, 1] = 0, 1
        while depth > 0:
            depth -= 1
            first, top = lists[depth]
            n, far = 0, 1.0
            for k in range(3):
                x[k], width[3 + k] = boxes[depth, k], boxes[depth, 3 + k]
                far += (abs(x[k]) + width[3 + k]) ** 2
                weights[k] = 0.0
            for k in range(4):
                if k == chart:
                    q[k] = 1.0
                else:
                    q[k] = x[n]
                    n += 1
            if left_out(chart, q, width, tables.images):
                continue
            tables.facts[LARGEST_NORM] = np.sqrt(far) * (1.0 + LENGTH_SUM_ROUNDING)
            space.ready[:] = 0
            end = top
            for item in range(first, top):
                high = 1
                stack[0] = pool[item]
                while high > 0:
                    high -= 1
                    for k in range(3):
                        p[k], width[k] = stack[high, k], stack[high, 3 + k]
                    if closest(p, width, 0) * (1.0 - LENGTH_SUM_ROUNDING) > radius * radius:
                        continue
                    count += 1
                    if proven(tables, space, chart, bound):
                        continue
                    if count >= budget or end + 1 >= len(pool) or high + 2 >= len(stack):
                        return -count
                    k, m = greatest(parts, 0), greatest(parts, 3)
                    if parts[m] > parts[k]:
                        for i in range(3):
                            pool[end, i], pool[end, 3 + i] = p[i], width[i]
                            weights[i] += parts[3 + i] / parts[m]
                        end += 1
                    else:
                        halve(p, width, k, -1.0, stack[high])
                        halve(p, width, k, 1.0, stack[high + 1])
                        high += 2
            if end > top:
                if depth + 2 >= len(boxes):
                    return -count
                k = greatest(weights, 0)
                for sign in (-1.0, 1.0):
                    halve(x, width[3:], k, sign, boxes[depth])
                    lists[depth, 0], lists[depth, 1] = top, end
                    depth += 1
        return count

    return search


search = njit(error_model="numpy", nogil=True, cache=True)(_searcher(_digest()))
