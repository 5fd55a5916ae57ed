"""Designs with legs that are driven at the base, in tables, limits and sweeps beside others."""

import numpy as np
import pytest

import gsp
from gsp.errors import GspError, InvalidDesign, MissingParameter
from gsp.indices import INDICES
from gsp.limits import Limits
from tests import driven

NAMES = ("control_number", "condition_number", "minimum_singular_value", "manipulability")


@pytest.mark.parametrize("design", driven.DESIGNS.values(), ids=driven.DESIGNS)
def test_tables_have_the_values_of_the_indices(design):
    poses = driven.near_home(design, 12)
    tables = [
        gsp.evaluate(design, poses, NAMES, length=0.7, backend=backend)
        for backend in ("compiled", "numpy")
    ]
    posture = design.at(poses)
    for name in NAMES:
        own = {"length": 0.7} if name != "manipulability" else {}
        expected = INDICES[name].function(posture, **own)
        for table in tables:
            assert (table[name].to_numpy() == expected).all()


def test_they_rank_beside_telescopic_designs():
    """The order is that of the means of the index, recomputed one by one."""
    designs = [
        driven.rotary().replace(name="rotary"),
        driven.hexaglide().replace(name="hexaglide"),
        gsp.hexapod(2.0, 0.28, 1.0, 0.28, 1.5, name="telescopic", unit="m"),
    ]
    poses = gsp.PoseBox([(-0.1, 0.1)] * 2 + [(1.45, 1.55)], [(-0.05, 0.05)] * 3).sample(50, rng=3)
    table = gsp.rank(designs, poses, ["control_number"], length=0.7).set_index("design")
    means = {
        one.name: float(gsp.indices.control_number(one.at(poses), 0.7).mean()) for one in designs
    }
    for name, mean in means.items():
        assert np.isclose(table.loc[name, "control_number_mean"], mean, rtol=1e-12)
    assert list(table.index) == sorted(means, key=means.get, reverse=True)


def test_cranks_need_a_length_and_sliders_do_not():
    pose = driven.rotary().home
    for name in ("control_number", "condition_number_points"):
        with pytest.raises(MissingParameter):
            gsp.evaluate(driven.rotary(), pose.reshape(1), name)
        gsp.evaluate(driven.hexaglide(), driven.hexaglide().home.reshape(1), name)
    with pytest.raises(MissingParameter, match="cranks"):
        driven.rotary().at(pose).weighted(None)


def test_no_maximum_of_the_determinant_and_no_key_of_the_store():
    from gsp.determinant.canonical import canonical

    design = driven.hexaglide()
    for ask in (gsp.determinant.maximum, gsp.determinant.reference, canonical):
        with pytest.raises(InvalidDesign, match="driven at the base"):
            ask(design)
    with pytest.raises(InvalidDesign, match="driven at the base"):
        gsp.indices.quality_index(design.at(design.home))
    assert gsp.indices.quality_index(design.at(design.home), maximum=2.0) > 0.0


def test_the_determinant_grows_without_bound_near_a_singular_drive():
    """Why λ has no maximum: as the inverse root of the distance from the singular pose."""
    design = driven.hexaglide()
    across = np.abs(design.platform_points[:, 1] + 0.05 - design.base_points[:, 1])
    top = np.sqrt(2.2**2 - across.max() ** 2)
    poses = gsp.Pose([[0.1, 0.05, top - shift] for shift in (1e-4, 1e-6, 1e-8)])
    values = gsp.indices.manipulability(design.at(poses))
    assert np.allclose(values[1:] / values[:-1], 10.0, rtol=0.05)


def test_strokes_are_those_of_the_drives():
    design = gsp.catalogue.design("lane-modified-paradex")
    poses = gsp.Pose([[0.0, 0.0, z] for z in (2.6, 2.8, 4.2, 5.6, 5.8)])
    joints = design.at(poses).joints
    inside = ((joints >= 0.0) & (joints <= 3.0)).all(axis=-1)
    found = gsp.feasible(design, poses)
    assert inside.tolist() == [False, True, True, True, False]
    assert (found.ok == inside).all()
    assert "d1 = " in found.reasons[0]


