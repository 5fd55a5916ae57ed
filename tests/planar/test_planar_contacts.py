"""Which parts a workspace at a fixed angle has where curves touch: closed forms and grids."""

import numpy as np
import pytest
from scipy import ndimage

from gsp.planar import PlanarDesign, planar_components, planar_section
from tests import campaign

FREE = ("D1", 0.0, 0.0, 0.0, 50.0)
INSIDE = ("D1", 0.0, 0.0, 0.0, 2.0)
SMALL = 1.0 / (1.0 + 2.0 / np.sqrt(3.0))  # the radius of three circles that touch in a circle of 1
CENTRES = (1.0 - SMALL) * np.exp(1j * (0.5 + 2.0 * np.arange(3) / 3.0) * np.pi)
BETWEEN = SMALL**2 * (np.sqrt(3.0) - 0.5 * np.pi)  # the triangle between them
BESIDE = (np.pi * (1.0 - 3.0 * SMALL**2) - BETWEEN) / 3.0  # of the three parts around


def hole(centre, radius):
    return ("D1", centre, 0.0, radius, 50.0)


# Legs (kind, base anchor, direction, strokes), the areas of the parts, and the number of holes.
CASES = {
    "two holes touch each other and the outline": (
        [INSIDE, hole(1, 1), hole(-1, 1)],
        [np.pi] * 2,
        0,
    ),
    "a hole touches the outline": ([INSIDE, hole(1, 1)], [3.0 * np.pi], 0),
    "two holes touch each other": ([INSIDE, hole(0.5, 0.5), hole(-0.5, 0.5)], [3.5 * np.pi], 1),
    "three holes touch, and the outline": (
        [("D1", 0, 0, 0, 1), *(hole(c, SMALL) for c in CENTRES)],
        [BESIDE] * 3 + [BETWEEN],
        0,
    ),
    "three holes touch, inside": (
        [("D1", 0, 0, 0, 3), *(hole(c, SMALL) for c in CENTRES)],
        [np.pi * (9.0 - 3.0 * SMALL**2) - BETWEEN, BETWEEN],
        1,
    ),
    "a chain of holes": (
        [INSIDE, *(hole(x, 0.5) for x in (-1.5, -0.5, 0.5, 1.5))],
        [1.5 * np.pi] * 2,
        0,
    ),
    "a chain with a gap": ([INSIDE, *(hole(x, 0.5) for x in (-1.5, -0.5, 1.5))], [3.25 * np.pi], 0),
    "six holes through one point": (
        [INSIDE, *(hole(np.exp(1j * np.pi * k / 3.0), 1) for k in range(6))],
        [np.pi / 3.0 - np.sqrt(0.75)] * 6,
        0,
    ),
    "a hole fills the disc": ([INSIDE, hole(0, 2)], [], 0),
    "a ring around a disc": ([("D1", 0, 0, 1, 2), ("D1", 0, 0, 0, 1), ("D1", 0, 0, 0, 3)], [], 0),
    "a hole fills a strip": (
        [("D3", 0, 1, 0, 1), ("D1", 0, 0, 0, 3), hole(0, 1)],
        [np.sqrt(8.0) + 9.0 * np.arcsin(1.0 / 3.0) - 0.5 * np.pi] * 2,
        0,
    ),
    "a hole touches a square": (
        [("D3", 0, 1, 0, 1), ("D2", 0, 1j, 0, 1), hole(0, 1)],
        [1.0 - 0.25 * np.pi] * 4,
        0,
    ),
    "a disc touches a strip from outside": ([("D2", 2j, 1, 0, 1), ("D1", 0, 0, 0, 1)], [], 0),
    "a disc on both sides of a strip": (
        [("D2", 0, 1, 1, 50), ("D1", 0, 0, 0, 2), ("D3", 0, 1j, 0, 2)],
        [4.0 * np.pi / 3.0 - np.sqrt(3.0)] * 2,
        0,
    ),
    "a disc touches the disc around it": ([INSIDE, ("D1", 1, 0, 0, 1)], [np.pi], 0),
    "the same hole three times": ([INSIDE, hole(0, 1), hole(0, 1), hole(0, 1)], [3.0 * np.pi], 1),
}


