import numpy as np
import pytest
from scipy.optimize import minimize

import gsp
from gsp.errors import GspError, InvalidInput, MissingParameter, UnknownIndex
from gsp.limits.bounds import bounded_quantities
from gsp.limits.legs import clearances, leg_pairs, segment_distance
from gsp.workspace import Limits, feasible

MIXED = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"


def sample(design, n=12, seed=5):
    return gsp.PoseBox.around(design.home, [20, 20, 20, 0.2, 0.2, 0.2]).sample(n, rng=seed)


def test_strokes_are_those_of_the_joints_and_the_reason_names_the_joint(platform):
    pose = gsp.Pose([[0.0, 0.0, 7.8], [0.0, 0.0, 13.0], [0.0, 0.0, 2.0]])
    found = gsp.feasible(platform, pose)
    joints = platform.at(pose).joints
    assert found.ok.tolist() == ((joints >= 8) & (joints <= 15)).all(axis=1).tolist()
    assert found.ok.tolist() == [True, False, False]
    assert found.reasons[0] == ""
    assert found.reasons[1].startswith("d1 = 15.03")
    assert "> 15" in found.reasons[1]
    assert found.reasons[2].count("< 8") == 6


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
def test_batches_keep_their_shape(platform, shape):
    pose = gsp.Pose(np.broadcast_to([0.0, 0.0, 7.8], (*shape, 3)))
    found = feasible(platform, pose)
    assert found.ok.shape == found.reasons.shape == shape
    assert found.ok.all()
    assert bool(found)


def test_a_pose_at_its_limit_is_feasible(platform):
    height = np.sqrt(225.0 - 57.0)
    assert gsp.feasible(platform, gsp.Pose([0.0, 0.0, height])).ok


def test_cones_are_angles_of_the_legs_in_base_and_platform():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    design = design.replace(legs=["D1"] * 6)
    pose = sample(design)
    bounds = Limits(base_cone=0.1, platform_cone=0.2)
    values = feasible(design, pose, bounds).values
    legs = design.at(pose).lines.d
    home = design.at(design.home).lines.d

    def angle(u, v):
        return np.arccos((u * v).sum(-1) / np.linalg.norm(u, axis=-1) / np.linalg.norm(v, axis=-1))

    seen = np.einsum("nij,nki->nkj", pose.rotation, legs)
    home_seen = home @ design.home.rotation
    assert np.allclose(values[:, 6:12], angle(legs, home), atol=1e-9)
    assert np.allclose(values[:, 12:], angle(seen, home_seen), atol=1e-9)
    assert feasible(design, design.home, bounds).ok


@pytest.mark.parametrize("side", ["base", "platform"])
def test_a_leg_may_have_no_cone(side):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    design = design.replace(legs=["D1"] * 6, strokes=None)
    pose = sample(design)
    angles = feasible(design, pose, Limits(**{f"{side}_cone": 1.0})).values[:, 6:]
    some = np.full(6, np.nan)
    some[[1, 4]] = np.quantile(angles[:, [1, 4]], 0.7, axis=0)
    here = feasible(design, pose, Limits(**{f"{side}_cone": some}))
    assert here.ok.tolist() == (angles[:, [1, 4]] <= some[[1, 4]]).all(axis=1).tolist()
    assert len(set(here.ok.tolist())) == 2
    assert np.array_equal(here.values[:, 6:], angles)
    with pytest.raises(MissingParameter):
        feasible(design, pose, Limits(**{f"{side}_cone": np.full(6, np.nan)}))


def test_legs_on_lines_stay_perpendicular_so_that_the_cone_is_the_turn_about_the_line():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    segments = design.at(sample(design)).segments
    assert np.abs((segments.along * design.base_directions).sum(-1)).max() < 1e-10
    on_line = np.cross(segments.base_feet - design.base_points, design.base_directions)
    assert np.abs(on_line).max() < 1e-9


