from itertools import product

import numpy as np
import pytest
from scipy.linalg import eigh

import gsp
from gsp.errors import InvalidDesign, InvalidInput, MissingParameter
from gsp.planar import PlanarDesign, PlanarPose, families, mechanisms
from gsp.planar.indices import (
    condition_number,
    condition_number_ellipsoid,
    control_number,
    cubic_eigenvalues,
    manipulability,
    maximum_determinant,
    metrics,
    quality_index,
)

OE = gsp.Ellipsoid((0.7, 1.2, 0.4), center=(0.3, -0.2, 5.0))


def spatial_matrices(posture, ellipsoid):
    """N, D, T of the source for (q3, q̂1, q̂2), from points in space: the submatrices (36)."""
    pose, design = posture.pose.spatial(), posture.design
    base = np.column_stack((design.base_points, np.zeros(design.n_legs)))
    platform = np.column_stack((design.platform_points, np.zeros(design.n_legs)))
    platform = platform @ pose.rotation.T + pose.position

    def velocity(x):  # of x for (q, q̂) with all six coordinates
        q = np.array([[0, x[2], -x[1]], [-x[2], 0, x[0]], [x[1], -x[0], 0]])
        return np.hstack((q, np.eye(3)))

    n, d, t = (np.zeros((6, 6)) for _ in range(3))
    for b, p in zip(base, platform, strict=True):
        length = np.linalg.norm(p - b)
        row = (p - b) @ velocity(p) / length
        n += np.outer(row, row)
        for x in (b, p):
            t += (velocity(x).T @ velocity(x) - np.outer(row, row)) / length**2
    for s in ellipsoid.vertices @ pose.rotation.T + pose.position:
        d += velocity(s).T @ velocity(s)
    part = np.ix_([2, 3, 4], [2, 3, 4])
    return n[part], d[part], t[part]


@pytest.mark.parametrize("n_legs", [3, 4, 6])
def test_rpr_indices_are_those_of_the_submatrices(n_legs, rng, make_design, make_pose):
    design, pose = make_design(("D1",) * n_legs, rng), make_pose((), rng)
    posture = design.at(pose)
    n, d, t = spatial_matrices(posture, OE)
    for value, metric in (
        (1 / condition_number_ellipsoid(posture, OE), d),
        (control_number(posture), t),
    ):
        eigenvalues = eigh(metric, n, eigvals_only=True)
        assert value == pytest.approx(np.sqrt(eigenvalues[0] / eigenvalues[-1]), rel=1e-9)


def test_the_cubic_formula_gives_the_general_eigenvalues(rng, make_design, make_pose):
    posture = make_design(("D1",) * 4, rng).at(make_pose((50,), rng))
    n, d, t = metrics(posture, OE)
    for metric, value in (
        (d, 1 / condition_number_ellipsoid(posture, OE)),
        (t, control_number(posture)),
    ):
        explicit = cubic_eigenvalues(metric, n)
        general = [eigh(a, b, eigvals_only=True)[::-1] for a, b in zip(metric, n, strict=True)]
        np.testing.assert_allclose(explicit, general, rtol=1e-6)
        np.testing.assert_allclose(np.sqrt(explicit[:, 2] / explicit[:, 0]), value, rtol=1e-5)
    same = cubic_eigenvalues(2.0 * np.eye(3), np.eye(3))
    np.testing.assert_allclose(same, 2.0)
    np.testing.assert_allclose(
        cubic_eigenvalues(1e200 * d, 1e150 * n) / 1e50, cubic_eigenvalues(d, n)
    )
    for bad in (np.ones((3, 3)), np.zeros((3, 3)), -np.eye(3)):
        with pytest.raises(InvalidInput, match="rates: expected positive definite"):
            cubic_eigenvalues(np.eye(3), bad)


@pytest.mark.parametrize("g", [3, 4, 7])
@pytest.mark.parametrize("p", [0.2, 1.0, 3.0])
def test_the_isotropic_planar_designs(g, p):
    design = families.isotropic(g, p)
    posture = design.at(design.home)
    assert condition_number_ellipsoid(posture, design.ellipsoid) == pytest.approx(1.0, abs=1e-12)
    assert control_number(posture) == pytest.approx(1.0, abs=1e-12)
    # The place of the ellipsoid along z is free.
    higher = gsp.Ellipsoid(design.ellipsoid.semi_axes, center=(0, 0, 9.0))
    assert condition_number_ellipsoid(posture, higher) == pytest.approx(1.0, abs=1e-12)