def test_out_of_reach_is_not_feasible_and_has_a_reason():
    design = gsp.catalogue.design("lane-modified-paradex")
    found = gsp.feasible(design, gsp.Pose([4.0, 0.0, 4.2]))
    assert not found.ok
    assert "the rod does not reach from the rail" in found.reason


@pytest.mark.parametrize("limits", [
    {"base_cone": 0.5}, {"platform_cone": 0.5}, {"leg_radius": 0.01},
])  # fmt: skip
def test_cones_and_clearances_are_refused(limits):
    design = driven.rotary()
    with pytest.raises(InvalidDesign, match="driven at the base"):
        gsp.feasible(design, design.home, Limits(**limits))


@pytest.mark.parametrize("design", driven.DESIGNS.values(), ids=driven.DESIGNS)
def test_gradients_are_those_of_differences(design):
    """By anchors and base lines: the lengths of rods and cranks are fixed."""
    pose = driven.near_home(design, 1)[0]
    found = gsp.indices.gradient(design.at(pose), "condition_number", length=0.7)

    def value(changed):
        return float(gsp.indices.condition_number(changed.at(pose), 0.7))

    step = 1e-5 * design.rms_radius
    for part in ("base_points", "platform_points"):
        for place in ((0, 0), (1, 2), (4, 1)):
            shift = np.zeros_like(design.base_points)
            shift[place] = step
            high, low = (
                value(design.replace(**{part: getattr(design, part) + sign * shift}))
                for sign in (1, -1)
            )
            expected = (high - low) / (2 * step)
            assert np.isclose(getattr(found, part)[place], expected, rtol=1e-5, atol=1e-7)


def test_a_space_whose_rods_change_has_no_gradient():
    def make(rod):
        return driven.general("slider", 1).replace(legs=[gsp.Slider(rod=rod)] * 6)

    space = gsp.Space(make, {"rod": (2.8, 3.2)})
    task = gsp.Task(poses=driven.HOME.reshape(1), wanted="mean CDN_CL", samples=1, length=0.7)
    with pytest.raises(GspError, match="same legs"):
        gsp.exploration.gradient(space, task, {"rod": 3.0})


@pytest.mark.parametrize("design", driven.DESIGNS.values(), ids=driven.DESIGNS)
def test_stiffness_and_forces_are_those_of_virtual_work(design):
    pose = driven.near_home(design, 1)[0]
    jacobian = design.at(pose).jacobian
    wrench = np.array([1.0, -2.0, 3.0, 0.2, 0.1, -0.3])
    forces = design.at(pose).actuator_forces(wrench)
    assert np.allclose(jacobian.T @ forces, -wrench, rtol=0, atol=1e-10)
    assert np.allclose(gsp.stiffness(design, pose, 3.0), 3.0 * jacobian.T @ jacobian, rtol=1e-12)


both = pytest.mark.parametrize(
    "design", [driven.general("slider", 1), driven.general("crank", 1), driven.mixed()]
)


@both
def test_sweeps_tasks_and_maps_have_the_values_of_the_index(design):
    path = gsp.sweeps.translation(design.home, "x", [0.0, 0.02, 0.05])
    table = gsp.sweep(design, path, ["CTN"], length=0.7)
    expected = gsp.indices.control_number(design.at(path.pose), 0.7)
    assert np.array_equal(table["control_number"], expected)
    box = gsp.PoseBox.around(design.home, [0.02] * 3 + [0.02] * 3)
    task = gsp.Task(poses=box, wanted="mean CTN", samples=16, length=0.7)
    mean = gsp.indices.control_number(design.at(task.pose()), 0.7).mean()
    found = gsp.exploration.assess(design, task)["control_number_mean"]
    assert np.isclose(float(np.ravel(found)[0]), mean, rtol=1e-12)
    limits = Limits(position=[(-9.0, 9.0)] * 3)
    mapped = gsp.workspace.index_map(design, box, 2, ["CTN"], length=0.7, limits=limits)
    assert mapped.feasible.all()
    expected = gsp.indices.control_number(design.at(mapped.pose), 0.7)
    assert np.allclose(mapped.values["control_number"], expected, rtol=1e-12)


