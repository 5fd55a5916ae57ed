"""Random designs and limits through all functions of `gsp.workspace`: nothing but their results."""

from contextlib import suppress

import matplotlib.pyplot as plt
import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from tests.campaign import count
from tests.support import turn

RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])
KINDS = ("strokes", "cones", "clearance", "index", "walls")
SMALL = {"budget": 1500, "progress": False}


def designs(rng, n, first=0):
    """Designs of general and of symmetric geometry, with 6 to 8 legs of all kinds, and a home."""
    kinds = ("D1", "D1", "D1", "D2", "D3", "D4", "A1", "D1 D1")
    for k in range(n):
        style = (k + first) % 6
        if style == 0:
            legs, a, b = ["D1"] * 6, rng.normal(size=(6, 3)), rng.uniform(-0.7, 0.7, (6, 3))
        elif style == 1:  # symmetric: anchors in pairs
            design = gsp.hexapod(1.5, rng.uniform(0.1, 0.5), 0.8, rng.uniform(0.1, 0.5), 1.4)
            legs, a, b = ["D1"] * 6, design.base_points, design.platform_points
        elif style == 2:  # 6-3 and 3-3: coincident anchors
            b = np.repeat(0.7 * RING[::2], 2, axis=0)
            a = 1.6 * (RING if k % 2 else np.repeat(RING[1::2], 2, axis=0))
            legs, a = ["D1"] * 6, np.roll(a, -1, axis=0)
        elif style == 3:  # parallel legs
            legs, a = ["D1"] * 6, RING + 0.1 * rng.normal(size=(6, 3))
            b = a
        elif style == 4:
            legs = list(rng.choice(kinds[:7], 6))
            a, b = rng.uniform(-1, 1, (6, 3)), rng.uniform(-0.7, 0.7, (6, 3))
        else:
            m = int(rng.integers(7, 9))
            legs, a, b = ["D1"] * m, rng.normal(size=(m, 3)), rng.uniform(-0.7, 0.7, (m, 3))
        u, v = rng.standard_normal((2, len(legs), 3))
        unit = 10.0 ** rng.choice([-6, 0, 6])
        bare = gsp.Design(legs, unit * a, unit * b, u, v)
        home = gsp.Pose(unit * np.array([0.1, 0.0, 1.5]), turn(rng.uniform(-0.3, 0.3, 3)))
        joints = bare.at(home).joints
        wide = rng.choice([0.05, 0.3])
        strokes = np.stack((joints * (1 - wide), joints * (1 + wide)), axis=1)
        yield bare.replace(strokes=strokes, home=home, characteristic_length=unit), unit


def limits_of(kind, design, unit):
    near = [(x - 2 * unit, x + 2 * unit) for x in design.home.position]
    options = {
        "strokes": {},
        "cones": {"base_cone": 0.9, "platform_cone": 1.2},
        "clearance": {"leg_radius": 0.02 * unit},
        "index": {"indices": ["CDN_CL <= 50"], "length": unit},
        "walls": {"position": [None, None, (0.0, None)]},
    }[kind]
    options = {"position": near, **options}
    return gsp.Limits(strokes=design.strokes, **options)


def check(region):
    low, high = region.bracket
    assert 0.0 <= low <= high < np.inf
    assert not region.empty or high == 0.0
    estimate = region.estimate(20)
    assert low <= estimate.value * (1 + 1e-9)
    assert estimate.value <= high * (1 + 1e-9)
    assert 0.0 <= estimate.error < np.inf
    where = region.contains(np.zeros((2, 3)))
    assert set(where.tolist()) <= {-1, 0, 1}
    assert len(region.parts) == 0 if region.empty else len(region.parts) > 0
    assert len(region.to_dataframe()) == len(region.codes)


