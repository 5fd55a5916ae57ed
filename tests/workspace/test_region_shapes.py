"""Outlines, surfaces, files and inscribed bodies of regions, against closed forms."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from types import SimpleNamespace
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
import shapely
import trimesh

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput, UnwritableOutput
from gsp.figures import name_lengths, new_axes
from gsp.model.units import METRES_PER_UNIT
from gsp.workspace.sets.shapes import files, inscribed
from gsp.workspace.sets.shapes.clipped import corners_beyond
from gsp.workspace.sets.shapes.drawing import _even, _outlined, _proven
from gsp.workspace.sets.shapes.polygons import Polygons
from gsp.workspace.sets.surfaces import meshes
from gsp.workspace.sets.tree.cuts import boxes_beyond, no_cuts
from tests import campaign

RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])
SHELL = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6, unit="mm")
ABOVE = gsp.Limits(position=[None, None, (0.0, None)])
PLANE = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
EMPTY = gsp.workspace.fixed_orientation(SHELL, limits=gsp.Limits(position=[(3, 4), None, None]))


@cache
def flat():
    return gsp.workspace.fixed_orientation(SHELL, plane=PLANE, resolution=0.1)


@cache
def solid():
    return gsp.workspace.fixed_orientation(SHELL, limits=ABOVE, resolution=0.3)


def test_polygons_have_the_area_of_the_bracket_and_the_hole_of_the_shell():
    shape = flat().polygons()
    assert [shape.inside.area, shape.possible.area] == pytest.approx(flat().area, rel=1e-8)
    assert len(shape.inside.interiors) == len(shape.possible.interiors) == 1
    radii = np.hypot(*np.array(shape.inside.exterior.coords).T)
    assert radii.max() <= 2.0 + 1e-9
    assert radii.min() > 1.8
    radii = np.hypot(*np.array(shape.possible.interiors[0].coords).T)
    assert radii.max() <= 1.0 + 1e-9
    assert radii.min() > 0.8
    assert shape.possible.buffer(1e-9).contains(shape.inside)


def test_mesh_has_the_volume_of_what_is_proven_and_lies_in_the_shell():
    mesh = solid().mesh()
    assert mesh.volume == pytest.approx(solid().volume[0], rel=1e-8)
    radii = np.linalg.norm(mesh.vertices, axis=1)
    assert radii.min() >= 1.0 - 1e-9
    assert radii.max() <= 2.0 + 1e-9


def test_pictures_in_space_hold_all_that_is_proven_inside():
    pytest.importorskip("matplotlib")
    region = solid()
    ax = region.plot()
    radii = np.linalg.norm(np.concatenate([x.reshape(-1, 3) for x in _proven(region)]), axis=1)
    assert 1.0 - 1e-9 <= radii.min() < 1.1
    assert 1.99 < radii.max() <= 2.0 + 1e-9
    # The axes end where what is not proven outside does.
    assert np.abs(ax.get_xlim()) == pytest.approx(2.0, abs=0.1)


def signed_area(points):
    """Area within a closed line, positive if it runs counterclockwise."""
    x, y = points.T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


def test_drawings_hold_the_outlines_in_the_unit_of_the_design(tmp_path):
    flat().write(tmp_path / "a.dxf")
    document = ezdxf.readfile(tmp_path / "a.dxf")
    assert document.header["$INSUNITS"] == 4
    lines = {name: [] for name in ("INSIDE", "POSSIBLE")}
    for line in document.modelspace():
        assert line.closed
        lines[line.dxf.layer].append(np.array(line.get_points("xy")))
    assert [len(rings) for rings in lines.values()] == [2, 2]
    # Outlines run counterclockwise and holes clockwise: signed areas add up to that of the region.
    signed = [[signed_area(points) for points in rings] for rings in lines.values()]
    assert [(max(areas) > 0.0, min(areas) < 0.0) for areas in signed] == [(True, True)] * 2
    assert [sum(areas) for areas in signed] == pytest.approx(flat().area, rel=1e-8)
    assert np.abs(np.concatenate(lines["INSIDE"])).max() == pytest.approx(2.0, abs=0.1)
    flat().write(tmp_path / "a.svg")
    root = ElementTree.parse(tmp_path / "a.svg").getroot()
    assert [p.get("id") for p in root.findall("{*}path")] == ["possible", "inside"]
    left, top, width, height = map(float, root.get("viewBox").split())
    assert left < -2.0
    assert top < -2.0
    assert left + width > 2.0
    assert top + height > 2.0


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb"])
def test_surfaces_are_read_back(tmp_path, suffix):
    solid().write(tmp_path / f"a.{suffix}")
    found = trimesh.load(tmp_path / f"a.{suffix}", force="mesh")
    # A .glb file is in metres, with the second coordinate upward.
    unit, axes = (1e-3, [0, 2, 1]) if suffix == "glb" else (1.0, [0, 1, 2])
    whole = solid().mesh()
    assert found.volume == pytest.approx(unit**3 * whole.volume, rel=1e-5)
    low, high = unit * whole.bounds[:, axes]
    if suffix == "glb":
        low[2], high[2] = -high[2], -low[2]
    np.testing.assert_allclose(found.bounds, [low, high], rtol=1e-5)
    with pytest.raises(UnwritableOutput, match="exists already"):
        solid().write(tmp_path / f"a.{suffix}")
    solid().write(tmp_path / f"a.{suffix}", overwrite=True)


def test_codes_of_dxf_files_are_those_of_the_units():
    units = ezdxf.units
    assert set(files.DXF_UNITS) == set(METRES_PER_UNIT)
    for name, code in files.DXF_UNITS.items():
        factor = units.conversion_factor(units.InsertUnits(code), units.M)
        # There an inch is 1 / 39.37007874 m.
        assert factor == pytest.approx(METRES_PER_UNIT[name], rel=1e-10)


def test_cells_are_written_as_a_table(tmp_path):
    solid().write(tmp_path / "a.csv")
    assert len((tmp_path / "a.csv").read_text().splitlines()) == len(solid().codes) + 1


@pytest.mark.parametrize(("region", "name"), [(flat, "a.stl"), (solid, "a.svg"), (solid, "a.txt")])
def test_files_of_other_kinds_are_refused(tmp_path, region, name):
    with pytest.raises(UnwritableOutput):
        region().write(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_an_empty_region_has_no_shape(tmp_path):
    with pytest.raises(EmptyWorkspace, match="a region with a cell or more"):
        EMPTY.write(tmp_path / "a.stl")
    with pytest.raises(EmptyWorkspace):
        EMPTY.largest()
    with pytest.raises(EmptyWorkspace):
        EMPTY.poses(3)


def test_a_picture_of_undecided_cells_only_states_it():
    design = gsp.catalogue.design("workspace-6-3")
    region = gsp.workspace.orientations(design, [0.0, 0.0, 8.0], resolution=2.0)
    assert region.volume[0] == 0.0 < region.volume[1]
    ax = region.plot()
    assert [text.get_text() for text in ax.texts] == ["nothing is proven inside"]


def test_only_holes_with_a_proven_part_outside_are_outlined():
    square = shapely.box(0, 0, 4, 4)
    hole, gap = shapely.box(1, 1, 2, 2), shapely.box(3, 3, 3.5, 3.5)
    inside = square.difference(hole).difference(gap)
    drawn = _outlined(Polygons(inside=inside, possible=square.difference(hole.buffer(-0.1))))
    assert drawn.equals(square.difference(hole))
    # Cells that share a corner have it to rounding only.
    slit = gap.buffer(-1e-11)
    drawn = _outlined(
        Polygons(inside=square.difference(gap), possible=square.difference(gap).union(slit))
    )
    assert drawn.equals(square)


def test_undecided_bays_that_are_narrower_than_the_outline_are_not_outlined():
    square, hole = shapely.box(0, 0, 4, 4), shapely.box(1, 1, 2, 2)
    narrow, wide = shapely.box(3.0, 2.0, 3.02, 4.0), shapely.box(2.0, 3.0, 2.5, 4.0)
    inside = square.difference(hole).difference(narrow).difference(wide)
    drawn = _outlined(Polygons(inside=inside, possible=square.difference(hole)))
    assert drawn.symmetric_difference(square.difference(hole).difference(wide)).area < 1e-3
    assert len(drawn.geoms) == 1
    assert len(drawn.geoms[0].interiors) == 1
    # A gap that is proven outside stays.
    drawn = _outlined(Polygons(inside=inside, possible=inside))
    assert drawn.equals(inside)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_numbers_of_axes_in_space_are_clear_of_the_marks_of_their_axis(size):
    from mpl_toolkits.mplot3d.proj3d import proj_transform

    region = gsp.workspace.fixed_orientation(SHELL.scaled(size), resolution=0.5 * size)
    ax = region.plot()
    ax.figure.canvas.draw()
    (low, high), axis = ax.get_zlim(), ax.zaxis
    shown = [
        t for t in axis.get_major_ticks() if low <= t.get_loc() <= high and t.label1.get_text()
    ]
    # The axis of z is the edge with the greatest x and y.
    for tick in shown:
        place = (ax.get_xlim()[1], ax.get_ylim()[1], tick.get_loc())
        mark = ax.transData.transform(proj_transform(*place, ax.get_proj())[:2])
        assert tick.label1.get_window_extent().x0 > mark[0]
    assert len(shown) >= 2


def test_undecided_parts_are_filled_as_hatches_are_coarser_than_some():
    looks = {patch.get_label(): patch for patch in flat().plot().patches}
    assert looks["undecided"].get_facecolor()[:3] not in ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    assert looks["undecided"].get_facecolor()[3] == 1.0


def test_a_plane_is_drawn_with_what_its_coordinates_count_from():
    away = ([0.0, 0.0, 1.25], PLANE[1])
    ax = gsp.workspace.fixed_orientation(SHELL, plane=away, resolution=1.0).plot()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [mm]", "z − 1.25 [mm]")


def test_a_search_of_bodies_that_ends_early_states_it(monkeypatch):
    done = flat().largest("ball")
    monkeypatch.setattr(inscribed, "MOST_CENTRES", 1)
    found = flat().largest("ball", tolerance=1e-6)
    assert not found.reached
    assert found.factor <= done.above
    assert found.above >= done.factor
    assert found.gap > 1e-6


# Half of a shell of radii 1 and 2: bodies above the inner sphere that touch the outer one.
@pytest.mark.parametrize(
    ("body", "size"),
    [
        ("ball", 0.5),
        ("cylinder", (np.sqrt(76.0) - 4.0) / 10.0),
        ("box", (np.sqrt(88.0) - 4.0) / 12.0),
    ],
)
def test_largest_bodies_of_half_a_shell(body, size):
    found = solid().largest(body)
    assert found.factor <= size <= found.above
    assert found.reached
    assert found.gap == pytest.approx((found.above - found.factor) / found.factor)
    assert found.above - found.factor < 0.35 * size
    rng = np.random.default_rng(0)
    points = rng.uniform(-1.0, 1.0, (2000, 3))
    if body == "ball":
        points /= np.linalg.norm(points, axis=1)[:, None]
    elif body == "cylinder":
        points[:, :2] /= np.maximum(1.0, np.linalg.norm(points[:, :2], axis=1))[:, None]
    radii = np.linalg.norm(found.centre + points * found.half_widths, axis=1)
    assert radii.min() >= 1.0
    assert radii.max() <= 2.0


@pytest.mark.parametrize("body", inscribed.GAUGES)
def test_sizes_of_bodies_are_bounded_by_what_all_obstacles_leave(body):
    """Against the distances to all of the boxes, and to the sides of planes in them."""
    rng, gauge = np.random.default_rng(1), inscribed.GAUGES[body]
    middle, half = rng.uniform(-2.0, 2.0, (150, 3)), rng.choice([0.05, 0.1, 0.2], (150, 1))
    half = np.tile(half, 3)
    planes = np.concatenate((rng.normal(size=(150, 3)), 0.1 * rng.normal(size=(150, 1))), axis=1)
    planes[::2] = inscribed.NO_PLANE
    points = rng.uniform(-2.0, 2.0, (300, 3))
    delta = points[:, None] - middle
    gap = gauge.size(np.maximum(np.abs(delta) - half, 0.0))
    beyond = (delta * planes[:, :3]).sum(axis=-1) - planes[:, 3]
    with np.errstate(divide="ignore"):
        exact = np.fmax(gap, beyond / gauge.dual(np.abs(planes[:, :3]))).min(axis=1)
    there = inscribed._obstacles(middle - half, middle + half, planes)
    assert len(there.groups) == 3
    least, most = inscribed._sizes(points, there, gauge)
    close = 1e-12
    assert (least <= exact + close).all()
    assert (exact <= most + close).all()
    assert (exact <= inscribed._most(points, there, gauge) + close).all()
    assert np.mean(most - least < close) > 0.5


def test_few_of_the_cells_are_looked_at_for_the_largest_disc(monkeypatch):
    region = gsp.workspace.fixed_orientation(SHELL, limits=ABOVE, plane=PLANE, resolution=0.01)
    sizes, counts = inscribed._sizes, []
    monkeypatch.setattr(
        inscribed, "_sizes", lambda p, *others: (counts.append(len(p)), sizes(p, *others))[1]
    )
    found = region.largest("ball", tolerance=0.5)
    assert sum(counts) < len(region.low)
    assert found.factor <= 0.5 <= found.above


def test_largest_disc_and_rectangle_in_a_plane():
    disc = flat().largest("ball")
    assert disc.factor <= 0.5 <= disc.above
    assert disc.centre.shape == (3,)
    assert disc.centre[1] == 0.0
    # 2 a wide and a high, above the inner circle: (2 a)² + (1 + 2 · a)² = 4.
    wide = flat().largest("box", [2.0, 1.0])
    size = (np.sqrt(16.0 + 96.0) - 4.0) / 16.0
    assert wide.factor <= size <= wide.above


@pytest.mark.parametrize(
    "arguments",
    [
        ("sphere",),
        (None,),
        ("ball", [1, 1, 2]),
        ("cylinder", [1, 2, 3]),
        ("box", [1, 1]),
        ("box", [1, 1, 0]),
        ("box", [1, 1, np.nan]),
        ("ball", None, 0.0),
    ],
)
def test_nonsense_about_bodies_is_refused(arguments):
    with pytest.raises(InvalidInput):
        solid().largest(*arguments)


def test_a_cylinder_has_no_place_in_a_plane():
    with pytest.raises(InvalidInput, match="in a plane"):
        flat().largest("cylinder")


@pytest.mark.parametrize("unit", [1e-12, 1e9, 1e-7][: campaign.count(2, 3)])
def test_surfaces_do_not_depend_on_the_unit(tmp_path, unit):
    design = gsp.Design(["D1"] * 6, unit * RING, unit * RING, strokes=[(unit, 2.0 * unit)] * 6)
    limits = gsp.Limits(position=[None, None, (0.0, None)])
    region = gsp.workspace.fixed_orientation(design, limits=limits, resolution=0.4 * unit)
    inside = region.volume[0]
    mesh = region.mesh()
    assert len(mesh.vertices) > 50
    parts = mesh.triangles / unit
    volume = np.einsum("ni,ni->n", parts[:, 0], np.cross(parts[:, 1], parts[:, 2])).sum() / 6.0
    assert volume == pytest.approx(inside / unit**3, rel=1e-8)
    region.write(tmp_path / "a.obj")
    lines = (tmp_path / "a.obj").read_text().splitlines()
    points = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], dtype=float)
    assert np.abs(points - mesh.vertices).max() < 1e-7 * unit


def cells_of(grid, step):
    low = np.argwhere(grid) * step
    domain = np.stack((np.zeros(3), 8 * step))
    codes, cuts = np.ones(len(low), dtype=np.int8), no_cuts(len(low))
    return SimpleNamespace(low=low, high=low + step, codes=codes, cuts=cuts, domain=domain)


@pytest.mark.parametrize("unit", [1.0, 1e-9])
@pytest.mark.parametrize("seed", range(6))
def test_meshes_are_closed_where_cells_meet_in_edges_and_corners(seed, unit):
    grid = np.random.default_rng(seed).random((4, 5, 3)) < 0.5
    step = unit * np.array([1.0, 0.5, 2.0])
    found = meshes.mesh(cells_of(grid, step))
    assert found.is_winding_consistent
    directed = found.edges
    pairs, count = np.unique(np.sort(directed, axis=1), axis=0, return_counts=True)
    assert (count == 2).all()
    assert len(pairs) > 100
    assert len(np.unique(directed, axis=0)) == len(directed)
    assert found.volume == pytest.approx(grid.sum() * step.prod(), rel=1e-12)
    sides = found.triangles / step
    assert (np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
            > 0.2).all()  # fmt: skip


@pytest.mark.parametrize("seed", range(3))
def test_files_keep_cells_apart_that_meet_in_an_edge(tmp_path, seed):
    """As read by programs that unite equal vertices, in single precision."""
    grid = np.random.default_rng(seed).random((4, 5, 3)) < 0.5
    step = np.array([1.0, 0.5, 2.0])
    found = meshes.mesh(cells_of(grid, step), gap=files.EDGE_GAP)
    found.apply_translation([50.0, -30.0, 80.0])
    found.export(tmp_path / "a.stl")
    read = trimesh.load(tmp_path / "a.stl")
    assert len(read.vertices) < len(found.triangles) * 3
    assert read.is_watertight
    assert read.is_winding_consistent
    volume = grid.sum() * step.prod()
    assert 0.999 * volume < read.volume < volume
    meshes.mesh(cells_of(grid, step)).export(tmp_path / "b.stl")
    assert not trimesh.load(tmp_path / "b.stl").is_watertight


def test_cells_that_form_a_ring_around_a_shared_edge_have_a_closed_mesh():
    """The two cells at the edge are joined by others at both of its ends."""
    grid = np.ones((2, 2, 3), dtype=bool)
    grid[0, 1, 1] = grid[1, 0, 1] = False
    found = meshes.mesh(cells_of(grid, np.ones(3)))
    assert found.is_watertight
    assert found.volume == pytest.approx(10.0)


def test_parts_of_cells_alone_have_no_worst_index():
    region = replace(solid(), **{name: getattr(solid(), name)[solid().codes == 0] for name in
                               ("low", "high", "codes", "cuts")})  # fmt: skip
    assert region.volume[0] > 0.0
    with pytest.raises(EmptyWorkspace, match="a whole cell that is proven inside"):
        region.worst("CTN")


@pytest.mark.parametrize("tolerance", [1e-300, 1e308])
def test_tolerances_at_the_ends_of_the_range_of_numbers_are_no_warnings(tolerance):
    design = gsp.catalogue.design("workspace-6-3")
    region = gsp.workspace.fixed_orientation(design, resolution=4.0)
    found = region.largest("ball", tolerance=tolerance)
    assert 0.0 < found.factor <= found.above < np.inf


def test_faces_of_unlike_lengths_are_drawn_without_memory_that_is_not_initialised():
    """Repeated vertices change neither the faces nor the three by which they are shaded."""
    region = gsp.workspace.fixed_orientation(SHELL, resolution=0.6)
    faces = _proven(region)
    assert len({some.shape[1] for some in faces}) > 1
    even = _even(faces)
    k = even.shape[1]
    for face, same in zip([face for some in faces for face in some], even, strict=True):
        np.testing.assert_array_equal(np.unique(same, axis=0), np.unique(face, axis=0))
        kept = np.r_[True, (np.diff(same, axis=0) != 0.0).any(axis=1)]
        np.testing.assert_array_equal(
            same[kept], face[np.r_[True, (np.diff(face, axis=0) != 0.0).any(axis=1)]]
        )
        assert len(np.unique(same[[0, k // 3, 2 * k // 3]], axis=0)) > 1
    drawn = region.plot().collections[0]._faces
    assert np.asarray(drawn).shape == even.shape
    np.testing.assert_array_equal(np.asarray(drawn), even)


def test_long_numbers_on_the_axes_of_a_plane_are_written_as_powers():
    wide = SHELL.scaled(2.5e5)
    plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    ax = gsp.workspace.fixed_orientation(wide, plane=plane, resolution=2e5).plot()
    ax.figure.canvas.draw()
    shown = [text for text in ax.get_xticklabels() if text.get_text()]
    boxes = [text.get_window_extent() for text in shown]
    assert all(one.x1 < two.x0 for one, two in pairwise(boxes))
    assert ax.xaxis.get_offset_text().get_text() == ""
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [10³ mm]", "z [10³ mm]")


@pytest.mark.parametrize("space", [False, True])
@pytest.mark.parametrize(
    ("ends", "labels", "numbers"),
    [
        ((-4.0, 8.0), ("x [mm]", "y [mm]"), ["−4", "0", "8"]),
        ((-4e6, 8e6), ("x [10⁶ mm]", "y [10⁶ mm]"), ["−4", "0", "8"]),
        ((-4e-6, 8e-6), ("x [10⁻⁶ mm]", "y [10⁻⁶ mm]"), ["−4", "0", "8"]),
        ((1e5 - 4.0, 1e5 + 8.0), ("x − 100000 [mm]", "y [mm]"), ["−4", "0", "8"]),
        ((-1e5 - 4.5, -1e5 + 7.5), ("x + 100000 [mm]", "y [mm]"), ["−4.5", "0", "7.5"]),
        ((-4e-7, 8e6), ("x [10⁶ mm]", "y [10⁶ mm]"), ["0", "0", "8"]),
    ],
)
def test_axes_have_one_power_of_ten_and_plain_numbers(space, ends, labels, numbers):
    ax = new_axes(projection="3d") if space else new_axes()
    ax.set_xlim(*ends)
    ax.set_ylim(0.0, 0.5 * (ends[1] - ends[0]))
    name_lengths(ax, {"x": "x", "y": "y"}, "mm")
    assert (ax.get_xlabel(), ax.get_ylabel()) == labels
    written = ax.xaxis.get_major_formatter()
    middle = {"−": -1e5, "+": 1e5}.get(labels[0][2], 0.0)
    assert [written(x) for x in (ends[0], -middle, ends[1])] == numbers
    ax.figure.canvas.draw()
    assert ax.xaxis.get_offset_text().get_text() == ""


def test_the_bound_of_the_largest_ball_has_no_more_volume_than_the_region():
    """Large undecided cells are outside but for a small part, where the centre may be."""
    turns = gsp.PoseBox([0, 0, 0], [(-20, 20)] * 3, degrees=True)
    design = gsp.catalogue.design("workspace-6-3")
    region = gsp.workspace.dextrous(design, turns, budget=300_000, progress=False)
    cells = region.high - region.low
    assert cells.max() > 4.0
    found = region.largest("ball", tolerance=0.1)
    assert found.factor < found.above
    # Above the base and below it there is one each.
    assert 2.0 * 4.0 / 3.0 * np.pi * found.above**3 < region.volume[1]


@pytest.mark.parametrize("d", [2, 3])
def test_boxes_of_parts_beyond_planes_are_those_of_their_corners(d):
    rng = np.random.default_rng(d)
    for _ in range(200):
        low = rng.normal(size=(1, d))
        high = low + rng.uniform(0.1, 2.0, (1, d))
        plane = np.zeros((1, 4))
        plane[0, :d] = rng.normal(size=d) * (rng.random(d) < 0.8)
        # The plane is a point of the box away from the middle.
        plane[0, 3] = plane[0, :d] @ (0.5 * rng.uniform(-1.0, 1.0, d) * (high - low)[0])
        flat = [(0, 0), (0, 3 - d)]
        corners = corners_beyond(np.pad(low, flat), np.pad(high, flat), plane)[:, :d]
        if not plane[0, :d].any():
            continue
        first, last = boxes_beyond(low, high, plane)
        assert first[0] == pytest.approx(corners.min(axis=0), abs=1e-10)
        assert last[0] == pytest.approx(corners.max(axis=0), abs=1e-10)
        assert (first <= corners).all()
        assert (last >= corners).all()


def test_boxes_without_a_plane_are_whole_and_without_a_part_empty():
    low, high = np.zeros((3, 2)), np.ones((3, 2))
    planes = [[0.0, 0.0, 0.0, -np.inf], [0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 2.0]]
    first, last = boxes_beyond(low, high, np.array(planes))
    np.testing.assert_array_equal((last - first).min(axis=1), [1.0, 1.0, 0.0])
