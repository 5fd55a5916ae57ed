import numpy as np
import pytest

import gsp
from gsp.errors import InvalidDesign, InvalidInput
from gsp.geometry.rotations import rotation_from_angles
from gsp.limits.labels import active_from_label
from gsp.workspace import Limits, Shells, exact_shells
from tests import campaign

BALL = 4.0 / 3.0 * np.pi


def lens(r1, r2, gap):
    """Volume common to two balls."""
    if gap >= r1 + r2:
        return 0.0
    if gap <= abs(r1 - r2):
        return BALL * min(r1, r2) ** 3
    both = r1 + r2 - gap
    return np.pi * both**2 * (gap**2 + 2 * gap * (r1 + r2) - 3 * (r1 - r2) ** 2) / (12 * gap)


def test_one_shell():
    shell = Shells([[0.3, -0.2, 0.7]], [0.6], [1.1])
    exact = BALL * (1.1**3 - 0.6**3)
    volume = shell.volume()
    assert volume.value == pytest.approx(exact, rel=1e-12)
    assert volume.error < 1e-9 * exact


@pytest.mark.parametrize("seed", range(12))
def test_two_shells_in_closed_form(seed):
    rng = np.random.default_rng(seed)
    low = rng.uniform(0.1, 0.9, 2)
    high = low + rng.uniform(0.1, 1.0, 2)
    gap = rng.uniform(0.05, 1.8)
    first = rng.normal(size=3)
    way = rng.normal(size=3)
    shells = Shells([first, first + gap * way / np.linalg.norm(way)], low, high)
    exact = (
        lens(*high, gap) - lens(low[0], high[1], gap) - lens(high[0], low[1], gap) + lens(*low, gap)
    )
    volume = shells.volume()
    assert volume.value == pytest.approx(exact, abs=1e-9)
    assert abs(volume.value - exact) <= volume.error + 1e-12


def test_volume_of_the_platform_against_random_points(platform):
    shells = exact_shells(platform)
    points = np.random.default_rng(3).uniform((-10, -10, 0), (10, 10, 14), (400_000, 3))
    inside = shells.contains(points)
    assert np.array_equal(inside, gsp.feasible(platform, gsp.Pose(points)).ok)
    box = 20 * 20 * 14
    expected, spread = inside.mean() * box, box * inside.std() / np.sqrt(len(points))
    volume = shells.volume((0.0, np.inf))
    assert abs(volume.value - expected) < 4 * spread
    assert shells.volume().value == pytest.approx(2 * volume.value, rel=1e-9)


def test_volume_does_not_change_with_a_rigid_motion_and_scales_with_the_cube(platform):
    turn = rotation_from_angles([0.3, -0.5, 1.1])
    shells = exact_shells(platform, rotation_from_angles([0.1, 0.2, -0.3]))
    moved = Shells(shells.centers @ turn.T + [1.0, 2.0, -3.0], shells.low, shells.high)
    scaled = Shells(2.5 * shells.centers, 2.5 * shells.low, 2.5 * shells.high)
    volume = shells.volume().value
    assert moved.volume().value == pytest.approx(volume, rel=1e-9)
    assert scaled.volume().value == pytest.approx(2.5**3 * volume, rel=1e-11)


def test_area_of_a_section_against_a_grid(platform):
    shells = exact_shells(platform)
    x = (np.arange(800) + 0.5) / 800 * 24 - 12
    y = np.stack(np.meshgrid(x, x, indexing="ij"), -1)
    points = np.concatenate((y, np.full((800, 800, 1), 8.0)), axis=-1)
    area = shells.section_area([0.0, 0.0, 8.0], [[1, 0, 0], [0, 1, 0]])
    assert shells.contains(points).mean() * 24**2 == pytest.approx(area, rel=2e-3)


def test_arcs_lie_on_the_boundary_and_close(platform):
    shells = exact_shells(platform, rotation_from_angles([0, 0, -0.5], "approach-roll"))
    for theta in (0.0, 0.4, 1.3):
        plane = np.array([[np.cos(theta), np.sin(theta), 0.0], [0.0, 0.0, 1.0]])
        arcs = shells.section([0.0, 0.0, 0.0], plane)
        ends = []
        for arc in arcs:
            assert shells.contains(arc.points, 1e-9).all()
            for leg, side in active_from_label(arc.label, 6):
                gap = np.linalg.norm(arc.points - shells.centers[leg], axis=1)
                assert np.allclose(gap, (shells.low, shells.high)[side][leg], atol=1e-12)
            normal = np.cross(*plane)
            assert np.abs(arc.points @ normal).max() < 1e-12
            ends += [arc.first, arc.last]
        for end in ends:
            near = sum(np.linalg.norm(end - other) < 1e-9 for other in ends)
            assert near % 2 == 0


