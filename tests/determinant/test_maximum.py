"""The maximum of |det J|: closed forms, seeds, bounds, domains, symmetries."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp.determinant import (
    Neighbourhood,
    UnboundedDeterminant,
    default_neighbourhood,
    maximum,
    upper_bound,
)
from gsp.determinant.hexagons import central_pose
from gsp.determinant.symmetry import symmetries
from gsp.errors import InvalidInput, MissingParameter
from gsp.families import lee
from gsp.geometry.pose import Pose, PoseBox
from gsp.indices import manipulability
from tests import campaign

FAMILIES = [
    (lee.octahedral_3_3(1.0, 2.0), lee.central_maximum(1.0, 2.0)),
    (lee.octahedral_3_3(1.3, 1.3), lee.central_maximum(1.3, 1.3)),
    (lee.octahedral_3_3(1.0, 4.0), lee.central_maximum(1.0, 4.0)),
    (lee.platform_3_6(1.0, 2.0, 0.2), lee.central_maximum(1.0, 2.0, 0.0, 0.2)),
    (lee.platform_3_6(1.0, 1.5, 0.05), lee.central_maximum(1.0, 1.5, 0.0, 0.05)),
    (lee.platform_6_6(1.0, 1.0, 0.25, 1 / 6), lee.central_maximum(1.0, 1.0, 0.25, 1 / 6)),
    (lee.platform_6_6(1.0, 1.2, 0.1, 0.1), lee.central_maximum(1.0, 1.2, 0.1, 0.1)),
    (
        lee.separated_to_centre(1.0, 2.0, 0.2),
        lee.best_central_pose(lee.to_centre, 1.0, 2.0, 0.2)[0],
    ),
    (
        lee.separated_along_side(1.0, 2.0, 0.2),
        lee.best_central_pose(lee.along_side, 1.0, 2.0, 0.2)[0],
    ),
]  # fmt: skip


# The quick ones of each kind; all with `make check-long`.
SEARCHED = [FAMILIES[i] for i in (0, 1, 4, 5, 7, 8, 2, 3, 6)[: campaign.count(6, 9)]]


def search(design):
    """The search, also where a closed form is known."""
    return maximum(design, seed=0, store=False)


def general(legs, seed=0):
    return gsp.Design(legs, *np.random.default_rng(seed).normal(size=(4, len(legs), 3)))


@pytest.mark.parametrize(("design", "value"), SEARCHED, ids=lambda x: getattr(x, "name", ""))
def test_search_finds_the_closed_forms(design, value):
    found = search(design)
    assert found.value == pytest.approx(float(value), rel=1e-10)
    assert manipulability(design.at(found.pose)) == pytest.approx(found.value, rel=1e-10)
    assert found.converged
    assert found.agreed >= 5


@pytest.mark.parametrize(
    "design",
    [lee.octahedral_3_3(1.0, 1.0), general(["D1"] * 6, seed=1), general(["D1"] * 6, seed=2)],
    ids=["octahedron", "general 1", "general 2"],
)
def test_all_seeds_find_the_same_value(design):
    seeds = range(campaign.count(2, 20))
    values = [maximum(design, seed=seed, store=False).value for seed in seeds]
    assert np.ptp(values) < 1e-10 * max(values)


def test_the_same_seed_gives_the_same_record():
    design = general(["D1"] * 6, seed=1)
    one, two = (maximum(design, seed=5, store=False) for _ in range(2))
    assert one.value == two.value
    assert (one.pose.position == two.pose.position).all()
    assert one.facts() == two.facts()
    assert one.seed == 5
    assert maximum(design, seed=np.random.default_rng(5), store=False).seed is None


@pytest.mark.parametrize("index", [0, 3, 5])
def test_the_closed_form_is_taken_where_it_is_proven(index):
    design, value = FAMILIES[index]
    found = maximum(design, store=False)
    assert found.method == "closed form"
    assert found.proven
    assert found.value == pytest.approx(float(value), rel=1e-12)
    assert found.value == pytest.approx(found.bound, rel=1e-12)


def test_the_closed_form_is_known_in_any_axes_and_order_of_legs():
    design = lee.platform_6_6(1.0, 1.0, 0.25, 1 / 6)
    order = [3, 0, 5, 1, 4, 2]
    turn, other = (Pose.from_rpy([0.3, 0.2, v], [v, 0.4, 2.0 * v]) for v in (0.5, 1.5))
    moved = gsp.Design(
        ["D1"] * 6,
        (design.base_points @ turn.rotation.T + turn.position)[order],
        (design.platform_points @ other.rotation.T + other.position)[order],
    )
    for each in (moved, moved.exchanged(), moved.scaled(25.4)):
        found = maximum(each, store=False)
        assert found.method == "closed form"
        assert manipulability(each.at(found.pose)) == pytest.approx(found.value, rel=1e-12)


def test_the_half_turn_is_the_better_central_pose_beyond_3_alpha_beta_1():
    design = lee.platform_6_6(1.0, 1.5, 0.8, 0.7)
    value = manipulability(design.at(central_pose(design)))
    assert value > 10.0 * lee.central_maximum(1.0, 1.5, 0.8, 0.7)
    assert search(design).value == pytest.approx(float(value), rel=1e-10)


def test_the_best_central_pose_is_not_always_the_best_pose():
    """Against the reading that eqs. (17), (55) and figures 19, 29 give |det J|max everywhere."""
    found = search(lee.octahedral_3_3(1.0, 20.0)).value
    assert found / lee.central_maximum(1.0, 20.0) == pytest.approx(1.09915, abs=1e-5)
    assert search(lee.octahedral_3_3(20.0, 1.0)).value == pytest.approx(found, rel=1e-10)
    for make, closed_form, rho, ratio in (
        (lee.separated_to_centre, lee.to_centre, 0.8, 1.274),
        (lee.separated_along_side, lee.along_side, 0.4, 1.031),
        (lee.separated_along_side, lee.along_side, 0.32, 1.0),
        (lee.separated_to_centre, lee.to_centre, 0.7, 1.0),
    ):
        best = lee.best_central_pose(closed_form, 1.0, 2.0, rho)[0]
        assert search(make(1.0, 2.0, rho)).value / best == pytest.approx(ratio, abs=1e-3)


@pytest.mark.parametrize(
    "legs",
    [
        ["D1"] * 6,
        ["D2"] * 6,
        ["D3"] * 6,
        ["D1"] * 3 + ["D2"] * 2 + ["A1"],
        ["D1"] * 8,
        ["D3"] * 3 + ["A1"] * 3,
        ["D1"] * 4 + ["A1"] * 2,
    ],
)
def test_no_pose_exceeds_the_bound(legs):
    rng = np.random.default_rng(0)
    for seed in range(4):
        design = general(legs, seed)
        far = rng.normal(size=(2000, 3)) * 10.0 ** rng.uniform(-1, 4, (2000, 1))
        values = manipulability(design.at(Pose.from_rpy(far, rng.uniform(-3, 3, (2000, 3)))))
        assert np.isfinite(upper_bound(design))
        assert np.nanmax(values) < upper_bound(design)


MORE_THAN_SIX = [
    ["D1"] * 6 + ["A1"],
    ["D1"] * 5 + ["A1"] * 3,
    ["D1"] * 4 + ["A1"] * 4,
    ["D3"] * 4 + ["A1"] * 3,
    ["D1"] * 3 + ["D2"] * 2 + ["A1"] * 2,
    ["D4"] * 3 + ["A1"] * 4,
    ["D1"] * 2 + ["A1"] * 5,
]


@pytest.mark.parametrize("legs", MORE_THAN_SIX, ids="".join)
@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_no_climb_exceeds_the_bound_of_more_than_six_legs_with_couples(legs, unit):
    """In all units: the minors with more couples count more where lengths are small."""
    rng = np.random.default_rng(3)
    steps = np.repeat([unit, 1.0], 3)
    poses_each = campaign.count(150, 400)
    for seed in range(2):
        flat = [1.0, 1.0, seed]  # the second design has its anchors in planes
        points = rng.normal(size=(2, len(legs), 3)) * flat * unit
        design = gsp.Design(legs, *points, *rng.normal(size=(2, len(legs), 3)))
        bound = upper_bound(design)
        far = unit * 10.0 ** rng.uniform(-1, 2, (poses_each, 1))
        poses = Pose.from_rpy(
            rng.normal(size=(poses_each, 3)) * far, rng.uniform(-3, 3, (poses_each, 3))
        )
        for width in 0.5 ** np.arange(12.0):
            values = manipulability(design.at(poses))
            assert np.nanmax(values) <= bound * (1.0 + 1e-12)
            best = poses[int(np.nanargmax(values))]
            poses = best.moved(rng.normal(size=(poses_each, 6)) * steps * width)


def test_the_bound_of_three_lines_and_more_couples_is_reached():
    """Three lines at right angles, and six couples, two about each axis: det JᵀJ = 1 · 2³."""
    axes = np.eye(3)
    design = gsp.Design(
        ["D4"] * 3 + ["A1"] * 6,
        np.zeros((9, 3)),
        np.zeros((9, 3)),
        np.vstack((axes, axes, axes))[:, [1, 2, 0]],
        np.vstack((axes, axes, axes))[:, [2, 0, 1]],
    )
    assert manipulability(design.at(Pose([0.1, 0.2, 0.3]))) == pytest.approx(8.0**0.5, rel=1e-12)
    assert upper_bound(design) == pytest.approx(8.0**0.5, rel=1e-12)


@pytest.mark.parametrize("unit", [1.0, 1e3])
def test_the_maximum_of_six_legs_and_a_couple_is_not_called_proven(unit):
    """The couple only adds to det JᵀJ of the six legs."""
    angles = np.deg2rad([-8, 8, 112, 128, 232, 248, 0, -52, 52, 68, 172, 188, 292, 0])
    radii = np.array([2.0] * 6 + [0.0] + [1.0] * 6 + [0.0])
    ends = unit * np.stack((radii * np.cos(angles), radii * np.sin(angles), 0.0 * radii), axis=1)
    lines = np.tile([[1.0, 0.0, 0.0], [0.0, 1.0, 0.2]], (7, 1))
    design = gsp.Design(["D1"] * 6 + ["A1"], ends[:7], ends[7:], lines[::2], lines[1::2])
    alone = gsp.Design(["D1"] * 6, ends[:6], ends[7:13])
    found = maximum(design, store=False)
    assert found.value > maximum(alone, store=False).value
    assert upper_bound(design) > upper_bound(alone)
    assert found.value < found.bound
    assert not found.proven


@pytest.mark.parametrize("legs", [["D2"] * 3 + ["D3"] * 3, ["D2"] * 4 + ["D3"] * 2])
def test_d2_with_d3_grows_without_bound_as_the_platform_runs_away(legs):
    design = general(legs)
    away = np.outer(10.0 ** np.arange(1, 7), [0.3, 0.5, 0.8])
    values = manipulability(design.at(Pose.from_rpy(away, [0.2, 0.3, 0.4])))
    assert (values[1:] / values[:-1] > 5.0).all()
    assert upper_bound(design) == np.inf


def test_d4_grows_without_bound_as_its_lines_turn_parallel():
    design = general(["D1"] * 5 + ["D4"])
    s, t = design.base_directions[5], design.platform_directions[5]
    axis = np.cross(t, s) / np.linalg.norm(np.cross(t, s))
    angle = np.arctan2(np.linalg.norm(np.cross(t, s)), s @ t)
    missing = 10.0 ** -np.arange(1.0, 7.0)
    from gsp.geometry.frames import exp3

    pose = Pose([0.3, 0.2, 0.5], exp3((angle - missing)[:, None] * axis))
    values = manipulability(design.at(pose))
    assert (values[2:] / values[1:-1] > 5.0).all()
    assert upper_bound(design) == np.inf


def test_d2_alone_is_d3_with_base_and_platform_exchanged():
    """So |det J| of D2 rows without D3 and D4 is bounded, as that of D3 rows is."""
    design = general(["D2"] * 6, seed=3)
    rng = np.random.default_rng(0)
    pose = Pose.from_rpy(rng.normal(size=(50, 3)) * 100.0, rng.normal(size=(50, 3)))
    exchanged = manipulability(design.exchanged().at(pose.inverse()))
    np.testing.assert_allclose(manipulability(design.at(pose)), exchanged, rtol=1e-7)
    assert upper_bound(design) == pytest.approx(upper_bound(design.exchanged()), rel=1e-12)
    found = maximum(design, store=False)
    assert found.domain is None
    assert found.value == pytest.approx(maximum(design.exchanged(), store=False).value, rel=1e-10)


@pytest.mark.parametrize("name", ["D2^3 D3^3", "D1^5 D4"])
def test_a_neighbourhood_of_home_is_taken_where_there_is_no_bound(name):
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    design = gsp.catalogue.instantiate(gsp.catalogue.mechanism(name), template)
    found = maximum(design, store=False)
    near = default_neighbourhood(design)
    assert isinstance(found.domain, Neighbourhood)
    assert set(found.facts()["domain"]) == {"near_home", "centre", "displacement", "angle_deg"}
    assert found.domain.contains(found.pose)
    samples = near.sample(3000, np.random.default_rng(0))
    assert near.contains(samples).all()
    assert np.nanmax(manipulability(design.at(samples))) <= found.value
    assert maximum(design, seed=9, store=False).value == pytest.approx(found.value, rel=1e-9)
    with pytest.raises(InvalidInput, match="unbounded"):
        maximum(design, "all")


def test_without_a_home_a_domain_is_required():
    design = general(["D4"] * 6)
    assert design.home is None
    with pytest.raises(MissingParameter, match="home pose of the design, or domain="):
        maximum(design)
    with pytest.raises(MissingParameter, match="home pose of the design, or maximum="):
        gsp.indices.quality_index(design.at(Pose([0.0, 0.0, 1.0])))
    with pytest.raises(MissingParameter, match="home pose of the design, or maximum="):
        gsp.evaluate(design, Pose([0.0, 0.0, 1.0]), ["quality_index"])
    with pytest.raises(MissingParameter, match="home pose of the design, or maximum="):
        gsp.rank([design], Pose([0.0, 0.0, 1.0]), ["quality_index"])


def test_the_default_neighbourhood_follows_the_strokes():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    limits = design.at(design.home).joints[:, None] + [-20.0, 15.0]
    assert default_neighbourhood(design.replace(strokes=limits)).displacement == pytest.approx(35.0)
    moved = design.replace(
        platform_points=design.platform_points + [1e3, 0.0, 0.0],
        home=design.home.compose(Pose([-1e3, 0.0, 0.0])),
    )
    one, two = default_neighbourhood(design), default_neighbourhood(moved)
    assert two.displacement == pytest.approx(one.displacement, rel=1e-12)
    np.testing.assert_allclose(two.centre, one.centre, atol=1e-9)


def test_the_border_of_a_neighbourhood_is_reached_and_not_passed():
    """Of an octahedron below its best height, against the best of many poses on the border."""
    design = lee.octahedral_3_3(1.0, 2.0)
    near = Neighbourhood(home=Pose([0, 0, 0.4]), centre=[0, 0, 0.4], displacement=0.2, angle=1e-6)
    found = maximum(design, near, store=False)
    expected = lee.central_determinant(1.0, 2.0, 0.6)
    assert found.value == pytest.approx(float(expected), rel=1e-5)
    assert near.contains(found.pose)
    assert np.linalg.norm(found.pose.position - near.centre) == pytest.approx(0.2, rel=1e-6)


@pytest.mark.parametrize("seed", range(2))
def test_a_box_with_parallel_lines_of_d4_is_an_error(seed):
    design = general(["D1"] * 5 + ["D4"], seed)
    s, t = design.base_directions[5], design.platform_directions[5]
    turn, _ = Rotation.align_vectors([s], [t])
    pose = Pose([0.3, 0.2, 0.5], turn.as_matrix())
    with pytest.raises(UnboundedDeterminant, match="leg 6"):
        maximum(design, PoseBox.around(pose, [0.5] * 3 + [0.3] * 3), store=False)
    with pytest.raises(UnboundedDeterminant, match="parallel at the home pose"):
        maximum(design.replace(home=pose))


def test_a_box_of_ups_poses_holds_the_maximum_inside_and_on_its_border():
    design, value = lee.octahedral_3_3(1.0, 2.0), lee.central_maximum(1.0, 2.0)
    around = PoseBox([(-0.5, 0.5), (-0.5, 0.5), (0.5, 1.5)], [(-0.5, 0.5)] * 3)
    assert maximum(design, around, store=False).value == pytest.approx(float(value), rel=1e-10)
    low = PoseBox([0.0, 0.0, (0.2, 0.6)], [0.0, 0.0, 0.0])
    expected = lee.central_determinant(1.0, 2.0, 0.6)
    found = maximum(design, low, store=False)
    assert found.value == pytest.approx(float(expected), rel=1e-10)
    assert found.pose.position[2] == pytest.approx(0.6, abs=1e-6)


def test_a_supremum_at_a_vanishing_leg_is_attained_by_no_pose(monkeypatch):
    monkeypatch.setattr("gsp.determinant.search.rounds.MOST_ROUNDS", 1)
    rng = np.random.default_rng(11)
    rng.normal(size=(72, 3))
    design = gsp.Design(["D1"] * 3 + ["A1"] * 3, *rng.normal(size=(4, 6, 3)))
    found = search(design)
    # Of an optimisation of rotation and direction alone, with the second leg of length zero.
    assert found.value == pytest.approx(0.976779077597008, abs=1e-7)
    assert not found.attained
    assert not found.converged
    assert (found.starts, found.agreed, found.n_local_maxima) == (0, 0, 0)
    assert (found.expected_unseen, found.probability_new) == (np.inf, 1.0)


def test_a_redundant_design_has_a_maximum():
    design = general(["D1"] * 8, seed=4)
    values = [maximum(design, seed=s, store=False).value for s in range(campaign.count(2, 4))]
    assert np.ptp(values) < 1e-10 * max(values)
    poses = Pose.sample([(-3, 3)] * 3, [(-3, 3)] * 3, 20000, rng=0)
    assert manipulability(design.at(poses)).max() < values[0]


def test_a_design_that_is_singular_everywhere_has_the_maximum_zero():
    found = maximum(lee.separated_along_side(1.0, 2.0, 0.5), store=False)
    assert (found.value, found.pose) == (0.0, None)


def test_the_maximum_is_invariant_and_has_the_unit_of_its_determinant():
    design = general(["D3"] * 5 + ["A1"], seed=1)
    value = maximum(design, seed=0, store=False).value
    scaled = maximum(design.scaled(10.0), seed=1, store=False).value
    assert scaled == pytest.approx(100.0 * value, rel=1e-9)


@pytest.mark.parametrize(("design", "number"), [(FAMILIES[0][0], 12), (FAMILIES[8][0], 6)])
def test_symmetries_map_poses_to_equally_good_ones(design, number):
    group = symmetries(design)
    assert len(group) == number
    poses = Pose.sample([(-1, 1)] * 3, [(-3, 3)] * 3, 20, rng=1)
    value = manipulability(design.at(poses))
    for symmetry in group:
        image = Pose(*symmetry.image(poses.position, poses.rotation))
        np.testing.assert_allclose(manipulability(design.at(image)), value, rtol=1e-9)


def test_the_pose_of_a_symmetric_design_does_not_depend_on_the_seed():
    design = lee.separated_along_side(1.0, 2.0, 0.2)
    poses = [maximum(design, seed=seed, store=False).pose for seed in range(campaign.count(3, 5))]
    for pose in poses[1:]:
        np.testing.assert_allclose(pose.position, poses[0].position, atol=1e-6)
        np.testing.assert_allclose(pose.rotation, poses[0].rotation, atol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("no design",), "design"),
        ((FAMILIES[0][0], "everything"), "domain"),
        ((FAMILIES[0][0], PoseBox([0, 0, 1], [0, 0, 0])), "width"),
        ((FAMILIES[0][0], None, -1), "seed"),
        ((FAMILIES[0][0], None, 1.5), "seed"),
    ],
)
def test_bad_input_is_named(arguments, message):
    with pytest.raises(InvalidInput, match=message):
        maximum(*arguments)


def test_progress_counts_rounds():
    reports = []
    maximum(
        general(["D1"] * 6), store=False, progress=lambda done, total: reports.append((done, total))
    )
    assert reports[0][0] == 1
    assert all(done <= total for done, total in reports)


@pytest.mark.parametrize("progress", [True, False])
def test_progress_of_a_search_may_be_a_flag(progress):
    found = maximum(lee.octahedral_3_3(1.0, 1.3), store=False, progress=progress)
    assert found.method == "search"


@pytest.mark.parametrize("ratio", [1.3, 2.0])
def test_progress_is_checked_also_where_nothing_is_searched(ratio):
    with pytest.raises(InvalidInput, match="progress: expected a function"):
        maximum(lee.octahedral_3_3(1.0, ratio), store=False, progress="yes")


def test_a_limit_toward_parallel_lines_of_an_angle_is_not_attained():
    """Ten seconds: in `make check-long` only."""
    if campaign.count(1, 2) == 1:
        pytest.skip("a long search")
    turn = np.deg2rad([0.0, 120.0, 240.0])
    ring = lambda r, a: np.c_[r * np.cos(a), r * np.sin(a), 0.0 * a]  # noqa: E731
    tangents, radii = ring(1.0, turn + np.pi / 2.0), ring(1.0, turn)
    base, platform = ring(1.0, turn), ring(0.6, turn + np.deg2rad(10.0))
    design = gsp.Design(
        ["D3"] * 3 + ["A1"] * 3,
        np.r_[base, base],
        np.r_[platform, platform],
        np.r_[tangents, tangents],
        np.r_[tangents, radii],
    )
    found = maximum(design, store=False)
    assert found.value == pytest.approx(1.0, abs=1e-9)
    assert not found.attained


def test_a_search_of_a_limit_ends_early_with_the_same_value():
    """Toward parallel lines of the A1 legs: no start settles, and all seeds approach one value."""
    points = np.random.default_rng(9).normal(size=(4, 6, 3))
    design = gsp.Design(["D1"] * 3 + ["A1"] * 3, *points)
    one, two = (maximum(design, seed=seed, store=False) for seed in (0, 1))
    assert one.starts == one.agreed == 0
    assert not one.converged
    assert one.evaluations < 150_000  # a third of those of twelve rounds
    assert one.value == pytest.approx(two.value, rel=1e-7)


POWERS = (-330, -180, -60, 60, 170, 330)


def redundant(name):
    rng = np.random.default_rng(5)
    a, b, s, t = rng.normal(size=(4, 8, 3))
    return gsp.Design([name] * 6 + ["A1"] * 2, a, b, s, t)


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize(
    "design",
    [gsp.families.lee.octahedral_3_3(1.0, 2.0), gsp.hexapod(2.0, 0.2, 1.0, 0.3, 1.5)],
    ids=["coplanar", "6-6"],
)
def test_bounds_hold_in_every_unit(design, power):
    scale = 2.0**power
    assert upper_bound(design.scaled(scale)) == upper_bound(design) * scale**3


@pytest.mark.parametrize("power", POWERS)
def test_bounds_of_mixed_units_hold_in_every_unit(power):
    # With 6 + 2 rows the minors without couples are of length³, those with two of length.
    scale = 2.0**power
    for name in ("D1", "D2", "D3"):
        design = redundant(name)
        bounds = [upper_bound(design.scaled(x)) for x in (2.0**-300, 2.0**300)]
        least, greatest = bounds[0] / 2.0**-300, bounds[1] / 2.0**900
        found = upper_bound(design.scaled(scale))
        powers = [greatest * scale**3, least * scale]
        assert max(powers) <= found * (1 + 1e-12)
        mixed = upper_bound(design) ** 2 - greatest**2 - least**2
        assert found == pytest.approx(
            np.hypot(np.hypot(*powers), np.sqrt(max(mixed, 0.0)) * scale**2), rel=1e-9
        )


def test_a_bound_that_no_float_holds_is_rounded_up():
    design = gsp.families.lee.octahedral_3_3(1.0, 2.0).scaled(2.0**-330)
    shift = np.array([0.0, 0.0, 2.0**-330])
    # Arms of 2⁻³⁷⁰, of which the third power is below every float, beside greater coordinates.
    tiny = design.replace(
        base_points=design.base_points * 2.0**-40 + shift,
        platform_points=design.platform_points * 2.0**-40 + shift,
    )
    assert 0.0 < upper_bound(tiny) < 1e-300
    assert upper_bound(tiny.replace(base_points=np.tile(shift, (6, 1)))) == 0.0