@pytest.mark.parametrize("side", ["base", "platform"])
def test_the_cone_of_a_line_is_the_turn_about_it_from_an_oblique_axis(side):
    design = gsp.catalogue.design(MIXED)
    pose, rng = sample(design), np.random.default_rng(3)
    axes = rng.normal(size=(design.n_legs, 3))
    bounds = Limits(**{f"{side}_cone": 1.0, f"{side}_axes": axes})
    found = feasible(design, pose, bounds)
    angles = found.values[:, -design.n_legs :]
    along = design.at(pose).segments.along
    seen = along if side == "base" else np.einsum("nij,nki->nkj", pose.rotation, along)
    lines = [i for i, leg in enumerate(design.legs) if getattr(leg, f"{side}_line")]
    assert lines
    for i in lines:
        line = getattr(design, f"{side}_directions")[i]
        x = np.cross(line, rng.normal(size=3))
        y = np.cross(line, x)
        turn = [np.arctan2(v @ y, v @ x) for v in (axes[i], *seen[:, i])]
        turns = np.abs((np.array(turn[1:]) - turn[0] + np.pi) % (2 * np.pi) - np.pi)
        np.testing.assert_allclose(angles[:, i], turns, atol=1e-9)
    axes[lines[0]] = getattr(design, f"{side}_directions")[lines[0]]
    with pytest.raises(InvalidInput, match=rf"{side}_axes\[{lines[0]}\]: expected an axis that is"):
        feasible(design, pose, Limits(**{f"{side}_cone": 1.0, f"{side}_axes": axes}))


def test_segment_distance_against_a_minimiser():
    rng = np.random.default_rng(2)
    for _ in range(25):
        p, u, q, v = rng.normal(size=(4, 3))

        def gap(x, p=p, u=u, q=q, v=v):
            return float(((p + x[0] * u - q - x[1] * v) ** 2).sum())

        best = min(
            minimize(gap, start, bounds=[(0, 1)] * 2, options={"ftol": 1e-15, "gtol": 1e-12}).fun
            for start in ([0.5, 0.5], [0.1, 0.9], [0.9, 0.1])
        )
        assert segment_distance(p, u, q, v) == pytest.approx(np.sqrt(best), abs=1e-6)


def test_segment_distance_of_parallel_and_crossing_segments():
    x, y, z = np.eye(3)
    assert segment_distance(0 * x, x, y, x) == 1.0
    assert segment_distance(0 * x, x, 2 * x, x) == 1.0
    assert segment_distance(0 * x, x, 0.5 * x - 0.5 * y, y) == 0.0
    assert segment_distance(0 * x, 0 * x, z, 0 * x) == 1.0


def test_legs_with_a_common_anchor_are_not_compared(platform):
    pairs = leg_pairs(platform)
    assert len(pairs) == 12
    assert (0, 1) not in pairs
    assert (0, 5) in pairs
    found = feasible(platform, platform.home, Limits(leg_radius=0.1))
    direct = clearances(platform.at(platform.home), pairs)
    assert np.array_equal(found.values[6:], direct)
    wide = feasible(platform, platform.home, Limits(leg_radius=0.51 * direct.min()))
    assert "clearance" in wide.reason


def test_index_thresholds_by_name_and_symbol():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    pose = sample(design)
    values = gsp.evaluate(design, pose, ["condition_number", "control_number"])
    limits = Limits(indices=["condition_number <= 3.1", "CTN ≥ 0.1"])
    found = feasible(design, pose, limits)
    wanted = (values["condition_number"] <= 3.1) & (values["control_number"] >= 0.1)
    assert found.ok.tolist() == wanted.tolist()
    assert 0 < found.ok.sum() < len(pose)


def test_undefined_quantities_are_infeasible_with_a_reason(platform):
    design = platform.replace(base_points=platform.platform_points)
    found = feasible(design, gsp.Pose([0.0, 0.0, 0.0]))
    assert not found.ok
    assert "d1 is not defined" in found.reason


@pytest.mark.parametrize("share", [1e-15, -1e-15, 2e-15])
def test_legs_that_are_undefined_in_a_posture_are_infeasible_for_the_same_reason(platform, share):
    home = platform.home
    above = home.position + home.rotation @ platform.platform_points[0]
    lengthened = above + [0.0, 0.0, share * np.linalg.norm(above)]
    base = np.concatenate(([lengthened], platform.base_points[1:]))
    design = platform.replace(base_points=base)
    (undefined,) = design.at(home).undefined
    found = feasible(design, home, Limits(strokes=[[-np.inf, 100.0]] * 6))
    assert not found.ok
    assert found.reason == f"{undefined.joint} is not defined: {undefined.reason}"


def test_gradients_of_all_kinds_of_limits():
    design = gsp.catalogue.design(MIXED)
    limits = Limits(base_cone=1.0, leg_radius=1.0, indices=["CTN >= 0.01"])
    bounds = bounded_quantities(design, limits)
    _, rows = bounds.evaluate(design.home.position, design.home.rotation)
    step = 1e-4
    for axis in range(3):
        ahead, back = (design.home.position + s * step * np.eye(3)[axis] for s in (1, -1))
        change = bounds.quantities.values(ahead, design.home.rotation) - bounds.quantities.values(
            back, design.home.rotation
        )
        assert np.allclose(rows[:, axis], change / (2 * step), atol=1e-6)