def parts_of(legs, *, unit=1.0, shift=0.0, turn=0.0, angle=0.0, rng=None):
    """The parts of legs in another unit, frame, order and at another angle of the platform."""
    legs = [*legs, *[FREE] * (3 - len(legs))]
    legs = legs if rng is None else [legs[i] for i in rng.permutation(len(legs))]
    kinds, anchors, lines, low, high = zip(*legs, strict=True)
    base, along = (np.exp(1j * turn) * np.array(z, dtype=complex) for z in (anchors, lines))
    base = unit * (base + shift)
    directions = (np.stack((z.real, z.imag), 1) for z in (along, along * np.exp(-1j * angle)))
    design = PlanarDesign(
        kinds,
        np.stack((base.real, base.imag), axis=1),
        np.zeros((len(legs), 2)),
        *directions,
        strokes=unit * np.stack((low, high), axis=1),
    )
    return planar_components(design, angle)


@pytest.mark.parametrize("name", CASES)
def test_parts_that_touch_are_separate_at_any_scale(name):
    legs, areas, holes = CASES[name]
    rng = np.random.default_rng(7)
    for shift in (0.0, 1e3, 1e3 - 2e3j):
        for unit in (1e-6, 1.0, 1e6):
            turn, angle = rng.uniform(-3.0, 3.0, 2) * rng.integers(0, 2, 2)
            given = {"unit": unit, "shift": shift, "turn": turn, "angle": angle}
            parts = parts_of(legs, **given, rng=rng)
            found = [part.area / unit**2 for part in parts]
            assert found == pytest.approx(sorted(areas, reverse=True), rel=1e-9), given
            assert sum(len(part.holes) for part in parts) == holes


@pytest.mark.parametrize("gap", [0.0, 1e-15, 1e-12, 1e-10, 8e-10])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_gap_below_the_tolerance_is_a_contact(gap, sign):
    """The tolerance is 1e-9 of the radius 2."""
    x = 1.0 + 0.5 * sign * gap
    found = [part.area for part in parts_of([INSIDE, hole(x, 1), hole(-x, 1)])]
    assert found == pytest.approx([np.pi] * 2, rel=1e-9)
    [part] = parts_of([INSIDE, hole(1.0 - sign * gap, 1)])
    assert (len(part.holes), len(part.outline)) == (0, 2)
    assert part.area == pytest.approx(3.0 * np.pi, rel=1e-9)
    assert parts_of([INSIDE, hole(0, 2.0 - gap)]) == ()
    assert parts_of([INSIDE, hole(gap * (0.6 + 0.8j), 2.0)]) == ()


@pytest.mark.parametrize("gap", [4e-9, 1e-6, 1e-3])
def test_a_gap_above_the_tolerance_is_a_passage(gap):
    """Between two holes at ±(1 + gap/2), and between a hole and the disc around it."""
    x = 1.0 + 0.5 * gap
    [part] = parts_of([INSIDE, hole(x, 1), hole(-x, 1)])
    crescent = np.pi - overlap(x, 2.0, 1.0)
    assert part.area == pytest.approx(2.0 * (np.pi + crescent), rel=1e-9)
    apart = parts_of([INSIDE, *(hole(s * (1.0 - 0.5 * gap), 1.0 + gap) for s in (-1, 1))])
    assert len(apart) == 2
    [part] = parts_of([INSIDE, hole(1.0 - gap, 1)])
    assert len(part.holes) == 1
    assert part.area == pytest.approx(3.0 * np.pi, rel=1e-12)
    [ring] = parts_of([INSIDE, hole(0, 2.0 - gap)])
    assert ring.area == pytest.approx(np.pi * gap * (4.0 - gap), rel=1e-6)


def overlap(apart, one, other):
    """Area that two discs have in common, by their sectors and triangles."""
    a = np.arccos((apart**2 + one**2 - other**2) / (2.0 * apart * one))
    b = np.arccos((apart**2 + other**2 - one**2) / (2.0 * apart * other))
    return one**2 * (a - np.sin(2 * a) / 2) + other**2 * (b - np.sin(2 * b) / 2)


def test_corners_are_where_curves_touch():
    """Both parts have them: the origin and the points of the outline at (±2, 0)."""
    upper, lower = parts_of([INSIDE, hole(1, 1), hole(-1, 1)])
    numbers = [{piece.first for piece in part.pieces} for part in (upper, lower)]
    assert numbers[0] == numbers[1]
    assert len(numbers[0]) == 3
    ends = np.concatenate([piece.points[[0, -1]] for piece in (*upper.pieces, *lower.pieces)])
    apart = np.abs(ends[:, None] - [[0.0, 0.0], [2.0, 0.0], [-2.0, 0.0]]).max(axis=-1)
    assert apart.min(axis=1).max() < 1e-15
    assert upper.contains([[0.0, 1.0], [0.0, 1e-5]]).all() != upper.contains([0.0, -1.0])


