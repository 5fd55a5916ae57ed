"""Components at a fixed angle, against sampled positions and closed forms."""

import numpy as np
import pytest

from gsp.errors import GspError, InvalidInput, MissingParameter
from gsp.planar import PlanarDesign, outlines, planar_components, planar_design, planar_section

SAMPLES = 20_000


def values(design, angle, points):
    """Joint values of D1, D2 and D3 legs at positions (n, 2), written afresh: shape (n, legs)."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    columns = []
    for i, leg in enumerate(design.legs):
        d = points + turn @ design.platform_points[i] - design.base_points[i]
        if leg.name == "D1":
            columns.append(np.hypot(d[:, 0], d[:, 1]))
            continue
        line = turn @ design.platform_directions[i] if leg.name == "D2" else None
        line = design.base_directions[i] if line is None else line
        columns.append(np.abs(d[:, 0] * line[1] - d[:, 1] * line[0]))
    return np.stack(columns, axis=1)


def feasible(design, angle, points):
    low, high = design.strokes.T
    joints = values(design, angle, points)
    return ((joints >= low) & (joints <= high)).all(axis=1)


def random_case(number, make_design, rng):
    """A random or symmetric design with strokes near those of a pose, and an angle."""
    n = int(rng.integers(3, 7))
    legs = ["D1", *rng.choice(["D1", "D1", "D2", "D3"], n - 1)] if number % 2 else ["D1"] * n
    design = make_design(legs, rng)
    if number % 5 == 0:
        turns = 2.0 * np.pi * np.arange(n) / n
        ring = np.stack((np.cos(turns), np.sin(turns)), axis=1)
        design = design.replace(base_points=ring, platform_points=0.5 * ring * (number % 10 > 0))
        low, high = sorted(rng.choice([0.3, 0.5, 1.0, 1.5], 2, replace=False))
        return design.replace(strokes=[[low, high]] * n), float(rng.choice([0.0, np.pi / n, 0.3]))
    if number % 5 == 1:
        points = design.base_points.copy()
        points[1] = points[0]
        design = design.replace(base_points=points)
    angle = float(rng.uniform(-3.0, 3.0))
    if number % 5 == 2:  # small against the strokes: rings with holes
        ends = 0.15 * design.base_points, 0.15 * design.platform_points
        design = design.replace(base_points=ends[0], platform_points=ends[1])
        low = rng.uniform(0.1, 0.5, n)
        return design.replace(strokes=np.stack((low, low + rng.uniform(0.8, 1.5, n)), 1)), angle
    here = values(design, angle, rng.normal(size=(1, 2)))[0]
    low = here * rng.uniform(0.3, 0.98, n)
    strokes = np.stack((low, here + rng.uniform(0.02, 1.5, n)), axis=1)
    return design.replace(strokes=strokes), angle


@pytest.mark.parametrize("number", range(60))
def test_areas_and_members_against_sampled_positions(number, make_design):
    rng = np.random.default_rng(number)
    design, angle = random_case(number, make_design, rng)
    parts = planar_components(design, angle)
    reach = np.nanmax(np.where([leg.name == "D1" for leg in design.legs], design.strokes[:, 1], 0))
    arms = np.linalg.norm(design.platform_points, axis=1).max()
    middle, half = design.base_points[0], reach + arms + np.ptp(design.base_points, axis=0).max()
    if parts:
        outline = np.concatenate([piece.points for part in parts for piece in part.outline])
        low, high = outline.min(axis=0), outline.max(axis=0)
        assert (np.diff([part.area for part in parts]) <= 0.0).all()
        # Nothing is feasible beyond the outlines.
        wide = rng.uniform(middle - half, middle + half, (SAMPLES, 2))
        beyond = ((wide < low) | (wide > high)).any(axis=1)
        assert not feasible(design, angle, wide[beyond]).any()
        middle, half = 0.5 * (low + high), 0.51 * (high - low)
    points = rng.uniform(middle - half, middle + half, (SAMPLES, 2))
    inside = feasible(design, angle, points)
    members = np.array([part.contains(points) for part in parts]).reshape(-1, SAMPLES)
    assert np.array_equal(members.sum(axis=0), inside)
    box = np.prod(2.0 * half * np.ones(2))
    share = inside.mean()
    error = box * np.sqrt(max(share * (1.0 - share), 1.0 / SAMPLES) / SAMPLES)
    assert abs(sum(part.area for part in parts) - share * box) < 5.0 * error
    for part, own in zip(parts, members, strict=True):
        share = own.mean()
        error = box * np.sqrt(max(share * (1.0 - share), 1.0 / SAMPLES) / SAMPLES)
        assert abs(part.area - share * box) < 5.0 * error


def test_the_cases_have_several_components_and_holes(make_design):
    """So that the comparison above tests them."""
    found = []
    for number in range(60):
        design, angle = random_case(number, make_design, np.random.default_rng(number))
        parts = planar_components(design, angle)
        found.append((len(parts), sum(len(part.holes) for part in parts)))
    assert sum(n > 1 for n, _ in found) >= 5
    assert sum(holes > 0 for _, holes in found) >= 5
    assert sum(n == 0 for n, _ in found) >= 3


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("shift", [0.0, 1e4])
def test_a_known_platform_in_any_unit_and_frame(scale, shift):
    """Three rings of the published platform: the tiny part about the origin, and a ring around."""
    move = np.array([shift, -2.0 * shift])
    design = planar_design("lee-2000-planar").replace(strokes=[[0.3, 0.9]] * 3)
    moved = design.replace(base_points=design.base_points + move, home=None).scaled(scale)
    angle = np.deg2rad(20.0)
    large, small = planar_components(moved, angle)
    points = np.random.default_rng(5).uniform(-0.8, 0.8, (400_000, 2))
    share = feasible(design, angle, points).mean()
    assert large.area / scale**2 == pytest.approx(2.56 * share, abs=5 * 2.56 * 6e-4)
    assert 0.9e-4 < small.area / scale**2 < 1.3e-4
    assert (len(large.outline), len(large.holes), len(small.holes)) == (3, 1, 0)
    assert small.contains(scale * move)
    assert not large.contains(scale * move)
    assert large.contains(scale * (move + [0.4, 0.0]))


def test_closed_forms():
    """A ring, two discs that overlap, that touch, and strips."""
    at = np.zeros((3, 2))
    apart = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]])
    ring = PlanarDesign(["D1"] * 3, at, at, strokes=[[1.0, 2.0], [0.5, 2.0], [0.0, 5.0]])
    [part] = planar_components(ring, 0.4)
    assert part.area == pytest.approx(3.0 * np.pi, rel=1e-14)
    assert [piece.active for piece in part.pieces] == [((0, 1), (1, 1)), ((0, 0),)]
    lens = PlanarDesign(["D1"] * 3, apart, at, strokes=[[0.0, 1.0]] * 3)
    [part] = planar_components(lens)
    assert part.area == pytest.approx(2 * np.pi / 3 - np.sqrt(3) / 2, rel=1e-14)
    touching = PlanarDesign(["D1"] * 3, 2.0 * apart, at, strokes=[[0.0, 1.0]] * 3)
    assert planar_components(touching) == ()
    opposite = PlanarDesign(["D1"] * 3, at, at, strokes=[[0.5, 1.0], [1.0, 2.0], [0.0, 3.0]])
    assert planar_components(opposite) == ()
    crossed = PlanarDesign(
        ["D3", "D3", "D2"],
        at,
        at,
        base_directions=[[1, 0], [0, 1], [1, 0]],
        platform_directions=[[1, 0], [1, 0], [1, 0]],
        strokes=[[1.0, 2.0], [1.0, 3.0], [0.0, 9.0]],
    )
    parts = planar_components(crossed)  # two pairs of strips
    assert [part.area for part in parts] == pytest.approx([2.0] * 4, rel=1e-14)


@pytest.mark.parametrize("gap", [0.0, 1e-13, -4e-12, 3e-10, -1.6e-9, 4e-9, 3e-8, -1e-7, 2e-6])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_outlines_of_curves_that_nearly_touch_or_coincide(gap, turn):
    """Circles that touch from outside and from inside, two of which nearly coincide."""
    c, s = np.cos(turn), np.sin(turn)
    spin = np.array([[c, -s], [s, c]])
    at = np.zeros((3, 2))
    # Holes of radius 0.5 about (0, 0) and (1, 0) touch, and the first touches the outline.
    base = np.array([[0.0, 0.0], [1.0, 0.0], [1.0 + gap, gap]]) @ spin.T
    strokes = [[0.5, 2.0], [0.5, 1.5], [0.5 + gap, 1.5 + 2.0 * gap]]
    parts = planar_components(PlanarDesign(["D1"] * 3, base, at, strokes=strokes))
    overlap = lens(1.0, 2.0, 1.5)
    assert sum(part.area for part in parts) == pytest.approx(overlap - np.pi / 2, abs=2e-4)
    # A disc that touches the ring from inside, cut by a third.
    base = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]]) @ spin.T
    strokes = [[1.0, 3.0], [0.0, 1.0 - gap], [0.0, 2.0 + gap]]
    parts = planar_components(PlanarDesign(["D1"] * 3, base, at, strokes=strokes))
    overlap = lens(np.sqrt(2.0), 1.0, 2.0)
    assert sum(part.area for part in parts) == pytest.approx(overlap, abs=2e-4)


def lens(apart, one, other):
    """Area that two discs have in common, by their sectors and triangles."""
    a = np.arccos((apart**2 + one**2 - other**2) / (2.0 * apart * one))
    b = np.arccos((apart**2 + other**2 - one**2) / (2.0 * apart * other))
    return one**2 * (a - np.sin(2 * a) / 2) + other**2 * (b - np.sin(2 * b) / 2)


SMALL = 1.0 / (1.0 + 2.0 / np.sqrt(3.0))  # the radius of three circles that touch in a circle
THREE = (1.0 - SMALL) * np.exp(1j * (0.5 + 2.0 * np.arange(3) / 3.0) * np.pi)
# Legs (kind, base anchor, direction, strokes), and the area.
TOUCHING = {
    "two holes": (
        [("D1", 0, 0, 0, 1), ("D1", 0.5, 0, 0.5, 9), ("D1", -0.5, 0, 0.5, 9)],
        0.5 * np.pi,
    ),
    "strip": (
        [("D3", 0, 1, 0, 1), ("D1", 0, 0, 0, 3), ("D1", 0, 0, 1, 9)],
        2.0 * (np.sqrt(8.0) + 9.0 * np.arcsin(1.0 / 3.0)) - np.pi,
    ),
    "square": ([("D3", 0, 1, 0, 1), ("D3", 0, 1j, 0, 1), ("D1", 0, 0, 1, 9)], 4.0 - np.pi),
    "ring and strip": (
        [("D3", 0, 1, 0, 1), ("D1", 0, 0, 1, 2), ("D1", 0, 0, 0, 9)],
        2.0 * (np.sqrt(3.0) + 4.0 * np.arcsin(0.5)) - np.pi,
    ),
    "lens": (
        [("D1", 1, 0, 0, 2), ("D1", -1, 0, 0, 2), ("D1", 0, 0, 1, 9)],
        8.0 * np.arccos(0.5) - np.sqrt(12.0) - np.pi,
    ),
    "three holes": (
        [("D1", 0, 0, 0, 1), *(("D1", c, 0, SMALL, 9) for c in THREE)],
        np.pi * (1.0 - 3.0 * SMALL**2),
    ),
}


@pytest.mark.parametrize("shift", [0.0, 1e3])
@pytest.mark.parametrize("name", TOUCHING)
def test_holes_that_touch_the_outline_or_each_other(name, shift):
    legs, area = TOUCHING[name]
    rng = np.random.default_rng(2)
    for turn in (0.0, 0.5 * np.pi, *rng.uniform(0.0, 7.0, 6)):
        for unit in (1e-6, 1.0, np.pi):
            order = rng.permutation(len(legs))
            kinds, anchors, lines, low, high = zip(*(legs[i] for i in order), strict=True)
            base, along = (np.exp(1j * turn) * np.array(z) for z in (anchors, lines))
            base = unit * (base + shift)
            design = PlanarDesign(
                kinds,
                np.stack((base.real, base.imag), axis=1),
                np.zeros((len(legs), 2)),
                np.stack((along.real, along.imag), axis=1),
                strokes=unit * np.stack((low, high), axis=1),
            )
            found = sum(part.area for part in planar_components(design)) / unit**2
            assert found == pytest.approx(area, rel=1e-6)


def test_positions_on_chords_of_the_boundary():
    """Its arcs are seen from there under half a turn."""
    ring = PlanarDesign(
        ["D1"] * 3, [[0, 0], [1, 1], [2, -1]], [[0, 0], [1, 1], [2, -1]], strokes=[[4, 9]] * 3
    )
    [part] = planar_components(ring)
    assert not part.contains([[-1, -3], [-2, -2], [2, 2], [0, 0]]).any()
    lens = PlanarDesign(
        ["D1"] * 3, [[-5, 0], [5, 0], [0, 3]], np.zeros((3, 2)),
        strokes=[[2, 5.1], [1, 5.1], [1, 6]],
    )  # fmt: skip
    [part] = planar_components(lens)
    assert part.contains([[0, 0], [0, 0.5], [1e-6, 0]]).all()
    assert not part.contains([[0, 2], [0.2, 0]]).any()


def test_pieces_that_form_no_outline_are_an_error(monkeypatch):
    ring = PlanarDesign(["D1"] * 3, np.eye(3, 2), np.zeros((3, 2)), strokes=[[0.0, 1.0]] * 3)
    monkeypatch.setattr(outlines, "traced", lambda limits: None)
    with pytest.raises(GspError, match=r"^strokes: expected limits .* form closed outlines"):
        planar_components(ring)


def test_an_angle_leg_allows_an_angle_or_not():
    design = PlanarDesign(
        ["D1", "D1", "A1"],
        [[0, 0], [1, 0], [0, 0]],
        np.zeros((3, 2)),
        base_directions=[[1, 0]] * 3,
        platform_directions=[[1, 0]] * 3,
        strokes=[[0.2, 1.0], [0.2, 1.0], [-0.5, 0.5]],
    )
    assert len(planar_components(design, 0.4)) == 1
    assert planar_components(design, 0.6) == ()
    # Half a turn is π and −π.
    half = design.replace(strokes=[*design.strokes[:2], [3.0, np.pi]])
    assert [len(planar_components(half, a)) for a in (np.pi, -np.pi, 3.05, -3.05)] == [1, 1, 1, 0]


def test_a_section_has_the_boundaries_of_all_components():
    design = planar_design("lee-2000-planar").replace(strokes=[[0.3, 0.9]] * 3)
    angle = np.deg2rad(20.0)
    for origin in ([0.0, 0.0], [0.4, 0.0]):
        mapped = planar_section(design, origin, angle=angle, rays=5)
        assert len(mapped.curves) == len(mapped.bifurcations) == 9
        for curve in mapped.curves:
            joints = values(design, angle, curve.pose.position[:, :2])
            for leg, side in curve.held:
                assert np.abs(joints[:, leg] - (0.3, 0.9)[side]).max() < 1e-12
        # The farthest point on each ray, by steps along it.
        turns = np.linspace(0.03, 2.0 * np.pi, 25)
        frame = mapped.on_rays(turns)
        outer = frame[frame["outer"]]
        assert list(outer["ray"]) == list(range(25))
        steps = np.linspace(1e-6, 2.0, 20_001)
        for ray, distance in zip(turns, outer["distance"], strict=True):
            way = origin + steps[:, None] * [np.cos(ray), np.sin(ray)]
            last = steps[feasible(design, angle, way)].max()
            assert 0.0 <= distance - last < 2e-4


def test_bad_input():
    design = planar_design("lee-2000-planar")
    with pytest.raises(MissingParameter, match="strokes"):
        planar_components(design)
    strips = PlanarDesign(
        ["D3"] * 3,
        np.zeros((3, 2)),
        np.eye(3, 2),
        base_directions=[[1, 0]] * 3,
        strokes=[[0.0, 1.0]] * 3,
    )
    with pytest.raises(InvalidInput, match=r"^strokes: expected a D1 leg with a greatest length"):
        planar_components(strips)
    with pytest.raises(InvalidInput, match="angle: expected one angle"):
        planar_components(design.replace(strokes=[[0.3, 0.9]] * 3), [0.0, 1.0])