@both
def test_errors_of_joints_move_the_platform_by_the_inverse(design):
    posture = design.at(design.home)
    found = gsp.statics.pose_errors(posture, 0.01)
    inverse = np.linalg.pinv(posture.jacobian)
    assert np.allclose(found.worst, 0.01 * np.abs(inverse).sum(axis=1), rtol=1e-9)
    assert np.allclose(found.covariance, 1e-4 * inverse @ inverse.T, rtol=0, atol=1e-9)


@both
def test_least_controlled_motions(design):
    """Of unit passive rates, and with the actuator rates that the Jacobian gives."""
    posture = design.at(design.home)
    found = gsp.instantaneous_motion(posture, length=0.7)
    rates = np.linalg.norm(posture.weighted(0.7) @ found.twists, axis=0)
    sizes = np.linalg.norm(posture.passive_rates(0.7) @ found.twists, axis=0)
    assert np.allclose(sizes, 1.0, rtol=1e-9)
    assert np.allclose(rates, found.rates, rtol=1e-9)
    ratio = gsp.indices.control_number(posture, 0.7)
    assert np.isclose(rates[0] / rates[-1], ratio, rtol=1e-9)


@both
def test_the_characteristic_length_has_the_least_condition_number(design):
    found = float(gsp.characteristic_length(design).length)
    posture = design.at(design.home)
    values = [float(gsp.indices.condition_number(posture, found * k)) for k in (0.98, 1.0, 1.02)]
    assert values[1] == min(values)


@both
def test_sensitivities_are_the_gradients(design):
    task = gsp.Task(poses=design.home.reshape(1), wanted="mean CDN_CL", samples=1, length=0.7)
    table = gsp.exploration.sensitivities(design, task).set_index("parameter")
    found = gsp.indices.gradient(design.at(design.home), "condition_number", length=0.7)
    for name, place in (("base_x1", (0, 0)), ("base_z5", (4, 2))):
        assert np.isclose(table.loc[name, "derivative"], found.base_points[place], rtol=1e-9)


def test_parallel_rails_have_a_motion_without_passive_joints():
    """All carriages together: the least gain to passive joints is 0, and so is the control number.

    The posture is regular. The motion has no unit size in the measure of the passive joints.
    """
    for design in (driven.hexaglide(), gsp.catalogue.design("lane-modified-paradex")):
        posture = design.at(driven.near_home(design, 3))
        along = np.concatenate((design.base_directions[0], np.zeros(3)))
        assert np.allclose(posture.jacobian @ along, 1.0, rtol=1e-12)
        assert np.abs(posture.passive_rates(None) @ along).max() < 1e-13
        assert not posture.singular().any()
        assert (gsp.indices.control_number(posture) == 0.0).all()
        assert np.isnan(gsp.instantaneous_motion(posture).rates).all()


def test_all_indices_are_those_that_driven_designs_have():
    design = driven.hexaglide().replace(ellipsoid=gsp.Ellipsoid(0.5))
    table = gsp.evaluate(design, driven.near_home(design, 2), "all", length=0.7)
    assert set(table.columns) >= set(INDICES) - {"singularity_distance", "quality_index"}
    assert table.attrs["left_out"] == ["quality_index", "singularity_distance"]
    singular = gsp.Pose([0.1, 0.05, 1.4]).reshape(1)
    with pytest.raises(InvalidDesign, match="driven at the base"):
        gsp.evaluate(design, singular, "SD", length=0.7)


def test_singular_drives_are_counted_as_singular():
    legs = [gsp.Slider(rod=3.0), *["D1"] * 5]
    base = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [-2, 0, 0], [0, -2, 0], [1, 1, 0]]
    platform = [[0, 0, 0], [1, 0.2, 0], [0, 1, 0.1], [-1, 0.3, 0], [0.2, -1, 0], [0.3, 0.3, 0.1]]
    design = gsp.Design(legs, base, platform, [[1, 0, 0]] * 6, name="singular drives")
    poses = gsp.Pose([[0.3, 0, z] for z in (2.5, 3.0, 3.5, 2.9)])
    row = gsp.rank(design, poses, ["condition_number"], length=0.7).iloc[0]
    assert (row["singular"], row["undefined"]) in ((1, 1), (0.25, 0.25))