def regions_are_proper(kind, number, design, unit):
    """Call all questions for a design, and what their regions answer."""
    limits = limits_of(kind, design, unit)
    plane = (design.home.position, [[1.0, 0.2, 0.0], [0.0, 0.1, 1.0]])
    near = gsp.PoseBox.around(design.home, [0.0, 0.0, 0.0, 0.1, 0.1, 0.05])
    flat = {"plane": plane} if number % 2 else {}
    every = gsp.workspace.fixed_orientation(design, design.home.rotation, limits, **flat, **SMALL)
    check(every)
    home = gsp.feasible(design, design.home, limits).ok
    assert every.contains(design.home.position) >= 0 or not home
    whole = gsp.workspace.dextrous(design, near, limits, **flat, **SMALL)
    check(whole)
    some = gsp.workspace.reachable(design, limits, rotations=near, **flat, **SMALL)
    check(some)
    check(gsp.workspace.reachable(design, limits, **flat, **SMALL))
    turns = gsp.workspace.orientations(design, design.home.position, limits, **SMALL)
    check(turns)
    for region in (every, whole, some, turns):
        shapes_are_proper(region)
    if (every.codes == 1).any():
        body = every.largest("ball", tolerance=0.2)
        assert 0.0 < body.factor <= body.above
        worst = every.worst("CDN_CL", length=unit, budget=500)
        assert 1.0 <= worst.value <= worst.bound * (1 + 1e-9)
        for part in (*every.regular_parts(500), *some.regular_parts(500)):
            assert part.size > 0.0


def shapes_are_proper(region):
    """The outline of a plane, and the surface in space, have what is inside."""
    if region.kind == "plane":
        shape = region.polygons()
        low, high = region.area
        # The proven area leaves out a thousandth of cells with a cut that is nearly along an axis.
        slack = 1e-6 * high
        coarse = slack + 1e-3 * region.sizes[region.codes == 0].sum()
        assert low - slack <= shape.inside.area <= low + coarse
        assert high - coarse <= shape.possible.area <= high + slack
    else:
        mesh, whole = region.mesh(), region.codes == 1
        inside = (region.high - region.low)[whole].prod(axis=1).sum()
        assert mesh.is_watertight or not whole.any()
        signed = np.linalg.det(mesh.triangles).sum() / 6.0
        assert signed == pytest.approx(inside, rel=1e-6)
    if not region.empty:
        figure = region.plot().figure
        assert figure.axes[0].get_title()
        plt.close(figure)