def test_vertices_and_edges(platform):
    shells = exact_shells(platform)
    corners = shells.vertices()
    for corner in corners:
        assert shells.contains(corner.position, 1e-9)
        assert len(active_from_label(corner.label, 6)) >= 3
    places = np.array([corner.position for corner in corners])
    for edge in shells.edges():
        assert shells.contains(edge.points, 1e-8).all()
        for end in (edge.first, edge.last):
            assert np.linalg.norm(places - end, axis=1).min() < 1e-8


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("tilt", [0.0, 0.3])
def test_points_where_spheres_are_tangent_are_one_vertex_and_no_edge(size, tilt):
    """Six inner spheres through one point with a common tangent, opposite ones touch the outer."""
    turns = np.arange(6) * np.pi / 3
    centres = 0.5 * np.stack((np.cos(turns), np.sin(turns), 0.0 * turns), axis=1)
    rotation = rotation_from_angles((tilt, 2.0 * tilt, 0.1 * tilt), "rpy")
    middle = tilt * np.array([1.0, -2.0, 10.0])
    shells = Shells(size * (centres @ rotation.T + middle), [0.5 * size] * 6, [1.5 * size] * 6)
    corners = shells.vertices()
    assert sorted(v.label for v in corners) == ["0 0 0 0 0 0", "1 1 1 1 1 1", "1 1 1 1 1 1"]
    heights = [(v.position / size - middle) @ rotation for v in corners]
    exact = np.array([[0.0, 0.0, z] for z in (-(2.0**0.5), 0.0, 2.0**0.5)])
    np.testing.assert_allclose(sorted(heights, key=lambda p: p[2]), exact, rtol=0, atol=3e-8)
    edges = shells.edges()
    assert len(edges) == 12
    assert all(edge.label.count("-") == 4 and edge.label.count("0") in (0, 2) for edge in edges)


def test_nothing_in_common():
    shells = Shells([[0, 0, 0], [5, 0, 0]], [0.5, 0.5], [1.0, 1.0])
    assert shells.volume() == (0.0, 0.0)
    assert shells.vertices() == shells.edges() == ()
    assert shells.section([0, 0, 0], [[1, 0, 0], [0, 0, 1]]) == ()


def test_bad_input(platform):
    with pytest.raises(InvalidInput, match="low < high"):
        Shells([[0, 0, 0]], [1.0], [1.0])
    with pytest.raises(InvalidInput, match="independent"):
        exact_shells(platform).section([0, 0, 0], [[1, 0, 0], [2, 0, 0]])
    with pytest.raises(InvalidDesign, match="SPS"):
        exact_shells(gsp.catalogue.design("toz-kucuk-2016-d3-6"))
    with pytest.raises(InvalidInput, match="strokes alone"):
        exact_shells(platform, limits=Limits(leg_radius=1.0))
    with pytest.raises(InvalidInput, match="least < greatest"):
        exact_shells(platform, limits=Limits(strokes=[[9.0, 9.0]] * 6))


def ring(radius, half_angle, turned=0.0):
    """Six points in three pairs on a circle."""
    angle = np.deg2rad([k * 120.0 + s * half_angle + turned for k in range(3) for s in (-1, 1)])
    return np.stack((radius * np.cos(angle), radius * np.sin(angle), 0.0 * angle), axis=1)


def symmetric(name):
    """Centres of shells that symmetric hexapods have; many spheres or circles coincide."""
    return {
        "three pairs": np.repeat(ring(1.0, 0.0)[::2], 2, axis=0),
        "all the same": np.tile([0.1, -0.2, 0.3], (6, 1)),
        "two threes": np.repeat([[0.0, 0.0, 0.0], [0.3, 0.0, 0.1]], 3, axis=0),
        "regular": ring(0.5, 8.0) - ring(0.3, 8.0, 60.0),
        "parallel pairs": ring(0.5, 8.0) - ring(0.3, 13.43, 0.0),
        "hexagon": ring(0.4, 30.0),
        "collinear": np.outer(np.arange(6) - 2.5, [0.1, 0.0, 0.0]),
        "on a vertical line": np.outer(np.arange(6) - 2.5, [0.0, 0.0, 0.1]),
    }[name]


