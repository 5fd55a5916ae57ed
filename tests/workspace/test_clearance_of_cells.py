"""Distances between legs over cells of positions."""

from itertools import pairwise

import numpy as np

import gsp
from gsp.workspace import fixed_orientation
from gsp.workspace.sets.compiled.gaps import stay_apart


def test_segments_that_stay_apart_do_so_wherever_their_ends_move():
    rng = np.random.default_rng(8)
    ends, proven, shares = np.empty((4, 3)), 0, np.linspace(0.0, 1.0, 21)
    for _ in range(300):
        p, p_end, q, q_end = rng.normal(size=(4, 3))
        moves, least = 0.3 * rng.random(3), 0.3 * rng.random()
        if not stay_apart(p, p_end, q, q_end, moves, least, ends):
            continue
        proven += 1
        shift, one, two = (
            m * x / np.linalg.norm(x) for m, x in zip(moves, rng.normal(size=(3, 3)), strict=True)
        )
        s, t = (x[..., None] for x in np.meshgrid(shares, shares))
        first = p + s * (p_end + shift + one - p)
        second = q + t * (q_end + shift + two - q)
        assert np.linalg.norm(first - second, axis=-1).min() >= least
    assert proven > 50


def test_clearance_is_proven_with_coarse_cells():
    """Legs that leave the base 1 apart are hardly moved there by a step of the platform."""
    design = gsp.catalogue.design("workspace-6-3")
    plane = ((0.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    thick = gsp.Limits(leg_radius=0.1)
    found = [
        fixed_orientation(design, np.eye(3), thick, plane=plane, resolution=r).area
        for r in (4.0, 2.0, 0.5)
    ]
    assert found[1][0] > 0.0
    assert all(a[0] <= b[0] <= b[1] <= a[1] for a, b in pairwise(found))