def boundaries_are_proper(kind, design, unit):
    """Call what follows boundaries, for a design whose home pose is feasible."""
    limits = limits_of(kind, design, unit)
    origin, axes = design.home.position, np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    if not gsp.feasible(design, design.home, limits).ok:
        return
    # Curves of clearances and indices are followed by differences.
    slow = kind in ("clearance", "index")
    few = {"limits": limits, "starts": 1 if slow else 2, "progress": False}
    rays, most = (1, 1) if slow else (2, count(6, 20))
    section = gsp.workspace.section(design, origin, axes, rays=rays, most=most, **few)
    assert np.isfinite(section.table()[["x", "y", "z"]].to_numpy()).all()
    for curve in section.curves[:1]:
        away = axes @ (curve.pose.position[len(curve.pose.position) // 2] - origin)
        start = float(np.arctan2(away[1], away[0]))
        with suppress(InvalidInput):  # the ray need not meet a local maximum there
            chain = gsp.workspace.curve_chain(section, 0, start, start + 0.3)
            assert chain[0] == 0
            assert set(chain) <= set(range(len(section.curves)))
    for point in section.bifurcations[:2]:
        place = point.pose.position
        with suppress(InvalidInput):  # its label and y may be fewer than six equations
            same = gsp.workspace.bifurcation_point(
                design, point.label, point.pose, held={"y": place[1]}, limits=limits
            )
            assert np.abs(same.pose.position - place).max() <= 1e-6 * unit
    surface = gsp.workspace.surface(design, origin, counts=(2, 2), **few)
    if surface.maximal.any():
        volume = surface.volume()
        assert volume.value > 0.0
        assert 0.0 <= volume.error < np.inf
    fixed = gsp.workspace.fixed_orientation(
        design, design.home.rotation, limits, plane=(origin, axes), **SMALL
    )
    if not fixed.empty:
        found = gsp.workspace.boundary_curves(fixed, most=most, budget=60, progress=False)
        assert np.isnan(found.labelled) or 0.0 <= found.labelled <= 1.0
    box = gsp.PoseBox.around(design.home, [0.1 * unit] * 3 + [0.05] * 3)
    grid = gsp.workspace.index_map(design, box, 3, ["CDN_CL"], limits=limits, length=unit)
    assert 0.0 <= grid.share <= 1.0
    if all(leg.name == "D1" for leg in design.legs):
        turned = design.home.rotation
        exact = gsp.workspace.exact_shells(design, turned).volume()
        low, high = gsp.workspace.fixed_orientation(design, turned, **SMALL).volume
        assert low <= exact.value + exact.error
        assert exact.value - exact.error <= high


@pytest.mark.parametrize("kind", KINDS)
def test_every_function_returns_a_proper_result(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    drawn = designs(rng, count(2, 200), 2 * KINDS.index(kind))
    for number, (design, unit) in enumerate(drawn):
        regions_are_proper(kind, number, design, unit)


@pytest.mark.parametrize("kind", KINDS)
def test_boundaries_are_returned_or_there_are_none(kind):
    rng = np.random.default_rng(10 + KINDS.index(kind))
    for design, unit in designs(rng, count(1, 200), KINDS.index(kind)):
        boundaries_are_proper(kind, design, unit)


SIX_THREE = gsp.catalogue.design("workspace-6-3")
POINT = gsp.PoseBox([0.0, 0.0, 8.0], [0.0, 0.0, 0.0])
ONE = {"budget": 1, "progress": False}


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: gsp.workspace.section(SIX_THREE, rays=0), "rays: expected an integer ≥ 1"),
        (lambda: gsp.workspace.surface(SIX_THREE, counts=8), "counts: expected two integers ≥ 1"),
        (lambda: gsp.workspace.index_map(SIX_THREE, POINT, 0, ["CTN"]), "counts: expected one or"),
        (lambda: gsp.workspace.reachable(SIX_THREE, budget=-1), "budget: expected an integer ≥ 1"),
        (lambda: gsp.Limits(base_cone=45), r"base_cone: .*degrees\? np.deg2rad converts"),
        (lambda: gsp.Limits(platform_cone=[45] * 6), r"platform_cone: .*degrees\?"),
    ],
)
def test_numbers_out_of_range_are_clear_errors(call, message):
    with pytest.raises(InvalidInput, match=message):
        call()


@pytest.mark.parametrize("limits", [[], [(8.0, 15.0)] * 6], ids=["empty", "strokes"])
@pytest.mark.parametrize(
    "function",
    [
        lambda limits: gsp.workspace.reachable(SIX_THREE, limits, **ONE),
        lambda limits: gsp.workspace.dextrous(SIX_THREE, POINT, limits, **ONE),
        lambda limits: gsp.workspace.fixed_orientation(SIX_THREE, None, limits, **ONE),
        lambda limits: gsp.workspace.orientations(SIX_THREE, [0, 0, 8], limits, **ONE),
        lambda limits: gsp.workspace.exact_shells(SIX_THREE, None, limits),
        lambda limits: gsp.workspace.section(SIX_THREE, limits=limits),
        lambda limits: gsp.workspace.surface(SIX_THREE, limits=limits),
        lambda limits: gsp.workspace.index_map(SIX_THREE, POINT, 2, ["CTN"], limits=limits),
    ],
    ids=[
        "reachable", "dextrous", "fixed_orientation", "orientations", "exact_shells", "section",
        "surface", "index_map",
    ],
)  # fmt: skip
def test_a_list_is_not_taken_for_limits(function, limits):
    with pytest.raises(InvalidInput, match=r"limits: expected a gsp\.Limits or None, received li"):
        function(limits)
