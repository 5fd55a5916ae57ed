"""Surfaces of regions in space: closed, with the volume of what is proven, and feasible inside."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

import gsp
from gsp.workspace.sets.shapes import files
from gsp.workspace.sets.surfaces import meshes
from gsp.workspace.sets.surfaces.manifold import manifold, united
from tests import campaign

TURNS = gsp.PoseBox([0, 0, 0], [(-8, 8)] * 3, degrees=True)
RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])


def random_design(seed, unit):
    rng = np.random.default_rng(seed)
    base, platform = (
        size * np.column_stack((rng.normal(size=(6, 2)), 0.3 * rng.normal(size=6)))
        for size in (1.0, 0.6)
    )
    lengths = np.linalg.norm([0.0, 0.0, 2.0] + platform - base, axis=1)
    strokes = np.column_stack((0.7 * lengths, 1.25 * lengths))
    return gsp.Design(["D1"] * 6, base, platform, strokes=strokes).scaled(unit)


def far(design):
    return design.replace(base_points=design.base_points + [300.0, -200.0, 500.0])


DESIGNS = {
    "6-3": lambda: gsp.catalogue.design("workspace-6-3"),
    # A shell, with a hole.
    "shell": lambda: gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6),
    "micro": lambda: random_design(1, 1e-6),
    "mega": lambda: random_design(2, 1e6),
    "far": lambda: far(random_design(3, 1.0)),
}
QUESTIONS = {
    "one": lambda d: gsp.workspace.fixed_orientation(d, budget=100_000),
    "cut": lambda d: gsp.workspace.fixed_orientation(
        d, half_space=[0.1, 0.2, 1.0, np.array([0.1, 0.2, 1.0]) @ d.base_points[0]], budget=100_000
    ),
    "all": lambda d: gsp.workspace.dextrous(d, TURNS, budget=200_000),
    "some": lambda d: gsp.workspace.reachable(d, rotations=TURNS, budget=100_000),
}


@cache
def region_of(design, question):
    return QUESTIONS[question](DESIGNS[design]())


def enclosed(vertices, faces):
    """Volume within triangles, by the divergence theorem."""
    a, b, c = np.moveaxis((vertices - vertices.mean(axis=0))[faces], 1, 0)
    return np.einsum("ni,ni->", a, np.cross(b, c)) / 6.0


def turns_around(points, corners):
    """How often triangles (n, 3, 3) enclose points: their solid angles, by 4π."""
    total = np.zeros(len(points))
    for i, point in enumerate(points):
        a, b, c = np.moveaxis(corners - point, 1, 0)
        x, y, z = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        above = np.einsum("ni,ni->n", a, np.cross(b, c))
        dots = [np.einsum("ni,ni->n", *pair) for pair in ((b, c), (c, a), (a, b))]
        below = x * y * z + dots[0] * x + dots[1] * y + dots[2] * z
        total[i] = 2.0 * np.arctan2(above, below).sum() / (4.0 * np.pi)
    return total


def assert_closed(vertices, faces):
    """Each edge has two triangles, of opposite directions."""
    edges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    assert (edges[:, 0] != edges[:, 1]).all()
    _, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    assert (count == 2).all()
    assert len(np.unique(edges, axis=0)) == len(edges)
    assert np.isfinite(vertices).all()


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("design", DESIGNS)
def test_surfaces_enclose_the_volume_that_is_proven(design, question):
    region = region_of(design, question)
    least, most = region.volume
    assert least > 0.0
    assert (np.isfinite(region.cuts[:, 7])).any()
    mesh = region.mesh()
    assert_closed(mesh.vertices, mesh.faces)
    assert mesh.is_watertight
    volume = enclosed(mesh.vertices, mesh.faces)
    assert mesh.volume == pytest.approx(volume, rel=1e-6)
    # Shares of cells are rounded down by 1e-9, those with planes nearly along an axis by more.
    assert least * (1.0 - 1e-9) <= volume <= least * (1.0 + 1e-4)
    assert volume < most


@pytest.mark.parametrize("question", ["one", "all"])
@pytest.mark.parametrize("design", DESIGNS)
def test_points_within_a_surface_are_feasible(design, question):
    """Legs by their closed form, for the one orientation or those at corners and in the range."""
    region, mechanism = region_of(design, question), DESIGNS[design]()
    mesh, rng = region.mesh(), np.random.default_rng(0)
    # Behind faces, just so and farther.
    corners = mesh.vertices[mesh.faces]
    some = rng.choice(len(corners), 120)
    depth = rng.choice([1e-7, 0.02, 0.2], 120) * np.ptp(mesh.vertices, axis=0).min()
    points = corners[some].mean(axis=1) - depth[:, None] * mesh.face_normals[some]
    around = turns_around(points, corners)
    assert np.abs(around - np.rint(around)).max() < 1e-6
    assert set(np.rint(around)) <= {0.0, 1.0}
    within = np.rint(around) == 1.0
    assert within.sum() > 50
    angles = np.zeros((1, 3))
    if question == "all":
        limit = np.deg2rad(8.0)
        corners = np.array(np.meshgrid(*[(-limit, limit)] * 3)).reshape(3, -1).T
        angles = np.concatenate((corners, rng.uniform(-limit, limit, (100, 3))))
    arms = gsp.geometry.rotation_from_angles(angles) @ mechanism.platform_points.T
    legs = points[within][:, None, None] + np.moveaxis(arms, 1, 2) - mechanism.base_points
    lengths = np.linalg.norm(legs, axis=-1)
    least, most = np.array(mechanism.strokes).T
    slack = 1e-9 * np.abs(mechanism.base_points).max()
    assert (lengths >= least - slack).all()
    assert (lengths <= most + slack).all()


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb"])
@pytest.mark.parametrize("design", ["6-3", "mega"])
def test_surfaces_in_files_are_closed_for_programs_that_unite_vertices(tmp_path, design, suffix):
    region = region_of(design, "one")
    region.write(tmp_path / f"a.{suffix}")
    found = trimesh.load(tmp_path / f"a.{suffix}", force="mesh")
    assert found.is_watertight
    assert found.is_winding_consistent
    assert found.volume == pytest.approx(region.volume[0], rel=1e-4)


@pytest.mark.parametrize("suffix", ["obj", "ply"])
def test_files_of_double_precision_keep_all_digits_of_small_coordinates(tmp_path, suffix):
    region = region_of("micro", "one")
    region.write(tmp_path / f"a.{suffix}")
    found = trimesh.load(tmp_path / f"a.{suffix}", force="mesh", process=False)
    mesh = meshes.mesh(region, gap=files.EDGE_GAP)
    assert_closed(found.vertices, found.faces)
    size = np.abs(mesh.vertices).max()
    order = [np.lexsort(np.round(x.vertices / size, 12).T) for x in (found, mesh)]
    apart = found.vertices[order[0]] - mesh.vertices[order[1]]
    assert np.abs(apart).max() <= 1e-15 * size


@pytest.mark.parametrize("seed", range(campaign.count(10, 300)))
def test_any_parts_of_cells_have_a_closed_surface_of_their_volume(seed):
    """Cells of several sizes, half of them with planes, many of which pass corners and edges."""
    rng = np.random.default_rng(seed)
    low, high = [np.zeros(3)], [np.array([4.0, 2.0, 8.0])]
    for _ in range(60):
        i = rng.integers(len(low))
        k = int(np.argmax(high[i] - low[i]))
        middle = 0.5 * (low[i] + high[i])
        low.append(np.where(np.arange(3) == k, middle, low[i]))
        high.append(high[i])
        high[i] = np.where(np.arange(3) == k, middle, high[i])
    low, high = np.array(low), np.array(high)
    some = rng.random(len(low)) < 0.7
    low, high = low[some], high[some]
    whole = rng.random(len(low)) < 0.5
    cuts = np.zeros((len(low), 8))
    cuts[:, 3], cuts[:, 7] = -np.inf, np.inf
    normal = rng.integers(-2, 3, (len(low), 3)).astype(float)
    normal[rng.random(len(low)) < 0.5] += rng.normal(size=3)
    # Through a corner, the middle, or anywhere.
    place = rng.choice([-0.5, 0.0, 0.5], (len(low), 3)) + 0.3 * (rng.random((len(low), 1)) < 0.3)
    cuts[~whole, 4:7] = normal[~whole]
    cuts[~whole, 7] = (normal * place * (high - low)).sum(axis=1)[~whole]
    region = SimpleNamespace(
        low=low, high=high, cuts=cuts, codes=whole.astype(np.int8),
        domain=np.array([[0.0, 0.0, 0.0], [4.0, 2.0, 8.0]]),
    )  # fmt: skip
    mesh = meshes.mesh(region)
    assert_closed(mesh.vertices, mesh.faces)
    # By counting: points in cells, on the inside of their planes.
    points = rng.random((400, 3)) * region.domain[1]
    cell = (points[:, None] >= low) & (points[:, None] <= high)
    delta = points[:, None] - 0.5 * (low + high)
    inside = (delta * cuts[:, 4:7]).sum(axis=-1) >= np.where(whole, -np.inf, cuts[:, 7])
    wanted = (cell.all(axis=-1) & inside).any(axis=1)
    around = turns_around(points, mesh.vertices[mesh.faces])
    np.testing.assert_allclose(around, wanted, atol=1e-6)


def test_a_volume_in_parts_of_cells_has_a_surface():
    region = region_of("6-3", "one")
    some = region.codes == 0
    parts = {name: getattr(region, name)[some] for name in ("low", "high", "codes", "cuts")}
    region = replace(region, **parts)
    assert region.mesh().volume == pytest.approx(region.volume[0], rel=1e-6)


def test_pairs_at_an_edge_are_those_with_the_solid_between_them():
    """Two tetrahedra with one edge: where it is divided, each has a vertex of its own."""
    points = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 1, 0], [-1, 0, 0], [-1, -1, 0]], float)
    one = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    both = np.concatenate((one, np.where(one > 1, one + 2, one)))
    vertices, faces = manifold(points, both, 0.1)
    assert_closed(vertices, faces)
    assert enclosed(vertices, faces) == pytest.approx(1.0 / 3.0, rel=0.1)
    middles = vertices[6:]
    assert len(middles) == 2
    assert middles[0] @ middles[1] < 0.3  # on opposite sides of the edge
    assert len(trimesh.Trimesh(*manifold(points, both), process=False).split()) == 2


def test_vertices_that_are_near_are_one_and_thin_triangles_vanish():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1e-12, 0, 0]], float)
    # A tetrahedron, one corner of which is an edge of no length.
    faces = np.array([[0, 2, 1], [0, 1, 3], [4, 3, 2], [1, 2, 3], [0, 3, 4], [0, 4, 2]])
    vertices, left = united(points, faces, 1e-9)
    assert len(vertices) == 4
    assert len(left) == 4
    assert_closed(vertices, left)
    assert enclosed(vertices, left) == pytest.approx(1.0 / 6.0, rel=1e-9)