SYMMETRIC = (
    "three pairs", "all the same", "two threes", "regular", "parallel pairs", "hexagon",
    "collinear", "on a vertical line",
)  # fmt: skip


def random_volume(shells, number, seed):
    """Volume by random points, and its standard error, from distances alone."""
    rng = np.random.default_rng(seed)
    low = (shells.centers - shells.high[:, None]).max(axis=0)
    high = (shells.centers + shells.high[:, None]).min(axis=0)
    if (low >= high).any():
        return 0.0, 0.0
    points = rng.uniform(low, high, (number, 3))
    gap = np.linalg.norm(points[:, None] - shells.centers, axis=-1)
    share = ((gap >= shells.low) & (gap <= shells.high)).all(axis=1).mean()
    box = np.prod(high - low)
    return box * share, box * np.sqrt(max(share * (1.0 - share), 1e-9) / number)


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize("radii", [(0.5, 0.9), (0.7, 0.75), (0.0, 0.6)])
def test_symmetric_shells_against_random_points(name, radii):
    centres = symmetric(name)
    shells = Shells(centres, np.full(6, radii[0]), np.full(6, radii[1]))
    volume = shells.volume()
    expected, spread = random_volume(shells, 60_000, 5)
    assert volume.value >= 0.0
    assert volume.error <= 1e-6
    assert abs(volume.value - expected) <= 4.5 * spread
    moved = Shells(centres @ rotation_from_angles([0.7, 0.2, -0.4]).T, shells.low, shells.high)
    assert moved.volume().value == pytest.approx(volume.value, rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("name", ["three pairs", "regular", "all the same"])
def test_shells_that_are_nearly_the_same(name):
    """A displacement changes the volume by no more than the surface allows."""
    centres, rng = symmetric(name), np.random.default_rng(8)
    way = rng.normal(size=(6, 3))
    volume = Shells(centres, np.full(6, 0.5), np.full(6, 0.9)).volume().value
    surface = 4.0 * np.pi * (0.5**2 + 0.9**2) * 6
    for exponent in range(-15, -3, 3 - campaign.count(1, 2)):  # each second one in the short form
        step = 10.0**exponent
        near = Shells(centres + step * way, np.full(6, 0.5), np.full(6, 0.9)).volume().value
        assert abs(near - volume) <= 3.0 * surface * step + 2e-7


@pytest.mark.parametrize("name", SYMMETRIC)
def test_sections_of_symmetric_shells(name):
    """Areas are those of a grid of points, outlines close, and turning by 120° changes nothing."""
    shells = Shells(symmetric(name), np.full(6, 0.5), np.full(6, 0.9))
    x = (np.arange(400) + 0.5) / 400 * 3.6 - 1.8
    flat = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1)
    for theta in (0.0, 60.0, 90.0, 17.0):
        across = [np.cos(np.deg2rad(theta)), np.sin(np.deg2rad(theta)), 0.0]
        plane = np.array([across, [0.0, 0.0, 1.0]])
        area = shells.section_area([0.0, 0.0, 0.0], plane)
        share = shells.contains(flat @ plane).mean()
        assert area >= 0.0
        assert area == pytest.approx(share * 3.6**2, abs=0.03)
        ends = [end for a in shells.section(np.zeros(3), plane) for end in (a.first, a.last)]
        for end in ends:
            assert sum(np.linalg.norm(end - other) < 1e-8 for other in ends) % 2 == 0
        if name in ("three pairs", "regular", "parallel pairs", "hexagon"):
            turn = rotation_from_angles([0.0, 0.0, 120.0], degrees=True)
            again = shells.section_area([0.0, 0.0, 0.0], plane @ turn.T)
            assert again == pytest.approx(area, rel=1e-9)


def test_labels_of_coincident_spheres_name_all_legs():
    shells = Shells(symmetric("three pairs"), np.full(6, 0.5), np.full(6, 1.1))
    assert {vertex.label for vertex in shells.vertices()} >= {"1 1 1 1 1 1"}
    for found in (*shells.vertices(), *shells.edges()):
        marks = found.label.split()
        assert marks[0::2] == marks[1::2]