@pytest.mark.parametrize("far", [-1e-3, 0.0, 1e-5, 1e-3])
def test_a_line_through_the_cusps_of_parts(far):
    """It allows y > far: nothing of the boundary is beyond it, also where cusps are narrow."""
    legs = [INSIDE, hole(1, 1), hole(-1, 1), ("D3", 1j * (3.0 + far), 1, 0, 3.0)]
    parts = parts_of(legs)
    points = np.concatenate([piece.points for part in parts for piece in part.pieces])
    assert (points[:, 1] > far - 3e-9).all()
    # The cusps at the origin and at (±2, 0) are about y² and y²/4 wide.
    lost = far**3 / 3.0 + 2.0 * far**3 / 12.0
    assert sum(part.area for part in parts) == pytest.approx(
        np.pi - lost, abs=1e-9 * abs(far) + 2e-13
    )


def lattice_design(rng):
    """Rings and strips about points of a lattice, of a few radii: most of them touch."""
    radii = np.array([0.25, 0.5, 1.0, 1.5, 2.0, np.sqrt(0.5), np.sqrt(2.0)])
    legs = [INSIDE]
    for _ in range(rng.integers(2, 7)):
        kind = "D1" if rng.random() < 0.75 else "D3"
        centre = complex(*(0.5 * rng.integers(-2, 3, 2)))
        along = np.exp(0.25j * np.pi * rng.integers(0, 4))
        low, high = np.sort(rng.choice(radii, 2, replace=False))
        legs.append((kind, centre, along, low, 50.0 if rng.random() < 0.6 else high))
    return legs


def allowed(legs, points):
    """Whether complex positions are within the limits of legs; written afresh."""
    ok = np.ones(points.shape, dtype=bool)
    for kind, centre, along, low, high in legs:
        away = points - centre
        value = np.abs(away) if kind == "D1" else np.abs((away * np.conj(along)).imag)
        ok &= (value >= low) & (value <= high)
    return ok


@pytest.mark.parametrize("seed", range(campaign.count(12, 400)))
def test_parts_of_lattices_against_flood_fill(seed):
    """Cells of a grid whose neighbours are in the set are one part, where no passage is narrow."""
    legs = lattice_design(np.random.default_rng(seed))
    n = campaign.count(500, 1200)
    step = 4.1 / n
    x = -2.05 + step * (np.arange(n) + 0.237)
    points = x[:, None] + 1j * (x + 0.374 * step)
    filled, _ = ndimage.label(allowed(legs, points))
    parts = parts_of(legs)
    flat = np.stack((points.real, points.imag), axis=-1)[filled > 0]
    inside = np.array([part.contains(flat) for part in parts]).reshape(len(parts), len(flat))
    assert (inside.sum(axis=0) == 1).all()
    cells = np.bincount(filled[filled > 0], minlength=2)
    number = filled[filled > 0]
    for part, own in zip(parts, inside, strict=True):
        assert part.area == pytest.approx(own.sum() * step**2, abs=30.0 * step**2 + 8.0 * step**1.5)
        met = np.unique(number[own])
        # Cusps end in cells without neighbours; a cell of another part would be a passage.
        assert not np.isin(number[~own], met).any()
        assert (cells[met] > 60).sum() == 1 or part.area < 100.0 * step**2


def test_a_section_of_parts_that_touch():
    at = np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0]])
    design = PlanarDesign(["D1"] * 3, at, np.zeros((3, 2)), strokes=[[0, 2], [1, 9], [1, 9]])
    found = planar_section(design, [0.0, 1.0], angle=0.0, rays=4)
    assert [len(found.curves), len(found.bifurcations)] == [6, 3]
    assert {point.label for point in found.bifurcations} == {"1 0 -", "1 - 0", "- 0 0"}
    frame = found.on_rays([0.5 * np.pi, -0.5 * np.pi])
    assert list(frame[frame["outer"]]["distance"]) == pytest.approx([1.0, 3.0], abs=1e-3)