def test_the_isotropic_planar_designs_are_one_parametric():
    """a² + b² = 2 r² (a circle): the projections lie on it, and off it CTN is less than 1."""
    for p in (0.3, 1.0, 2.0):
        x = gsp.families.nawratil.isotropic_parameters(p)
        assert x["a"] ** 2 + x["b"] ** 2 == pytest.approx(2 * x["r"] ** 2, abs=1e-14)
    for angle in (0.1, 1.0, 2.5):
        a, b = np.sqrt(2 / 3) * np.cos(angle), np.sqrt(2 / 3) * np.sin(angle)
        design = families.set_p(3, np.sqrt(1 / 3), a, b)
        assert control_number(design.at(design.home)) == pytest.approx(1.0, abs=1e-12)
        off = families.set_p(3, np.sqrt(1 / 3), 1.05 * a, b)
        assert control_number(off.at(off.home)) < 0.999


def test_base_and_platform_anchors_can_be_exchanged_leg_by_leg():
    for swap in product([False, True], repeat=3):
        design = families.isotropic(3, 0.8, swap)
        posture = design.at(design.home)
        assert control_number(posture) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("platform", mechanisms(), ids=lambda m: m.name)
def test_all_sixteen_have_indices_that_no_motion_and_no_unit_changes(platform, rng, make_design):
    design = make_design(platform.legs, rng)
    pose = PlanarPose([[0.3, 0.4], [-1.0, 0.2]], [0.4, 1.9])
    posture, k = design.at(pose), 250.0
    motion = PlanarPose([5.0, -2.0], 1.1)
    there = design.replace(
        base_points=design.base_points @ motion.rotation.T + motion.position,
        base_directions=design.base_directions @ motion.rotation.T,
    ).at(motion.compose(pose))
    bigger = design.scaled(k).at(PlanarPose(k * pose.position, pose.angle))
    big = gsp.Ellipsoid(k * OE.semi_axes, k * OE.center)
    for function, here, scaled in (
        (condition_number, (0.7,), (0.7 * k,)),
        (control_number, (0.7,), (0.7 * k,)),
        (condition_number_ellipsoid, (OE, 0.7), (big, 0.7 * k)),
    ):
        value = function(posture, *here)
        assert np.isfinite(value).all()
        np.testing.assert_allclose(function(there, *here), value, rtol=1e-9)
        np.testing.assert_allclose(function(bigger, *scaled), value, rtol=1e-9)


def test_singular_undefined_and_bad():
    three = np.array([[1.0, 0.0], [-0.5, 0.8], [-0.5, -0.8]])
    concurrent = PlanarDesign(["D1"] * 3, 2 * three, three).at(PlanarPose([0.0, 0.0], 0.0))
    assert concurrent.singular()
    assert control_number(concurrent) == 0.0
    assert condition_number_ellipsoid(concurrent, OE) == np.inf
    assert condition_number(concurrent, 1.0) == np.inf
    touching = PlanarDesign(["D1"] * 3, three, three).at(
        PlanarPose([[0.0, 0.0], [0.1, 0.3]], [0, 0.7])
    )
    for values in (control_number(touching), condition_number_ellipsoid(touching, OE)):
        assert np.isnan(values).tolist() == [True, False]
    with pytest.raises(InvalidInput, match="Ellipsoid"):
        condition_number_ellipsoid(touching, 3.0)
    angled = PlanarDesign(["D1", "D1", "A1"], three, 2 * three, np.ones((3, 2)), np.eye(3, 2) + 1)
    posture = angled.at(PlanarPose([0.1, 0.2], 0.4))
    with pytest.raises(MissingParameter):
        control_number(posture)
    with pytest.raises(MissingParameter):
        condition_number_ellipsoid(posture, OE)


def test_parallel_lines_of_an_angle_leg_are_the_limit_of_nearly_parallel_ones():
    three = np.array([[1.0, 0.0], [-0.5, 0.8], [-0.3, -0.8]])
    line = [[1, 0]] * 3
    design = PlanarDesign(["D1", "D1", "A1"], three, 2 * three[::-1], line, line)
    angles = np.array([1e-3, 1e-6, 0.0])
    values = control_number(design.at(PlanarPose([0.1, 0.2], angles)), 1.0)
    assert values[2] == 0.0
    assert values[0] > 100 * values[1] > 0.0


# --- λ and the largest determinant -------------------------------------------------------------


def largest_by_search(design, seed=0):
    """The largest |det J| of clouds of poses that shrink around their best ones."""
    rng, size = np.random.default_rng(seed), design.rms_radius

    def values(x):
        return np.nan_to_num(manipulability(design.at(PlanarPose(x[..., :2] * size, x[..., 2]))))

    start = rng.normal(size=(20_000, 3)) * [2.0, 2.0, 2.0]
    best = start[np.argsort(values(start))[-12:]]
    for width in 0.5 * 0.75 ** np.arange(45):
        cloud = best[:, None] + width * rng.normal(size=(12, 60, 3))
        cloud[:, 0] = best
        best = cloud[np.arange(12), np.argmax(values(cloud), axis=1)]
    return float(values(best).max())


