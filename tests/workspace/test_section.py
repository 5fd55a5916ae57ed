"""The vertical plane of Workspace-3, against its own formulas and a general optimiser."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve, minimize

import gsp
from gsp.errors import EmptyWorkspace, InvalidInput, MissingParameter
from gsp.limits.labels import active_from_label
from gsp.workspace import Limits, exact_shells, section
from gsp.workspace.boundary.climb import BARRIER_STEPS

# The section is drawn with φ from the negative z-axis, as eq. (3.14) has it.
AXES = [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]
POINTS = {
    "B": ("000000", (0.6, 0.9, -38)),
    "C": ("001100", (4.3, 0.1, -119)),
    "D": ("011110", (8.7, 3.8, -82)),
    "E": ("111111", (4.2, 10.4, -118)),
    "F": ("111111", (0.0, 13.0, 0)),
    "G": ("011110", (6.6, 8.1, 32)),
}
CURVES = ("BC 00--00", "CD 0-11-0", "DE -1111-", "FG -1111-", "GD 01--10", "EF 11--11")


@pytest.fixture(scope="module")
def plane(platform):
    return section(
        platform, axes=AXES, rays=np.deg2rad([45.0, 90.0, 105.0, 150.0]), starts=6, rng=1
    )


@pytest.fixture(scope="module")
def places(plane, formula):
    """The named points, solved with scipy from eqs. (3.3), (3.4) in the plane of symmetry."""
    result = {}
    for name, (text, (x, z, beta)) in POINTS.items():
        target = [(8.0, 15.0)[int(mark)] for mark in text[:3]]

        def gap(q, target=target):
            return formula(q[0], 0.0, q[1], 0.0, q[2], 0.0)[:3] - target

        result[name] = fsolve(gap, (x, z, np.deg2rad(beta)), xtol=1e-13)
    return result


def number(plane, place):
    wanted = np.array([place[0], 0.0, place[1]])
    gaps = [np.linalg.norm(b.pose.position - wanted) for b in plane.bifurcations]
    turn = [abs(b.pose.angles("approach-roll")[1] - place[2]) for b in plane.bifurcations]
    found = [i for i in range(len(gaps)) if gaps[i] < 1e-9 and turn[i] < 1e-9]
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize("name", POINTS)
def test_bifurcation_points_are_exact(plane, places, name):
    node = plane.bifurcations[number(plane, places[name])]
    assert node.label.replace(" ", "") == POINTS[name][0]
    assert np.abs(node.joints - [(8.0, 15.0)[int(c)] for c in POINTS[name][0]]).max() < 1e-11


@pytest.mark.parametrize("text", CURVES)
def test_curves_join_the_points_that_the_source_states(plane, places, text):
    (start, stop), label = text.split()
    ends = {number(plane, places[start]), number(plane, places[stop])}
    assert any({plane.curves[i].first, plane.curves[i].last} == ends for i in plane.find(label))


def test_no_curve_is_reported_twice(plane):
    keys = [
        (c.active, frozenset((c.first, c.last)), *np.sort(c.pose.position[[1, -2]], axis=0).ravel())
        for c in plane.curves
    ]
    rounded = {(k[0], k[1], *np.round(k[2:], 3)) for k in keys}
    assert len(rounded) == len(keys)


def test_points_of_curves_satisfy_the_printed_formulas(plane, formula):
    for curve in plane.curves:
        angles = curve.pose.angles("approach-roll")
        values = formula(*curve.pose.position.T, *angles.T)
        for leg, side in curve.active:
            assert np.abs(values[leg] - (8.0, 15.0)[side]).max() < 1e-10
        assert values.min() > 8.0 - 1e-7
        assert values.max() < 15.0 + 1e-7
        assert np.abs(curve.pose.position[:, 1]).max() < 1e-12


def test_weights_are_those_of_dependent_gradients(plane, formula):
    """Σ λ ∂l/∂(turn) = 0 with signs, by central differences of the formula in the angles."""
    step = 1e-6
    for curve in plane.curves:
        sign = np.array([1.0 if side else -1.0 for _, side in curve.active])
        legs = [leg for leg, _ in curve.active]
        i = len(curve.pose) // 2
        place = curve.pose.position[i]
        angles = curve.pose.angles("approach-roll")[i]
        total = np.zeros(3)
        for axis in range(3):
            turn = step * np.eye(3)[axis]
            change = formula(*place, *(angles + turn)) - formula(*place, *(angles - turn))
            total[axis] = (curve.weight[i] * sign) @ change[legs] / (2 * step)
        assert np.abs(total).max() < 1e-7
        assert np.linalg.norm(curve.weight[i]) == pytest.approx(1.0)


def test_ef_and_gd_are_maxima_on_a_part_only(plane, places):
    """Their multipliers change sign: from there on they only connect bifurcation points."""
    for text, ends in (("11--11", "EF"), ("01--10", "GD")):
        wanted = {number(plane, places[end]) for end in ends}
        curves = [plane.curves[i] for i in plane.find(text)]
        curve = next(c for c in curves if {c.first, c.last} == wanted)
        assert 0.0 < curve.maximal.mean() < 1.0
        inner = slice(1, -1)
        negative = (curve.weight[inner] < -1e-6).any(axis=1)
        assert not (curve.maximal[inner] & negative).any()


@pytest.mark.parametrize("phi", [45.0, 90.0, 150.0])
def test_ray_ends_against_a_general_optimiser(plane, formula, phi):
    """SLSQP with the printed formulas, from the pose of the ray end: it cannot get farther."""
    ends, direction = plane.ends, np.array([np.sin(np.deg2rad(phi)), -np.cos(np.deg2rad(phi))])
    assert ends.maximal.mean() > 0.9
    along = ends.position[:, [0, 2]] - plane.origin[[0, 2]]
    on = np.flatnonzero((np.abs(along @ [-direction[1], direction[0]]) < 1e-9) & ends.maximal)
    angles = gsp.Pose(ends.position[on], ends.rotation[on]).angles("approach-roll")
    for i, w in zip(on[:3], angles[:3], strict=True):
        x0 = np.array([ends.distance[i] - 1e-3, *w])

        def lengths(q):
            x, z = plane.origin[[0, 2]] + q[0] * direction
            return formula(x, 0.0, z, *q[1:])

        found = minimize(
            lambda q: -q[0],
            x0,
            method="SLSQP",
            options={"ftol": 1e-13, "maxiter": 300},
            constraints={"type": "ineq", "fun": lambda q: np.r_[lengths(q) - 8, 15 - lengths(q)]},
        )
        assert -found.fun == pytest.approx(ends.distance[i], abs=1e-6)


def test_crossings_of_rays_are_solved_on_their_rays(plane):
    angles = np.deg2rad(np.linspace(20, 170, 31))
    frame = plane.on_rays(angles)
    assert frame["solved"].mean() > 0.9
    good = frame[frame["solved"]]
    x = good["distance"] * np.sin(good["angle"])
    z = plane.origin[2] - good["distance"] * np.cos(good["angle"])
    assert np.abs(good["x"] - x).max() < 1e-10
    assert np.abs(good["z"] - z).max() < 1e-10
    assert (frame[frame["outer"]].groupby("ray").size() >= 1).all()
    assert frame.loc[frame["outer"], "maximal"].all()
    at_150 = frame[(frame["ray"] == 26) & frame["maximal"]]
    assert at_150["distance"].max() == pytest.approx(4.7398, abs=1e-4)


def test_tables(plane):
    table, points = plane.table(), plane.bifurcation_table()
    assert len(table) == sum(len(c.pose) for c in plane.curves)
    assert len(points) == len(plane.bifurcations)
    e = points[(points["label"] == "1 1 1 1 1 1") & (points["z"].sub(10.41168).abs() < 1e-4)]
    assert e["beta"].iloc[0] == pytest.approx(-117.95983, abs=1e-5)


def test_fixed_orientation_agrees_with_the_shells(platform):
    turn = gsp.Pose.from_angles([0, 0, 0], [0, 0, -30], "approach-roll", degrees=True).rotation
    plane = [[np.cos(0.3), np.sin(0.3), 0.0], [0.0, 0.0, 1.0]]
    mapped = section(platform, [0.0, 0.0, 8.5], plane, rotation=turn, rays=12)
    arcs = [
        arc
        for arc in exact_shells(platform, turn).section([0.0, 0.0, 8.5], plane)
        if arc.points[:, 2].min() > 0
    ]
    assert mapped.ends.maximal.all()
    assert sorted(c.label for c in mapped.curves) == sorted(arc.label for arc in arcs)
    exact = np.array([end for arc in arcs for end in (arc.first, arc.last)])
    for node in mapped.bifurcations:
        assert np.linalg.norm(exact - node.pose.position, axis=1).min() < 1e-9
    for curve in mapped.curves:
        assert curve.maximal[1:-1].all()
        assert not curve.lost


def test_a_box_of_positions_bounds_the_set(platform):
    turn = np.eye(3)
    box = Limits(position=[None, None, (4.0, 9.0)])
    mapped = section(platform, rotation=turn, rays=8, limits=box)
    heights = np.concatenate([c.pose.position[:, 2] for c in mapped.curves])
    assert heights.min() == pytest.approx(4.0)
    assert heights.max() == pytest.approx(9.0)
    assert any("z=1" in c.label for c in mapped.curves)


def test_other_legs_with_a_fixed_orientation():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    joints = design.at(design.home).joints
    limits = Limits(strokes=np.stack((joints - 8.0, joints + 8.0), axis=1))
    mapped = section(design, rotation=design.home.rotation, rays=12, limits=limits)
    assert mapped.ends.maximal.all()
    for curve in mapped.curves:
        assert not curve.lost
        assert curve.maximal[1:-1].all()
        values = design.at(curve.pose).joints
        for leg, side in curve.active:
            bound = joints[leg] + (16.0 * side - 8.0)
            assert np.abs(values[:, leg] - bound).max() < 1e-8


def test_progress_advances_along_rays_and_within_curves(platform):
    heard = []
    options = {"rotation": np.eye(3), "rays": 4, "starts": 1}
    mapped = section(platform, progress=lambda *at: heard.append(at), **options)
    done, total = np.array(heard).T
    assert ((np.diff(done) >= 0) & (np.diff(done) <= max(BARRIER_STEPS))).all()
    assert (done <= total).all()
    assert done[-1] == total[-1]
    points = sum(len(curve.pose) for curve in mapped.curves)
    assert len(mapped.curves) < 20
    assert len(heard) > points > 50
    # A function that raises, as Ctrl-C does, ends the call wherever it is.
    for number in (1, len(heard) // 3, len(heard)):
        calls = []

        def stop(done, total, calls=calls, number=number):
            calls.append(done)
            if len(calls) == number:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            section(platform, progress=stop, **options)
        assert len(calls) == number


def test_what_the_budget_of_steps_ends_is_stated(platform):
    options = {"rays": 3, "starts": 1, "connecting": False, "progress": False}
    short = section(platform, budget=40, **options)
    full = section(platform, rotation=np.eye(3), **options)
    assert {curve.status for curve in short.curves} <= {"complete", "budget"}
    assert short.curves[-1].status == "budget"
    assert sum(len(curve.pose.position) - 1 for curve in short.curves) <= 40
    assert not any(curve.status == "budget" for curve in full.curves)
    assert full.waiting == 0
    one = section(platform, most=1, **options)
    assert len(one.curves) == 1
    assert one.waiting > 0


def test_bad_input(platform):
    with pytest.raises(EmptyWorkspace, match="feasible orientation"):
        section(platform, [0.0, 0.0, 40.0])
    with pytest.raises(EmptyWorkspace, match="d1"):
        section(platform, [0.0, 0.0, 2.0], rotation=np.eye(3))
    with pytest.raises(InvalidInput, match="least < greatest"):
        section(platform, limits=Limits(strokes=[[9.0, 9.0]] * 6))
    with pytest.raises(InvalidInput, match="independent"):
        section(platform, axes=[[1, 0, 0], [1, 0, 0]])
    with pytest.raises(MissingParameter):
        section(platform.replace(strokes=None))
    with pytest.raises(InvalidInput, match="home"):
        section(platform.replace(home=None))
    with pytest.raises(InvalidInput, match="marks"):
        active_from_label("0 1 2", 6)


@pytest.mark.parametrize("pose", ["identity", "home"])
def test_a_few_feasible_orientations_about_a_known_one_are_found(platform, pose):
    """Strokes of ±1e-4 of legs of 8 to 15 allow no random orientation."""
    place = gsp.Pose([0.0, 0.0, 10.0])
    home = gsp.Pose.from_rpy([0.0, 0.0, 10.0], [20.0, -10.0, 30.0], degrees=True)
    there = {"identity": place, "home": home}[pose]
    joints = platform.at(there).joints
    few = platform.replace(
        home=home if pose == "home" else None,
        strokes=np.stack((joints - 1e-4, joints + 1e-4), axis=1),
    )
    found = section(few, place.position, rays=2, starts=3, connecting=False)
    assert len(found.ends.distance) == 2
    np.testing.assert_allclose(found.ends.rotation, np.stack([there.rotation] * 2), atol=1e-3)


def test_where_no_orientation_is_found_the_number_of_tries_is_stated(platform):
    """No joint is within its stroke at the identity; those at random prove nothing."""
    joints = platform.at(gsp.Pose.from_rpy([0.0, 0.0, 10.0], [1.0, 2.0, 3.0])).joints
    few = platform.replace(home=None, strokes=np.stack((joints - 1e-6, joints + 1e-6), axis=1))
    for search in (section, gsp.workspace.surface):
        with pytest.raises(EmptyWorkspace, match="none was found in 20001 tries; closest: d"):
            search(few, [0.0, 0.0, 10.0])


def test_a_table_without_curves_has_the_types_of_one_with_rows(plane):
    none = replace(plane, curves=()).table()
    kinds = plane.table().dtypes
    assert not len(none)
    assert list(none.columns) == list(kinds.index)
    numbers = ["curve", "x", "y", "z", "alpha", "beta", "gamma", "maximal", "connecting"]
    assert (none.dtypes[numbers] == kinds[numbers]).all()


@pytest.mark.parametrize("leg", [0, 3])
def test_one_limited_leg_bounds_two_circles(platform, leg):
    """The platform origin is at most l + |b| from the base anchor, and at least l − |b|."""
    strokes = np.full((6, 2), np.nan)
    arm = np.linalg.norm(platform.platform_points[leg])
    strokes[leg] = arm + np.array([2.0, 5.0])
    place = platform.base_points[leg] + [0.0, 0.0, 2.0 * arm + 3.5]
    found = section(platform.replace(strokes=strokes), place, rays=8, starts=4)
    assert found.ends.maximal.all()
    assert not found.bifurcations
    assert sorted(curve.held for curve in found.curves) == [((leg, 0),), ((leg, 1),)]
    for curve in found.curves:
        side = curve.held[0][1]
        assert curve.closed
        assert curve.maximal.all()
        away = np.linalg.norm(curve.pose.position - platform.base_points[leg], axis=1)
        np.testing.assert_allclose(away, strokes[leg, side] + (2 * side - 1) * arm, rtol=1e-10)


def test_a_limited_angle_alone_bounds_no_position():
    design = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    angle = int(np.flatnonzero(design.angular)[0])
    strokes = np.full((6, 2), np.nan)
    strokes[angle] = design.at(design.home).joints[angle] + np.array([-0.3, 0.3])
    found = section(design.replace(strokes=strokes), rays=2, starts=1)
    assert not found.ends.maximal.any()
    assert not found.curves