@pytest.mark.parametrize(
    ("limits", "kind"),
    [
        (dict(strokes=[[2.0, 1.0]] * 6), InvalidInput),
        (dict(strokes=[[1.0, 2.0]] * 5), InvalidInput),
        (dict(base_cone=-1.0), InvalidInput),
        (dict(leg_radius=0.0), InvalidInput),
        (dict(leg_radius="thin"), InvalidInput),
        (dict(strokes=[1.0, 2.0]), InvalidInput),
        (dict(strokes=[[[1.0, 2.0]] * 6]), InvalidInput),
        (dict(strokes="long"), InvalidInput),
        (dict(base_cone=[0.1] * 5), InvalidInput),
        (dict(base_cone=0.0), InvalidInput),
        (dict(platform_cone=[[0.1] * 6]), InvalidInput),
        (dict(base_cone=1.0, base_axes=[[0.0, 0.0, 0.0]] * 6), InvalidInput),
        (dict(base_cone=1.0, base_axes=[[0.0, 0.0, 1.0]] * 5), InvalidInput),
        (dict(position=[(0.0, 1.0)]), InvalidInput),
        (dict(position=[(0.0, 1.0), None, (2.0, 1.0)]), InvalidInput),
        (dict(position=[(0.0, 1.0), None, 2.0]), InvalidInput),
        (dict(position=[("a", 1.0), None, None]), InvalidInput),
        (dict(position=5), InvalidInput),
        (dict(indices=5), InvalidInput),
        (dict(indices=[5]), InvalidInput),
        (dict(indices=["CTN >= much"]), InvalidInput),
        (dict(length=-1.0), InvalidInput),
        (dict(maximum=0.0), InvalidInput),
        (dict(ellipsoid=100.0), InvalidInput),
        (dict(indices=["CTN"]), InvalidInput),
        (dict(indices=["CTM >= 0.1"]), UnknownIndex),
        (dict(indices=["quality_index >= 0.1"]), MissingParameter),
        (dict(), MissingParameter),
    ],
)
def test_bad_limits_are_named(limits, kind):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.raises(kind) as error:
        feasible(design, design.home, Limits(**limits))
    assert isinstance(error.value, GspError)


@pytest.mark.parametrize("degrees", [90.0, 30.0, [10.0] * 6])
def test_cones_in_degrees_are_errors_with_a_hint(degrees):
    with pytest.raises(InvalidInput, match=r"limits\.base_cone: expected angles in .*degrees"):
        Limits(base_cone=degrees)
    assert Limits(base_cone=np.deg2rad(90.0)).base_cone == np.pi / 2


@pytest.mark.parametrize("given", [[[1.0, 2.0]] * 6, "strokes", 5, {"strokes": None}])
def test_an_object_that_is_not_limits_is_an_error(platform, given):
    with pytest.raises(InvalidInput, match=r"limits: expected a gsp\.Limits or None"):
        feasible(platform, platform.home, given)


def test_crossing_limits_are_refused_when_they_are_made():
    strokes = [[8.0, 15.0]] * 3 + [[15.0, 8.0]] + [[8.0, 15.0]] * 2
    message = r"limits of joint 4: expected least ≤ greatest, received 15 and 8"
    with pytest.raises(InvalidInput, match=message):
        Limits(strokes=strokes)
    assert Limits(strokes=[[8.0, 8.0], [np.nan, 3.0], [-np.inf, np.inf]]).strokes.shape == (3, 2)
    with pytest.raises(InvalidInput, match="limits of z"):
        Limits(position=[None, None, (9.0, 4.0)])


def test_limits_are_read_only_copies():
    strokes = np.ones((6, 2)) * [1.0, 2.0]
    limits = Limits(strokes=strokes, position=[None, (0.0, 1.0), (None, 3.0)])
    strokes[:] = 5.0
    assert limits.strokes.tolist() == [[1.0, 2.0]] * 6
    assert limits.position.tolist() == [[-np.inf, np.inf], [0.0, 1.0], [-np.inf, 3.0]]
    with pytest.raises(ValueError, match="read-only"):
        limits.strokes[0] = 0.0


def test_cones_need_axes():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6").replace(home=None)
    with pytest.raises(MissingParameter, match="base_axes"):
        feasible(design, gsp.Pose([0.0, 0.0, 100.0]), Limits(base_cone=1.0))