TRIANGLE = np.array([[0.0, 0.0], [1.0, 0.1], [0.3, 0.9]])


def test_the_largest_determinant_is_half_the_smaller_perimeter():
    """Lee's (l1 + l2 + l3)/2 for a general platform triangle, against a search over poses."""
    base = np.array([[-1.5, -1.0], [2.0, -0.8], [0.2, 2.1]])
    sides = np.linalg.norm(TRIANGLE - np.roll(TRIANGLE, 1, axis=0), axis=1)
    for design in (
        PlanarDesign(["D1"] * 3, base, TRIANGLE),
        PlanarDesign(["D1"] * 3, TRIANGLE, base),
    ):
        assert maximum_determinant(design) == pytest.approx(sides.sum() / 2, rel=1e-12)
        assert largest_by_search(design) == pytest.approx(sides.sum() / 2, rel=1e-6)


def test_a_base_wound_the_other_way_does_not_reach_it():
    mirrored = 1.2 * TRIANGLE * [-1.0, 1.0]
    design = PlanarDesign(["D1"] * 3, mirrored, TRIANGLE)
    assert (
        largest_by_search(design)
        < 0.97 * np.linalg.norm(TRIANGLE - np.roll(TRIANGLE, 1, axis=0), axis=1).sum() / 2
    )
    with pytest.raises(InvalidDesign, match="reachable"):
        maximum_determinant(design)


def test_reachability_agrees_with_a_search_for_random_triangles():
    rng = np.random.default_rng(12)
    seen = set()
    for _ in range(8):
        design = PlanarDesign(["D1"] * 3, rng.normal(size=(3, 2)), rng.normal(size=(3, 2)))
        bound = min(
            np.linalg.norm(x - np.roll(x, 1, axis=0), axis=1).sum() / 2
            for x in (design.base_points, design.platform_points)
        )
        found = largest_by_search(design)
        assert found <= bound * (1 + 1e-9)
        try:
            assert maximum_determinant(design) == pytest.approx(bound, rel=1e-12)
            assert found == pytest.approx(bound, rel=1e-5)
            seen.add(True)
        except InvalidDesign:
            assert found < bound * (1 - 1e-5)
            seen.add(False)
    assert seen == {True, False}


def test_lambda_of_the_equilateral_platform_is_one_at_its_best_pose():
    angle = np.arange(3) * 2 * np.pi / 3
    triangle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    design = PlanarDesign(["D1"] * 3, -2 * triangle[[1, 2, 0]], triangle[[0, 1, 2]])
    search = maximum_determinant(design)
    assert search == pytest.approx(3 * np.sqrt(3) / 2, rel=1e-12)
    angles = np.linspace(0, 2 * np.pi, 3601)
    values = quality_index(design.at(PlanarPose([0.0, 0.0], angles)))
    assert values.max() == pytest.approx(1.0, abs=1e-5)
    assert values.max() <= 1 + 1e-12


@pytest.mark.parametrize("legs", [("D1", "D1", "D2"), ("D1",) * 4])
def test_only_three_rpr_legs_have_the_closed_form(legs, rng, make_design):
    with pytest.raises(InvalidDesign, match="RPR"):
        maximum_determinant(make_design(legs, rng))


def test_anchors_on_a_line_have_no_closed_form():
    line = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    with pytest.raises(InvalidDesign):
        maximum_determinant(PlanarDesign(["D1"] * 3, 5 * TRIANGLE, line))


@pytest.mark.parametrize("swap", [[True], [True] * 4])
def test_swaps_are_counted(swap):
    with pytest.raises(InvalidInput):
        families.isotropic(3, 1.0, swap)


@pytest.mark.parametrize("shift", [(-0.8, 0.3, 1.1), (0.6, 1.5, -0.4)])
def test_lambda_is_one_in_the_centre_and_falls_on_every_way_out(shift):
    """Base points anywhere on the sides of the larger triangle, the legs along them (figure 1)."""
    angle = np.arange(3) * 2 * np.pi / 3
    triangle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    sides = np.stack((-np.sin(angle), np.cos(angle)), axis=1)
    base = triangle + np.array(shift)[:, None] * sides
    design = PlanarDesign(["D1"] * 3, base, triangle)
    best = 3 * np.sqrt(3) / 2
    centre = design.at(PlanarPose([0.0, 0.0]))
    assert quality_index(centre, best) == pytest.approx(1.0, rel=1e-12)
    rng = np.random.default_rng(0)
    ways = rng.normal(size=(200, 3)) * 0.05
    values = quality_index(design.at(PlanarPose(ways[:, :2], ways[:, 2])), best)
    assert (values < 1.0).all()
